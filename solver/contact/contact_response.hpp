#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "solver/contact/pair_response.hpp"
#include "solver/filter.hpp"
#include "solver/stage.hpp"

namespace drape::solver {

/// Contacts within one step of an implicit method, answered by constraints: inelastic, with Coulomb friction
/// [Etzmuß 2002, 4.4].
///
/// A particle that would leave its half-space is constrained along the normal n to the velocity that ends the step on the
/// border (4.4), and released when the residual in that direction would have to pull it. The set of constrained particles is
/// found together with the solution: at the end of the step <x, n> ≥ least, multipliers push, and one of the two is at its
/// limit. A constrained particle sticks while its tangential multiplier stays below η times the normal one; else it slides, and
/// η times the normal one acts against its motion. Friction lags: it is computed from multipliers and velocities of the step
/// before, except for new contacts and for particles that it would reverse, which stick. These are decided once the set of
/// constrained particles has been found, since multipliers of another set may be many times the right ones.
///
/// Contacts that alter positions are those of [Baraff, Witkin 1998]: the normal velocity becomes the obstacle's w at once, and
/// dx/dt = v + c with the c that leads a step of Euler to `least`, in the implicit equation x = ax + γ (v + c). One-step
/// methods get there; with history, which does not know of c, x goes elsewhere.
///
/// Other constrained directions follow x0 + (t − t0) v in every method, so that one with history ends on the border as Euler
/// does. After the step they move with the obstacle, and where they are new the history is adapted, since motion is not smooth
/// at impacts.
class ContactResponse {
 public:
  explicit ContactResponse(const SplitOde& ode);

  /// Finds the possible contacts of the step from t0 to t0 + h, and starts with those constraints of the step before that may
  /// hold. `again`: repeats the same step.
  void begin(double t0, double h, const State& y0, bool again = false);

  /// The same for a part of this step, with the contacts that were found for the whole; the borders move evenly. A method that
  /// divides its steps begins and finishes each part.
  void begin_part(double t0, double h, const State& y0);

  /// Whether nothing can be touched in this step.
  bool empty() const { return touched_.empty() && !has_pairs(); }

  /// Whether pairs of the cloth may be constrained.
  bool has_pairs() const { return pairs_ && !pairs_->empty(); }

  /// Adds constraints of pairs of the cloth that meet on the way to a stage's solution; true if there are any.
  bool find_pairs(const Stage& stage, const State& y);

  /// All contacts of the step, in which particles may take part.
  std::span<const Contact> possible() const { return contacts_; }

  /// Partially pinned particles and the constrained directions.
  const Filter& filter() const { return filter_; }

  /// Sets the constrained components of v, and those of x at the time of the stage.
  void impose(const Stage& stage, State& y) const;

  /// What may change in an update.
  enum class Changes {
    constraints,  ///< no friction: y was solved to a tolerance that tells which constraints hold and not how hard they push
    all,
    captures  ///< only new constraints, so that changes come to an end
  };

  /// Adapts the constraints to a stage's solution y, and friction once no constraint changes. r: the whole residual
  /// M (av − v) + γ f without friction; `bounds`: as PairResponse::update takes them, if there are pairs; `noise`: round-off in
  /// r. True if something changed, so that it must be imposed again.
  bool update(const Stage& stage, State& y, const Vectors& r, const Eigen::VectorXd& bounds, double noise, Changes changes);

  /// Adds γ times friction to a residual.
  void add_friction(double gamma, Vectors& r) const;

  /// After the step: the constrained directions of y1 move with the obstacle, and where they are new, y0 becomes the start of a
  /// uniformly accelerated motion to y1; true if y0 changed.
  bool finish(State& y1, State& y0);

  /// Kinetic energy of the motion that new constraints stop in the step [J].
  double stopped_energy() const;

  /// Whether the step has new constraints.
  bool impact() const;

  int constrained() const;                              ///< particles constrained in the last step or sub-step
  Eigen::Vector3d impulse() const { return impulse_; }  ///< of the obstacles on the particles in the last step [N s]
  double work() const { return work_; }                 ///< done by these impulses [J]

 private:
  enum class Status { free, slides, sticks };

  /// Three contacts fix a particle, so it has at most three active ones.
  static constexpr int most_contacts = 3;
  using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, most_contacts>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, most_contacts, 3>;
  using PerContact = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, most_contacts, 1>;

