#pragma once

#include <Eigen/Dense>

namespace drape::base {

/// Numbers from -1 to below 1 that look random and are the same in every process, on every machine.
Eigen::VectorXd noise(Eigen::Index size, unsigned seed);

}  // namespace drape::base
