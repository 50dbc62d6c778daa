# Writes a header that says which source code and which arithmetic a reference was computed with.
#   cmake -D OUTPUT=<header> -D ROOT=<folder> -D FILES=<sources, sorted> -D COMPILER=<c++> -D FLAGS=<its flags> -P fingerprint.cmake

set(listing "")
foreach(file IN LISTS FILES)
  file(SHA256 ${file} hash)
  file(RELATIVE_PATH name ${ROOT} ${file})
  string(APPEND listing "${hash} ${name}\n")
endforeach()
string(SHA256 sources "${listing}")

# -march=native is another machine on every machine, and an updated compiler has the old name: its macros tell.
separate_arguments(arguments UNIX_COMMAND "${FLAGS}")
execute_process(COMMAND ${COMPILER} ${arguments} -dM -E -x c++ /dev/null OUTPUT_VARIABLE macros COMMAND_ERROR_IS_FATAL ANY)
string(SHA256 arithmetic "${macros}")

file(WRITE ${OUTPUT} "#pragma once

namespace drape::reference {

constexpr char fingerprint[] = R\"(sources ${sources}
flags ${FLAGS}
predefined macros ${arithmetic})\";

}  // namespace drape::reference
")
