# Writes a header that says which source code and which arithmetic a reference was computed with.
#   cmake -D OUTPUT=<header> -D ROOT=<folder> -D FILES=<sources, sorted> -D COMPILER=<c++> -D FLAGS=<its flags> -P fingerprint.cmake

include(${CMAKE_CURRENT_LIST_DIR}/../solver/base/hash_of_files.cmake)
hash_of_files(sources ${ROOT} ${FILES})

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
