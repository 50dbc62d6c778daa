# Writes the commit of the sources in SOURCE_DIR as a row for results/provenance.cpp to OUTPUT, which is touched only if it changes.
# Runs with every build, since a commit does not make CMake configure again.
# "-dirty" also for files git does not know: a new source file is found and built like any other.
execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse HEAD
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
execute_process(COMMAND git -C ${SOURCE_DIR} status --porcelain OUTPUT_VARIABLE changes ERROR_QUIET)
if(failed)
  set(commit unknown)
elseif(changes)
  string(APPEND commit -dirty)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT
  [[{"git_commit", "@commit@", "commit of the sources, -dirty if they had changes that were not committed"},
]])
