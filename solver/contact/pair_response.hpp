#pragma once

#include <memory>
#include <vector>

#include "solver/contact/pair_motion.hpp"
#include "solver/contact/pair_search.hpp"
#include "solver/filter.hpp"
#include "solver/split_ode.hpp"
#include "solver/stage.hpp"

namespace drape::solver {

/// Contacts of a cloth with itself within one step of an implicit method, answered by constraints over four particles, whose
/// rows C are removed from the step's linear systems by P = I − Cᵀ (C Cᵀ)⁻¹ C  [Etzmuß 2002, 4.4; (4.3) for rows that are not
/// orthonormal].
///
/// A pair that would come nearer than the thickness has a row: at the end of the step Σ w <x, n> ≥ thickness, with the nearest
/// points and the normal where they meet, and without torque, so that impulses keep momentum and angular momentum. Where
/// friction holds the pair, it has two more across the normal; where it slides, Coulomb's friction is a force of the system.
/// The normal where the step begins may be another: that of a border, over which a particle slides in the step. Which rows are
/// constrained is found together with the solution by projected gradients [Moré, Toraldo 1991]: velocities move along the
/// residual, over bounds of the matrix, and back to where no row is violated, by Gauss and Seidel's iteration over the rows.
/// Rows that push there are constrained in the next linear system, at the velocities that they have there: so rows that depend
/// on each other agree.
class PairResponse : public Projector {
 public:
  explicit PairResponse(const SplitOde& ode);
  ~PairResponse() override;

  /// Starts with the rows of the step before. `again`: repeats the same step.
  void begin(double t0, double h, const State& y0, bool again);

  /// Starts without rows.
  void clear();

  /// Whether there are rows.
  bool empty() const { return rows_.empty(); }

  /// Adds rows of pairs that meet on the way to a stage's solution; true if there are any.
  bool find(const Stage& stage, const State& y);

  /// Sets what obstacles leave free, beside pins.
  void set_free(const Filter& obstacles);

  /// Sets the constrained components of v, and those of x at the time of the stage.
  void impose(const Stage& stage, State& y) const;

  /// A contact with an obstacle that constrains a particle, and from which pairs may push it.
  struct Support {
    int particle;
    Eigen::Vector3d normal;
    double lambda;  ///< multiplier [N s]; 0 after an update that releases the contact
    double least;   ///< <v, n> [m/s]
  };

  /// Adapts the constrained rows, and v to them, to a stage's solution y with residual r; true if they changed. `bounds`: for
  /// each particle more than the eigenvalues of the stage's matrix [kg]; `noise`: of r. `releases`: whether rows and supports
  /// may be released.
  bool update(State& y, const Vectors& r, const Eigen::VectorXd& bounds, double noise, bool releases,
              std::vector<Support>& supports);

  /// Adds the multipliers of constrained rows, and friction, to a residual.
  void add_forces(Vectors& r) const;

  /// Adds the friction of pairs that slide to a residual.
  void add_friction(Vectors& r) const;

  /// r = P r.
  void project(Vectors& r) const override;

  /// After the step: constrained rows of y1 keep their distance, and where they are new, y0 becomes the start of a uniform
  /// motion to y1 in their directions; true if y0 changed.
  bool finish(State& y1, State& y0);

  /// Kinetic energy of the motion that new constraints stop in the step [J].
  double stopped_energy() const;

  bool impact() const;      ///< whether the step has new constraints
  int constrained() const;  ///< number of rows that are

 private:
  struct Row {
    PairContact pair;
    PairContact::Points points;
    ClothPart cloth;
    PairMotion motion;                                 ///< along the distance and across it
    PairMotion left;                                   ///< of it what pins and obstacles leave free
    Eigen::Vector3d given;                             ///< how fast points of bodies move along it [m/s]
    double least = 0;                                  ///< of the speed along the normal over the step [m/s]
    Eigen::Vector3d start;                             ///< what the motion gives of positions when the step begins [m]
    Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< speeds while constrained [m/s]
    Eigen::Vector3d lambda = Eigen::Vector3d::Zero();  ///< multiplier, and friction across it [N s]
    Eigen::Vector2d slides = Eigen::Vector2d::Zero();  ///< friction that the system takes as given [N s]
    bool active = false;                               ///< whether it is constrained
    bool sticks = false;                               ///< whether it is also across the normal
    bool before = false;                               ///< whether it was active in the step before

    double speed(int direction, const Vectors& v) const { return motion[direction].along(cloth.particles, v); }
    double slip(int direction, const Vectors& v) const { return speed(direction, v) + given[direction]; }
    int constrained() const { return !active ? 0 : sticks ? 3 : 1; }  ///< directions, from the first
    void add(const Eigen::Vector3d& impulses, Vectors& r) const;
  };
  class Factor;

  /// A row as the sweeps over all of them need it.
  struct Push {
    Row* row;
    std::array<std::array<Eigen::Vector3d, 4>, 3> way;  ///< changes of velocities for a unit of impulse [1/kg]
    Eigen::Vector3d gain = Eigen::Vector3d::Zero();     ///< change of the speed [1/kg]

    double give(int direction, double impulse, Vectors& v);
    double push(Vectors& v);
    double stop_sliding(Vectors& v);
  };

  PairMotion motion_at(const Row& row, const Vectors& x) const;
  Row row_of(const PairContact& pair, const PairContact::Points& points) const;
  void leave(Row& row) const;
  bool settle(const Eigen::VectorXd& mass, double noise, std::vector<Support>& supports);
  void activate(bool releases);
  bool rub(const Vectors& v, double noise);
  void factorise();
  void stop(State& y1);
  template <class Value>
  Eigen::VectorXd constrained(const Value& value) const;
  Eigen::VectorXd speeds(const Vectors& v) const;

  const SplitOde& ode_;
  std::vector<Eigen::Matrix3d> allowed_, free_;  ///< projectors for each particle: on what pins leave, and obstacles
  std::vector<Eigen::Matrix3d> loose_;           ///< with the normals of supports
  std::vector<char> pinned_;                     ///< for each particle
  bool rubs_;                                    ///< whether pairs do
  double t0_ = 0, h_ = 0;
  const State* y0_ = nullptr;
  std::vector<Row> rows_;
  std::vector<PairContact> found_;
  std::vector<Push> pushes_;
  Vectors u_;
  std::unique_ptr<Factor> factor_;
  std::int64_t &constrained_pairs_, &changes_, &sweeps_, &undecided_;
};

}  // namespace drape::solver
