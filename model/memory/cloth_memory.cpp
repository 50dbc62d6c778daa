#include "model/memory/cloth_memory.hpp"

#include <algorithm>
#include <utility>

namespace drape::model {

using solver::State;

ClothMemory::ClothMemory(solver::Counters& work)
    : updates_(work.counter("memory_updates", "updates of all internal variables, at ends of steps and of sub-steps")) {}

void ClothMemory::add(std::shared_ptr<TermMemory> memory) {
  const int first = variables_;
  variables_ += memory->variables();
  parts_.push_back({std::move(memory), first});
}

void ClothMemory::begin(int order, double t, const State& y) {
  for (const Part& part : parts_) part.memory->begin(order, t, y, part.of(y.z));
}

void ClothMemory::pass(double t, const State& y) {
  for (const Part& part : parts_) part.memory->pass(t, y, part.of(y.z));
}

void ClothMemory::carry(double t, State& y) {
  ++updates_;
  y.z.resize(variables_);
  for (const Part& part : parts_) part.memory->carry(t, y, part.of(y.z));
}

void ClothMemory::rate(const State& y, Eigen::VectorXd& dz) const {
  dz.resize(variables_);
  for (const Part& part : parts_) part.memory->rate(y, part.of(y.z), part.of(dz));
}

void ClothMemory::respond(double gamma, const State& y, const Eigen::VectorXd& r, State& d) const {
  d.z.resize(variables_);
  for (const Part& part : parts_) part.memory->respond(gamma, y, part.of(r), d, part.of(d.z));
}

void ClothMemory::branches(const State& y, std::vector<int>& now) const {
  now.clear();
  for (const Part& part : parts_) part.memory->add_branches(y, part.of(y.z), now);
}

double ClothMemory::first_kink(double h, double from, const State& y0, const State& y1) const {
  double first = 1;
  for (const Part& part : parts_) first = std::min(first, part.memory->first_kink(h, from, y0, part.of(y0.z), y1));
  return first;
}

std::int64_t ClothMemory::stiffness_changes() const {
  std::int64_t changes = 0;
  for (const Part& part : parts_) changes += part.memory->stiffness_changes();
  return changes;
}

const solver::SparseMatrix& ClothMemory::stiffness() {
  const std::int64_t changes = stiffness_changes();
  if (changes == changes_known_) return stiffness_;
  changes_known_ = changes;
  std::vector<Eigen::Triplet<double>> entries;
  for (const Part& part : parts_) part.memory->add_stiffness(entries);
  solver::SparseMatrix changing(constant_.rows(), constant_.cols());
  changing.setFromTriplets(entries.begin(), entries.end());
  stiffness_ = constant_ + changing;
  return stiffness_;
}

double ClothMemory::energy(const State& y) const {
  if (y.z.size() == 0) return 0;  // a motion from elsewhere
  double energy = 0;
  for (const Part& part : parts_) energy += part.memory->energy(y, part.of(y.z));
  return energy;
}

}  // namespace drape::model
