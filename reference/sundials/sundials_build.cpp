#include "reference/sundials/sundials_build.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_klu.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace drape::reference {
namespace {

/// Without optimisation compilers for x86-64 begin every function by saving the frame pointer, with it none.
std::string_view optimisation() {
#if defined(__x86_64__)
  constexpr std::array<unsigned char, 4> endbr64{0xf3, 0x0f, 0x1e, 0xfa}, frame{0x55, 0x48, 0x89, 0xe5};
  if (const auto* code = static_cast<const unsigned char*>(dlsym(RTLD_DEFAULT, "CVode"))) {
    if (std::equal(endbr64.begin(), endbr64.end(), code)) code += endbr64.size();
    return std::equal(frame.begin(), frame.end(), code) ? "compiled without optimisation" : "compiled with optimisation";
  }
#endif
  return "not known how compiled";
}

std::string sundials_version() {
  std::array<char, 32> text{};
  SUNDIALSGetVersion(text.data(), static_cast<int>(text.size()));
  return text.data();
}

}  // namespace

std::string sundials_build() {
  return fmt::format("SUNDIALS {}, {}; vectors, linear solves and forces by drape", sundials_version(), optimisation());
}

std::string sundials_versions() {
  return fmt::format("SUNDIALS {}, KLU {}.{}.{}", sundials_version(), KLU_MAIN_VERSION, KLU_SUB_VERSION, KLU_SUBSUB_VERSION);
}

}  // namespace drape::reference
