// MuJoCo's own cloth: a flex of triangles with a membrane, its particles those of the problem.

const {root, run} = require("./mujoco_run.js");

const thickness = 1e-3;  // [m]: only its product with the modulus matters to a membrane

function model(problem) {
  const mass = problem.mass.reduce((sum, m) => sum + m, 0);
  return root(problem, `<worldbody><flexcomp name="cloth" type="direct" dim="2" mass="${mass}" radius="${thickness}"
  point="${problem.positions.join(" ")}" element="${problem.triangles.flat().join(" ")}">
<elasticity young="${problem.young / thickness}" poisson="0" thickness="${thickness}" elastic2d="stretch"/>
<contact selfcollide="none" internal="false"/><pin id="${problem.pinned.join(" ")}"/></flexcomp></worldbody>`);
}

run(model, (_, {mujoco, compiled, data}) => {
  mujoco.mj_kinematics(compiled, data);
  mujoco.mj_flex(compiled, data);
  return Array.from(data.flexvert_xpos);
});
