#pragma once

#include <array>

namespace drape::model {

/// What a strain is known by on its path: its value and h times its rate at both ends of the path, and at the accepted state
/// before.
enum Node { at_begin, rate_at_begin, at_end, rate_at_end, before, rate_before };
inline constexpr int most_nodes = 6;

/// ζ at the end of a path of h: e^{−θ} times that at its beginning, θ = ω h, and these weights times the nodes. Exact for
/// polynomials: of degree 1 through 2 nodes (the values at both ends), of degree 3 through 4, of degree 5 through 6.
using PathWeights = std::array<double, most_nodes>;

/// `nodes`: 2, 4 or 6. `older`: time from the state before to the beginning over h.
PathWeights path_weights(double theta, int nodes, double older);

}  // namespace drape::model
