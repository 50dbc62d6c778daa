// The extension module drape._drape: what the Python package drape is made of.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <csignal>
#include <optional>
#include <variant>

#include "bench/commands/choices.hpp"
#include "bench/commands/scene_choice.hpp"
#include "bench/python/ode.hpp"
#include "bench/python/stepper.hpp"
#include "bench/runs/certified_reference.hpp"
#include "bench/runs/interruption.hpp"
#include "bench/runs/sweep.hpp"
#include "bench/score/score.hpp"
#include "bench/studies/refinement.hpp"
#include "bench/studies/stability/stability.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/atomic_file.hpp"
#include "solver/base/hash.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench::python {
namespace {

using namespace py::literals;

/// A scene with what differs from its file.
struct NamedScene {
  model::Scene scene;
  std::string overrides;
};

/// A name of ours or an integrator in Python.
using AnyMethod = std::variant<const Stepper*, std::string>;

/// While this lives, Ctrl-C ends what is computed.
class Interruptible {
 public:
  Interruptible() {
    for (std::size_t k = 0; k < std::size(signals); ++k) sigaction(signals[k], nullptr, &before_[k]);
    note_interruptions();
  }
  ~Interruptible() {
    for (std::size_t k = 0; k < std::size(signals); ++k) sigaction(signals[k], &before_[k], nullptr);
    forget_interruptions();
  }
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  static constexpr int signals[] = {SIGINT, SIGTERM};
  struct sigaction before_[std::size(signals)];
};

/// Calls what takes long. Throws what a stepper has thrown.
template <class Compute>
auto interruptibly(const Compute& compute) {
  const Interruptible guard;
  try {
    return compute();
  } catch (StepperError& error) {
    throw std::move(error.error);
  } catch (const Interrupted&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
}

NamedScene load_scene(const std::string& name_or_file, const std::vector<std::string>& sets) {
  return {SceneChoice{name_or_file, sets}.load(), fmt::format("{}", fmt::join(sets, " "))};
}

py::list pairs(const Choices& choices) {
  py::list all;
  for (const Choice& choice : choices) all.append(py::make_tuple(choice.name, choice.description));
  return all;
}

py::array_t<double> frames_of(const std::vector<solver::State>& states, solver::Vectors solver::State::*part) {
  const auto n = static_cast<py::ssize_t>(states.empty() ? 0 : (states.front().*part).rows());
  py::array_t<double> all(std::vector<py::ssize_t>{std::ssize(states), n, 3});
  double* to = all.mutable_data();
  for (const solver::State& y : states) to = std::copy_n((y.*part).data(), (y.*part).size(), to);
  return all;
}

py::object certified(const NamedScene& named, std::optional<std::vector<double>> times, double agreement) {
  return interruptibly([&] {
    const model::Cloth cloth = model::compile(named.scene);
    References references(agreement);
    const reference::Reference found = references(named.scene, cloth, times ? *times : compared_times(named.scene));
    return py::object(py::module_::import("drape.scenes")
                          .attr("Reference")("times"_a = py::array(py::cast(found.trajectory.times)),
                                             "x"_a = frames_of(found.trajectory.states, &solver::State::x),
                                             "v"_a = frames_of(found.trajectory.states, &solver::State::v),
                                             "uncertainty"_a = py::array(py::cast(found.error)),
                                             "growth"_a = py::array(py::cast(found.growth)),
                                             "families"_a = py::make_tuple(found.name, found.witness)));
  });
}

Methods methods_of(const std::vector<AnyMethod>& all) {
  Methods methods;
  for (const AnyMethod& any : all)
    methods.push_back(std::holds_alternative<std::string>(any) ? &solver::method(std::get<std::string>(any))
                                                               : &std::get<const Stepper*>(any)->method());
  return methods;
}

SweepOptions options_for(const std::string& out, const std::string& command_line) {
  SweepOptions options;
  options.out = out;
  options.command_line = command_line;
  return options;
}

using Runs = std::vector<std::pair<AnyMethod, double>>;

Group group_of(const NamedScene& named, const Runs& runs) {
  Group group;
  for (const auto& [any, step] : runs) {
    RunSpec spec{named.scene, named.overrides, nullptr, step, {}};
    if (std::holds_alternative<std::string>(any)) {
      choose_method(spec, std::get<std::string>(any));
      if (const std::string reason = reason_against(*spec.method, named.scene); !reason.empty())
        throw std::invalid_argument(fmt::format("method '{}' on {}: {}", std::get<std::string>(any), named.scene.name, reason));
    } else {
      require_smooth(named.scene);
      spec.method = &std::get<const Stepper*>(any)->method();
    }
    if (!(step > 0 && std::isfinite(step)))
      throw std::invalid_argument(fmt::format("step: expected a positive number of seconds, not {:g}", step));
    group.push_back(std::move(spec));
  }
  return group;
}

void record_sweep(const std::vector<std::pair<const NamedScene*, Runs>>& scenes, const std::string& out, int repetitions,
                  bool reference, std::optional<double> every, const std::string& command_line) {
  std::vector<Group> groups;
  for (const auto& [named, runs] : scenes) groups.push_back(group_of(*named, runs));
  SweepOptions options = options_for(out, command_line);
  options.repetitions = repetitions;
  options.reference = reference;
  options.frames_every = every;
  interruptibly([&] { sweep(groups, options); });
}

/// Jobs that are one sweep.
void record(const std::vector<Job>& jobs, const std::string& out, const std::string& command_line) {
  std::string names;
  for (const Job& job : jobs) names += job.name + "\n";
  interruptibly([&] { record_in_file(options_for(out, command_line), base::long_hash_text(names), jobs); });
}

void record_orders(const std::vector<AnyMethod>& methods, double most_work, const std::string& out,
                   const std::string& command_line) {
  record({orders_on(smooth_scene(), most_work, methods_of(methods))}, out, command_line);
}

void record_stability(const std::vector<AnyMethod>& methods, bool quick, const std::string& out,
                      const std::string& command_line) {
  record({largest_steps(quick, methods_of(methods))}, out, command_line);
}

void record_score(const NamedScene& named, const std::string& motion, const std::string& out, const std::string& command_line) {
  interruptibly([&] {
    const ExternalMotion external = read_external_motion({motion}, std::nullopt, named.scene);
    const SweepOptions options = options_for(out, command_line);
    const ScoreOptions score{std::nullopt, {}, options.agreement, options.repetitions};
    record_in_file(options, score_identity(named.scene, external, score), {score_job(named.scene, external, score)});
  });
}

/// One line, as the program's own messages are, without the option "--set key: " that Python does not have.
std::string line_of(const std::exception& error) {
  constexpr std::size_t longest = 2000;
  std::string_view text = error.what();
  if (const std::size_t colon = text.find(": "); text.starts_with("--set ") && colon != std::string_view::npos)
    text.remove_prefix(colon + 2);
  return base::shortened(base::printable(text), longest);
}

void translate_exceptions() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const model::SceneError& error) {
      PyErr_SetString(PyExc_ValueError, line_of(error).c_str());
    } catch (const std::invalid_argument& error) {
      PyErr_SetString(PyExc_ValueError, line_of(error).c_str());
    } catch (const base::FileError& error) {
      PyErr_SetString(PyExc_OSError, line_of(error).c_str());
    }
  });
}

