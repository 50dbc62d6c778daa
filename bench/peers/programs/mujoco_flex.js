// MuJoCo's own cloth: a flex of triangles with a membrane, its particles those of the problem.

const {load, main, solve} = require("./program.js");
const {arena, requireNoReset} = require("./mujoco_limits.js");

const thickness = 1e-3;  // [m]: only its product with the modulus matters to a membrane

function model(problem) {
  const mass = problem.mass.reduce((sum, m) => sum + m, 0);
  return `<mujoco><option timestep="${problem.step}" integrator="${problem.integrator}" gravity="${
             problem.gravity.join(" ")}">` +
      `<flag contact="disable"/></option><size memory="${arena}"/>
<worldbody><flexcomp name="cloth" type="direct" dim="2" mass="${mass}" radius="${thickness}"
  point="${problem.positions.join(" ")}" element="${problem.triangles.flat().join(" ")}">
<elasticity young="${problem.young / thickness}" poisson="0" thickness="${thickness}" elastic2d="stretch"/>
<contact selfcollide="none" internal="false"/><pin id="${problem.pinned.join(" ")}"/></flexcomp></worldbody></mujoco>`;
}

main(async problem => {
  const {version, exported} = await load("@mujoco/mujoco", "mujoco.js");
  const mujoco = await exported.default();
  const compiled = mujoco.MjModel.from_xml_string(model(problem));
  const data = new mujoco.MjData(compiled);
  const free = problem.mass.map((_, i) => i).filter(i => !problem.pinned.includes(i));
  free.forEach((i, place) => {
    for (let c = 0; c < 3; ++c) data.qvel[3 * place + c] = problem.velocities[3 * i + c];
  });
  const frame = () => {
    requireNoReset(data);
    mujoco.mj_kinematics(compiled, data);
    mujoco.mj_flex(compiled, data);
    const v = [...problem.velocities], w = data.qvel;
    free.forEach((i, place) => {
      for (let c = 0; c < 3; ++c) v[3 * i + c] = w[3 * place + c];
    });
    return [Array.from(data.flexvert_xpos), v];
  };
  return solve(problem, `MuJoCo ${version}`, () => mujoco.mj_step(compiled, data), frame);
});
