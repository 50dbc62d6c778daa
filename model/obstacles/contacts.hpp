#pragma once

#include <optional>
#include <span>
#include <vector>

#include "model/obstacles/obstacle.hpp"
#include "model/obstacles/posed_mesh.hpp"
#include "model/sheet/grid.hpp"
#include "solver/base/threads.hpp"
#include "solver/split_ode.hpp"

namespace drape::model {

enum class ResponseKind {
  constraint,  ///< velocities of colliding particles are constrained in the step's linear systems [Etzmuß 2002, 4.4]
  reaction,    ///< forces on colliding particles are replaced by a damped spring [Etzmuß 2002, 4.3]
  penalty,     ///< a steep potential around obstacles (Repulsion)
  field,       ///< an exponential, damped field around obstacles (Repulsion)
  reposition,  ///< after the step particles are moved to the border, where they stop (Relocation)
  reflect,     ///< ... or are reflected (Relocation)
  impulse,     ///< ... or get the velocity that counteracts the force on them (Relocation)
  alteration,  ///< what is inside when a step begins stops, and its position is altered in the implicit equation
               ///< [Baraff, Witkin 1998; Etzmuß 2002, 4.2]
};

/// How it is found which particles may touch an obstacle in a step.
enum class DetectionKind {
  half_spaces,  ///< by the nearest point of the obstacle when the step begins
  ray,          ///< by the ray from the old place of a particle to its new one [Eberhardt et al. 2000; Etzmuß 2002, 5.1]
};

/// How particles and obstacles meet.
struct ContactRule {
  double distance = 5e-3;   ///< d: what is nearer than this is in the collision area [m]
  double relaxation = 0.5;  ///< ω: part of its depth in the collision area that a particle loses in a step (4.4), at most 2
  ResponseKind response = ResponseKind::constraint;
  DetectionKind detection = DetectionKind::half_spaces;
  double thickness = 0;         ///< distance between layers of cloth that touch [m]; 0: cloth passes through itself
  double self_friction = 0;     ///< μ between layers of cloth
  bool faces = false;           ///< whether edges and corners of obstacles are met between particles
  double reaction_time = 0.02;  ///< τ [s]: the springs of reaction constraints have k = m/τ² and d = 2m/τ
  double push = 9.81;           ///< c [m/s²]: force of penalty and field on a unit of mass at the border
  double exponent = 10;         ///< n of penalty
  double range = 1e-3;          ///< e of field [m]
  double restitution = 0.5;     ///< e of reflect
  bool adaptive = false;        ///< whether springs have virtual neighbours on the edges of obstacles [Etzmuß 2002, 5.4]
};

/// Whether a response changes positions and velocities after the step.
constexpr bool relocates(ResponseKind kind) {
  return kind == ResponseKind::reposition || kind == ResponseKind::reflect || kind == ResponseKind::impulse;
}

/// Whether a response is a force of the ODE.
constexpr bool is_force(ResponseKind kind) {
  return kind == ResponseKind::reaction || kind == ResponseKind::penalty || kind == ResponseKind::field;
}

/// The parts of obstacles as rays or distances meet them. Throws std::invalid_argument if the mesh of an obstacle cannot be
/// read, and, naming the key, if rays are asked for with a response or an obstacle that they cannot serve.
std::vector<Obstacle> met_parts(std::span<const ObstacleRule> obstacles, const ContactRule& rule);

/// A particle near an obstacle.
struct Depth {
  int particle;
  Eigen::Vector3d normal;    ///< n, unit
  double depth;              ///< distance from the border of the area [m], negative outside
  Eigen::Vector3d velocity;  ///< w of the obstacle's surface [m/s]
  double friction;           ///< η
};

/// Which particles may touch which obstacles in a step.
///
/// Half-spaces: every particle is asked for the nearest point of every obstacle at the beginning of the step; the half-space
/// behind that point moves with the obstacle and must not be left by the end of the step. A convex obstacle is thereby never
/// tunnelled, however long the step: it lies on one side of the half-space. Where an obstacle deforms, the particle is carried
/// to the end of the step by the triangle that is nearest, and the half-space is behind the point that is nearest there and
/// then. Limits: particles are not watched that would have to go more than d and twice as far as the fastest one and gravity go
/// in a step; one obstacle gives a particle one half-space, so in hollows narrower than the way of a step the other wall is
/// seen a step later; edges and faces of the sheet between particles are not tested (chapter 5).
///
/// Rays: obstacles are the closed meshes that are drawn. A particle is a ball of radius d that goes straight from where it is
/// to x + h v + h² g, in the frame of the obstacle; where it first touches the mesh, the half-space is behind the nearest
/// point. The print has the ray go to the new position, which no step knows before contacts are solved: only `passed` does so.
/// A ray of the centre alone, as printed, would not see what rests at distance d; one against faces that are displaced by d
/// would slip between those of an edge. Of what the print calls face/particle, particles of the cloth in faces of the obstacle
/// are found, corners of the obstacle in faces of the cloth are not. Limits: what the forces of cloth push farther than free
/// flight is found a step later, or not at all if the obstacle is thinner than this way; so is what is more than d inside.
class Contacts {
 public:
  /// For this number of particles under this acceleration [m/s²]. Throws as met_parts.
  Contacts(std::span<const ObstacleRule> obstacles, const ContactRule& rule, const Eigen::Vector3d& gravity, int particles,
           solver::Counters& work);