/// A view of what the object holds, which keeps it alive.
py::array_t<double> mass_of(const py::object& self) {
  const Eigen::VectorXd& mass = self.cast<const Ode&>().ode().mass;
  py::array_t<double> view(mass.size(), mass.data(), self);
  view.attr("flags").attr("writeable") = false;
  return view;
}

py::object start_of(const Ode& ode) {
  return py::module_::import("drape.state").attr("State")(to_array(ode.start().x), to_array(ode.start().v));
}

constexpr const char* ode_doc = R"(The split equation of motion  M dv/dt = f(t, x, v),  dx/dt = v  of a scene with n particles.

x [m], v [m/s] and f [N] are arrays of shape (n, 3) and type float64, row by row (C order); times are in seconds. They are
read and written where they are, without a copy, if they begin at a multiple of 64 bytes, as all arrays do that NumPy
allocates after `import drape`; others are copied once. Anything else is a ValueError. Pinned particles have forces as others
have: `acceleration` leaves their directions out, `free` says which those are. One thread at a time.)";

void bind_ode(py::module_& module) {
  py::class_<Ode>(module, "Ode", ode_doc)
      .def_property_readonly(
          "n", [](const Ode& o) { return o.ode().particles(); }, "Number of particles.")
      .def_property_readonly("start", start_of, "State (x, v) at the beginning, copies of shape (n, 3) [m], [m/s].")
      .def_property_readonly("mass", mass_of, "Masses of the particles, shape (n,) [kg], read-only.")
      .def_property_readonly(
          "stiffness", [](const Ode& o) { return o.ode().stiffness; },
          "K of the split f = K x + D v + f_expl: scipy.sparse CSR, shape (n, n) [N/m], the same for x, y and z.")
      .def_property_readonly(
          "damping", [](const Ode& o) { return o.ode().damping; },
          "D of the split f = K x + D v + f_expl: scipy.sparse CSR, shape (n, n) [N s/m], the same for x, y and z.")
      .def_property_readonly("free", &Ode::free_coordinates, "Whether coordinates are not pinned, shape (n, 3), bool.")
      .def("force", &Ode::force, "t"_a, "x"_a, "v"_a, "out"_a = py::none(),
           "force(t, x, v, out=None): f(t, x, v) [N], shape (n, 3), a new array or `out`.")
      .def("acceleration", &Ode::acceleration, "t"_a, "x"_a, "v"_a, "out"_a = py::none(),
           "acceleration(t, x, v, out=None): M⁻¹ f(t, x, v) [m/s²], 0 where particles are pinned, shape (n, 3), a new array or "
           "`out`.")
      .def("derivative", &Ode::derivative, "t"_a, "y"_a,
           "derivative(t, y): (v, a) of y = (x, v), both flat, of length 6 n: what solve_ivp wants.")
      .def("energy", &Ode::potential_energy, "x"_a, "t"_a = 0.0, "energy(x, t=0): potential energy [J].")
      .def("kinetic_energy", &Ode::kinetic_energy, "v"_a, "kinetic_energy(v): ½ Σ m v² [J].")
      .def("jacobian", &Ode::jacobian, "t"_a, "x"_a, "v"_a,
           "jacobian(t, x, v): (∂f/∂x [N/m], ∂f/∂v [N s/m]) of the whole force, scipy.sparse CSR of shape (3n, 3n); coordinate "
           "c of\n"
           "particle i has the index 3i + c.")
      .def("filter", &Ode::filter, "r"_a, "filter(r): sets r, shape (n, 3), to 0 in the directions of pins, in place.")
      .def_property_readonly("copies", &Ode::copies,
                             "Number of arrays so far that had to be copied since they were not aligned.")
      .def("time_force", &Ode::time_force, "count"_a, "t"_a, "x"_a, "v"_a,
           "time_force(count, t, x, v): mean wall time [ns] of one of `count` forces called from C++.");
}

