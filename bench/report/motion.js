// What is shown of a motion: positions at any time, distances from the truth as colours, and what three.js draws.

import {element, shortNumber} from "./data.js";

// Viridis [van der Walt, Smith 2015] at ninths: even steps of lightness, also for the colour-blind.
export const viridis =
    ["#440154", "#482878", "#3e4a89", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"];

const bytesOf = (text) => Uint8Array.from(atob(text), (character) => character.charCodeAt(0));

/** A trajectory, unpacked once: positions frame by frame, what constrains each particle, obstacles with their poses. */
function unpack(trajectory, surfaces) {
  const obstacles = trajectory.obstacles.drawn.map(
      ({surface, poses}) => ({surface: surfaces[surface], poses: new Float32Array(bytesOf(poses).buffer)}));
  return {
    ...trajectory,
    particles: trajectory.nu * trajectory.nv,
    positions: new Float32Array(bytesOf(trajectory.positions).buffer),
    constraint: bytesOf(trajectory.constraint),
    trim: unpackTrim(trajectory.trim),
    refined: trajectory.trim ? null : unpackRefined(trajectory.refined),
    obstacles,
    missing: [
      ...trajectory.obstacles.missing.map((why) => `An obstacle is not drawn: ${why}`),
      ...(trajectory.trim?.missing ? [`The grid is drawn in the place of a mesh: ${trajectory.trim.missing}`] : [])
    ]
  };
}

/** The mesh in the place of the grid, if it can be drawn: three particles and weights of each vertex, triangles. */
function unpackTrim(trim) {
  if (!trim || trim.missing) return null;
  return {
    particles: new Uint32Array(bytesOf(trim.particles).buffer),
    weights: new Float32Array(bytesOf(trim.weights).buffer),
    triangles: new Uint32Array(bytesOf(trim.triangles).buffer)
  };
}

/** The sheet with its virtual particles, frame by frame. */
function unpackRefined(frames) {
  if (!frames) return null;
  return frames.map(({vertices, nearest, triangles}) => ({
                      vertices: new Float32Array(bytesOf(vertices).buffer),
                      nearest: new Uint32Array(bytesOf(nearest).buffer),
                      triangles: new Uint32Array(bytesOf(triangles).buffer)
                    }));
}

const longest = (frames, part) => Math.max(...frames.map((frame) => frame[part].length));

/** Draws the virtual particles of the frame before a time, each in the colour of the particle that is nearest. */
export function placeRefined({motion, geometry, drawn}, t) {
  const {vertices, nearest, triangles} = motion.refined[framesAt(motion.times, t).below];
  const {position, color} = drawn.attributes, first = 3 * motion.particles;
  position.array.set(geometry.attributes.position.array);
  position.array.set(vertices, first);
  color.array.set(geometry.attributes.color.array);
  nearest.forEach((i, k) => color.array.copyWithin(first + 3 * k, 3 * i, 3 * i + 3));
  drawn.index.array.fill(0);
  drawn.index.array.set(triangles);
  drawn.index.needsUpdate = position.needsUpdate = color.needsUpdate = true;
  drawn.setDrawRange(0, triangles.length);
}

/** Writes what particles have, three numbers each, to the vertices of the mesh that rides on them. */
export function carry({particles, weights}, from, to) {
  for (let i = 0; i < to.length; ++i) {
    const vertex = 3 * Math.floor(i / 3), c = i % 3;
    to[i] = [0, 1, 2].reduce((sum, k) => sum + weights[vertex + k] * from[3 * particles[vertex + k] + c], 0);
  }
}

/** The particle to which a vertex of what is drawn is nearest. */
export function particleOf({trim, refined, particles, times}, vertex, t) {
  if (refined && vertex >= particles) return refined[framesAt(times, t).below].nearest[vertex - particles];
  if (!trim) return vertex;
  const weights = trim.weights.subarray(3 * vertex, 3 * vertex + 3);
  return trim.particles[3 * vertex + weights.indexOf(Math.max(...weights))];
}

/** The frames before and after a time, and how far it is from the one to the other; after the end the last one. */
function framesAt(times, t) {
  const next = times.findIndex((time) => time > t), after = next < 0 ? times.length : next;
  const below = Math.max(after - 1, 0), above = Math.min(after, times.length - 1);
  return {below, above, share: above > below ? (t - times[below]) / (times[above] - times[below]) : 0};
}

/** Positions at a time, between frames linearly, written to `to`. */
export function positionsAt({times, positions, particles}, t, to) {
  const {below, above, share} = framesAt(times, t), size = 3 * particles;
  for (let i = 0; i < size; ++i)
    to[i] = (1 - share) * positions[below * size + i] + share * positions[above * size + i];
}

/** The distance of each particle from that of the truth. */
export function distances(positions, truth) {
  return Array.from(
      {length: positions.length / 3},
      (_, i) => Math.hypot(...[0, 1, 2].map((c) => positions[3 * i + c] - truth[3 * i + c])));
}

export const rootMeanSquare = (numbers) => Math.sqrt(numbers.reduce((sum, x) => sum + x * x, 0) / numbers.length);

export const runLabel = (run) => `${run.method}, h = ${shortNumber(run.step)} s`;

/**
 * Distances from the truth, all that a colour means: share(distance) in [0, 1] on a log scale of four powers of ten.
 */
export function colourScale(views, truth, end) {
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

export function colourAt(share) {
  const at = share * (viridis.length - 1), below = Math.min(Math.floor(at), viridis.length - 2);
  return new THREE.Color(viridis[below]).lerp(new THREE.Color(viridis[below + 1]), at - below);
}

const noCloth = 3;  // the constraint of particles outside of a cut

/** Two triangles for every cell whose corners are in the cloth; none for a chain. */
function cellTriangles({panels, constraint}) {
  const triangles = [];
  let first = 0;
  for (const [nu, nv] of panels) {
    for (let b = 0; b + 1 < nv; ++b)
      for (let a = 0; a + 1 < nu; ++a) {
        const i = first + a + nu * b;
        if ([i, i + 1, i + nu, i + nu + 1].some((corner) => constraint[corner] === noCloth)) continue;
        triangles.push(i, i + 1, i + nu + 1, i, i + nu + 1, i + nu);
      }
    first += nu * nv;
  }
  return triangles;
}

/** What a particle is called: "particle (a, b)", of several panels with its panel, counted from 1. */
export function particleName({panels}, i) {
  let panel = 0;
  for (; i >= panels[panel][0] * panels[panel][1]; ++panel) i -= panels[panel][0] * panels[panel][1];
  const [nu] = panels[panel], place = `particle (${i % nu}, ${Math.floor(i / nu)})`;
  return panels.length > 1 ? `${place} of panel ${panel + 1}` : place;
}

/** The geometry of a surface, made once: runs share it, and the time. */
function surfaceGeometry(surface) {
  if (surface.geometry) return surface.geometry;
  const geometry = new THREE.BufferGeometry();
  surface.positions = new Float32Array(bytesOf(surface.vertices).buffer);
  geometry.setAttribute("position", new THREE.BufferAttribute(surface.positions.slice(0, 3 * surface.count), 3));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(bytesOf(surface.triangles).buffer), 1));
  geometry.computeVertexNormals();
  return (surface.geometry = geometry);
}

