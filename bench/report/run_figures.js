// Figures of runs: those of one scene with the same changes and the same end are compared.

import {element, groupBy, shortNumber, toNumber, unique} from "./data.js";
import {finitePositive, workPrecisionLayout, workPrecisionTrace} from "./figures.js";
import {runLabel} from "./motion.js";
import {along, axis, baseLayout, labelled, lineStyle, moreCurves, style, timeAxis} from "./plots.js";

const runTitle = (run) => [run.scene, run.overrides, `${shortNumber(run.until)} s`].filter((text) => text).join(", ");

export const comparedRuns = (file) => [...groupBy(file.runs, runTitle)];

/** A run as a row of time against error, with the quartiles of its times; undefined if it cannot be one. */
function workPrecisionRow(run) {
  if (!run.succeeded || !run.error?.comparable || !finitePositive(run.error.rms) || !run.time) return undefined;
  return {
    method: run.method,
    step: run.step,
    steps: run.steps.t.length,
    error: run.error.rms,
    uncertainty: run.error.reference_error,
    unresolved: !run.error.resolved,
    lower: run.time.lower,
    time: run.time.median,
    upper: run.time.upper
  };
}

/** Methods in the order of how little more time than the quickest they take for an error that they reach. */
function byUse(methods, rows) {
  const excess = (row) =>
      row.time / Math.min(...rows.filter((other) => other.error <= row.error).map((other) => other.time));
  const least =
      new Map(methods.map((method) => [method, Math.min(...rows.filter((row) => row.method === method).map(excess))]));
  return [...methods].sort((a, b) => least.get(a) - least.get(b));
}

function runWorkPrecision(file, name, runs) {
  const rows = runs.map(workPrecisionRow).filter((row) => row);
  if (rows.length < 2) return [];
  const methods = byUse(unique(rows.map((row) => row.method)), rows);
  const uncertainty = Math.max(...rows.map((row) => row.uncertainty));
  const make = (width, colours) => {
    const curves = labelled(
        methods.map(
            (method) => workPrecisionTrace(
                method, rows.filter((row) => row.method === method).sort((a, b) => b.step - a.step), style(method),
                (row) => `${method}, h = ${shortNumber(row.step)} s`)),
        width);
    const titles = {x: "error over the scene's size", y: "solver time [ms]"};
    return {
      data: curves,
      layout: workPrecisionLayout(width, colours, rows, uncertainty, curves, curves.length, titles)
    };
  };
  return [{
    file,
    make,
    title: `Work–precision of runs: ${name}`,
    says:
        "Lower is quicker, further right more accurate; bars are quartiles of the times. Marks are hollow where the " +
        `error is below 10 × the reference's own of ${shortNumber(uncertainty)} (grey band).` +
        moreCurves(methods.length),
    columns: () => ["method", "step", "error", "uncertainty", "time", "lower", "upper"].map(
        (column) => ({name: column, cells: rows.map((row) => row[column])})),
  }];
}

/** A choice among step sizes for a figure. */
function stepChoice(runs) {
  const steps = unique(runs.map((run) => run.step)).sort((a, b) => b - a);
  const select =
      element("select", {}, ...steps.map((step) => element("option", {value: step}, `${shortNumber(step)} s`)));
  select.value = steps[Math.floor((steps.length - 1) / 2)];
  element("label", {}, "step h ", select);
  return select;
}

/**
 * What is drawn over time: of(run) gives {t, value}, two lists; undefined if the run has none. `ofFrames`: one value
 * for each frame rather than each step. `constant`: nothing is to be seen where it is the same in all steps but the
 * last, rather than where it is zero.
 */
const ofSteps = (value) => ({steps}) => (steps.t.length ? {t: steps.t, value: value(steps)} : undefined);
const fromZero = {
  rangemode: "tozero"
};
const quantities = [
  {
    title: "Energy",
    says: "Kinetic and potential energy together, after each step: it may only fall, except where something moves " +
        "or blows.",
    label: "energy [J]",
    of: ofSteps(
        (steps) => steps.kinetic_energy.map((kinetic, k) => toNumber(kinetic) + toNumber(steps.potential_energy[k])))
  },
  {
    title: "Updates",
    says: "Updates of the iterate in each step: where they pile up the stage solver has a hard time.",
    label: "updates a step",
    axis: fromZero,
    of: ofSteps((steps) => steps.updates)
  },
  {
    title: "CG iterations",
    says: "Iterations of conjugate gradients in each step.",
    label: "CG iterations a step",
    axis: fromZero,
    of: ofSteps((steps) => steps.cg_iterations)
  },
  {
    title: "Contacts",
    says: "Particles that obstacles constrain at the end of each step.",
    label: "particles in contact",
    axis: fromZero,
    of: ofSteps((steps) => steps.contacts)
  },
  {
    title: "Clearance",
    says: "Least distance of a particle from an obstacle in each recorded frame, negative inside.",
    label: "clearance [mm]",
    axis: fromZero,
    ofFrames: true,
    of: frameClearance
  },
  {
    title: "Step size",
    says: "Size of the steps that were taken: where it falls the method was cut short.",
    label: "h [s]",
    axis: fromZero,
    constant: true,
    of: ofSteps((steps) => steps.h.map(toNumber))
  },
];