  /// A particle that may touch an obstacle.
  struct Touched {
    int particle = 0;
    std::size_t begin = 0, end = 0;  ///< its contacts
    Eigen::Matrix3d allowed;         ///< projector on what its pins leave
    Status status = Status::free;
    bool fresh = false;                                  ///< constrained in this step and not in the one before
    Columns normals;                                     ///< of its active contacts, without pinned coordinates
    Rows inverse;                                        ///< pseudo-inverse of these
    Eigen::Matrix3d free;                                ///< projector on what pins and constraints leave
    Eigen::Vector3d velocity;                            ///< v in the constrained directions [m/s]
    bool altered = false;                                ///< whether its contacts alter positions
    Eigen::Vector3d alteration;                          ///< c [m/s]
    Eigen::Vector3d obstacle;                            ///< w [m/s]
    bool rubs = false;                                   ///< whether its friction is decided
    Eigen::Vector3d friction = Eigen::Vector3d::Zero();  ///< [N]
    Eigen::Vector3d holding = Eigen::Vector3d::Zero();   ///< tangential multiplier of the constraints [N]
    double bound = 0;                                    ///< Σ η λ, its limit [N]
    Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< f of the stage [N]

    Eigen::Matrix3d constrained() const { return allowed - free; }
    Eigen::Matrix3d tangent() const { return allowed - normals * inverse; }
  };

  /// A contact in the step before.
  struct Past {
    int particle, obstacle;
    Status status;
    Eigen::Vector3d force;
    double bound;
  };

  void find_supports(const Vectors& r, const Vectors& v);
  void leave_supports();
  bool update_particles(const Stage& stage, const State& y, const Vectors& r, double noise, Changes changes);
  void remember();
  void touch_all(double t0, double h, const State& y0);
  void touch(int particle, std::size_t begin, std::size_t end, std::size_t& past);
  void configure(Touched& p);
  void rebuild_filter();
  Status first_status(const Touched& p) const;
  double time_to_impact(const Touched& p) const;
  bool release(Touched& p, const PerContact& lambda, double noise);
  bool capture(Touched& p, const Eigen::Vector3d& x1);
  PerContact balance(Touched& p, const Stage& stage, const State& y, const Vectors& r) const;
  void rub_obstacles(double gamma, Vectors& r) const;
  void remember_friction(Touched& p, const Past& was) const;
  bool rub(Touched& p, const Eigen::Vector3d& v);
  void rewrite_history(const Eigen::Matrix3d& directions, const Eigen::Vector3d& a, int particle, const State& y1,
                       State& y0) const;
  Eigen::Vector3d coulomb(const Touched& p, const Eigen::Vector3d& v, const Eigen::Vector3d& force, double bound) const;
  double friction_bound(const Touched& p, const PerContact& lambda) const;

  const SplitOde& ode_;
  std::vector<Eigen::Matrix3d> allowed_;  ///< for each particle, if there are pins
  double t0_ = 0, h_ = 0;
  double step_begin_ = 0, step_ = 0;  ///< t0 and h of the whole step [s]
  bool divided_ = false;              ///< whether a part of the step has begun
  double size_ = 0;                   ///< largest coordinate of a particle [m]
  const State* y0_ = nullptr;
  std::vector<Contact> contacts_;
  struct Border {
    double begin, end;
  };
  std::vector<Border> borders_;  ///< for each contact, least <x, n> when the step begins and when it ends [m]
  std::vector<char> active_;     ///< for each contact
  std::vector<Touched> touched_;
  std::vector<Past> past_;
  Filter pinned_, filter_;
  std::optional<PairResponse> pairs_;  ///< if the cloth meets itself
  Vectors rubbed_, pushed_;            ///< the residual with friction of obstacles, and with forces of pairs
  std::vector<PairResponse::Support> supports_;
  /// What obstacles and bodies bear less than the forces of contacts, which follow the last sweeps over pairs: all forces
  /// without those of contacts and pairs have this sum with these [N].
  Eigen::Vector3d missing_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d impulse_ = Eigen::Vector3d::Zero();
  double work_ = 0;
  std::int64_t &constrained_particles_, &changes_;
};

}  // namespace drape::solver