/**
 * A grey body with its sharp edges drawn, which tells it from the sheet on light and dark pages alike. It is drawn a
 * little farther away than it is: a refined sheet lies on its faces exactly.
 */
function makeObstacle({surface, poses}) {
  const geometry = surfaceGeometry(surface), body = new THREE.Group();
  body.add(new THREE.Mesh(geometry, new THREE.MeshPhongMaterial({
    color: 0x76828e,
    shininess: 0,
    flatShading: !surface.smooth,
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1
  })));
  if (!surface.smooth)
    body.add(
        new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 40), new THREE.LineBasicMaterial({color: 0x4a5560})));
  return {body, poses, surface};
}

/** Moves an obstacle to where it is at a time. */
export function placeObstacle({body, poses, surface}, times, t) {
  const {positions, geometry, count} = surface;
  if (positions.length > 3 * count) {
    positionsAt({times, positions, particles: count}, t, geometry.attributes.position.array);
    geometry.attributes.position.needsUpdate = true;
    geometry.computeVertexNormals();
    geometry.computeBoundingSphere();
  }
  const moves = poses.length > 7, {below, above, share} = moves ? framesAt(times, t) : {below: 0, above: 0, share: 0};
  const position = (frame) => new THREE.Vector3().fromArray(poses, 7 * frame),
        turn = (frame) => new THREE.Quaternion().fromArray(poses, 7 * frame + 3);
  body.position.copy(position(below).lerp(position(above), share));
  body.quaternion.copy(turn(below).slerp(turn(above), share));
}

