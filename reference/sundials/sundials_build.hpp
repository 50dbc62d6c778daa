#pragma once

#include <string>

namespace drape::reference {

/// Which SUNDIALS this process uses and how it was built, with what of it is ours: "SUNDIALS 6.4.1, compiled without
/// optimisation; vectors, linear solves and forces by drape". Whether it is optimised is read off the machine code that is
/// loaded, so that it holds for whatever library the loader has found.
std::string sundials_build();

/// "SUNDIALS 6.4.1, KLU 1.3.8": the libraries that results depend on.
std::string sundials_versions();

}  // namespace drape::reference
