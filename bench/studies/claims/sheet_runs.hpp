#pragma once

#include <string>
#include <vector>

#include "model/scene_file/scene_file.hpp"
#include "reference/trajectory.hpp"
#include "results/run_record.hpp"

/// Runs of sheets that claims are about.
namespace drape::bench {

inline constexpr double thesis_step = 0.01;  ///< [s], the step of the thesis

/// A built-in scene with other values.
model::Scene with(const std::string& scene, std::vector<model::Override> overrides);

/// The sheet hung by its corners, d [N s/m].
model::Scene hung(double damping, double end = 0.4);

/// A run by a method as choose_method() names it.
results::RunRecord run_by(const model::Scene& scene, const std::string& method, double step = thesis_step);

/// The states of such a run at these times; fewer if it ends before.
std::vector<solver::State> states_by(const model::Scene& scene, const std::string& method, double step,
                                     const std::vector<double>& times);

/// A motion by the midpoint rule with steps of 1 ms, and what twice that would change.
struct FineMotion {
  reference::Trajectory motion;
  double uncertainty = 0;  ///< root mean square at the end [m]
};
FineMotion fine_motion(const model::Scene& scene);

/// Root mean square distance at the end of a run over the size of the scene; NaN if it failed.
double distance_at_end(const model::Scene& scene, const results::RunRecord& run, const solver::Vectors& x);

/// The largest of the steps end/10, end/20, end/40 … that ends within a part of the scene's size of x, and half of which does
/// as well: in contact errors do not fall evenly, and one may be small by chance. NaN if there is none.
double largest_accurate_step(const model::Scene& scene, const std::string& method, const solver::Vectors& x, double part);

/// A count of the work of a run; NaN if it failed.
double work_of(const results::RunRecord& run, const char* kind);

/// Largest rise of the energy above that of the start [J].
double energy_gain(const model::Scene& scene, const std::string& method, double step);

}  // namespace drape::bench
