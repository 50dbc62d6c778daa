# Writes a header with the hash of others.
#   cmake -D OUTPUT=<header> -D FOLDER=<name> -D ROOT=<its path> -D FILES=<headers, sorted> -P header_hash.cmake
include(${CMAKE_CURRENT_LIST_DIR}/base/hash_of_files.cmake)
hash_of_files(hash ${ROOT} ${FILES})
string(SUBSTRING ${hash} 0 32 hash)
file(WRITE ${OUTPUT} "#pragma once

namespace drape::${FOLDER} {

constexpr char header_hash[] = \"${hash}\";

}  // namespace drape::${FOLDER}
")
