#include "reference/reference_file.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "solver/base/hash.hpp"

namespace drape::reference {
namespace {

using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little, "numbers are written as they are in memory");
constexpr std::uint8_t doubles_tag = 86;  ///< of an array of 64-bit numbers, little endian  [RFC 8746]

Json to_json(const double* first, std::size_t count) {
  std::vector<std::uint8_t> bytes(count * sizeof(double));
  if (count > 0) std::memcpy(bytes.data(), first, bytes.size());
  return Json::binary(std::move(bytes), doubles_tag);
}

Json to_json(const std::vector<double>& values) { return to_json(values.data(), values.size()); }

Json to_json(const solver::Vectors& values) { return to_json(values.data(), static_cast<std::size_t>(values.size())); }

Json to_json(const Trajectory& trajectory) {
  Json states = Json::array();
  for (const solver::State& state : trajectory.states)
    states.push_back({{"x", to_json(state.x)},
                      {"v", to_json(state.v)},
                      {"z", to_json(state.z.data(), static_cast<std::size_t>(state.z.size()))}});
  return {{"times", to_json(trajectory.times)}, {"states", std::move(states)}};
}

std::vector<double> numbers(const Json& json) {
  const auto& bytes = json.get_binary();
  if (bytes.subtype() != doubles_tag || bytes.size() % sizeof(double) != 0)
    throw DamagedFile("it has not numbers where they belong");
  std::vector<double> values(bytes.size() / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

solver::Vectors vectors(const Json& json) {
  const std::vector<double> values = numbers(json);
  if (values.size() % 3 != 0) throw DamagedFile("its vectors have not three columns");
  return Eigen::Map<const solver::Vectors>(values.data(), static_cast<Eigen::Index>(values.size() / 3), 3);
}

Trajectory trajectory(const Json& json) {
  Trajectory result{numbers(json.at("times")), {}};
  for (const Json& state : json.at("states")) {
    const std::vector<double> z = numbers(state.at("z"));
    result.states.push_back({vectors(state.at("x")), vectors(state.at("v")),
                             Eigen::Map<const Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size()))});
  }
  return result;
}

/// A right checksum does not make a right file.
void require_consistent(const Reference& reference) {
  const std::vector<double>& times = reference.trajectory.times;
  const std::vector<solver::State>& states = reference.trajectory.states;
  const Eigen::Index rows = states.empty() ? 0 : states.front().x.rows();
  const Eigen::Index variables = states.empty() ? 0 : states.front().z.size();
  const auto fits = [&](const Trajectory& trajectory) {
    return trajectory.times == times && trajectory.states.size() == times.size() &&
           std::ranges::all_of(trajectory.states, [&](const solver::State& y) {
             return y.x.rows() == rows && y.v.rows() == rows && y.z.size() == variables;
           });
  };
  for (const auto* series : {&reference.error, &reference.growth})
    if (series->size() != times.size()) throw DamagedFile("it has not a number for each time");
  for (const Trajectory* trajectory : {&reference.trajectory, &reference.witnessed, &reference.perturbed})
    if (!fits(*trajectory)) throw DamagedFile("its trajectories have different times or particles");
}

std::string checksum(std::string_view bytes) {
  const std::uint64_t hash = base::hash(bytes);
  return {reinterpret_cast<const char*>(&hash), sizeof hash};
}

Reference reference_of(const Json& json, std::string_view key) {
  if (json.at("key").get<std::string>() != key) throw DamagedFile("it belongs to another key");
  Reference reference{.name = json.at("name"),
                      .witness = json.at("witness"),
                      .tolerance = json.at("tolerance"),
                      .error = numbers(json.at("error")),
                      .growth = numbers(json.at("growth")),
                      .trajectory = trajectory(json.at("trajectory")),
                      .witnessed = trajectory(json.at("witnessed")),
                      .perturbed = trajectory(json.at("perturbed"))};
  require_consistent(reference);
  return reference;
}

}  // namespace

std::string encode(std::string_view key, const Reference& reference) {
  const Json json{{"key", key},
                  {"name", reference.name},
                  {"witness", reference.witness},
                  {"tolerance", reference.tolerance},
                  {"error", to_json(reference.error)},
                  {"growth", to_json(reference.growth)},
                  {"trajectory", to_json(reference.trajectory)},
                  {"witnessed", to_json(reference.witnessed)},
                  {"perturbed", to_json(reference.perturbed)}};
  std::string out;
  Json::to_cbor(json, out);
  return out + checksum(out);
}

Reference decode(std::string_view bytes, std::string_view key) {
  const std::string_view body = bytes.substr(0, bytes.size() - std::min(bytes.size(), sizeof(std::uint64_t)));
  if (checksum(body) != bytes.substr(body.size())) throw DamagedFile("its checksum is wrong");
  try {
    return reference_of(Json::from_cbor(body, true, true, Json::cbor_tag_handler_t::store), key);
  } catch (const Json::exception& error) {
    throw DamagedFile(error.what());
  }
}

}  // namespace drape::reference
