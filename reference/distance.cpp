#include "reference/distance.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "solver/base/largest.hpp"

namespace drape::reference {

using solver::Vectors;

double rms(const Vectors& field) { return std::sqrt(field.squaredNorm() / static_cast<double>(field.rows())); }

double rms_distance(const Vectors& a, const Vectors& b) {
  return std::sqrt((a - b).squaredNorm() / static_cast<double>(a.rows()));
}

double maximum_distance(const Vectors& a, const Vectors& b) { return (a - b).rowwise().norm().maxCoeff(); }

double largest_rms_distance(std::span<const Vectors> a, std::span<const Vectors> b) {
  if (a.size() != b.size()) throw std::invalid_argument("motions with different numbers of times cannot be compared");
  double largest = 0;
  for (std::size_t k = 0; k < b.size(); ++k) largest = base::larger(largest, rms_distance(a[k], b[k]));
  return largest;
}

Eigen::RowVector3d centre_of_mass(const Eigen::VectorXd& mass, const Vectors& x) {
  return (mass.asDiagonal() * x).colwise().sum() / mass.sum();
}

Eigen::Vector3d angular_momentum(const Eigen::VectorXd& mass, const Eigen::RowVector3d& centre, const solver::State& y) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < y.x.rows(); ++i)
    sum += mass[i] * (y.x.row(i) - centre).transpose().cross(y.v.row(i).transpose());
  return sum;
}

double centre_distance(const Eigen::VectorXd& mass, const Vectors& a, const Vectors& b) {
  return centre_of_mass(mass, a - b).norm();
}

std::vector<Vectors> positions_of(std::vector<solver::State> states) {
  std::vector<Vectors> all;
  for (solver::State& y : states) all.push_back(std::move(y.x));
  return all;
}

}  // namespace drape::reference
