# Copies the headers of the libraries from the folder FROM to the folder TO, those that have changed.
foreach(folder solver model reference results)
  file(COPY ${FROM}/${folder} DESTINATION ${TO} FILES_MATCHING PATTERN *.hpp)
endforeach()
