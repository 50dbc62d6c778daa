// Motions side by side: one camera, one time, each run coloured by its distance from the one chosen as the truth.

import {commandLine, element, files, groupBy, lengthText, shortNumber, unique} from "./data.js";
import {carry, colourAt, colourScale, constraints, constraintsAt, distances, framing, hasMarks, makeView} from "./motion.js";
import {markPicture, particleName, particleOf, placeMarks, placeObstacle, placeRefined} from "./motion.js";
import {positionsAt, rootMeanSquare, runLabel, viridis} from "./motion.js";
import {along, axis, baseLayout, labelled, lineStyle, logTicks, style, timeAxis} from "./plots.js";
import {comparedRuns} from "./run_figures.js";
import {marked} from "./tips.js";

/** Writes positions and colours of time t into a view. */
function updateView(view, player) {
  const {geometry, motion} = view, {position, color} = geometry.attributes;
  positionsAt(motion, player.t, position.array);
  positionsAt(player.truth.motion, player.t, player.true_positions);
  view.off = distances(position.array, player.true_positions);
  view.off.forEach((off, i) => colourAt(player.scale.share(off)).toArray(color.array, 3 * i));
  position.needsUpdate = color.needsUpdate = true;
  if (motion.trim) {
    carry(motion.trim, position.array, view.drawn.attributes.position.array);
    carry(motion.trim, color.array, view.drawn.attributes.color.array);
    view.drawn.attributes.position.needsUpdate = view.drawn.attributes.color.needsUpdate = true;
  }
  if (motion.refined) placeRefined(view, player.t);
  if (!view.chain) view.drawn.computeVertexNormals();
  view.drawn.computeBoundingSphere();
  for (const body of view.bodies) placeObstacle(body, motion.times, player.t);
  for (const marks of view.marks) placeMarks(marks, motion, player.t);
  const ended = player.t > motion.times[motion.times.length - 1] + 1e-9 ?
      `; ended at ${shortNumber(motion.times[motion.times.length - 1])} s` :
      "";
  const distance = `${lengthText(rootMeanSquare(view.off))} off (root mean square)`;
  view.says.textContent = (view === player.truth ? "the others are measured from this one" : distance) + ended;
}

/** One renderer draws all the views and hands each its picture: browsers allow but few at a time. */
function renderViews(player) {
  const {renderer, camera} = player;
  for (const {canvas, scene, marks} of player.views) {
    const width = Math.round(canvas.clientWidth * devicePixelRatio), height = Math.round(width / camera.aspect);
    if (!width) continue;
    if (canvas.width !== width || canvas.height !== height) canvas.width = width, canvas.height = height;
    for (const {mark, points} of marks)
      points.material.size = Math.max(3, Math.min(mark.size, canvas.clientWidth / 40)) * devicePixelRatio;
    renderer.setSize(width, height, false);
    renderer.render(scene, camera);
    const context = canvas.getContext("2d");
    context.clearRect(0, 0, width, height);
    context.drawImage(renderer.domElement, 0, 0);
  }
}

export function showTime(player, t) {
  player.t = t;
  player.slider.value = t;
  player.clock.textContent = `t = ${t.toFixed(3)} s`;
  for (const view of player.views) updateView(view, player);
  renderViews(player);
}

/** Plays from the time shown to the end, slowed down or sped up by a factor. */
function play(player) {
  player.used = true;
  if (player.playing) return void (player.playing = false);
  player.playing = true;
  player.button.textContent = "Pause";
  let last = performance.now(), t = player.t >= player.end ? 0 : player.t;
  const step = (now) => {
    if (!player.playing) return void (player.button.textContent = "Play");
    t = Math.min(player.end, t + (now - last) / 1000 * Number(player.speed.value));
    last = now;
    showTime(player, t);
    player.playing = t < player.end;
    requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}

/** Plays once when the motions come into view, unless they were used before or the user wants no motion. */
export function playWhenSeen(player) {
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) return;
  const seen = new IntersectionObserver(([entry]) => {
    if (!entry.isIntersecting) return;
    seen.disconnect();
    if (player.used) return;
    player.t = 0;
    play(player);
  }, {threshold: 0.3});
  seen.observe(player.grid);
}

