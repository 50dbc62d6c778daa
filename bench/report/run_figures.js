"use strict";
// Figures of runs: those of one scene with the same changes and the same end are compared.

const runTitle = (run) => [run.scene, run.overrides, `${shortNumber(run.until)} s`].filter((text) => text).join(", ");

const comparedRuns = (file) => [...groupBy(file.runs, runTitle)];

/** A run as a row of time against error, with the quartiles of its times; undefined if it cannot be one. */
function workPrecisionRow(run) {
  const times = (run.times_ms ?? []).map(toNumber).filter(finitePositive).sort((a, b) => a - b);
  if (run.outcome !== "success" || !run.error?.comparable || !finitePositive(run.error.rms) || !times.length) return undefined;
  const share = (part) => {
    const at = part * (times.length - 1), below = Math.floor(at);
    return times[below] + (at - below) * ((times[below + 1] ?? times[below]) - times[below]);
  };
  return {method: run.method, step: run.step, steps: run.steps.t.length, error: run.error.rms, uncertainty: run.error.reference_error,
          unresolved: !run.error.resolved, lower: share(0.25), time: share(0.5), upper: share(0.75)};
}

function runWorkPrecision(file, name, runs) {
  const rows = runs.map(workPrecisionRow).filter((row) => row);
  if (rows.length < 2) return [];
  const methods = unique(runs.map((run) => run.method));
  const uncertainty = Math.max(...rows.map((row) => row.uncertainty));
  const make = (width, colours) => {
    const curves = methods.map((method, k) => [method, rows.filter((row) => row.method === method).sort((a, b) => b.step - a.step), k]).filter(([, of]) => of.length)
      .map(([method, of, k]) => workPrecisionTrace(method, of, style(k), (row) => `${method}, h = ${shortNumber(row.step)} s`));
    return {data: curves, layout: workPrecisionLayout(width, colours, rows, uncertainty, curves.length)};
  };
  return [{
    file, make, title: `Work–precision of runs: ${name}`,
    says: `Lower is quicker, further right more accurate; bars are quartiles of the times. Marks are hollow where the error is below 10 × the reference's own of ${shortNumber(uncertainty)} (grey band).`,
    columns: () => ["method", "step", "error", "uncertainty", "time", "lower", "upper"].map((column) => ({name: column, cells: rows.map((row) => row[column])})),
  }];
}

/** A choice among step sizes for a figure. */
function stepChoice(runs) {
  const steps = unique(runs.map((run) => run.step)).sort((a, b) => b - a);
  const select = element("select", {}, ...steps.map((step) => element("option", {value: step}, `${shortNumber(step)} s`)));
  select.value = steps[Math.floor((steps.length - 1) / 2)];
  element("label", {}, "step h ", select);
  return select;
}

/** What is drawn over time: value(steps) gives a list. */
const quantities = [
  {title: "Energy", says: "Kinetic and potential energy together, after each step: it may only fall, but for what moves or blows.", label: "energy [J]",
   value: (steps) => steps.kinetic_energy.map((kinetic, k) => toNumber(kinetic) + toNumber(steps.potential_energy[k]))},
  {title: "Updates", says: "Updates of the iterate in each step: where they pile up the stage solver has a hard time.", label: "updates a step", value: (steps) => steps.updates},
  {title: "CG iterations", says: "Iterations of conjugate gradients in each step.", label: "CG iterations a step", value: (steps) => steps.cg_iterations},
  {title: "Contacts", says: "Particles that obstacles constrain at the end of each step.", label: "particles in contact", value: (steps) => steps.contacts},
  {title: "Step size", says: "Size of the steps that were taken: where it falls the method was cut short.", label: "h [s]", value: (steps) => steps.h.map(toNumber)},
];

/** Whether there is anything to see in a quantity: step sizes must vary, others not be all zero. */
function worthSeeing(quantity, runs) {
  if (quantity.title !== "Step size") return runs.some((run) => quantity.value(run.steps).some((value) => value !== 0));
  return runs.some((run) => Math.min(...quantity.value(run.steps).slice(0, -1)) < 0.99 * Math.max(...quantity.value(run.steps)));
}

function timeFigure(file, name, runs, quantity) {
  const methods = unique(runs.map((run) => run.method)), choice = stepChoice(runs);
  const chosen = () => runs.filter((run) => run.step === Number(choice.value));
  const make = (width, colours) => {
    const curves = chosen().map((run) => {
      const look = style(methods.indexOf(run.method)), failed = run.outcome !== "success";
      return {type: "scatter", mode: "lines", name: failed ? `${run.method}: ${run.outcome}` : run.method, x: run.steps.t, y: quantity.value(run.steps),
              hovertemplate: `${run.method}, h = ${shortNumber(run.step)} s<br>t = %{x:.4g} s: %{y:.6g}<extra></extra>`, line: {color: look.color, dash: look.dash, width: 1.6}};
    });
    const layout = {...baseLayout(width, colours, curves.length), xaxis: axis("t [s]", colours), yaxis: axis(quantity.label, colours)};
    return {data: curves, layout};
  };
  const columns = () => {
    const rows = chosen().flatMap((run) => quantity.value(run.steps).map((value, k) => ({method: run.method, step: run.step, t: run.steps.t[k], value})));
    return ["method", "step", "t", "value"].map((column) => ({name: column === "value" ? quantity.label : column, cells: rows.map((row) => row[column])}));
  };
  const every = Math.max(...runs.map((run) => run.steps.every));
  const says = quantity.says + (every > 1 ? ` Of long runs every ${every}th step is shown.` : "");
  return {file, make, columns, says, title: `${quantity.title}: ${name}`, controls: [choice]};
}

/** All figures of the runs of a file. */
function figuresOfRuns(file) {
  return comparedRuns(file).flatMap(([name, runs]) => {
    const moved = runs.filter((run) => run.steps.t.length);
    const seen = quantities.filter((quantity) => moved.length && worthSeeing(quantity, moved));
    return [...runWorkPrecision(file, name, runs), ...seen.map((quantity) => timeFigure(file, name, moved, quantity))];
  });
}
