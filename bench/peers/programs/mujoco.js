// MuJoCo on springs: each particle is a body with three slides, each spring a tendon between the sites of two.

const {root, run} = require("./mujoco_run.js");

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

const model = problem => root(problem, `<worldbody>${list(problem.mass, i => particle(problem, i))}</worldbody>
<tendon>${list(problem.ends, k => spring(problem, k))}</tendon>`);

/** Slides are what a particle has moved by. */
run(model, (problem, {data, forFree}) => {
  const x = [...problem.positions], q = data.qpos;
  forFree((one, own) => x[one] += q[own]);
  return x;
});