// What the trajectory says of particles, and how they are marked.
export const constraints = [
  {kind: 1, name: "pinned", square: true, colour: "#ffffff", border: "#000000", size: 9},
  {kind: 2, name: "in contact", square: false, colour: "#D55E00", border: "#ffffff", size: 8}
];

/** A mark as a small picture. */
export function markPicture({square, colour, border}) {
  const canvas = element("canvas", {width: 32, height: 32}), context = canvas.getContext("2d");
  context.fillStyle = colour, context.strokeStyle = border, context.lineWidth = square ? 6 : 3;
  if (square)
    context.rect(4, 4, 24, 24);
  else
    context.arc(16, 16, 12, 0, 2 * Math.PI);
  context.fill(), context.stroke();
  return canvas;
}

/** Marks on particles of one kind; a little nearer than they are, so that the sheet does not cut them in half. */
function makeMarks(mark, positions, particles) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", positions);
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(particles), 1));
  const material = new THREE.PointsMaterial({
    map: new THREE.CanvasTexture(markPicture(mark)),
    size: mark.size,
    sizeAttenuation: false,
    transparent: true,
    alphaTest: 0.4
  });
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace(
        "#include <project_vertex>",
        "#include <project_vertex>\n gl_Position = projectionMatrix * vec4(0.99 * mvPosition.xyz, 1.0);");
  };
  const points = new THREE.Points(geometry, material);
  points.frustumCulled = false;
  return {mark, points, geometry};
}

/** What each particle is at a time: those of the frame before. */
export function constraintsAt({times, constraint, particles}, t) {
  const first = constraint.length > particles ? framesAt(times, t).below * particles : 0;
  return constraint.subarray(first, first + particles);
}

/** Puts the marks on those particles that are of their kind at a time. */
export function placeMarks({mark, geometry}, motion, t) {
  let count = 0;
  constraintsAt(motion, t).forEach((kind, i) => {
    if (kind === mark.kind) geometry.index.array[count++] = i;
  });
  geometry.index.needsUpdate = true;
  geometry.setDrawRange(0, count);
}

export const hasMarks = (motion, mark) => motion.constraint.includes(mark.kind);

/** The sheet, or the line of a chain, with its mesh. */
function makeCloth(motion, geometry) {
  const chain = !motion.trim && motion.panels.every(([nu, nv]) => nu === 1 || nv === 1);
  if (motion.trim)
    geometry.setIndex(new THREE.BufferAttribute(motion.trim.triangles, 1));
  else if (motion.refined)
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(longest(motion.refined, "triangles")), 1));
  else if (!chain)
    geometry.setIndex(cellTriangles(motion));
  const cloth = chain ?
      new THREE.Line(geometry, new THREE.LineBasicMaterial({vertexColors: THREE.VertexColors})) :
      new THREE.Mesh(
          geometry, new THREE.MeshLambertMaterial({vertexColors: THREE.VertexColors, side: THREE.DoubleSide}));
  const lines = chain ?
      [] :
      [new THREE.Mesh(
          geometry, new THREE.MeshBasicMaterial({color: 0x000000, wireframe: true, transparent: true, opacity: 0.12}))];
  for (const any of [cloth, ...lines]) any.frustumCulled = false;
  return {chain, cloth, lines};
}

