// MuJoCo on springs: each particle is a body with three slides, each spring a tendon between the sites of two.

const {load, main, solve} = require("./program.js");
const {arena, requireNoReset} = require("./mujoco_limits.js");

function particle(problem, i) {
  const x = problem.positions.slice(3 * i, 3 * i + 3).join(" ");
  if (problem.pinned.includes(i)) return `<site name="${i}" pos="${x}"/>`;
  const slides = ["1 0 0", "0 1 0", "0 0 1"].map(axis => `<joint type="slide" axis="${axis}"/>`).join("");
  const inertia = `<inertial pos="0 0 0" mass="${problem.mass[i]}" diaginertia="1e-6 1e-6 1e-6"/>`;  // they do not turn
  return `<body pos="${x}">${inertia}${slides}<site name="${i}"/></body>`;
}

function spring(problem, k) {
  const [i, j] = problem.ends[k];
  return `<spatial springlength="${problem.rest[k]}" stiffness="${problem.stiffness[k]}" damping="${
             problem.drag[k]}">` +
      `<site site="${i}"/><site site="${j}"/></spatial>`;
}

const list = (all, one) => Array.from(all, (_, k) => one(k)).join("\n");

function model(problem) {
  return `<mujoco><option timestep="${problem.step}" integrator="${problem.integrator}" gravity="${
             problem.gravity.join(" ")}">` +
      `<flag contact="disable"/></option><size memory="${arena}"/>
<worldbody>${list(problem.mass, i => particle(problem, i))}</worldbody>
<tendon>${list(problem.ends, k => spring(problem, k))}</tendon></mujoco>`;
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
    const x = [...problem.positions], v = [...problem.velocities], q = data.qpos, w = data.qvel;
    free.forEach((i, place) => {
      for (let c = 0; c < 3; ++c) {
        x[3 * i + c] += q[3 * place + c];
        v[3 * i + c] = w[3 * place + c];
      }
    });
    return [x, v];
  };
  return solve(problem, `MuJoCo ${version}`, () => mujoco.mj_step(compiled, data), frame);
});
