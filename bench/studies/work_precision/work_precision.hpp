#pragma once

#include "bench/studies/work_precision/runs.hpp"

namespace drape::bench {

/// A scene with its positions at all tenths of its end, from the two families that certify a reference. Throws what References
/// does.
Problem certified_problem(const std::string& name, const model::Scene& scene, Checkpoint& checkpoint);

/// The same of a scene without damping, which is not stiff: from velocity Verlet, extrapolated, and ARKODE's explicit method.
Problem explicit_problem(const std::string& name, const model::Scene& scene, Checkpoint& checkpoint);

/// The same of a large sheet, whose certificate would take hours: from BDF(5) and ESDIRK4, with steps of 1/400 of the end, a
/// quarter of that and so on, until both agree to 1e-8 of the size or 1/6400 of the end is reached; what they differ by is the
/// uncertainty.
Problem stepped_problem(const std::string& name, const model::Scene& scene, Checkpoint& checkpoint);

}  // namespace drape::bench
