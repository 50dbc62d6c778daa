#pragma once

#include <cstddef>
#include <iterator>

#include "solver/header_hash.hpp"
#include "solver/methods.hpp"

/// A plugin is a shared library that the program loads. It has methods by a source that includes this header and ends in
///
///     DRAPE_PLUGIN(rows)    // rows: an array of drape::solver::Method
///
/// compiled by drape_plugin() of find_package(drape), or forces (model/plugin.hpp). It calls the functions in the program.
namespace drape::solver {

/// One thing that must be the same in a plugin and the program, since they share classes and are to compute the same.
struct BuildFact {
  const char* name;
  const char* value;
};

/// What a plugin with methods shows. The first two members stay as they are: they are read before it is known who has made the
/// rest.
struct Plugin {
  const BuildFact* facts;
  std::size_t fact_count;
  const Method* methods;
  std::size_t method_count;
};

#define DRAPE_TEXT_OF(x) #x
#define DRAPE_TEXT(x) DRAPE_TEXT_OF(x)

#ifdef NDEBUG
#define DRAPE_ASSERTIONS "no assertions"
#else
#define DRAPE_ASSERTIONS "assertions"
#endif
#ifdef __SANITIZE_ADDRESS__
#define DRAPE_SANITIZERS ", AddressSanitizer"
#else
#define DRAPE_SANITIZERS ""
#endif
#if defined __AVX512F__
#define DRAPE_VECTORS "AVX-512"
#elif defined __AVX2__
#define DRAPE_VECTORS "AVX2"
#else
#define DRAPE_VECTORS "SSE2"
#endif

/// Facts of the source that includes this. Not inline: else a plugin's would be the program's.
constexpr BuildFact build_facts[] = {
    {"headers", header_hash},
    {"compiler", __VERSION__},
    {"standard library", DRAPE_TEXT(__GLIBCXX__) ", ABI " DRAPE_TEXT(_GLIBCXX_USE_CXX11_ABI)},
    {"Eigen", DRAPE_TEXT(EIGEN_WORLD_VERSION) "." DRAPE_TEXT(EIGEN_MAJOR_VERSION) "." DRAPE_TEXT(EIGEN_MINOR_VERSION)},
    {"flags", DRAPE_COMPILE_FLAGS},
    {"macros", DRAPE_VECTORS ", " DRAPE_ASSERTIONS DRAPE_SANITIZERS ", C++ " DRAPE_TEXT(__cplusplus)},
};

}  // namespace drape::solver

#define DRAPE_PLUGIN(rows)                                                                                       \
  extern "C" {                                                                                                   \
  extern const drape::solver::Plugin drape_plugin __attribute__((visibility("default")));                        \
  const drape::solver::Plugin drape_plugin = {drape::solver::build_facts, std::size(drape::solver::build_facts), \
                                              std::data(rows), std::size(rows)};                                 \
  }
