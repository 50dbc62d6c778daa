// PETSc's time steppers on our own equation of motion, with its Newton method and its sparse LU: for every scene that is an
// ODE.

#include <petscts.h>

#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "bench/peers/programs/program.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/sundials/first_order.hpp"

namespace drape::bench::peers {
namespace {

using reference::FirstOrderOde;
using reference::Part;
using reference::WideSparseMatrix;

void check(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  char* specific = nullptr;
  PetscErrorMessage(code, &text, &specific);
  std::string said = "PETSc:";
  for (const char* part : {text, static_cast<const char*>(specific)})
    if (part != nullptr) said.append(" ").append(part);
  throw std::runtime_error(said);
}

/// PETSc, which begins MPI of one process.
class Library {
 public:
  Library() {
    check(PetscInitializeNoArguments());
    check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));  // errors are ours to report
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library() { PetscFinalize(); }
};

/// An object of PETSc.
template <class Object, PetscErrorCode (*destroy)(Object*)>
struct Owned {
  Object object = nullptr;

  Owned() = default;
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() { destroy(&object); }
};
using OwnedVec = Owned<Vec, VecDestroy>;
using OwnedMat = Owned<Mat, MatDestroy>;
using OwnedTs = Owned<TS, TSDestroy>;
using OwnedIs = Owned<IS, ISDestroy>;

Eigen::VectorXd values_of(Vec vec) {
  PetscInt size = 0;
  const PetscScalar* data = nullptr;
  check(VecGetLocalSize(vec, &size));
  check(VecGetArrayRead(vec, &data));
  Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(data, size);
  check(VecRestoreArrayRead(vec, &data));
  return values;
}

void set(Vec vec, const Eigen::VectorXd& values) {
  PetscScalar* data = nullptr;
  check(VecGetArrayWrite(vec, &data));
  std::copy(values.begin(), values.end(), data);
  check(VecRestoreArrayWrite(vec, &data));
}

void create(OwnedVec& vec, const Eigen::VectorXd& values) {
  check(VecCreateSeq(PETSC_COMM_SELF, PetscInt(values.size()), &vec.object));
  set(vec.object, values);
}

/// What PETSc asks of the equation du/dt = g(t, u), u the free positions and velocities. Exceptions do not pass through PETSc:
/// it is told of an error, and `failure` keeps the words.
class Equation {
 public:
  explicit Equation(const model::Scene& scene)
      : cloth_(model::compile(scene)), ode_(require_ode(cloth_), cloth_.start, cloth_.begin), y_(ode_.initial()), dy_(y_) {}

  const std::string& failure() const { return failure_; }
  int size() const { return ode_.size(); }
  Eigen::VectorXd start() const { return ode_.gather(ode_.initial()); }
  double begin() const { return cloth_.begin; }

  solver::State state(double t, const Eigen::VectorXd& u) const {
    solver::State y = ode_.initial();
    ode_.scatter(u, y);
    return ode_.output(t, std::move(y));
  }

  Eigen::VectorXd rate(double t, const Eigen::VectorXd& u, Part part) {
    move_to(t, u);
    ode_.derivative(t, y_, dy_, part);
    return ode_.gather(dy_);
  }

  const WideSparseMatrix& jacobian(double t, const Eigen::VectorXd& u, Part part) {
    move_to(t, u);
    return ode_.jacobian(t, y_, part);
  }

  template <class Work>
  PetscErrorCode guarded(const Work& work) {
    try {
      work();
      return 0;
    } catch (const std::exception& error) {
      failure_ = error.what();
      return PETSC_ERR_USER;
    }
  }

 private:
  static const solver::SplitOde& require_ode(const model::Cloth& cloth) {
    if (cloth.ode.has_contacts() || cloth.ode.memory || cloth.ode.step_forces)
      throw std::runtime_error("PETSc runs scenes without obstacles, contact and memory");
    return cloth.ode;
  }

  void move_to(double t, const Eigen::VectorXd& u) {
    ode_.scatter(u, y_);
    y_ = ode_.output(t, std::move(y_));
  }

