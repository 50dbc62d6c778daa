"use strict";
// What is shown of a motion: positions at any time, distances from the truth as colours, and what three.js draws.

// Viridis [van der Walt, Smith 2015] at ninths: even steps of lightness, for the colour-blind, too.
const viridis = ["#440154", "#482878", "#3e4a89", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"];

/** The positions of a trajectory, unpacked once: Float32Array, frame by frame. */
function unpack(trajectory) {
  const bytes = Uint8Array.from(atob(trajectory.positions), (character) => character.charCodeAt(0));
  return {...trajectory, particles: trajectory.nu * trajectory.nv, positions: new Float32Array(bytes.buffer)};
}

/** Positions at a time, between frames linearly, written to `to`; those of the last frame after the end. */
function positionsAt(motion, t, to) {
  const {times, positions, particles} = motion, size = 3 * particles;
  let k = times.findIndex((time) => time > t);
  if (k < 0) k = times.length;
  const below = Math.max(k - 1, 0), above = Math.min(k, times.length - 1);
  const share = above > below ? (t - times[below]) / (times[above] - times[below]) : 0;
  for (let i = 0; i < size; ++i) to[i] = (1 - share) * positions[below * size + i] + share * positions[above * size + i];
}

/** The distance of each particle from that of the truth. */
function distances(positions, truth) {
  return Array.from({length: positions.length / 3}, (_, i) => Math.hypot(...[0, 1, 2].map((c) => positions[3 * i + c] - truth[3 * i + c])));
}

const rootMeanSquare = (numbers) => Math.sqrt(numbers.reduce((sum, x) => sum + x * x, 0) / numbers.length);

const runLabel = (run) => `${run.method}, h = ${shortNumber(run.step)} s`;

/** Distances from the truth, all that a colour means: share(distance) in [0, 1] on a log scale of four powers of ten. */
function colourScale(views, truth, end) {
  let largest = 0;
  const mine = new Float32Array(3 * truth.motion.particles), its = mine.slice();
  for (const view of views)
    for (let k = 0; k <= 20; ++k) {
      positionsAt(view.motion, end * k / 20, mine), positionsAt(truth.motion, end * k / 20, its);
      largest = Math.max(largest, ...distances(mine, its));
    }
  const top = largest || 1;
  return {top, low: 1e-4 * top, share: (distance) => Math.min(1, Math.max(0, 1 + Math.log10(distance / top) / 4))};
}

function colourAt(share) {
  const at = share * (viridis.length - 1), below = Math.min(Math.floor(at), viridis.length - 2);
  return new THREE.Color(viridis[below]).lerp(new THREE.Color(viridis[below + 1]), at - below);
}

/** Two triangles for every cell; none for a chain. */
function cellTriangles({nu, nv}) {
  const triangles = [];
  for (let b = 0; b + 1 < nv; ++b)
    for (let a = 0; a + 1 < nu; ++a) {
      const i = a + nu * b;
      triangles.push(i, i + 1, i + nu + 1, i, i + nu + 1, i + nu);
    }
  return triangles;
}

/** What three.js draws of one run. */
function makeScene(motion) {
  const geometry = new THREE.BufferGeometry(), count = 3 * motion.particles;
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(count), 3));
  geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(count).fill(0.6), 3));
  const scene = new THREE.Scene(), sun = new THREE.DirectionalLight(0xffffff, 0.7);
  sun.position.set(1, -2, 3);
  scene.add(new THREE.AmbientLight(0xffffff, 0.6), sun);
  const chain = motion.nu === 1 || motion.nv === 1;
  if (!chain) geometry.setIndex(cellTriangles(motion));
  const cloth = chain ? new THREE.Line(geometry, new THREE.LineBasicMaterial({vertexColors: THREE.VertexColors}))
                      : new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({vertexColors: THREE.VertexColors, side: THREE.DoubleSide}));
  cloth.frustumCulled = false;
  scene.add(cloth);
  if (!chain) {
    const lines = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({color: 0x000000, wireframe: true, transparent: true, opacity: 0.12}));
    lines.frustumCulled = false;
    scene.add(lines);
  }
  return {scene, cloth, geometry, chain};
}

/** A run's canvas with its name and, below it, how far it is off. */
function makeView(run) {
  const motion = unpack(run.trajectory), canvas = element("canvas", {role: "img", "aria-label": `Motion of ${runLabel(run)}`});
  const says = element("p", {className: "quiet"}, "\u00a0");
  const box = element("div", {className: "view"}, element("p", {}, element("strong", {}, run.method), ` h = ${shortNumber(run.step)} s`), canvas, says);
  return {run, motion, canvas, says, box, ...makeScene(motion)};
}

/** The box around all that moves, over all frames. */
function bounds(views) {
  const box = new THREE.Box3(), point = new THREE.Vector3();
  for (const {motion} of views)
    for (let i = 0; i < motion.positions.length; i += 3) box.expandByPoint(point.set(...motion.positions.subarray(i, i + 3)));
  return box.getBoundingSphere(new THREE.Sphere());
}
