#pragma once

#include "solver/base/temporary_folder.hpp"

namespace drape::verify {

using base::TemporaryFolder;

}  // namespace drape::verify