function frameClearance({trajectory}) {
  const clearance = trajectory?.obstacles.clearance;
  return clearance && {t: trajectory.times, value: clearance.map((metres) => 1000 * toNumber(metres))};
}

/** Whether there is anything to see in a quantity. */
function worthSeeing(quantity, runs) {
  const lists = runs.map((run) => quantity.of(run).value);
  if (!quantity.constant) return lists.some((values) => values.some((value) => value !== 0));
  return lists.some((values) => Math.min(...values.slice(0, -1)) < 0.99 * Math.max(...values));
}

function timeFigure(file, name, runs, quantity) {
  const rank = (run) => (run.succeeded ? toNumber(run.error?.rms) || 0 : Infinity), choice = stepChoice(runs);
  const chosen = () => runs.filter((run) => run.step === Number(choice.value)).sort((a, b) => rank(a) - rank(b));
  const make = (width, colours) => {
    const curves = labelled(
        chosen().map((run) => {
          return {
            type: "scatter",
            mode: "lines",
            name: run.succeeded ? run.method : `${run.method}: ${run.outcome}`,
            x: quantity.of(run).t,
            y: quantity.of(run).value,
            hovertemplate: `${run.method}, h = ${shortNumber(run.step)} s<br>t = %{x:.4g} s: %{y:.6g}<extra></extra>`,
            line: lineStyle(run.method)
          };
        }),
        width, along);
    const layout = {
      ...baseLayout(width, colours, curves.length),
      xaxis: timeAxis(colours),
      yaxis: axis(quantity.label, colours, quantity.axis)
    };
    return {data: curves, layout};
  };
  const columns = () => {
    const rows = chosen().flatMap((run) => {
      const {t, value} = quantity.of(run);
      return t.map((time, k) => ({method: run.method, step: run.step, t: time, value: value[k]}));
    });
    return ["method", "step", "t", "value"].map(
        (column) => ({name: column === "value" ? quantity.label : column, cells: rows.map((row) => row[column])}));
  };
  const every = Math.max(...runs.map((run) => run.steps.every));
  const says = quantity.says +
      (every > 1 && !quantity.ofFrames ? ` Of long runs every ${every}th step is shown.` : "") +
      moreCurves(chosen().length);
  return {file, make, columns, says, title: `${quantity.title}: ${name}`, controls: [choice]};
}

/** How near obstacles were at the nearest, a line for each run. */
function clearanceFigure(file, name, runs) {
  const rows = runs.map((run) => ({
                          method: run.method,
                          step: run.step,
                          succeeded: run.succeeded,
                          outcome: run.outcome,
                          clearance: 1000 * toNumber(run.contact.clearance),
                          energy_rise: toNumber(run.contact.energy_rise),
                          area: toNumber(run.contact.area),
                          reference_area: toNumber(run.contact.reference_area)
                        }))
                   .filter((row) => Number.isFinite(row.clearance));
  if (!rows.length) return [];
  const label = (row) => runLabel(row) + (row.succeeded ? "" : `: ${row.outcome}`);
  const make = (width, colours) => {
    const dots = [...groupBy(rows, (row) => row.method)].map(
        ([method, of]) => ({
          type: "scatter",
          mode: "markers",
          name: method,
          x: of.map((row) => row.clearance),
          y: of.map(label),
          text: of.map(
              (row) => `area in contact at the end ${shortNumber(row.area)}${
                  Number.isNaN(row.reference_area) ?
                      "" :
                      ` (reference ${shortNumber(row.reference_area)})`}, energy rise ${shortNumber(row.energy_rise)}`),
          hovertemplate: "%{y}<br>%{x:.4g} mm<br>%{text}<extra></extra>",
          marker: {color: style(method).color, symbol: style(method).symbol, size: 9}
        }));
    const layout = {
      ...baseLayout(width, colours, 0),
      height: 110 + 24 * rows.length,
      showlegend: false,
      xaxis: axis("least clearance [mm]", colours, {zeroline: true, zerolinecolor: colours.text, rangemode: "tozero"}),
      yaxis: axis("", colours, {type: "category", autorange: "reversed"})
    };
    return {data: dots, layout};
  };
  return [{
    file,
    make,
    title: `Least clearance: ${name}`,
    says: "Least distance of a particle from an obstacle at the end of any step, negative inside.",
    columns: () => ["method", "step", "clearance", "energy_rise", "area", "reference_area"].map(
        (column) => ({name: column === "clearance" ? "clearance [mm]" : column, cells: rows.map((row) => row[column])}))
  }];
}

/** All figures of the runs of a file. */
export function figuresOfRuns(file) {
  const kind = (name, figures) => figures.map((figure) => ({...figure, kind: name}));
  return comparedRuns(file).flatMap(([name, runs]) => {
    const overTime = quantities.flatMap((quantity) => {
      const known = runs.filter((run) => quantity.of(run));
      return known.length && worthSeeing(quantity, known) ? [timeFigure(file, name, known, quantity)] : [];
    });
    return [
      ...kind("runs", runWorkPrecision(file, name, runs)),
      ...kind("clearance", clearanceFigure(file, name, runs.filter((run) => run.contact))),
      ...kind("steps", overTime).map((figure) => ({...figure, fold: `Step by step: ${name}`}))
    ];
  });
}
