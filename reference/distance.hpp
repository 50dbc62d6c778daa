#pragma once

#include <span>
#include <vector>

#include "solver/state.hpp"

/// How far motions are apart: the measures of every error.
namespace drape::reference {

/// Root mean square over the particles of a field, N × 3.
double rms(const solver::Vectors& field);

/// Root mean square over the particles of the distance [m] between two sets of positions, each N × 3.
double rms_distance(const solver::Vectors& a, const solver::Vectors& b);

/// Largest distance of a particle [m].
double maximum_distance(const solver::Vectors& a, const solver::Vectors& b);

/// Largest rms distance [m] of two motions at the same times; NaN if one is. Throws std::invalid_argument if their numbers
/// differ.
double largest_rms_distance(std::span<const solver::Vectors> a, std::span<const solver::Vectors> b);

/// Centre of mass [m]. `mass`: of each particle [kg].
Eigen::RowVector3d centre_of_mass(const Eigen::VectorXd& mass, const solver::Vectors& x);

/// Angular momentum about `centre` [kg m²/s].
Eigen::Vector3d angular_momentum(const Eigen::VectorXd& mass, const Eigen::RowVector3d& centre, const solver::State& y);

/// Distance of the centres of mass [m] of two sets of positions.
double centre_distance(const Eigen::VectorXd& mass, const solver::Vectors& a, const solver::Vectors& b);

/// Positions of states.
std::vector<solver::Vectors> positions_of(std::vector<solver::State> states);

}  // namespace drape::reference
