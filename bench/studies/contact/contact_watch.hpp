#pragma once

#include <optional>
#include <vector>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/runs/observer.hpp"
#include "model/collision/self_contacts.hpp"
#include "model/obstacles/surface.hpp"

namespace drape::bench {

/// What contacts did to a run, besides what a record has.
struct ContactFindings {
  std::vector<int> pairs = {};  ///< of the cloth with itself that are near at the ends of the steps, as in_contact() has it
  std::optional<double> least = {};  ///< least distance of such a pair, over the thickness
  int intersecting = 0;              ///< frames in which cloth intersects itself, by exact predicates
  int in_bodies = 0;                 ///< frames with a particle inside an obstacle
  int through_bodies = 0;            ///< frames in which faces of cloth intersect those of obstacles

  /// Largest rise of the total energy above what it was before, over the energies, while pins and obstacles rest; nothing if
  /// they never do, or if obstacles divide springs, whose energies jump.
  std::optional<double> energy_rise = {};

  /// What the change of momentum is off from forces, by the trapezoidal rule, and the obstacles' impulses, over the impulse of
  /// all forces; nothing where pins give momentum.
  std::optional<double> momentum = {};
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ContactFindings, pairs, least, intersecting, in_bodies, through_bodies, energy_rise,
                                   momentum)

/// Finds that. Frames are the start and the ends of all steps.
class ContactWatch : public Observer {
 public:
  void begin(const model::Scene& scene, const model::Cloth& cloth, const solver::State& start) override;
  void observe(const solver::StepReport& step) override;

  const ContactFindings& findings() const { return findings_; }

 private:
  /// Energies of a phase [J].
  struct Energies {
    double potential;  ///< at the start
    double least;      ///< of the total ones
    double scale = 0;
  };

  void see(double t, const solver::State& y);
  void see_energy(double t, const solver::State& y);
  Eigen::Vector3d force(double t, const solver::State& y);

  ContactFindings findings_;
  const model::Cloth* cloth_ = nullptr;
  double thickness_ = 0;  ///< [m]
  solver::Counters unused_;
  std::optional<model::SelfContacts> self_;
  std::vector<model::PosedObstacle> bodies_;
  std::vector<model::Proximity> near_;
  std::optional<Energies> energies_;
  solver::Vectors f_;
  Eigen::Vector3d force_, momentum_;  ///< at the end of the step before [N], [N s]
  Eigen::Vector3d off_;               ///< [N s]
  double given_ = 0;                  ///< [N s]
  bool holds_ = false;                ///< whether pins have given momentum
};

}  // namespace drape::bench
