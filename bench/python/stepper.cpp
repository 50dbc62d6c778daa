#include "bench/python/stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <stdexcept>
#include <utility>

#include "bench/python/ode.hpp"

namespace drape::bench::python {
namespace {

using solver::Step;
using solver::Vectors;

/// A method has no room for an object: each of these functions finds the stepper in its slot.
constexpr std::size_t most_steppers = 32;
std::array<Stepper*, most_steppers> steppers{};

/// What a stepper has in one run.
struct PythonRun {
  PythonRun(const Stepper& stepper, const Step& s)
      : equation(py::cast(std::make_unique<Ode>(s.ode, s.y0()))),
        step(PyType_Check(stepper.step().ptr()) != 0 ? stepper.step()() : stepper.step()) {}
  ~PythonRun() { equation.cast<Ode&>().end(); }
  PythonRun(const PythonRun&) = delete;
  PythonRun& operator=(const PythonRun&) = delete;

  py::object equation, step;
};

/// Whether a method may throw such an exception where its step is too long.
bool is_numerical(const py::error_already_set& error) {
  return error.matches(PyExc_ArithmeticError) || error.matches(py::module_::import("numpy.linalg").attr("LinAlgError"));
}

/// One part of the y that a step has returned.
void set(Vectors& part, const py::object& value, const char* name) {
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(value);
  if (!array) PyErr_Clear();
  if (!array || array.ndim() != 2 || array.shape(0) != part.rows() || array.shape(1) != 3) {
    const std::string found = array ? fmt::format("an array of shape {}", std::string(py::str(array.attr("shape"))))
                                    : std::string(py::str(py::type::of(value).attr("__name__")));
    PyErr_SetString(
        PyExc_ValueError,
        fmt::format("step: expected y = (x, v) with {} of shape ({}, 3), not {}", name, part.rows(), found).c_str());
    throw py::error_already_set();
  }
  part = Eigen::Map<const Vectors>(array.data(), part.rows(), 3);
}

void set(solver::State& y, const py::object& value) {
  if (py::hasattr(value, "x") && py::hasattr(value, "v")) {
    set(y.x, value.attr("x"), "x");
    set(y.v, value.attr("v"), "v");
    return;
  }
  if (!py::isinstance<py::sequence>(value) || py::len(value) != 2) {
    const std::string found = py::str(py::type::of(value).attr("__name__"));
    PyErr_SetString(PyExc_ValueError,
                    fmt::format("step: expected it to return y = (x, v), or an object that has both, not {}", found).c_str());
    throw py::error_already_set();
  }
  const auto both = value.cast<py::sequence>();
  set(y.x, both[0], "x");
  set(y.v, both[1], "v");
}

void take_step(const Stepper& stepper, Step& s) {
  try {
    if (!s.kept.has_value()) s.kept.emplace<std::shared_ptr<PythonRun>>(std::make_shared<PythonRun>(stepper, s));
    const PythonRun& run = **std::any_cast<std::shared_ptr<PythonRun>>(&s.kept);
    static const py::handle state = py::object(py::module_::import("drape.state").attr("State")).release();
    const py::object y = run.step(run.equation, s.t, s.h, state(to_array(s.y0().x), to_array(s.y0().v)));
    set(s.y1(), y);
  } catch (py::error_already_set& error) {
    if (is_numerical(error)) throw std::runtime_error(py::str(error.value()).cast<std::string>());
    throw StepperError{std::move(error)};
  }
  if (!s.y1().x.allFinite() || !s.y1().v.allFinite()) s.result.outcome = solver::Outcome::not_finite;
}

template <std::size_t slot>
void take_step_of(Step& s) {
  take_step(*steppers[slot], s);
}

constexpr auto step_functions = []<std::size_t... slots>(std::index_sequence<slots...>) {
  return std::array<void (*)(Step&), most_steppers>{take_step_of<slots>...};
}
(std::make_index_sequence<most_steppers>());

std::string checked(std::string name) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("-_.+=").find(char(c)) != std::string_view::npos;
  };
  if (name.empty() || name.size() > 60 || !std::ranges::all_of(name, plain))
    throw std::invalid_argument("name: expected 1 to 60 letters, digits and -_.+=, not '" + name + "'");
  if (std::ranges::find(solver::methods(), name, &solver::Method::name) != solver::methods().end())
    throw std::invalid_argument("name: '" + name + "' is a method of ours; expected another name");
  return name;
}

std::size_t free_slot() {
  const auto slot = std::ranges::find(steppers, nullptr);
  if (slot == steppers.end())
    throw std::invalid_argument(fmt::format("step: expected at most {} integrators at a time", most_steppers));
  return static_cast<std::size_t>(slot - steppers.begin());
}

}  // namespace

Stepper::Stepper(std::string name, int order, py::object step)
    : name_(checked(std::move(name))),
      step_(std::move(step)),
      slot_(free_slot()),
      method_{.name = name_,
              .description = "written in Python",
              .order = order,
              .stages = solver::Method::Stages::none,
              .step = step_functions[slot_],
              .meets_obstacles = false,
              .own_family = "Python"} {
  if (PyCallable_Check(step_.ptr()) == 0)
    throw std::invalid_argument("step: expected a function step(ode, t, h, y), or a class whose instances are called so");
  if (order < 1 || order > 20)
    throw std::invalid_argument(fmt::format("order: expected a whole number from 1 to 20, not {}", order));
  steppers[slot_] = this;
}

Stepper::~Stepper() { steppers[slot_] = nullptr; }

void require_smooth(const model::Scene& scene) {
  const model::Cloth cloth = model::compile(scene);
  const auto refuse = [&](const char* what) {
    throw std::invalid_argument(fmt::format("{}: expected a scene whose state is x and v alone, not one {}", scene.name, what));
  };
  if (cloth.ode.has_contacts() || cloth.ode.step_forces || cloth.ode.relocate) refuse("with contact");
  if (cloth.ode.memory) refuse("whose forces remember the motion");
}

}  // namespace drape::bench::python
