#pragma once

#include <span>
#include <string>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/integrator.hpp"

/// Scenes with obstacles, and what happens in them.
namespace drape::verify::contact_scenes {

/// All methods that meet obstacles, by name.
std::vector<std::string> methods();

/// A compiled scene that tests can change before it runs.
struct Trial {
  model::Scene scene;
  model::Cloth cloth;
};

/// Four particles without any forces but weight, at the corners of a square of 0.1 m at height 0; `more`: TOML.
Trial particles(const std::string& more, std::span<const model::Override> changes = {});

/// A horizontal sheet of 0.3 m with 7 × 7 particles at height 0; `more`: TOML.
Trial sheet(const std::string& more, std::span<const model::Override> changes = {});

/// A scene by name.
Trial builtin(const std::string& name, std::span<const model::Override> changes = {});

/// A step as it was seen.
struct Moment {
  double t;
  solver::State y;
  double energy;
  solver::ContactReport contacts;
};

/// All steps of a run, the first being the start. Expects that it succeeds.
std::vector<Moment> run(const Trial& trial, const std::string& method, double h, const solver::Options& options = {});

/// The largest rise of the energy over the least energy before it [J].
double energy_rise(const std::vector<Moment>& moments);

/// The least distance from an obstacle at any time [m].
double clearance(const Trial& trial, const std::vector<Moment>& moments);

}  // namespace drape::verify::contact_scenes
