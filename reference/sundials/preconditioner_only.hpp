#pragma once

#include <sundials/sundials_linearsolver.h>

namespace drape::reference::sundials_tools {

/// A linear solver of SUNDIALS that applies the user's preconditioner once: for one that is nearly the inverse. SUNDIALS keeps
/// it up to date by the rules it has for preconditioners. Null if there is no memory.
SUNLinearSolver make_preconditioner_only(SUNContext context);

}  // namespace drape::reference::sundials_tools
