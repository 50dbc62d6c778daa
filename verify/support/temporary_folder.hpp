#pragma once

#include "solver/base/temporary.hpp"

namespace drape::verify {

using base::TemporaryFolder;

}  // namespace drape::verify
