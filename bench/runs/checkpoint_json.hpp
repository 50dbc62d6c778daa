#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/runs/run.hpp"
#include "results/file/run_file.hpp"

/// How checkpoints keep what nlohmann/json does not know by itself.
namespace nlohmann {

/// Rows, columns and the numbers as they are in memory.
template <class Scalar, int rows, int columns, int options>
struct adl_serializer<Eigen::Matrix<Scalar, rows, columns, options>> {
  using Matrix = Eigen::Matrix<Scalar, rows, columns, options>;

  static void to_json(json& j, const Matrix& m) {
    j = {m.rows(), m.cols(), std::vector<Scalar>(m.data(), m.data() + m.size())};
  }
  static void from_json(const json& j, Matrix& m) {
    const auto values = j.at(2).get<std::vector<Scalar>>();
    m = Eigen::Map<const Matrix>(values.data(), j.at(0).get<Eigen::Index>(), j.at(1).get<Eigen::Index>());
  }
};

/// A list of none or one.
template <class Value>
struct adl_serializer<std::optional<Value>> {
  static void to_json(json& j, const std::optional<Value>& value) {
    j = json::array();
    if (value) j.push_back(*value);
  }
  static void from_json(const json& j, std::optional<Value>& value) {
    value.reset();
    if (!j.empty()) value = j.at(0).get<Value>();
  }
};

/// As it would be in a file.
template <>
struct adl_serializer<drape::results::RunRecord> {
  static void to_json(json& j, const drape::results::RunRecord& run) {
    const auto bytes = drape::results::to_bytes(run);
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());  // NOLINT
    j = json::binary(std::vector<std::uint8_t>(first, first + bytes.size()));
  }
  static void from_json(const json& j, drape::results::RunRecord& run) {
    run = drape::results::run_of(std::as_bytes(std::span(j.get_binary())));
  }
};

}  // namespace nlohmann

namespace drape::solver {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunResult, outcome, message, last_good_time, steps, rejected_steps)

}  // namespace drape::solver

namespace drape::bench {

/// Without the state at its end.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunEnd, result, evaluations, newton_matrices, cpu_ms)

}  // namespace drape::bench

namespace drape::results {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Verdict, standing, detail)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ErrorRecord, rms, maximum, reference, reference_tolerance, reference_error, growth, energy,
                                   energy_spread, centre, centre_spread)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MotionErrorRecord, position, amplitude, relative, velocity, reference_velocity, energy,
                                   momentum, angular_momentum)

}  // namespace drape::results