/** The particle below the pointer with its numbers. */
function hover(player, view, event) {
  const area = view.canvas.getBoundingClientRect(), ray = new THREE.Raycaster();
  const at = new THREE.Vector2(
      2 * (event.clientX - area.left) / area.width - 1, 1 - 2 * (event.clientY - area.top) / area.height);
  ray.setFromCamera(at, player.camera);
  const [hit] = view.chain ? [] : ray.intersectObject(view.cloth);
  if (!hit) return void (view.canvas.title = "");
  const {array} = view.geometry.attributes.position;
  const far = (i) => hit.point.distanceToSquared(new THREE.Vector3(...array.subarray(3 * i, 3 * i + 3)));
  const corners = [hit.face.a, hit.face.b, hit.face.c].map((vertex) => particleOf(view.motion, vertex, player.t));
  const i = corners.sort((p, q) => far(p) - far(q))[0];
  const place = [...array.subarray(3 * i, 3 * i + 3)].map((x) => x.toFixed(4)).join(", ");
  const constrained = constraints.find(({kind}) => kind === constraintsAt(view.motion, player.t)[i]);
  view.canvas.title = view.says.textContent = `${particleName(view.motion, i)}${
      constrained ? `, ${constrained.name}` : ""}: (${place}) m, ${lengthText(view.off[i])} off`;
}

/** The arrow keys turn the camera. */
function turn(player, event) {
  const turns = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]}[event.key];
  if (!turns) return;
  event.preventDefault();
  const {camera, controls} = player, from = camera.position.clone().sub(controls.target);
  from.applyAxisAngle(camera.up, turns[0])
      .applyAxisAngle(new THREE.Vector3().crossVectors(camera.up, from).normalize(), turns[1]);
  camera.position.copy(controls.target).add(from);
  controls.update();
}

function makeCamera(player, grid) {
  const up = new THREE.Vector3(0, 0, 1), direction = new THREE.Vector3(1.85, -2.65, 1.3).normalize(), field = 35;
  const {target, distance, aspect} = framing(player.views, direction, up, field);
  player.camera = new THREE.PerspectiveCamera(field, aspect, distance / 100, 100 * distance);
  player.camera.up.copy(up);
  player.camera.position.copy(target).addScaledVector(direction, distance);
  for (const {canvas} of player.views) canvas.style.aspectRatio = aspect;
  player.controls = new THREE.OrbitControls(player.camera, grid);
  player.controls.target.copy(target);
  player.controls.enableKeys = false;
  player.controls.update();
  player.controls.saveState();
  player.controls.addEventListener("change", () => renderViews(player));
  grid.addEventListener("keydown", (event) => turn(player, event));
}

/** The run with the least error that is known, else with the least step. */
function mostAccurate(views) {
  const error = (view) => view.run.error?.rms ?? Infinity;
  return [...views].sort((a, b) => error(a) - error(b) || a.run.step - b.run.step)[0];
}

const alike = (a, b) => String(a.motion.panels) === String(b.motion.panels);

function scaleElement(player) {
  const bar = element("div", {className: "scale", role: "img", "aria-label": "colours of distances"});
  bar.style.background = `linear-gradient(to right, ${viridis.join(", ")})`;
  const labels = [0, 1, 2, 3, 4].map(
      (k) => element(
          "span", {}, `${k ? "" : "≤ "}${lengthText(Number((player.scale.top * 10 ** (k - 4)).toPrecision(2)))}`));
  return element("div", {}, bar, element("div", {className: "scale-labels"}, ...labels));
}

/** What the marks mean that there are, and what is not drawn. */
function legendElement({views}) {
  const entry = (picture, name) => element("span", {}, picture, ` ${name}`);
  const entries = constraints.filter((mark) => views.some(({motion}) => hasMarks(motion, mark)))
                      .map((mark) => entry(markPicture(mark), mark.name));
  if (views.some(({bodies}) => bodies.length)) entries.push(entry(element("span", {className: "body"}), "obstacle"));
  const missing =
      unique(views.flatMap(({motion}) => motion.missing)).map((why) => element("p", {className: "bad"}, why));
  return element("div", {}, element("p", {className: "legend"}, ...entries), ...missing);
}

