// What programs that run MuJoCo share.

const {load, main, solve} = require("./program.js");

const arena = "300M";  // of its own accord it takes more for a large sheet than WebAssembly has

/** MuJoCo goes back to its start, and only counts that, where something is not finite or too large. */
function requireNoReset(data) {
  for (let k = 0; k < data.warning.size(); ++k)
    if (data.warning.get(k).number > 0)
      throw Error(`MuJoCo has warned and gone back to its start before ${data.time} s`);
}

/** The element that is the root of a model, around what it consists of. */
const root = (problem, parts) => `<mujoco><option timestep="${problem.step}" integrator="${
                                     problem.integrator}" gravity="${problem.gravity.join(" ")}">` +
    `<flag contact="disable"/></option><size memory="${arena}"/>
${parts}</mujoco>`;

/**
 * Runs the model of a problem, XML, in which particles that are not pinned have three coordinates each, in their order.
 * positionsOf(problem, {mujoco, compiled, data, forFree}) gives all positions; forFree(visit) visits the coordinates of
 * particles that are not pinned, by their places among all coordinates and among those of the model.
 */
function run(model, positionsOf) {
  main(async problem => {
    const {version, exported} = await load("@mujoco/mujoco", "mujoco.js");
    const mujoco = await exported.default();
    const compiled = mujoco.MjModel.from_xml_string(model(problem));
    const data = new mujoco.MjData(compiled);
    const free = problem.mass.map((_, i) => i).filter(i => !problem.pinned.includes(i));
    const forFree = visit => free.forEach((i, place) => {
      for (let c = 0; c < 3; ++c) visit(3 * i + c, 3 * place + c);
    });
    forFree((one, own) => data.qvel[own] = problem.velocities[one]);
    const frame = () => {
      requireNoReset(data);
      const x = positionsOf(problem, {mujoco, compiled, data, forFree}), v = [...problem.velocities], w = data.qvel;
      forFree((one, own) => v[one] = w[own]);
      return [x, v];
    };
    return solve(problem, `MuJoCo ${version}`, () => mujoco.mj_step(compiled, data), frame);
  });
}

module.exports = {
  root,
  run
};
