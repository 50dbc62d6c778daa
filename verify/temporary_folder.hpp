#pragma once

#include "results/temporary_folder.hpp"

namespace drape::verify {

using results::TemporaryFolder;

}  // namespace drape::verify