  model::Cloth cloth_;
  FirstOrderOde ode_;
  solver::State y_, dy_;
  std::string failure_;
};

Equation& equation(void* context) { return *static_cast<Equation*>(context); }

/// Adds the rows from `first` on of a Jacobian to a matrix, times `factors` of the columns of positions and of velocities;
/// `second_order`: both kinds of columns are the same unknown.
void add_rows(Mat matrix, const WideSparseMatrix& jacobian, PetscInt first, std::pair<double, double> factors,
              bool second_order) {
  const auto n = PetscInt(jacobian.cols() / 2);
  std::vector<PetscInt> columns;
  std::vector<PetscScalar> values;
  for (PetscInt row = first; row < PetscInt(jacobian.rows()); ++row) {
    columns.clear(), values.clear();
    for (WideSparseMatrix::InnerIterator entry(jacobian, row); entry; ++entry) {
      const auto column = PetscInt(entry.col());
      columns.push_back(second_order && column >= n ? column - n : column);
      values.push_back(entry.value() * (column < n ? factors.first : factors.second));
    }
    const PetscInt place = row - first;
    check(MatSetValues(matrix, 1, &place, PetscInt(columns.size()), columns.data(), values.data(), ADD_VALUES));
  }
}

void assemble(Mat matrix) {
  check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
}

/// shift I minus the Jacobian of a part.
template <Part part>
PetscErrorCode first_order_jacobian(TS, PetscReal t, Vec u, Vec, PetscReal shift, Mat, Mat matrix, void* context) {
  return equation(context).guarded([&] {
    check(MatZeroEntries(matrix));
    add_rows(matrix, equation(context).jacobian(t, values_of(u), part), 0, {-1, -1}, false);
    assemble(matrix);
    check(MatShift(matrix, shift));
  });
}

template <Part part>
PetscErrorCode residual(TS, PetscReal t, Vec u, Vec rate, Vec f, void* context) {
  return equation(context).guarded([&] { set(f, values_of(rate) - equation(context).rate(t, values_of(u), part)); });
}

template <Part part>
PetscErrorCode right_side(TS, PetscReal t, Vec u, Vec f, void* context) {
  return equation(context).guarded([&] { set(f, equation(context).rate(t, values_of(u), part)); });
}

Eigen::VectorXd stacked(Vec x, Vec v) {
  const Eigen::VectorXd positions = values_of(x), velocities = values_of(v);
  Eigen::VectorXd u(positions.size() + velocities.size());
  u << positions, velocities;
  return u;
}

PetscErrorCode second_order_residual(TS, PetscReal t, Vec x, Vec v, Vec a, Vec f, void* context) {
  return equation(context).guarded([&] {
    const Eigen::VectorXd acceleration = values_of(a);
    set(f, acceleration - equation(context).rate(t, stacked(x, v), Part::whole).tail(acceleration.size()));
  });
}

PetscErrorCode second_order_jacobian(TS, PetscReal t, Vec x, Vec v, Vec, PetscReal shift_v, PetscReal shift_a, Mat, Mat matrix,
                                     void* context) {
  return equation(context).guarded([&] {
    check(MatZeroEntries(matrix));
    const WideSparseMatrix& jacobian = equation(context).jacobian(t, stacked(x, v), Part::whole);
    add_rows(matrix, jacobian, PetscInt(jacobian.rows() / 2), {-1, -shift_v}, true);
    assemble(matrix);
    check(MatShift(matrix, shift_a));
  });
}

/// The parts of a split right side, of all unknowns.
PetscErrorCode position_rate(TS, PetscReal, Vec u, Vec f, void* context) {
  return equation(context).guarded([&] { set(f, values_of(u).tail(equation(context).size() / 2)); });
}

PetscErrorCode velocity_rate(TS, PetscReal t, Vec u, Vec f, void* context) {
  return equation(context).guarded(
      [&] { set(f, equation(context).rate(t, values_of(u), Part::whole).tail(equation(context).size() / 2)); });
}

/// A time stepper with all that it works on.
class Stepper {
 public:
  Stepper(const Problem& problem, Equation& equation) : equation_(equation) {
    const std::string family = problem.integrator.substr(0, problem.integrator.find('/'));
    const std::string member = family.size() < problem.integrator.size() ? problem.integrator.substr(family.size() + 1) : "";
    check(TSCreate(PETSC_COMM_SELF, &ts_.object));
    check(TSSetType(ts_.object, family.c_str()));
    check(TSSetTime(ts_.object, equation.begin()));
    check(TSSetTimeStep(ts_.object, problem.step));
    check(TSSetMaxSteps(ts_.object, PetscInt(problem.steps.back() + 1)));
    check(TSSetExactFinalTime(ts_.object, TS_EXACTFINALTIME_STEPOVER));
    set_equation(family);
    if (family == TSROSW) check(TSRosWSetType(ts_.object, member.c_str()));
    if (family == TSARKIMEX) check(TSARKIMEXSetType(ts_.object, member.c_str()));
    if (family == TSBDF) check(TSBDFSetOrder(ts_.object, PetscInt(std::stoi(member))));
    if (family == TSBASICSYMPLECTIC) check(TSBasicSymplecticSetType(ts_.object, member.c_str()));
    TSAdapt adapt = nullptr;
    check(TSGetAdapt(ts_.object, &adapt));
    check(TSAdaptSetType(adapt, TSADAPTNONE));
    if (family != TSBASICSYMPLECTIC) set_solvers();
  }

  void step() {
    const PetscErrorCode code = TSStep(ts_.object);
    if (!equation_.failure().empty()) throw std::runtime_error(equation_.failure());
    check(code);
    TSConvergedReason reason = TS_CONVERGED_ITERATING;
    check(TSGetConvergedReason(ts_.object, &reason));
    if (reason < 0) throw std::runtime_error(std::string("PETSc: ") + TSConvergedReasons[reason]);
  }

