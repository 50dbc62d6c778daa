#include "bench/runs/choice_rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>

namespace drape::bench {
namespace {

// --- Ways --------------------------------------------------------------------------------------------------------------------

/// What a way costs on a sheet of N particles: nanoseconds a particle, fitted to the times of results/baselines/choice.h5;
/// setting up, to runs of one step.
struct Nanoseconds {
  double set_up, step, update;
};

struct KnownWay {
  Way way;
  int order;
  Nanoseconds costs;
  double aim = 0.8;     ///< part of the error asked for that is to be predicted: errors scatter about what is interpolated
  bool splits = false;  ///< whether its error goes with κ: it treats the springs as stiff in all directions

  double ms(int particles, double steps, double updates) const {
    return 1e-6 * particles * (costs.set_up + costs.step * steps + costs.update * updates);
  }
};

/// In the order of the table that bench/choice-table writes.
const KnownWay known_ways[] = {
    {{"imex-euler"}, 1, {230, 26, 0}, 0.93, true},
    {{"sbdf2"}, 2, {350, 25, 0}, 0.93, true},
    {{.method = "midpoint/fixed-point/cholesky", .loop_tolerance = 0.1}, 2, {350, 12, 12}, 0.8, true},
    {{.method = "midpoint/fixed-point/cholesky", .loop_tolerance = 0.01}, 2, {350, 12, 12}, 0.5, true},
    {{"midpoint"}, 2, {350, 3, 20.5}},
    {{"bdf3"}, 3, {400, 3, 20.5}},
    {{"bdf4"}, 4, {400, 3, 20.5}},
    {{.method = "bdf2", .stage_accuracy = 1}, 2, {350, 3, 20.5}},
};

// --- What was measured, by bench/choice-table --------------------------------------------------------------------------------

constexpr std::size_t table_rows = 7, table_steps = 10;
using Measured = std::array<std::array<double, table_steps>, table_rows>;

/// log10 of errors and numbers of updates over damping, ascending, and step, from 0.2 s on halved.
struct MeasuredWay {
  Measured error, updates;
};

constexpr double measured_size = 0.8, measured_gravity = 9.81, longest_step = 0.2;  // [m], [m/s²], [s]
constexpr double measured_tension = 1e4 / (measured_gravity * measured_size);       // κ
constexpr int measured_side = 24;                                                   // particles
constexpr double measured_limit = measured_size / (measured_side - 1) * 1e-2;  // [s], l √(ρ/k): of velocity Verlet, undamped
constexpr std::array<double, table_rows> measured_damping{0.05, 0.5, 1.6, 5,
                                                          16,   50,  160};  // [N s/m]; the first stands for none
constexpr std::size_t measured_verlet = std::size(known_ways);              ///< after the others
constexpr std::array<std::array<MeasuredWay, measured_verlet + 1>, 2> measured_ways{{
#include "bench/runs/choice_table.inc"
}};

const MeasuredWay& measured(const FallingSheet& sheet, std::size_t way) {
  return measured_ways[static_cast<std::size_t>(sheet.support)][way];
}

double measured_fall_time() { return std::sqrt(measured_size / measured_gravity); }

/// Largest number of whole intervals below a place between 0 and count − 1, and the part of the next.
struct Place {
  std::size_t below;
  double part;
};

Place place(double x, std::size_t count) {
  const double inside = std::clamp(x, 0.0, static_cast<double>(count - 1));
  const auto below = std::min(static_cast<std::size_t>(inside), count - 2);
  return {below, inside - static_cast<double>(below)};
}

/// Place of a damping δ among those of the measured sheet, linear in its logarithm.
Place damping_place(double damping) {
  const double d = damping * measured_size * measured_size / measured_fall_time();
  const double inside = std::clamp(d, measured_damping.front(), measured_damping.back());
  const auto above = std::max<std::ptrdiff_t>(1, std::ranges::lower_bound(measured_damping, inside) - measured_damping.begin());
  const double low = measured_damping[above - 1], high = measured_damping[above];
  return {static_cast<std::size_t>(above - 1), std::log(inside / low) / std::log(high / low)};
}

/// Between two steps, values fall by no more than `most_fall` would over a whole interval.
double interpolated(const Measured& values, const Place& damping, const Place& step,
                    double most_fall = std::numeric_limits<double>::max()) {
  const auto along = [&](std::size_t row) {
    const double before = values[row][step.below];
    return std::max(std::lerp(before, values[row][step.below + 1], step.part), before - most_fall * step.part);
  };
  return std::lerp(along(damping.below), along(damping.below + 1), damping.part);
}

constexpr double aim_of_verlet = 0.8, least_fraction = 0.05;  ///< of the stability limit that is tried

/// Damping δ below which a sheet's motion soon depends on all its details, so that no error is known after that.
constexpr double chaotic = 0.1;

constexpr int order_beyond = 2;  ///< with which errors fall at most with steps that are shorter than those of the tables

/// A sheet beside the measured one.
struct Beside {
  explicit Beside(const FallingSheet& sheet)
      : scale(measured_fall_time() / sheet.fall_time),
        stiffer(sheet.tension / measured_tension),
        damping(damping_place(sheet.damping)),
        ratio(damping_place(sheet.damping / stiffer)) {}

