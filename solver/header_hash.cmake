# Writes a header with the hash of others.
#   cmake -D OUTPUT=<header> -D ROOT=<folder> -D FILES=<headers, sorted> -P header_hash.cmake
set(listing "")
foreach(file IN LISTS FILES)
  file(SHA256 ${file} hash)
  file(RELATIVE_PATH name ${ROOT} ${file})
  string(APPEND listing "${hash} ${name}\n")
endforeach()
string(SHA256 hash "${listing}")
string(SUBSTRING ${hash} 0 32 hash)
file(WRITE ${OUTPUT} "#pragma once

namespace drape::solver {

constexpr char header_hash[] = \"${hash}\";

}  // namespace drape::solver
")
