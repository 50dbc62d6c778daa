#pragma once

#include <array>
#include <complex>
#include <vector>

namespace drape::model {

/// A spring in series with a dashpot: it carries a part Y of the modulus, which it forgets at a rate ω.
struct MaxwellElement {
  double rate;  ///< ω [1/s]
  double part;  ///< Y [1]

  bool operator==(const MaxwellElement&) const = default;
};

/// How a modulus relaxes: σ = M (ε − Σ Y ζ), dζ/dt = ω (ε − ζ), M being the modulus of sudden strains. This generalised Maxwell
/// body can be in equilibrium with any strain if Σ Y < 1   [Emmerich, Korn 1987].
using Spectrum = std::vector<MaxwellElement>;

/// C(ω)/M = 1 − Σ Y ω_l/(ω_l + iω), for strains that swing with ω [rad/s].
std::complex<double> complex_modulus(const Spectrum& spectrum, double frequency);

/// Q = Re C/Im C: 4π times the mean energy over the loss of a period, infinite where nothing is lost. [Etzmuß 2002, 2.4.2]
/// leaves out 4π.
double quality(const Spectrum& spectrum, double frequency);

/// A Kelvin-Voigt element in series with a spring: it yields `compliance` times as much as the spring, with the rate ω_j =
/// k_j/d_j.
struct KelvinVoigtElement {
  double rate;        ///< ω_j [1/s]
  double compliance;  ///< k_0/k_j [1]

  bool operator==(const KelvinVoigtElement&) const = default;
};

/// The Maxwell elements that move as a spring in series with Kelvin-Voigt elements [Etzmuß 2002, (2.34)], exactly. Compliances
/// of a series add up, relaxation functions do not, as the thesis has it.
Spectrum relaxation_of_series(const std::vector<KelvinVoigtElement>& series);

using Band = std::array<double, 2>;  ///< [rad/s]

/// Frequencies of a band, evenly spaced in their logarithms, with both ends.
std::vector<double> frequencies(const Band& band, int count);

/// The fewest elements whose quality is within a twentieth of the wished one throughout the band: their rates are evenly spaced
/// in logarithms, Y is found by least squares of Im C = Re C/Q [Emmerich, Korn 1987]. Empty if up to 20 elements do not do, or
/// if one would have to feed energy: the quality is too low for the band.
Spectrum constant_quality(double wished, const Band& band);

}  // namespace drape::model
