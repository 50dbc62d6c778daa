#include "model/panel_memory.hpp"

#include <utility>

namespace drape::model {
namespace {

using solver::State;

class PanelMemory final : public TermMemory {
 public:
  PanelMemory(std::shared_ptr<TermMemory> memory, const Garment::Panel& panel) : memory_(std::move(memory)), panel_(panel) {}

  int variables() const override { return memory_->variables(); }
  void begin(int order, double t, const State& y, const Variables& z) override { memory_->begin(order, t, own(y), z); }
  void pass(double t, const State& y, const Variables& z) override { memory_->pass(t, own(y), z); }
  void carry(double t, const State& y, MutableVariables z) override { memory_->carry(t, own(y), z); }
  void rate(const State& y, const Variables& z, MutableVariables dz) const override { memory_->rate(own(y), z, dz); }
  void respond(double gamma, const State& y, const Variables& r, const State& d, MutableVariables dz) const override {
    memory_->respond(gamma, own(y), r, own(d, other_), dz);
  }
  double energy(const State& y, const Variables& z) const override { return memory_->energy(own(y), z); }
  void add_branches(const State& y, const Variables& z, std::vector<int>& now) const override {
    memory_->add_branches(own(y), z, now);
  }
  double first_kink(double h, double from, const State& y0, const Variables& z, const State& y1) const override {
    return memory_->first_kink(h, from, own(y0), z, own(y1, other_));
  }
  std::int64_t stiffness_changes() const override { return memory_->stiffness_changes(); }
  void add_stiffness(std::vector<Eigen::Triplet<double>>& entries) const override {
    std::vector<Eigen::Triplet<double>> of_particles;
    memory_->add_stiffness(of_particles);
    for (const auto& entry : of_particles)
      entries.emplace_back(panel_.node(entry.row()), panel_.node(entry.col()), entry.value());
  }

 private:
  /// The state of the panel's particles, without internal variables.
  const State& own(const State& y, State& gathered) const {
    gathered.x.resize(y.x.size() > 0 ? std::ssize(panel_.nodes) : 0, 3);
    gathered.v.resize(y.v.size() > 0 ? std::ssize(panel_.nodes) : 0, 3);
    if (y.x.size() > 0) panel_.seen(y.x, gathered.x);
    if (y.v.size() > 0) panel_.seen(y.v, gathered.v);
    return gathered;
  }
  const State& own(const State& y) const { return own(y, own_); }

  std::shared_ptr<TermMemory> memory_;
  const Garment::Panel& panel_;
  mutable State own_, other_;
};

}  // namespace

std::shared_ptr<TermMemory> of_nodes(std::shared_ptr<TermMemory> memory, const Garment::Panel& panel) {
  if (panel.nodes.empty()) return memory;
  return std::make_shared<PanelMemory>(std::move(memory), panel);
}

}  // namespace drape::model
