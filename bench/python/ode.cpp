#include "bench/python/ode.hpp"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>

#include "model/phases.hpp"

namespace drape::bench::python {

using solver::Vectors;

/// Vectors that are read in an array, or, where it is not aligned, in a copy of it.
class Ode::Read {
 public:
  Read(Ode& ode, double* data, Vectors& copy) : borrowed_(data, ode.ode().particles()), vectors_(&*borrowed_) {
    if (aligned(data)) return;
    ++ode.copies_;
    copy = Eigen::Map<const Vectors>(data, ode.ode().particles(), 3);
    vectors_ = &copy;
  }

  const Vectors& operator*() const { return *vectors_; }

 private:
  Borrowed borrowed_;
  const Vectors* vectors_;
};

namespace {

/// Vectors that are written in an array; where that is not aligned, when this ends.
class Written {
 public:
  Written(double* data, Eigen::Index rows, Vectors& copy, long& copies)
      : data_(data), borrowed_(data, rows), copy_(aligned(data) ? nullptr : &copy) {
    if (copy_ == nullptr) return;
    ++copies;
    copy_->resize(rows, 3);
  }

  Vectors& operator*() { return copy_ != nullptr ? *copy_ : *borrowed_; }

  void finish() const {
    if (copy_ != nullptr) Eigen::Map<Vectors>(data_, copy_->rows(), 3) = *copy_;
  }

 private:
  double* data_;
  Borrowed borrowed_;
  Vectors* copy_;
};

const model::Scene& with_one_phase(const model::Scene& scene) {
  if (const std::size_t count = model::phases(scene).size(); count > 1)
    throw std::invalid_argument(fmt::format(
        "{}: expected a scene of one phase, without paths of pins: each of its {} has another equation", scene.name, count));
  return scene;
}

}  // namespace

Ode::Ode(const model::Scene& scene)
    : cloth_(std::make_shared<model::Cloth>(model::compile(with_one_phase(scene)))), ode_(&cloth_->ode), start_(cloth_->start) {
  solver::prescribe(ode_->pins, start_.v);
}

Ode::Ode(const solver::SplitOde& ode, solver::State start) : ode_(&ode), start_(std::move(start)) {}

py::object Ode::into(py::object out) const {
  if (out.is_none()) return new_vectors(ode().particles());
  return out;
}

py::object Ode::force(double t, py::handle x, py::handle v, py::object out) {
  const solver::SplitOde& equation = ode();
  const Eigen::Index n = equation.particles();
  const Read at(*this, vectors_of(x, n, "x"), x_), moving(*this, vectors_of(v, n, "v"), v_);
  py::object result = into(std::move(out));
  Written f(vectors_of(result, n, "out", true), n, f_, copies_);
  equation.force(t, *at, *moving, *f);
  f.finish();
  return result;
}

void Ode::set_acceleration(double t, const Vectors& x, const Vectors& v, Vectors& a) const {
  ode_->force(t, x, v, a);
  a.array().colwise() /= ode_->mass.array();
  solver::filter(ode_->pins, a);
}

py::object Ode::acceleration(double t, py::handle x, py::handle v, py::object out) {
  const Eigen::Index n = ode().particles();
  const Read at(*this, vectors_of(x, n, "x"), x_), moving(*this, vectors_of(v, n, "v"), v_);
  py::object result = into(std::move(out));
  Written a(vectors_of(result, n, "out", true), n, f_, copies_);
  set_acceleration(t, *at, *moving, *a);
  a.finish();
  return result;
}

py::array_t<double> Ode::derivative(double t, py::handle y) {
  const Eigen::Index n = ode().particles();
  const auto values = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(y);
  if (!values || values.ndim() != 1 || values.size() != 6 * n)
    throw std::invalid_argument(fmt::format("y: expected {} numbers, x and v one after the other", 6 * n));
  auto* data = const_cast<double*>(values.data());
  const Read at(*this, data, x_), moving(*this, data + 3 * n, v_);
  py::array_t<double> dy(6 * n);
  std::copy_n(data + 3 * n, 3 * n, dy.mutable_data());
  Written a(dy.mutable_data() + 3 * n, n, f_, copies_);
  set_acceleration(t, *at, *moving, *a);
  a.finish();
  return dy;
}

double Ode::potential_energy(py::handle x, double t) {
  const Read at(*this, vectors_of(x, ode().particles(), "x"), x_);
  return ode_->potential_energy(t, *at);
}

double Ode::kinetic_energy(py::handle v) {
  const Read moving(*this, vectors_of(v, ode().particles(), "v"), v_);
  return solver::kinetic_energy(*ode_, *moving);
}

std::pair<solver::SparseMatrix, solver::SparseMatrix> Ode::jacobian(double t, py::handle x, py::handle v) {
  const Eigen::Index n = ode().particles();
  const Read at(*this, vectors_of(x, n, "x"), x_), moving(*this, vectors_of(v, n, "v"), v_);
  std::pair<solver::SparseMatrix, solver::SparseMatrix> both;
  ode_->jacobian(t, *at, *moving, both.first, both.second);
  for (solver::SparseMatrix* matrix : {&both.first, &both.second}) matrix->makeCompressed();
  return both;
}

py::array_t<bool> Ode::free_coordinates() const {
  py::array_t<bool> all(std::vector<py::ssize_t>{ode().particles(), 3});
  auto entries = all.mutable_unchecked<2>();
  std::fill_n(all.mutable_data(), all.size(), true);
  for (const solver::Pin& pin : ode_->pins) {
    if (pin.oblique()) throw std::invalid_argument("free: pins hold directions other than those of axes; expected filter(r)");
    for (int c = 0; c < 3; ++c) entries(pin.particle, c) = !pin.fixed(c);
  }
  return all;
}

void Ode::filter(py::handle r) {
  const Eigen::Index n = ode().particles();
  double* data = vectors_of(r, n, "r", true);
  Written residual(data, n, f_, copies_);
  if (!aligned(data)) *residual = Eigen::Map<Vectors>(data, n, 3);
  solver::filter(ode_->pins, *residual);
  residual.finish();
}

double Ode::time_force(int count, double t, py::handle x, py::handle v) {
  const Eigen::Index n = ode().particles();
  const Read at(*this, vectors_of(x, n, "x"), x_), moving(*this, vectors_of(v, n, "v"), v_);
  f_.resize(n, 3);
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < count; ++k) ode_->force(t, *at, *moving, f_);
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count() / count;
}

}  // namespace drape::bench::python
