#pragma once

#include <functional>
#include <span>
#include <vector>

#include "model/collision/approach.hpp"
#include "model/collision/box_tree.hpp"
#include "model/collision/cloth_surface.hpp"
#include "model/obstacles/surface.hpp"
#include "solver/contact/pair_search.hpp"

namespace drape::model {

/// Finds where a cloth comes near bodies between its particles: corners of bodies at faces of the cloth, and edges at edges.
/// Particles at faces of bodies are not searched (Contacts), nor edges and corners that are flat or hollow while their body is
/// rigid. Points of bodies have the numbers after the N nodes of the cloth.
class BodyContacts {
 public:
  /// Without planes, which no face passes through unless a particle does.
  BodyContacts(const ClothSurface& cloth, std::span<const ObstacleRule> bodies, solver::Counters& work);

  /// Sets where bodies are when a step begins, at t [s], and when it ends.
  void begin(double t, double h);
  const solver::BodyPoints& points() const { return points_; }

  /// Whether any has friction.
  bool rub() const;

  using Visit = std::function<void(const Approach&, double friction)>;

  /// Visits the approaches to `distance` [m] while nodes move uniformly from x0 to x1, N × 3, and bodies in their step.
  void find(const Vectors& x0, const Vectors& x1, double distance, const Visit& visit);

 private:
  struct Body {
    PosedObstacle posed;
    double friction;
    bool moves;
    int first;  ///< of its points
  };

  /// A triangle of a body, with those of its corners and edges that are searched.
  struct Face {
    std::array<int, 3> corners;
    std::vector<int> vertices;
    std::vector<std::array<int, 2>> edges;
    int body;
  };

  void place(double t, Vectors& x) const;
  void fit_bodies(double margin);
  void add_faces(const Polygons& surface, int body, bool is_rigid);

  ClothSurface cloth_;
  std::vector<Body> bodies_;
  std::vector<Face> faces_;
  solver::BodyPoints points_;
  bool placed_ = false;
  double fitted_ = -1;  ///< margin of the boxes around faces of bodies [m]; −1: they are to be fitted
  BoxTree cloth_tree_, body_tree_;
  std::vector<Eigen::AlignedBox3d> cloth_boxes_, body_boxes_;
  Vectors x0_, x1_;  ///< of nodes and points of bodies
  std::int64_t& pairs_;
};

}  // namespace drape::model