/** Places and grey, three numbers each. */
function makeGeometry(count) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(count), 3));
  geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(count).fill(0.6), 3));
  return geometry;
}

/** What three.js draws of one run: `geometry` has the particles, `drawn` the vertices of the cloth. */
function makeScene(motion) {
  const geometry = makeGeometry(3 * motion.particles);
  const drawn = motion.trim ? makeGeometry(motion.trim.particles.length) :
      motion.refined        ? makeGeometry(3 * motion.particles + longest(motion.refined, "vertices")) :
                              geometry;
  const {chain, cloth, lines} = makeCloth(motion, drawn), bodies = motion.obstacles.map(makeObstacle);
  const marks = constraints.filter((mark) => hasMarks(motion, mark))
                    .map((mark) => makeMarks(mark, geometry.attributes.position, motion.particles));
  const scene = new THREE.Scene(), sun = new THREE.DirectionalLight(0xffffff, 0.7);
  sun.position.set(1, -2, 3);
  scene.add(
      new THREE.AmbientLight(0xffffff, 0.6), sun, cloth, ...lines, ...bodies.map(({body}) => body),
      ...marks.map(({points}) => points));
  return {scene, cloth, geometry, drawn, chain, bodies, marks};
}

/** A run's canvas with its name and, below it, how far it is off. */
export function makeView(run, surfaces) {
  const motion = unpack(run.trajectory, surfaces),
        canvas = element("canvas", {role: "img", "aria-label": `Motion of ${runLabel(run)}`});
  const says = element("p", {className: "quiet"}, "\u00a0");
  const box = element(
      "div", {className: "view"},
      element("p", {}, element("strong", {}, run.method), ` h = ${shortNumber(run.step)} s`), canvas, says);
  return {run, motion, canvas, says, box, ...makeScene(motion)};
}

/**
 * How a camera with a field of view, in degrees, sees all that moves from a direction, from as near as it fits over all
 * frames: the `target` it looks at, its `distance` from that, and the `aspect` of its picture.
 */
export function framing(views, direction, up, field) {
  const right = new THREE.Vector3().crossVectors(up, direction).normalize(),
        above = new THREE.Vector3().crossVectors(direction, right);
  const along = [right, above, direction], low = along.map(() => Infinity), high = along.map(() => -Infinity);
  const point = new THREE.Vector3();
  const forEach = (visit) => views.forEach(({motion: {positions}}) => {
    for (let i = 0; i < positions.length; i += 3) visit(point.fromArray(positions, i));
  });
  forEach(() => along.forEach((axis, k) => {
    const place = point.dot(axis);
    low[k] = Math.min(low[k], place), high[k] = Math.max(high[k], place);
  }));
  const middle = along.map((_, k) => (low[k] + high[k]) / 2), size = along.map((_, k) => high[k] - low[k]);
  const target = new THREE.Vector3();
  along.forEach((axis, k) => target.addScaledVector(axis, middle[k]));
  const aspect = Math.max(0.75, Math.min(1.5, size[0] / size[1] || 1));
  const slope = 0.93 * Math.tan(field * Math.PI / 360);
  let distance = 0;
  forEach(() => {
    const [x, y, z] = along.map((axis, k) => point.dot(axis) - middle[k]);
    distance = Math.max(distance, z + Math.max(Math.abs(y), Math.abs(x) / aspect) / slope);
  });
  return {target, distance, aspect};
}
