#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "bench/peers/peers.hpp"
#include "bench/studies/studies.hpp"
#include "reference/trajectory.hpp"

/// The pieces of the study `peers`: sheets, runs, tables.
namespace drape::bench::peers {

/// The compared times that errors are told at, counted from the first: 0.2, 0.5 and 1 of the end.
inline constexpr std::array<std::size_t, 3> told_times{1, 4, 9};

/// A peer, or a method of ours, with what controls its accuracy.
struct Entrant {
  std::string name;
  bool is_peer = false;
  double value = 0;  ///< step [s], or fraction of the stability limit of a method that divides its steps

  bool divides_steps() const;
  std::string setting() const;  ///< "bullet-explicit, h = 0.001 s", "verlet, 0.9 of its limit"
};

/// What an entrant does on a sheet. Errors are NaN if it has no motion, or if nothing tells them.
struct PeerRun {
  Entrant who;
  std::string simulator = {};                   ///< with its version
  std::array<double, 3> errors{NAN, NAN, NAN};  ///< rms over the particles at told_times [m]
  std::vector<double> seconds = {};             ///< wall time of all steps, over the end, of the repetitions [s/s]
  std::string reason = {};                      ///< why it has no motion

  double error() const;  ///< the largest [m]
};

/// A scene with the entrants on it.
struct PeerSheet {
  std::string name;
  model::Scene scene;
  std::vector<Entrant> entrants;
  double limit = std::numeric_limits<double>::infinity();  ///< for a run [s]
  int repetitions = 1;
};

/// A sheet with all that was run on it.
struct PeerResult {
  PeerSheet sheet;
  double uncertainty = NAN;  ///< of the errors [m]
  std::vector<PeerRun> runs = {};
};

/// The order of a run's error at the first told time, from that of the same entrant with the next larger value; NaN without
/// any.
double observed_order(const std::vector<PeerRun>& runs, std::size_t k);

/// Sheets of the study; without those peers that are missing.
std::vector<PeerSheet> peer_sheets(bool quick);

/// All entrants once after the other, and that as often as the sheet says, so that what else the machine does meets all of
/// them. Peers measure their steps by the monotonic clock in their own process, and so do we.
PeerResult run_peers(const PeerSheet& sheet, Checkpoint& checkpoint);

/// The errors of a peer's motion at told_times [m]: against a motion at compared_times(), or where the peer has a cloth of its
/// own against that in short steps. Exceptions as for run_peer().
std::array<double, 3> errors_of(const Entrant& who, const PeerMotion& motion, const model::Scene& scene,
                                const reference::Trajectory& truth, double limit);

/// Rows of all sheets, beside each peer the quickest of our methods that is at most as far off.
results::Table peer_table(const std::vector<PeerResult>& sheets);

/// All tables of the study: those rows, errors of peers against those that an independent driver measured, and what is missing.
std::vector<results::Table> peer_tables(const std::vector<PeerResult>& sheets);

/// Steps of a peer that the driver took.
std::vector<double> printed_steps(std::string_view peer);

}  // namespace drape::bench::peers
