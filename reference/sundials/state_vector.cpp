#include "reference/sundials/state_vector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace drape::reference::sundials_tools {
namespace {

using Array = Eigen::Map<Eigen::ArrayXd>;

/// A block of this many numbers of a sum of vectors is added up before it is stored: it stays in the first-level
/// cache.
constexpr Eigen::Index chunk = 128;

Array positions(N_Vector vector) {
  auto& x = content(vector).state.x;
  return {x.data(), x.size()};
}
Array velocities(N_Vector vector) {
  auto& v = content(vector).state.v;
  return {v.data(), v.size()};
}
Array internal_variables(N_Vector vector) {
  auto& z = content(vector).state.z;
  return {z.data(), z.size()};
}
Array reactions(N_Vector vector) {
  auto& all = content(vector).reactions;
  return {all.data(), all.size()};
}

/// Calls operation(block of each vector) for positions, velocities, internal variables and reactions.
template <class Operation, class... Vector>
void each(const Operation& operation, Vector... vectors) {
  operation(positions(vectors)...);
  operation(velocities(vectors)...);
  operation(internal_variables(vectors)...);
  operation(reactions(vectors)...);
}

/// The sum over the blocks of what reduce(block of each vector) returns.
template <class Reduce, class... Vector>
double total(const Reduce& reduce, Vector... vectors) {
  return reduce(positions(vectors)...) + reduce(velocities(vectors)...) + reduce(internal_variables(vectors)...) +
         reduce(reactions(vectors)...);
}

/// Calls operation(segment) for all chunks of all blocks, where segment(vector) is that chunk of a vector.
template <class Operation>
void each_chunk(N_Vector like, const Operation& operation) {
  for (Array (*const block)(N_Vector) : {positions, velocities, internal_variables, reactions}) {
    const Eigen::Index size = block(like).size();
    for (Eigen::Index first = 0; first < size; first += chunk)
      operation([=](N_Vector vector) { return block(vector).segment(first, std::min(chunk, size - first)); });
  }
}

/// What a chunk is added up in.
using Sum = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, chunk, 1>;

int combine(int count, realtype* factors, N_Vector* vectors, N_Vector z) {
  each_chunk(z, [&](const auto& segment) {
    Sum sum = factors[0] * segment(vectors[0]);
    for (int k = 1; k < count; ++k) sum += factors[k] * segment(vectors[k]);
    segment(z) = sum;
  });
  return 0;
}

int add_to_each(int count, realtype* factors, N_Vector x, N_Vector* vectors, N_Vector* results) {
  each_chunk(x, [&](const auto& segment) {
    const Sum added = segment(x);  // x may be one of the results
    for (int k = 0; k < count; ++k) segment(results[k]) = factors[k] * added + segment(vectors[k]);
  });
  return 0;
}

realtype dot(N_Vector x, N_Vector y) {
  return total([](auto a, auto b) { return (a * b).sum(); }, x, y);
}

int dot_with_each(int count, N_Vector x, N_Vector* vectors, realtype* products) {
  std::transform(vectors, vectors + count, products, [x](N_Vector y) { return dot(x, y); });
  return 0;
}

realtype mean_square_root(N_Vector like, double sum) { return std::sqrt(sum / static_cast<double>(content(like).unknowns)); }

realtype weighted_norm(N_Vector x, N_Vector weights) {
  return mean_square_root(x, total([](auto a, auto w) { return (a * w).square().sum(); }, x, weights));
}

realtype masked_norm(N_Vector x, N_Vector weights, N_Vector mask) {
  const auto squares = [](auto a, auto w, auto id) { return (id > 0).select(a * w, 0.0).square().sum(); };
  return mean_square_root(x, total(squares, x, weights, mask));
}

realtype largest(N_Vector x) {
  double found = 0;
  each([&](auto a) { found = a.size() == 0 ? found : std::max(found, a.abs().maxCoeff()); }, x);
  return found;
}

realtype smallest(N_Vector x) {
  double found = std::numeric_limits<double>::infinity();
  each([&](auto a) { found = a.size() == 0 ? found : std::min(found, a.minCoeff()); }, x);
  return found;
}

N_Vector clone(N_Vector vector);

void destroy(N_Vector vector) {
  delete &content(vector);
  N_VFreeEmpty(vector);
}

void set_operations(_generic_N_Vector_Ops& ops) {
  ops.nvgetvectorid = [](N_Vector) { return SUNDIALS_NVEC_CUSTOM; };
  ops.nvclone = clone;
  ops.nvdestroy = destroy;
  ops.nvgetlength = [](N_Vector x) -> sunindextype { return content(x).unknowns; };
  ops.nvlinearsum = [](realtype a, N_Vector x, realtype b, N_Vector y, N_Vector z) {
    each([=](auto p, auto q, auto r) { r = a * p + b * q; }, x, y, z);
  };
  ops.nvconst = [](realtype c, N_Vector z) { each([=](auto r) { r = c; }, z); };
  ops.nvprod = [](N_Vector x, N_Vector y, N_Vector z) { each([](auto p, auto q, auto r) { r = p * q; }, x, y, z); };
  ops.nvdiv = [](N_Vector x, N_Vector y, N_Vector z) { each([](auto p, auto q, auto r) { r = p / q; }, x, y, z); };
  ops.nvscale = [](realtype c, N_Vector x, N_Vector z) { each([=](auto p, auto r) { r = c * p; }, x, z); };
  ops.nvabs = [](N_Vector x, N_Vector z) { each([](auto p, auto r) { r = p.abs(); }, x, z); };
  ops.nvinv = [](N_Vector x, N_Vector z) { each([](auto p, auto r) { r = p.inverse(); }, x, z); };
  ops.nvaddconst = [](N_Vector x, realtype b, N_Vector z) { each([=](auto p, auto r) { r = p + b; }, x, z); };
  ops.nvdotprod = dot;
  ops.nvmaxnorm = largest;
  ops.nvwrmsnorm = weighted_norm;
  ops.nvwrmsnormmask = masked_norm;
  ops.nvmin = smallest;
  ops.nvlinearcombination = combine;
  ops.nvscaleaddmulti = add_to_each;
  ops.nvdotprodmulti = dot_with_each;
}

N_Vector clone(N_Vector vector) {
  try {
    return make_state_vector(content(vector), vector->sunctx);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

}  // namespace

N_Vector make_state_vector(StateVector content, SUNContext context) {
  N_Vector vector = N_VNewEmpty(context);
  if (vector == nullptr) return nullptr;
  set_operations(*vector->ops);
  vector->content = new (std::nothrow) StateVector(std::move(content));
  if (vector->content != nullptr) return vector;
  N_VFreeEmpty(vector);
  return nullptr;
}

}  // namespace drape::reference::sundials_tools
