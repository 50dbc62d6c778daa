#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/runs/checkpoint.hpp"
#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "reference/reference.hpp"

/// The pieces of the study `field`: sheets with their references, runs, winners, tables.
namespace drape::bench {

/// A scene of the study with its size.
struct FieldSheet {
  std::string scene;
  std::optional<double> damping;  ///< d [N s/m]; nothing: the scene's own
  int n;                          ///< particles a side
  double end;                     ///< [s]
  bool quick = false;             ///< fewer settings and repetitions
  std::string fabric = {};        ///< whose material replaces the scene's, by its tables if it has any; empty: none

  std::string label() const;  ///< "hung-corners" or "hung-corners, denim"
  std::string name() const;   ///< "hung-corners d=0.5 n=20"
  model::Scene load() const;
};

/// Those of the study, small before large: a sheet on which settings are chosen comes before those that they are judged on.
std::vector<FieldSheet> field_sheets(bool quick);

/// Sheets of fabrics as they were measured, without damping.
std::vector<FieldSheet> fabric_sheets(bool quick);

/// How a sheet really moves. Without a reference `missing` says why, and there are no errors.
struct FieldTruth {
  reference::Trajectory motion = {};   ///< from the start on, at times close enough for lags
  reference::Reference compared = {};  ///< the same at all tenths of the end
  double uncertainty = 0;              ///< largest at these times, over the size of the scene
  double interpolation = 0;            ///< error of positions between the times of `motion` [m]
  std::string missing = {};

  bool known() const { return missing.empty(); }
};

/// Damped sheets have the certified reference, from the cache. Undamped ones are beyond its factors where they are large, but
/// not stiff: velocity Verlet at a tenth of its limit, extrapolated, which ARKODE's explicit method confirms.
FieldTruth field_truth(const FieldSheet& sheet, const model::Scene& scene, const model::Cloth& cloth, Checkpoint& checkpoint);

}  // namespace drape::bench
