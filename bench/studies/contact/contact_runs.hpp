#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/runs/run.hpp"
#include "bench/studies/contact/contact_watch.hpp"
#include "bench/studies/step_means.hpp"

namespace drape::bench {

inline constexpr double contact_step = 0.01;  // [s]

inline constexpr const char* self_contact_garments[] = {"dress",        "sewn_dress", "walking_dress", "trousers",
                                                        "circle_skirt", "t_shirt",    "sweater"};

/// Values of contact.response; the others are compared with the first.
inline constexpr std::string_view contact_responses[] = {"constraint", "alteration", "reaction", "penalty",
                                                         "field",      "reposition", "reflect",  "impulse"};

bool is_garment(const std::string& name);

/// All values of a table, or for tests the first ones.
template <std::size_t n>
std::span<const char* const> some_of(const char* const (&all)[n], bool quick, std::size_t first) {
  return std::span(all).first(quick ? first : n);
}

/// A scene of the study: built-in, or "stack". For tests it is coarse where it has a grid of its own, and short.
model::Scene contact_scene(const std::string& name, bool quick, std::string_view response = contact_responses[0]);

/// With the thesis' solvers.
RunSpec contact_spec(const model::Scene& scene, std::string_view method, double step = contact_step);

/// Frames in which cloth is through itself or an obstacle; some may count twice.
int intersections(const ContactFindings& found);

/// A run and what contacts did to it.
struct WatchedRun {
  results::RunRecord run;
  ContactFindings found;

  bool usable() const;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WatchedRun, run, found)

WatchedRun watched(const RunSpec& spec);

/// Kinetic energy over the largest one.
double motion_at_end(Steps steps);

/// The steps of a run: before anything touches, the last ones of a run that ends at rest, and those between.
struct ContactParts {
  Steps flight, impact, rest;
};

ContactParts parts_of(const WatchedRun& one);

/// CG iterations a step; nothing without steps.
std::optional<double> iterations_of(Steps steps);

}  // namespace drape::bench