function makeControls(player) {
  player.button = element("button", {type: "button", on: {click: () => play(player)}}, "Play");
  player.slider = element("input", {
    type: "range",
    className: "time",
    min: 0,
    max: player.end,
    step: player.end / 1000,
    value: 0,
    "aria-label": "time"
  });
  player.slider.addEventListener("input", () => {
    player.used = true;
    player.playing = false;
    showTime(player, Number(player.slider.value));
  });
  player.clock = element("output", {});
  player.speed = element(
      "select", {"aria-label": "speed"},
      ...[0.1, 0.25, 0.5, 1, 2].map((speed) => element("option", {value: speed}, `${speed} ×`)));
  player.speed.value = 0.5;
  const reset = element("button", {type: "button", on: {click: () => player.controls.reset()}}, "Reset view");
  return element("div", {className: "actions"}, player.button, player.slider, player.clock, player.speed, reset);
}

/** How far each run is off over time, as columns for the CSV and as a figure. */
function distanceRows(player) {
  const mine = new Float32Array(3 * player.truth.motion.particles), its = mine.slice();
  return player.views.filter((view) => view !== player.truth).flatMap((view) => view.motion.times.map((t) => {
    positionsAt(view.motion, t, mine), positionsAt(player.truth.motion, t, its);
    const off = distances(mine, its);
    return {method: view.run.method, step: view.run.step, t, rms: rootMeanSquare(off), maximum: Math.max(...off)};
  }));
}

/** The same as a figure. */
function distanceFigure(file, name, player) {
  const rows = distanceRows(player), truth = runLabel(player.truth.run);
  const make = (width, colours) => {
    const curves = labelled(
        [...groupBy(rows.filter((row) => row.rms > 0), runLabel)].map(
            ([label, of]) => ({
              type: "scatter",
              mode: "lines+markers",
              name: label,
              x: of.map((row) => row.t),
              y: of.map((row) => row.rms),
              hovertemplate: `${label}<br>t = %{x:.4g} s: %{y:.3e} m<extra></extra>`,
              line: lineStyle(of[0].method),
              marker: {symbol: style(of[0].method).symbol, size: 5}
            })),
        width, along);
    return {
      data: curves,
      layout: {
        ...baseLayout(width, colours, curves.length),
        xaxis: timeAxis(colours),
        yaxis: axis("RMS distance [m]", colours, logTicks(rows.map((row) => row.rms)))
      }
    };
  };
  return {
    file,
    make,
    title: `Distance from ${truth}: ${name}`,
    says: "Root mean square distance of the recorded positions, frame by frame.",
    columns: () => ["method", "step", "t", "rms", "maximum"].map(
        (column) => ({name: column, cells: rows.map((row) => row[column])}))
  };
}

/** The motions of compared runs as an article; undefined if less than one was recorded. */
function playerElement(file, name, runs, id) {
  const all = runs.filter((run) => run.trajectory?.times.length).map((run) => makeView(run, file.surfaces));
  if (!all.length) return undefined;
  const truth = mostAccurate(all), views = all.filter((view) => alike(view, truth));
  const player = {
    views,
    truth,
    t: 0,
    playing: false,
    end: Math.max(...views.map((view) => view.motion.times[view.motion.times.length - 1]))
  };
  player.scale = colourScale(views, truth, player.end);
  player.true_positions = new Float32Array(3 * truth.motion.particles);
  player.renderer = new THREE.WebGLRenderer({antialias: true, alpha: true, preserveDrawingBuffer: true});
  const grid = element(
      "div", {
        className: "player",
        tabIndex: 0,
        role: "group",
        "aria-label": "Motions; drag or use the arrow keys to turn them"
      },
      ...views.map((view) => view.box));
  player.grid = grid;
  makeCamera(player, grid);
  const controls = makeControls(player);
  for (const view of views) view.canvas.addEventListener("pointermove", (event) => hover(player, view, event));
  new ResizeObserver(() => renderViews(player)).observe(grid);
  const says = `Drag to turn, wheel to come nearer, point at a particle for its numbers. Colours are distances from ${
      runLabel(truth.run)}, ${
      truth.run.error ? `which has the least error of these runs, ${
                            shortNumber(100 * truth.run.error.rms)} % of the size at the end` :
                        "one of the least step"}.`;
  const figure = element(
      "figure", {id},
      element("figcaption", {}, element("h3", {}, `Motion: ${name}`), element("p", {}, ...marked(says))), grid,
      controls, scaleElement(player), legendElement(player), commandLine(file));
  return {figure, player, more: views.length > 1 ? [distanceFigure(file, name, player)] : []};
}

/** All motions of a file. */
export const playersOf = (file) =>
    comparedRuns(file)
        .map(([name, runs], k) => playerElement(file, name, runs, `motion-${files.indexOf(file) + 1}-${k + 1}`))
        .filter((any) => any);
