#include "reference/reference_file.hpp"

#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace drape::reference {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are in memory");

template <class T>
void put(std::string& out, const T* first, std::size_t count) {
  const std::uint64_t length = count;
  out.append(reinterpret_cast<const char*>(&length), sizeof length);
  out.append(reinterpret_cast<const char*>(first), count * sizeof(T));
}

/// Takes from the front what put() appended.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  template <class Container>
  Container take() {
    std::uint64_t count = 0;
    std::memcpy(&count, bytes(sizeof count).data(), sizeof count);
    constexpr std::size_t width = sizeof(typename Container::value_type);
    if (count > rest_.size() / width) throw DamagedFile("it is shorter than it says");
    Container result(count, {});
    std::ranges::copy(bytes(count * width), reinterpret_cast<char*>(result.data()));
    return result;
  }

  std::string_view bytes(std::size_t count) {
    if (count > rest_.size()) throw DamagedFile("it is shorter than it says");
    const std::string_view front = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return front;
  }

 private:
  std::string_view rest_;
};

solver::Vectors take_vectors(Reader& reader) {
  const auto values = reader.take<std::vector<double>>();
  if (values.size() % 3 != 0) throw DamagedFile("its vectors have not three columns");
  return Eigen::Map<const solver::Vectors>(values.data(), static_cast<Eigen::Index>(values.size() / 3), 3);
}

void put_trajectory(std::string& out, const Trajectory& trajectory) {
  put(out, trajectory.times.data(), trajectory.times.size());
  for (const solver::State& state : trajectory.states)
    for (const solver::Vectors* part : {&state.x, &state.v}) put(out, part->data(), static_cast<std::size_t>(part->size()));
}

Trajectory take_trajectory(Reader& reader) {
  Trajectory trajectory{reader.take<std::vector<double>>(), {}};
  for (std::size_t i = 0; i < trajectory.times.size(); ++i) {
    solver::Vectors x = take_vectors(reader);
    trajectory.states.push_back({std::move(x), take_vectors(reader)});
  }
  return trajectory;
}

/// A right checksum does not make a right file.
void require_consistent(const Reference& reference) {
  const std::vector<double>& times = reference.trajectory.times;
  const std::vector<solver::State>& states = reference.trajectory.states;
  const Eigen::Index rows = states.empty() ? 0 : states.front().x.rows();
  const auto fits = [&](const Trajectory& trajectory) {
    return trajectory.times == times && std::ranges::all_of(trajectory.states, [&](const solver::State& y) {
             return y.x.rows() == rows && y.v.rows() == rows;
           });
  };
  for (const auto* series : {&reference.error, &reference.growth})
    if (series->size() != times.size()) throw DamagedFile("it has not a number for each time");
  for (const Trajectory* trajectory : {&reference.trajectory, &reference.witnessed, &reference.perturbed})
    if (!fits(*trajectory)) throw DamagedFile("its trajectories have different times or particles");
}

std::string checksum(std::string_view bytes) {
  const std::uint64_t hash = XXH3_64bits(bytes.data(), bytes.size());
  return {reinterpret_cast<const char*>(&hash), sizeof hash};
}

}  // namespace

std::string encode(std::string_view key, const Reference& reference) {
  std::string out;
  put(out, key.data(), key.size());
  for (const std::string* name : {&reference.name, &reference.witness}) put(out, name->data(), name->size());
  put(out, &reference.tolerance, 1);
  for (const auto* series : {&reference.error, &reference.growth}) put(out, series->data(), series->size());
  for (const Trajectory* trajectory : {&reference.trajectory, &reference.witnessed, &reference.perturbed})
    put_trajectory(out, *trajectory);
  return out + checksum(out);
}

Reference decode(std::string_view bytes, std::string_view key) {
  const std::string_view body = bytes.substr(0, bytes.size() - std::min(bytes.size(), sizeof(XXH64_hash_t)));
  if (checksum(body) != bytes.substr(body.size())) throw DamagedFile("its checksum is wrong");

  Reader reader(body);
  if (reader.take<std::string>() != key) throw DamagedFile("it belongs to another key");
  Reference reference;
  for (std::string* name : {&reference.name, &reference.witness}) *name = reader.take<std::string>();
  const auto tolerances = reader.take<std::vector<double>>();
  if (tolerances.size() != 1) throw DamagedFile("it has not one tolerance");
  reference.tolerance = tolerances.front();
  for (auto* series : {&reference.error, &reference.growth}) *series = reader.take<std::vector<double>>();
  for (Trajectory* trajectory : {&reference.trajectory, &reference.witnessed, &reference.perturbed})
    *trajectory = take_trajectory(reader);
  require_consistent(reference);
  return reference;
}

}  // namespace drape::reference
