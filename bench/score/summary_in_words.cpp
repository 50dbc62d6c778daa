#include <fmt/format.h>

#include <cmath>

#include "bench/score/scoring.hpp"
#include "results/run_record.hpp"

namespace drape::bench {
namespace {

std::string error_line(const Summary& s) {
  return fmt::format(
      "error        {:.3g} of the size (rms, at {:g} s), {:.3g} at the end; largest of a particle {:.3g}; reference {:.1e}\n",
      s.error, s.worst->t, s.end_error, s.maximum, s.reference_error);
}

std::string lag_line(const Summary& s) {
  const double lag = s.late.seconds.value;
  if (std::isnan(lag)) return "lag          nothing moves\n";
  return fmt::format(
      "lag          {:.3g} ms {}{} (± {:.1e}); the error falls from {:.3g} to {:.3g} (rms over all frames) without it\n",
      std::abs(1e3 * lag), lag < 0 ? "ahead" : "late", std::abs(lag) < 0.999 * longest_lag * s.last->t ? "" : " or more",
      1e3 * s.late.seconds.uncertainty, s.mean_error, s.late.left.value);
}

std::string damping_line(const Summary& s) {
  const double rate = s.damping.value;
  if (std::isnan(rate)) return "";
  return fmt::format("damping      the kinetic energy falls by {:.3g} 1/s too {} (± {:.1e})\n", std::abs(rate),
                     rate < 0 ? "little" : "much", s.damping.uncertainty);
}

std::string energy_line(const Summary& s) {
  return fmt::format("energy       {:.4g} J at the end, the reference {:.4g} J (± {:.1e}); velocities from {}\n",
                     s.last->own.total, s.last->truth.value.total, s.last->truth.uncertainty.total,
                     source_of_velocities(s.scoring->external));
}

std::string penetration_line(const Summary& s) {
  if (!s.scoring->truth.cloth.contacts) return "";
  return fmt::format("penetration  {:.3g} mm at {:g} s; the reference {:.3g} mm\n", 1e3 * s.deepest->depth, s.deepest->t,
                     1e3 * s.reference_depth);
}

std::string best_line(const ComparedRun* best, const char* question) {
  if (best == nullptr) return "";
  return fmt::format("ours         {}: {}, {:.2g}: error {:.3g} in {:.3g} ms\n", question, best->configuration->name,
                     best->variant().value, best->measured.error, results::quartiles(best->measured.times).median);
}

std::string best_lines(const Answers& best) {
  const std::string as_right = best_line(best.as_right, "quickest at most as wrong");
  return (as_right.empty() ? "ours         none of those tried is as right\n" : as_right) +
         best_line(best.at_cost, "least wrong that takes no longer");
}

std::string growth_line(double growth) {
  if (!(growth > results::comparable_growth)) return "";
  return fmt::format("note         small perturbations of the start grow by {:.2g}: positions say little about a method\n",
                     growth);
}

}  // namespace

std::string in_words(const Summary& s) {
  const Scoring& all = *s.scoring;
  return fmt::format("{} on {}: {} frames to {:g} s\n", all.external.name, all.scene.name, all.frames.size(), s.last->t) +
         error_line(s) + lag_line(s) + damping_line(s) + energy_line(s) + penetration_line(s) + growth_line(all.truth.growth) +
         best_lines(all.ours.best);
}

}  // namespace drape::bench
