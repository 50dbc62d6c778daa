#include "model/memory/spectrum.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace drape::model {
namespace {

constexpr double allowed = 0.05;  ///< relative deviation of the quality
constexpr int most_elements = 20;

/// Rates a little beyond the ends of the band: else the quality would rise towards them.
Spectrum fit(double wished, const Band& band, int count) {
  const double beyond = count > 1 ? std::pow(band[1] / band[0], 0.25 / (count - 1)) : 1;
  const std::vector<double> rates = frequencies({band[0] / beyond, band[1] * beyond}, count);
  const std::vector<double> sampled = frequencies(band, 4 * count + 1);
  Eigen::MatrixXd A(sampled.size(), count);
  for (std::size_t k = 0; k < sampled.size(); ++k)
    for (int l = 0; l < count; ++l) {
      const double w = sampled[k], r = rates[l];
      A(static_cast<Eigen::Index>(k), l) = (r * w + r * r / wished) / (r * r + w * w);
    }
  const Eigen::VectorXd right = Eigen::VectorXd::Constant(A.rows(), 1 / wished);
  const Eigen::VectorXd Y = A.colPivHouseholderQr().solve(right);
  Spectrum spectrum;
  for (int l = 0; l < count; ++l) spectrum.push_back({rates[l], Y[l]});
  return spectrum;
}

bool dissipates(const Spectrum& spectrum) {
  const double sum = std::accumulate(spectrum.begin(), spectrum.end(), 0.0, [](double s, const auto& e) { return s + e.part; });
  return sum < 1 && std::ranges::all_of(spectrum, [](const MaxwellElement& e) { return e.part > 0; });
}

bool keeps(const Spectrum& spectrum, double wished, const Band& band) {
  return std::ranges::all_of(frequencies(band, 40 * static_cast<int>(spectrum.size()) + 1),
                             [&](double w) { return std::abs(quality(spectrum, w) / wished - 1) <= allowed; });
}

}  // namespace

std::complex<double> complex_modulus(const Spectrum& spectrum, double frequency) {
  std::complex<double> C = 1;
  for (const auto& [rate, part] : spectrum) C -= part * rate / std::complex<double>(rate, frequency);
  return C;
}

double quality(const Spectrum& spectrum, double frequency) {
  const std::complex<double> C = complex_modulus(spectrum, frequency);
  return C.imag() > 0 ? C.real() / C.imag() : std::numeric_limits<double>::infinity();
}

// With e_j = u_j g_j, u_j² = ω_j k_0/k_j, the series is  dg/dt = −(diag ω + u uᵀ) g + u ε,   σ = k_0 (ε − uᵀ g): eigenvectors
// of this symmetric matrix part it into Maxwell elements.
Spectrum relaxation_of_series(const std::vector<KelvinVoigtElement>& series) {
  const auto count = static_cast<Eigen::Index>(series.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd u(count);
  for (Eigen::Index j = 0; j < count; ++j) {
    A(j, j) = series[j].rate;
    u[j] = std::sqrt(series[j].rate * series[j].compliance);
  }
  A += u * u.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  Spectrum spectrum;
  for (Eigen::Index l = 0; l < count; ++l) {
    const double rate = eigen.eigenvalues()[l], share = eigen.eigenvectors().col(l).dot(u);
    spectrum.push_back({rate, share * share / rate});
  }
  return spectrum;
}

std::vector<double> frequencies(const Band& band, int count) {
  if (count == 1) return {std::sqrt(band[0] * band[1])};
  std::vector<double> all;
  for (int k = 0; k < count; ++k) all.push_back(band[0] * std::pow(band[1] / band[0], static_cast<double>(k) / (count - 1)));
  return all;
}

Spectrum constant_quality(double wished, const Band& band) {
  for (int count = 1; count <= most_elements; ++count)
    if (Spectrum spectrum = fit(wished, band, count); dissipates(spectrum) && keeps(spectrum, wished, band)) return spectrum;
  return {};
}

}  // namespace drape::model
