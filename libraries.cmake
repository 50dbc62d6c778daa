# What the libraries need, for our own build and for find_package(drape) of the installed ones.

# --- Libraries: each by its Debian package, with the reason it is here --------------------------------------------------
function(say_missing what debian_package)
  message(FATAL_ERROR "${what} is missing: install the Debian package ${debian_package} (apt-get install ${debian_package}), "
                      "or let bench/run install all that is needed.")
endfunction()
function(require_package name debian_package)
  find_package(${name} ${ARGN} QUIET)
  if(NOT ${name}_FOUND)
    say_missing(${name} ${debian_package})
  endif()
  set(${name}_VERSION "${${name}_VERSION}" PARENT_SCOPE)
endfunction()
function(require_module prefix module debian_package)
  pkg_check_modules(${prefix} QUIET IMPORTED_TARGET ${module})
  if(NOT ${prefix}_FOUND)
    say_missing(${module} ${debian_package})
  endif()
  set(${prefix}_VERSION "${${prefix}_VERSION}" PARENT_SCOPE)
endfunction()

find_package(PkgConfig QUIET)
if(NOT PkgConfig_FOUND)
  say_missing(pkg-config pkg-config)
endif()
find_package(Threads REQUIRED)
find_package(OpenMP REQUIRED)                                  # threads for large grids; part of g++
require_package(Eigen3 libeigen3-dev 3.4 NO_MODULE)            # vectors and matrices
require_package(SUNDIALS libsundials-dev 6.4)                  # CVODE: the reference
require_package(benchmark libbenchmark-dev)                    # timing, interleaved
require_package(GTest libgtest-dev)                            # tests
require_package(fmt libfmt-dev)                                # text
require_package(CLI11 libcli11-dev)                            # command lines
require_package(assimp libassimp-dev)                          # meshes of obstacles
require_package(CGAL libcgal-dev)                              # meshes of outlines: headers only
require_module(TOMLPP tomlplusplus libtomlplusplus-dev)        # scene files
require_module(HDF5 hdf5-serial libhdf5-dev)                   # the record
require_module(XXHASH libxxhash libxxhash-dev)                 # keys of cached references, checksums
require_module(JSON nlohmann_json nlohmann-json3-dev)  # --format json, the journal, cached references

# A library that ships neither .pc nor configuration, as a target of this name.
function(require_library name library header debian_package)
  find_library(${name}_LIBRARY ${library})
  find_path(${name}_INCLUDE_DIR ${header} PATH_SUFFIXES suitesparse)
  if(NOT ${name}_LIBRARY OR NOT ${name}_INCLUDE_DIR)
    say_missing(${name} ${debian_package})
  endif()
  add_library(${name} INTERFACE IMPORTED)
  target_link_libraries(${name} INTERFACE ${${name}_LIBRARY})
  target_include_directories(${name} SYSTEM INTERFACE ${${name}_INCLUDE_DIR})
endfunction()
require_library(CHOLMOD cholmod cholmod.h libsuitesparse-dev)  # SuiteSparse: sparse Cholesky
require_library(KLU klu klu.h libsuitesparse-dev)              # the same for SUNDIALS: sparse LU
require_library(GLPK glpk glpk.h libglpk-dev)                  # numbers of cells of sewn panels: integer programmes