  void add_frame(Solved& solved) const {
    PetscReal t = 0;
    check(TSGetTime(ts_.object, &t));
    const solver::State y = equation_.state(t, v_.object != nullptr ? stacked(u_.object, v_.object) : values_of(u_.object));
    solved.positions.emplace_back(y.x.data(), y.x.data() + y.x.size());
    solved.velocities.emplace_back(y.v.data(), y.v.data() + y.v.size());
  }

 private:
  void set_equation(const std::string& family) {
    const Eigen::VectorXd start = equation_.start();
    const int n = equation_.size() / 2;
    TS ts = ts_.object;
    if (family == TSALPHA2) {
      create(u_, start.head(n));
      create(v_, start.tail(n));
      create_matrix(n, n);
      check(TSSetI2Function(ts, nullptr, second_order_residual, &equation_));
      check(TSSetI2Jacobian(ts, matrix_.object, matrix_.object, second_order_jacobian, &equation_));
      check(TS2SetSolution(ts, u_.object, v_.object));
      return;
    }
    create(u_, start);
    check(TSSetSolution(ts, u_.object));
    if (family == TSBASICSYMPLECTIC) {
      check(ISCreateStride(PETSC_COMM_SELF, n, 0, 1, &positions_.object));
      check(ISCreateStride(PETSC_COMM_SELF, n, n, 1, &velocities_.object));
      check(TSRHSSplitSetIS(ts, "position", positions_.object));
      check(TSRHSSplitSetIS(ts, "momentum", velocities_.object));
      check(TSRHSSplitSetRHSFunction(ts, "position", nullptr, position_rate, &equation_));
      check(TSRHSSplitSetRHSFunction(ts, "momentum", nullptr, velocity_rate, &equation_));
      check(TSSetRHSFunction(ts, nullptr, right_side<Part::whole>, &equation_));
      return;
    }
    create_matrix(2 * n, 0);
    if (family == TSARKIMEX) {
      check(TSSetIFunction(ts, nullptr, residual<Part::linear>, &equation_));
      check(TSSetIJacobian(ts, matrix_.object, matrix_.object, first_order_jacobian<Part::linear>, &equation_));
      check(TSSetRHSFunction(ts, nullptr, right_side<Part::remainder>, &equation_));
    } else {
      check(TSSetIFunction(ts, nullptr, residual<Part::whole>, &equation_));
      check(TSSetIJacobian(ts, matrix_.object, matrix_.object, first_order_jacobian<Part::whole>, &equation_));
    }
  }

  /// A matrix with room for the rows of the Jacobian from `first` on.
  void create_matrix(int size, int first) {
    const WideSparseMatrix& jacobian = equation_.jacobian(equation_.begin(), equation_.start(), Part::whole);
    std::vector<PetscInt> entries;
    for (int row = 0; row < size; ++row)
      entries.push_back(PetscInt(jacobian.outerIndexPtr()[first + row + 1] - jacobian.outerIndexPtr()[first + row]));
    check(MatCreateSeqAIJ(PETSC_COMM_SELF, size, size, 0, entries.data(), &matrix_.object));
  }

  /// Newton's method to well below the errors of any step, and a complete factor.
  void set_solvers() {
    constexpr double relative = 1e-10, of_step = 1e-13;
    SNES snes = nullptr;
    KSP ksp = nullptr;
    PC pc = nullptr;
    check(TSGetSNES(ts_.object, &snes));
    check(SNESSetTolerances(snes, PETSC_DEFAULT, relative, of_step, PETSC_DEFAULT, PETSC_DEFAULT));
    check(SNESGetKSP(snes, &ksp));
    check(KSPSetType(ksp, KSPPREONLY));
    check(KSPGetPC(ksp, &pc));
    check(PCSetType(pc, PCLU));
  }

  Equation& equation_;
  OwnedVec u_, v_;  ///< all unknowns; or positions and velocities apart
  OwnedMat matrix_;
  OwnedIs positions_, velocities_;
  OwnedTs ts_;  // it goes first
};

Solved solve(const Problem& problem) {
  const Library petsc;
  Equation equation(model::parse_scene(problem.scene, "problem.json"));
  Solved solved{"PETSc " + std::to_string(PETSC_VERSION_MAJOR) + "." + std::to_string(PETSC_VERSION_MINOR) + "." +
                std::to_string(PETSC_VERSION_SUBMINOR)};
  Stepper stepper(problem, equation);
  StepClock clock;
  std::int64_t done = 0;
  for (const std::int64_t until : problem.steps) {
    clock.time([&] {
      for (; done < until; ++done) stepper.step();
    });
    stepper.add_frame(solved);
  }
  solved.seconds = clock.seconds();
  return solved;
}

}  // namespace
}  // namespace drape::bench::peers

int main(int argc, char** argv) { return drape::bench::peers::run_program(argc, argv, drape::bench::peers::solve); }
