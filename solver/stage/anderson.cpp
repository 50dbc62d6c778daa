#include "solver/stage/anderson.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace drape::solver {
namespace {

/// Part of the diagonal that is added to the normal equations: below it differences are parallel.
constexpr double ridge = 1e-13;

/// The response that is assumed before any was observed.
constexpr double unknown_response = 0.05;

}  // namespace

Anderson::Anderson(Eigen::Index particles, const Partition& all)
    : all_(all), v_(3 * particles), d_(3 * particles), dd_(3 * particles, depth), dg_(3 * particles, depth) {}

void Anderson::begin() {
  follows_ = false;
  for (int i = 0; i < kept(); ++i) serves_[i] = serves_[i] && response(i) >= lasting_response;
}

/// Stores the differences to the last iterate, if this one follows it, and makes this one the last.
void Anderson::remember(const Vectors& v, const Vectors& d) {
  if (follows_) {
    add_pair(v.data(), d.data());
    return;
  }
  std::copy_n(v.data(), v_.size(), v_.data());
  std::copy_n(d.data(), d_.size(), d_.data());
  follows_ = true;
}

/// The new differences replace the oldest. Own particles are those whose products count.
void Anderson::add_pair(const double* v, const double* d) {
  const int slot = pairs_++ % depth, count = kept();
  double *const dd = dd_.col(slot).data(), *const dg = dg_.col(slot).data();
  double *const last_v = v_.data(), *const last_d = d_.data();
  const Eigen::Index n = v_.size();
  const auto [begin, own] = all_.own(n);
  const auto advance = [&](Eigen::Index first, Eigen::Index last) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (Eigen::Index i = first; i < last; ++i) {
      const double dv = v[i] - last_v[i];
      dd[i] = d[i] - last_d[i];
      dg[i] = dd[i] + dv;
      sum += dv * dv;
      last_v[i] = v[i];
      last_d[i] = d[i];
    }
    return sum;
  };
  advance(0, begin);
  Eigen::Matrix<double, depth + 1, 1> sums;
  sums[depth] = advance(begin, begin + own);
  advance(begin + own, n);
  serves_[slot] = true;
  sums.head(count).noalias() = dd_.middleRows(begin, own).leftCols(count).transpose() * dd_.col(slot).segment(begin, own);
  sums.segment(count, depth - count).setZero();
  all_.add_up({sums.data(), depth + 1});
  lengths_[slot] = std::sqrt(sums[depth]);
  gram_.col(slot).head(count) = sums.head(count);
  gram_.row(slot).head(count) = sums.head(count).transpose();
}

double Anderson::smallest_response() const {
  if (kept() < 1) return unknown_response;
  double smallest = 1;
  for (int i = 0; i < kept(); ++i) smallest = std::min(smallest, response(i));
  return smallest;
}

/// Solves the normal equations of min |d − Σ w_i Δd_i|, with columns scaled to length one.
Anderson::Small Anderson::weights() const {
  const int count = kept();
  Small scale = gram_.diagonal().head(count).cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
  for (int i = 0; i < count; ++i)
    if (!serves_[i]) scale[i] = 0;
  Gram normal = Gram::Identity();
  normal.topLeftCorner(count, count) = scale.asDiagonal() * gram_.topLeftCorner(count, count) * scale.asDiagonal();
  normal.diagonal().array() += ridge;
  Eigen::Matrix<double, depth, 1> right = Eigen::Matrix<double, depth, 1>::Zero();
  right.head(count) = scale.cwiseProduct(projections_.head(count));
  return scale.cwiseProduct(normal.ldlt().solve(right).head(count));
}

void Anderson::advance(Vectors& v, Vectors& d) {
  remember(v, d);
  if (const int count = kept(); count > 0) {
    Eigen::Map<Eigen::VectorXd> flat_d(d.data(), d.size());
    const auto [begin, own] = all_.own(v.size());
    projections_.head(count).noalias() = dd_.middleRows(begin, own).leftCols(count).transpose() * d_.segment(begin, own);
    all_.add_up({projections_.data(), static_cast<std::size_t>(count)});
    flat_d.noalias() -= dg_.leftCols(count) * weights();
  }
  v += d;
}

}  // namespace drape::solver
