#pragma once

#include <string>

#include "results/run_record.hpp"

namespace drape::verify {

/// All of a record, a new member of which does not compile until it is listed there. Unlike ==, two NaN are equal and -0.0
/// differs from 0.0.
std::string as_text(const results::RunRecord& run);

}  // namespace drape::verify