constexpr const char* scene_doc = "A scene: cloth, pins, obstacles, start. Made by drape.scene(); it does not change.";

}  // namespace

PYBIND11_MODULE(_drape, module) {
  check_borrowing();
  align_new_arrays();
  translate_exceptions();
  py::options options;
  options.disable_function_signatures();
  module.doc() = "What the package drape is made of; use that.";
  bind_ode(module);
  py::class_<NamedScene>(module, "Scene", scene_doc)
      .def_property_readonly(
          "name", [](const NamedScene& s) { return s.scene.name; }, "Name of the scene.")
      .def_property_readonly(
          "overrides", [](const NamedScene& s) { return s.overrides; }, "What differs from its file.")
      .def_property_readonly(
          "toml", [](const NamedScene& s) { return model::to_toml(s.scene); },
          "The complete scene as a scene file, defaults included.")
      .def_property_readonly(
          "end", [](const NamedScene& s) { return s.scene.end; }, "Time it lasts [s].")
      .def_property_readonly(
          "size", [](const NamedScene& s) { return model::size(s.scene); }, "Length by which errors are divided [m].")
      .def(
          "numerical_stiffness", [](const NamedScene& s, double h) { return model::numerical_stiffness(s.scene, h); }, "h"_a,
          "numerical_stiffness(h): ν_h = h² k/(ρ l²), the largest of weft and warp, for a step h [s].")
      .def(
          "stiffness_to_damping", [](const NamedScene& s, double h) { return model::stiffness_to_damping(s.scene, h); }, "h"_a,
          "stiffness_to_damping(h): h k/d, for a step h [s]; infinite without damping.")
      .def("reference", certified, "times"_a = py::none(), "agreement"_a = 1e-7,
           "reference(times=None, agreement=1e-7): the certified motion at ascending times [s], by default the tenths of the "
           "scene's end,\n"
           "as a drape.Reference with its uncertainty. agreement: the most that two families may differ by, over the scene's "
           "size;\n"
           "RuntimeError if they differ by more.")
      .def(
          "ode", [](const NamedScene& s) { return std::make_unique<Ode>(s.scene); },
          "ode(): a new equation of motion, drape.Ode.")
      .def("__repr__", [](const NamedScene& s) {
        return fmt::format("<drape scene {}{}{}>", s.scene.name, s.overrides.empty() ? "" : " ", s.overrides);
      });
  py::class_<Stepper>(module, "Stepper", "A time integrator written in Python, as a method of ours.")
      .def(py::init<std::string, int, py::object>(), "name"_a, "order"_a, "step"_a)
      .def_property_readonly("name", [](const Stepper& s) { return s.method().name; });
  module.def("load_scene", load_scene, "name_or_file"_a, "sets"_a);
  module.def("scene_keys", [] { return pairs(scene_key_choices()); });
  module.def("scenes", [] { return pairs(scene_choices()); });
  module.def("methods", [] { return pairs(method_choices()); });
  module.def("sweep", record_sweep, "scenes"_a, "out"_a, "repetitions"_a, "reference"_a, "every"_a, "command_line"_a);
  module.def("orders", record_orders, "methods"_a, "most_work"_a, "out"_a, "command_line"_a);
  module.def("stability", record_stability, "methods"_a, "quick"_a, "out"_a, "command_line"_a);
  module.def("score", record_score, "scene"_a, "motion"_a, "out"_a, "command_line"_a);
}

}  // namespace drape::bench::python
