#include "bench/strips/programs/strip.hpp"

#include <mpi.h>

#include <array>
#include <memory>
#include <span>
#include <utility>

#include "bench/strips/programs/processes.hpp"

namespace drape::bench::strips {
namespace {

using solver::State;
using solver::Vectors;

class StripPartition : public solver::Partition {
 public:
  explicit StripPartition(const Strip& strip)
      : strip_(strip),
        own_{3 * strip.first_row(), 3 * strip.rows()},
        place_{static_cast<Eigen::Index>(strip.columns()) * strip.share().copied_first(),
               static_cast<Eigen::Index>(strip.columns()) * strip.lines()} {}

  Range own(Eigen::Index) const override { return own_; }
  Place place(Eigen::Index) const override { return place_; }
  void add_up(std::span<double> sums) const override { Processes::add_up(sums); }
  double largest(double here) const override { return Processes::largest(here); }
  void set_copies(Vectors& field) const override { strip_.exchange(field); }

 private:
  const Strip& strip_;
  const Range own_;
  const Place place_;
};

}  // namespace

Strip::Strip(const model::Scene& whole, const std::vector<int>& lines)
    : Strip(whole, shares(whole.sheet.grid.nv, Processes::count(), lines).at(static_cast<std::size_t>(Processes::rank()))) {}

Strip::Strip(const model::Scene& whole, const Share& share)
    : share_(share),
      columns_(whole.sheet.grid.nu),
      lines_(whole.sheet.grid.nv),
      cloth_(model::compile(strip_of(whole, share))) {
  cloth_.ode.mass = strip_masses(whole, share, cloth_.ode.mass);
  ode_.mass = cloth_.ode.mass;
  ode_.stiffness = cloth_.ode.stiffness;
  ode_.damping = cloth_.ode.damping;
  ode_.pins = cloth_.ode.pins;
  ode_.work = cloth_.ode.work;
  ode_.force = exchanged(cloth_.ode.force);
  ode_.explicit_force = exchanged(cloth_.ode.explicit_force);
  ode_.partition = std::make_shared<StripPartition>(*this);
}

solver::SplitOde::Force Strip::exchanged(solver::SplitOde::Force force) const {
  return [this, force = std::move(force)](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    force(t, x, v, f);
    exchange(f);
  };
}

void Strip::exchange(Vectors& field) const {
  const int line = 3 * columns_, rank = Processes::rank();
  double* const own = field.data() + 3 * first_row();
  double* const behind = own + 3 * rows();
  std::array<MPI_Request, 4> requests;
  int count = 0;
  const auto meet = [&](bool neighbour, int other, double* copy, const double* original) {
    if (!neighbour) return;
    MPI_Irecv(copy, line, MPI_DOUBLE, other, 0, MPI_COMM_WORLD, &requests[static_cast<std::size_t>(count++)]);
    MPI_Isend(original, line, MPI_DOUBLE, other, 0, MPI_COMM_WORLD, &requests[static_cast<std::size_t>(count++)]);
  };
  meet(share_.before, rank - 1, own - line, own);
  meet(share_.behind, rank + 1, behind, behind - line);
  MPI_Waitall(count, requests.data(), MPI_STATUSES_IGNORE);
}

void Strip::acceleration(double t, State& y, Vectors& a) const {
  exchange(y.x);
  exchange(y.v);
  cloth_.ode.force(t, y.x, y.v, a);
  solver::filter(ode_.pins, a);
  a = ode_.mass.cwiseInverse().asDiagonal() * a;
}

}  // namespace drape::bench::strips