  double scale;    ///< of times, which become those of the measured sheet
  double stiffer;  ///< quotient of κ
  Place damping;
  Place ratio;  ///< as d/k has it
};

/// log10 of the error with a step h [s] as on the measured sheet; infinite with longer ones than were measured.
/// Errors that fall faster than with the order of a method do so in jumps, somewhere between two steps.
double log_error(const MeasuredWay& table, int order, const Place& damping, double h) {
  const double halvings = std::log2(longest_step / h), beyond = std::max(0.0, halvings - (table_steps - 1));
  if (halvings < -1e-9) return INFINITY;
  return interpolated(table.error, damping, place(halvings, table_steps), order * std::log10(2)) -
         std::min(order, order_beyond) * beyond * std::log10(2);
}

/// Where damping is strong a sheet creeps about its pins, the more the finer its grid is: so do the errors of implicit methods.
double of_finer_grid(const FallingSheet& sheet) {
  constexpr double creeping = 5;  // δ
  return sheet.damping > creeping ? std::max(1.0, std::sqrt(sheet.particles) / measured_side) : 1;
}

/// Errors of what treats springs implicitly as they are do not depend on k, those of the others go with κ h², of the first
/// order with κ h. How often a stage is corrected goes by k/d.
Prediction predicted(std::size_t way, const FallingSheet& sheet, const Beside& beside, int parts) {
  const KnownWay& known = known_ways[way];
  Prediction one{.way = known.way, .step = sheet.end / parts};
  const MeasuredWay& table = measured(sheet, way);
  const double h = one.step * beside.scale, stiffer = known.splits ? std::pow(beside.stiffer, 1.0 / known.order) : 1;
  one.error = std::pow(10, log_error(table, known.order, beside.damping, h * stiffer));
  if (!known.splits) one.error *= of_finer_grid(sheet);
  const double a_second = interpolated(table.updates, beside.ratio, place(std::log2(longest_step / h), table_steps));
  one.updates = std::max<double>(parts, a_second * sheet.end * beside.scale);
  one.ms = known.ms(sheet.particles, parts, one.updates);
  return one;
}

/// A fifth of the end, and parts of its tenths, each about a tenth shorter than the one before.
std::vector<int> numbers_of_steps() {
  std::vector<int> all{5};
  for (double tenths = 1; tenths < 20'000; tenths *= 1.1)
    if (const int n = 10 * static_cast<int>(tenths); n > all.back()) all.push_back(n);
  return all;
}

/// Without damping waves as short as the grid's spacing do not fade: the error goes with the part of the stability limit then,
/// not with the step, and is the same on all grids. A force of velocity Verlet costs some hundred nanoseconds beside those of
/// its particles.
Prediction verlet(const FallingSheet& sheet, const Beside& beside, double fraction) {
  constexpr double a_force = 600, a_particle = 5, estimates = 40;  // [ns], [ns], forces that find the limit
  Prediction one{.way = {"verlet"}, .step = sheet.end / 10, .fraction = fraction};
  const double h = std::min(fraction * sheet.limit, one.step);
  const double measured_h = sheet.damping < chaotic ? h / sheet.limit * measured_limit : h * beside.scale;
  one.error = std::pow(10, log_error(measured(sheet, measured_verlet), 2, beside.damping, measured_h));
  one.updates = std::ceil(sheet.end / h) + estimates;
  one.ms = 1e-6 * one.updates * (a_force + a_particle * sheet.particles);
  return one;
}

void keep_quicker(std::optional<Prediction>& best, const Prediction& one, double most_error) {
  if (one.error <= most_error && (!best || one.ms < best->ms)) best = one;
}

}  // namespace

std::vector<Prediction> predictions(const FallingSheet& sheet, double accuracy) {
  std::vector<Prediction> all;
  const auto add = [&](const std::optional<Prediction>& best) {
    if (best) all.push_back(*best);
  };
  const Beside beside(sheet);
  const std::vector<int> numbers = numbers_of_steps();
  for (std::size_t way = 0; way < std::size(known_ways); ++way) {
    const KnownWay& known = known_ways[way];
    std::optional<Prediction> best;
    for (const int parts : numbers) {
      if (best && known.ms(sheet.particles, parts, parts) > best->ms) break;  // and so are all with more
      keep_quicker(best, predicted(way, sheet, beside, parts), known.aim * accuracy);
    }
    add(best);
  }
  std::optional<Prediction> best;
  for (double fraction = solver::Options().verlet_fraction; fraction > least_fraction; fraction *= 0.92)
    keep_quicker(best, verlet(sheet, beside, fraction), aim_of_verlet * accuracy);
  add(best);
  std::ranges::sort(all, {}, &Prediction::ms);
  return all;
}

std::string reason_out_of_range(const FallingSheet& sheet) {
  struct Range {
    const char* name;
    double value, least, most;
  };
  const double falls = sheet.end / sheet.fall_time;  // errors of much shorter runs are those of their first moments
  const bool undamped = sheet.damping < chaotic;
  const Range ranges[] = {{"particles", static_cast<double>(sheet.particles), 36, 25'000},
                          {"k/(ρ g L)", sheet.tension, measured_tension / 3, 3 * measured_tension},
                          {"d T/(ρ L²)", sheet.damping, 0, 75},
                          {"end / √(L/g)", falls, undamped ? 1.0 : 2.5, undamped ? 1.5 : 4}};
  for (const auto& [name, value, least, most] : ranges)
    if (!(least <= value && value <= most)) return fmt::format("{} = {:.3g}, not {:.3g} to {:.3g}", name, value, least, most);
  return "";
}

}  // namespace drape::bench
