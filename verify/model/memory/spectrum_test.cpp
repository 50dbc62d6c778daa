// The relaxation of moduli: the fit of a constant quality, and Kelvin-Voigt elements in series, against their own definitions.

#include "model/memory/spectrum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace drape::verify::spectrum_test {
namespace {

using model::Band;
using model::KelvinVoigtElement;
using model::Spectrum;

/// Largest relative deviation of the quality from the wished one, on a grid that the fit does not use.
double deviation(const Spectrum& spectrum, double wished, const Band& band) {
  double largest = 0;
  for (const double w : model::frequencies(band, 997))
    largest = std::max(largest, std::abs(model::quality(spectrum, w) / wished - 1));
  return largest;
}

TEST(Spectrum, KeepsAConstantQualityThroughoutTheBand) {
  for (const double wished : {5.0, 10.0, 20.0, 100.0})
    for (const Band& band : {Band{1, 10}, Band{1, 1000}, Band{3, 3e5}}) {
      const Spectrum spectrum = model::constant_quality(wished, band);
      ASSERT_FALSE(spectrum.empty()) << wished;
      EXPECT_LE(deviation(spectrum, wished, band), 0.052) << "Q = " << wished << " up to " << band[1];
      double sum = 0;
      for (const auto& [rate, part] : spectrum) {
        EXPECT_GT(part, 0);
        sum += part;
      }
      EXPECT_LT(sum, 1);
      EXPECT_LE(spectrum.size(), 12);
    }
}

TEST(Spectrum, IsEmptyWhereTheQualityIsTooLow) { EXPECT_TRUE(model::constant_quality(0.3, {1, 1e6}).empty()); }

/// S(ω) k_0 = 1 + Σ k_0/k_j/(1 + iω/ω_j)   [Etzmuß 2002, (2.34)]
std::complex<double> compliance(const std::vector<KelvinVoigtElement>& series, double frequency) {
  std::complex<double> S = 1;
  for (const auto& [rate, part] : series) S += part / std::complex<double>(1, frequency / rate);
  return S;
}

TEST(Spectrum, OfASeriesIsItsReciprocalCompliance) {
  const std::vector<KelvinVoigtElement> series{{0.1, 0.33}, {3, 0.8}, {20, 0.1}, {900, 2}};
  const Spectrum spectrum = relaxation_of_series(series);
  ASSERT_EQ(spectrum.size(), series.size());
  for (const double w : model::frequencies({1e-3, 1e5}, 60)) {
    const std::complex<double> C = complex_modulus(spectrum, w);
    EXPECT_LE(std::abs(C * compliance(series, w) - 1.0), 1e-12) << w;
  }
}

/// Six elements, one a decade, for Q = 10 from 1 to 1000 rad/s.
TEST(Spectrum, OfTheSixElementsForQualityTen) {
  std::vector<KelvinVoigtElement> series;
  double rate = 0.1;
  for (const double k : {3.035, 3.509, 4.064, 4.707, 5.453, 6.308}) series.push_back({rate, 1 / k}), rate *= 10;
  const Spectrum spectrum = relaxation_of_series(series);
  double lowest = 1e9, highest = 0;
  for (const double w : model::frequencies({1, 1000}, 400)) {
    lowest = std::min(lowest, model::quality(spectrum, w));
    highest = std::max(highest, model::quality(spectrum, w));
  }
  EXPECT_NEAR(lowest, 9.43, 0.02);
  EXPECT_NEAR(highest, 10.59, 0.02);
}

}  // namespace
}  // namespace drape::verify::spectrum_test