  /// Appends the contacts, ordered by particle.
  void find(double t, double h, const solver::State& y, std::vector<solver::Contact>& found);

  /// Sets `found` to the particles that are less than `reach` [m] away from an obstacle.
  void near(double t, const Vectors& x, double reach, std::vector<Depth>& found);

  /// The same for a step that was made, x0 to x1 in h [s], by rays: particles that have come into a collision area on the way
  /// and are behind the border that they met there.
  void passed(double t, double h, const Vectors& x0, const Vectors& x1, std::vector<Depth>& found);

  /// Distance of each particle from the nearest obstacle, N, negative inside [m].
  Eigen::VectorXd distances(double t, const Vectors& x) const;

  std::span<const Obstacle> obstacles() const { return obstacles_; }

 private:
  /// An answer that bounds others: distances change at most as far as the particle moves in the obstacle's frame, and the
  /// surface there.
  struct Answer {
    Eigen::Vector3d p;
    Nearest nearest{0, Eigen::Vector3d::Zero()};
    double way = 0;  ///< MovingMesh::way of a surface that deforms [m]
    bool known = false;
  };

  /// A point on the border of the collision area, in the frame of the obstacle.
  struct Border {
    Eigen::Vector3d begin, end;  ///< of the step, where the obstacle takes it
    Eigen::Vector3d normal;      ///< at the end
  };

  /// The surface of an obstacle that deforms, at the beginning and the end of a step.
  struct Deforming {
    PosedMesh begin, end;

    void set_times(double t, double h);

    /// The point of the border to which a particle is nearest at the end when `at`, which is nearest at the beginning, has
    /// carried it there.
    Border border(const Eigen::Vector3d& p, const MaterialPoint& at, double distance) const;
  };

  /// A rigid obstacle in a step.
  struct Ride {
    Pose begin, end;
    double h;

    /// Velocity of a point of its border [m/s].
    Eigen::Vector3d velocity(const Border& border) const {
      return (end.to_world(border.end) - begin.to_world(border.begin)) / h;
    }
  };

  void find_half_spaces(int obstacle, double t, const Ride& ride, const solver::State& y, std::vector<solver::Contact>& found);
  void find_by_rays(int obstacle, const Ride& ride, const solver::State& y, std::vector<solver::Contact>& found);
  std::optional<Border> cast(int obstacle, const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  solver::Contact contact(int particle, int obstacle, double gap, const Ride& ride, const Border& border) const;

  std::vector<Obstacle> obstacles_;
  std::vector<std::optional<Deforming>> deforming_;  ///< for each obstacle
  double distance_, relaxation_;
  bool alters_;    ///< only what is in the collision area when a step begins is a contact, and its position is altered
  double moment_;  ///< [s]: obstacles move uniformly between key frames
  Eigen::Vector3d gravity_;
  std::vector<std::vector<Answer>> answers_;  ///< for each obstacle and particle
  base::Collector<solver::Contact> collect_;
  std::int64_t& queries_;
  std::int64_t *rays_ = nullptr, *boxes_ = nullptr;  ///< counters, if rays are cast
};

}  // namespace drape::model
