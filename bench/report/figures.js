// Figures of tables: a table names its figure.

import {cellsOf, groupBy, isNumeric, rowsOf, shortNumber, unique} from "./data.js";
import {along, axis, baseLayout, labelled, lineStyle, logRange, logTicks} from "./plots.js";
import {moreCurves, style, timeAxis, uncertainBand} from "./plots.js";
import {columnsWhere, exactCells} from "./tables.js";

export const finitePositive = (value) => value > 0 && Number.isFinite(value);

/** Indices of what is beaten in neither error nor time, from the smallest time on. */
function paretoFront(rows) {
  const front = [];
  let best = Infinity;
  for (const row of [...rows].sort((a, b) => a.time - b.time || a.error - b.error))
    if (row.error < best) front.push(row), best = row.error;
  return front;
}

/** One curve of time against error, with the quartiles of the times as bars. */
export function workPrecisionTrace(name, rows, look, text, mode = "lines+markers") {
  return {
    type: "scatter",
    mode,
    name,
    x: rows.map((row) => row.error),
    y: rows.map((row) => row.time),
    text: rows.map(text),
    hovertemplate: "%{text}<br>error %{x:.3e}, %{y:.4g} ms<extra></extra>",
    error_y: {
      type: "data",
      symmetric: false,
      array: rows.map((row) => row.upper - row.time),
      arrayminus: rows.map((row) => row.time - row.lower),
      color: look.color,
      thickness: 1,
      width: 2
    },
    line: {color: look.color, dash: look.dash, width: look.width ?? 1.5},
    marker:
        {color: look.color, symbol: rows.map((row) => (row.unresolved ? `${look.symbol}-open` : look.symbol)), size: 7},
  };
}

export function workPrecisionLayout(width, colours, rows, uncertainty, entries) {
  const range = logRange(rows.map((row) => row.error), true);
  return {
    ...baseLayout(width, colours, entries),
    xaxis: axis("error over the scene's size", colours, {type: "log", range}),
    yaxis: axis("solver time [ms]", colours, logTicks(rows.map((row) => row.time))),
    shapes: uncertainBand(10 * uncertainty, 10 ** range[1], colours),
  };
}

/** The kinds of trials, in marks that black and white tell apart; the first lies below others that it consists of. */
const kindLooks = {
  "our best": {symbol: "circle", width: 6},
  "automatic": {symbol: "square"},
  "explicit": {symbol: "triangle-up"},
  "thesis": {symbol: "triangle-down"},
  "SUNDIALS, tuned": {symbol: "diamond", width: 2.5}
};

/** A study's trials: all of them as dots, and those that no other of the same kind beats in both as curves. */
function trialsFigure(file, table) {
  const rows = rowsOf(table).filter((row) => finitePositive(row.error) && finitePositive(row.time));
  if (!rows.length) return [];
  const scene = table.name.replace("trials: ", ""), own = ["drape", "explicit", "thesis"];
  const codes = groupBy(rows, (row) => row.code), ours = rows.filter((row) => own.includes(row.code)),
        others = rows.filter((row) => !own.includes(row.code));
  const kinds = new Map([["our best", ours], ["automatic", rows.filter((row) => row.method !== "")]]);
  for (const code of ["explicit", "thesis"]) kinds.set(code, codes.get(code) ?? []);
  kinds.set("SUNDIALS, tuned", others);
  for (const [code, of] of codes)
    if (!own.includes(code)) kinds.set(code, of);
  const look = (name) => ({...style(name), ...kindLooks[name]});
  const uncertainty = Math.max(...rows.map((row) => row.uncertainty || 0));
  const text = (row) => `${row.family}<br>${row.control} ${shortNumber(row.value)}: ${row.steps} steps, ${
      row.forces} forces, ${row.factorisations} factorisations`;
  const make = (width, colours) => {
    const dots = (name, of, symbol) => ({
      type: "scatter",
      mode: "markers",
      name,
      x: of.map((row) => row.error),
      y: of.map((row) => row.time),
      text: of.map(text),
      hovertemplate: "%{text}<br>error %{x:.3e}, %{y:.4g} ms<extra></extra>",
      marker: {color: "#999999", size: 3, symbol}
    });
    const front = ([name, of]) => workPrecisionTrace(name, paretoFront(of), look(name), text);
    const curves = labelled([...kinds].filter(([, of]) => of.length).map(front), width, along);
    const all = [dots("all of ours", ours, "circle"), dots("all of SUNDIALS", others, "x")];
    return {
      data: [...all, ...curves],
      layout: workPrecisionLayout(width, colours, rows, uncertainty, curves.length + all.length)
    };
  };
  return [{
    file,
    make,
    title: `Work–precision: ${scene}`,
    columns: () => table.columns.map(exactCells),
    says: "Lower is quicker, further right more accurate; curves join what no other of its kind beats in both. " +
        "Bars are quartiles of the times; in the grey band, below 10 × the reference's uncertainty of " +
        `${shortNumber(uncertainty)}, errors say nothing. ${rows[0].build ?? ""}`,
  }];
}

/** The columns of errors, of what they are plotted over, and of the two texts that name a curve. */
function convergenceColumns(table) {
  const keys = table.columns.filter((column) => column.role === "key");
  const [outer, inner] = keys.filter((column) => !isNumeric(column));
  const [error, order] = ["error", "order"].map((role) => table.columns.find((column) => column.role === role));
  return {over: keys.find(isNumeric), error, order, outer: outer.name, inner: inner.name};
}

/** Straight lines of the orders that were fitted, through the middle of the errors. */
function slopeLines(orders, rows, over, resolved) {
  const x = rows.map((row) => row[over]), low = Math.min(...x), high = Math.max(...x),
        top = Math.max(...rows.map((row) => row.error));
  return unique(orders.map(Math.round)).filter((order) => order > 0).sort().map((order) => {
    const ratio = (high / low) ** order, ends = resolved ? [top, top / ratio] : [top / ratio, top];
    return {
      type: "scatter",
      mode: "lines",
      name: `slope ${order}`,
      x: [low, high],
      y: ends,
      hoverinfo: "name",
      line: {color: "#999999", width: 1, dash: "dot"}
    };
  });
}

/** A figure for each scene or experiment: errors against steps or resolutions, a curve for each method or form. */
function convergenceFigures(file, table) {
  const columns = convergenceColumns(table), {outer, inner} = columns, {unit} = columns.error, over = columns.over.name;
  const resolved = columns.over.unit === "1",
        title = resolved ? "particles a side" : "time step h [s]";  // else over time steps
  const fittedOf = (row) => (columns.order ? row[columns.order.name] : undefined);
  return [...groupBy(rowsOf(table), (row) => row[outer])].flatMap(([name, all]) => {
    const rows =
        all.map((row) => ({...row, error: row[columns.error.name]})).filter((row) => finitePositive(row.error));
    if (rows.length < 2) return [];
    const series = [...groupBy(rows, (row) => row[inner])];
    const fits = new Map(
        [...groupBy(all, (row) => row[inner])].map(([key, of]) => [key, of.map(fittedOf).find((order) => order > 0)]));
    const uncertainty = Math.max(0, ...rows.map((row) => row.uncertainty || 0));
    const make = (width, colours) => {
      const curves = labelled(
          series.map(([key, of]) => {
            const look = style(key), fitted = fits.get(key);
            return {
              type: "scatter",
              mode: "lines+markers",
              name: fitted ? `${key}: ${fitted.toFixed(2)}` : key,
              x: of.map((row) => row[over]),
              y: of.map((row) => row.error),
              text: of.map(
                  (row) => (Number.isFinite(row.order) ? `order ${row.order.toFixed(3)} from the one before` : "")),
              hovertemplate: `${key}<br>${resolved ? "n" : "h"} = %{x}, error %{y:.3e}<br>%{text}<extra></extra>`,
              line: {color: look.color, dash: look.dash, width: 1.5},
              marker: {color: look.color, symbol: look.symbol, size: 7}
            };
          }),
          width, () => 0);
      const slopes = slopeLines([...fits.values()].filter((fitted) => fitted), rows, over, resolved);
      const range = logRange(rows.map((row) => row.error));
      const layout = {
        ...baseLayout(width, colours, curves.length + slopes.length),
        xaxis: axis(title, colours, {type: "log", dtick: undefined, exponentformat: "e", tickangle: 0}),
        yaxis: axis(
            unit === "1" ? "error over the scene's size" : `error [${unit}]`, colours,
            {...logTicks(rows.map((row) => row.error)), range}),
        shapes: uncertainBand(10 * uncertainty, 10 ** range[0], colours)
                    .map((band) => ({...band, xref: "paper", yref: "y", x0: 0, x1: 1, y0: band.x0, y1: band.x1})),
      };
      return {data: [...curves, ...slopes], layout};
    };
    return [{
      file,
      make,
      title: `Convergence: ${name}`,
      says: `Error against ${
                resolved ? "resolution" :
                           "time step"}; the legend has the order fitted over the window that the program found.` +
          (uncertainty ?
               ` In the grey band, below 10 × the uncertainty of ${shortNumber(uncertainty)}, errors say nothing.` :
               "") +
          moreCurves(series.length),
      columns: () => columnsWhere(table, (row) => row[outer] === name),
    }];
  });
}

// Colours of Okabe and Ito, and symbols for those who print in black and white.
const verdicts = [
  ["accurate", "#56B4E9", ""], ["stable but wrong", "#F0E442", "w"], ["stable, error unknown", "#CFE8F7", "?"],
  ["unstable", "#D55E00", "U"], ["not converged", "#CC79A7", "×"], ["not finished", "#999999", "…"]
];

const powerOfTen = (value) => (Number.isFinite(value) ? `10<sup>${Math.round(Math.log10(value))}</sup>` : "∞");

/** Lines between cells of which one is predicted to fail and the other is not. */
function failingBorders(failing, x, y, colour) {
  const line = {color: colour, width: 2.5}, lines = [];
  const add = (x0, y0, x1, y1) => lines.push({type: "line", xref: x, yref: y, x0, y0, x1, y1, line});
  failing.forEach((row, i) => row.forEach((fails, j) => {
    if (i + 1 < failing.length && fails !== failing[i + 1][j]) add(j - 0.5, i + 0.5, j + 0.5, i + 0.5);
    if (j + 1 < row.length && fails !== row[j + 1]) add(j + 0.5, i - 0.5, j + 0.5, i + 0.5);
  }));
  return lines;
}

/** The heat map of one method in its place k of the figure. */
function stabilityPanel(rows, nus, ratios, k, colours) {
  const suffix = k ? String(k + 1) : "", grid = () => nus.map(() => ratios.map(() => null));
  const z = grid(), text = grid(), hover = grid(), failing = nus.map(() => ratios.map(() => false));
  for (const row of rows) {
    const i = nus.indexOf(row.nu), j = ratios.indexOf(row.to_damping),
          at = verdicts.findIndex(([name]) => name === row.verdict);
    z[i][j] = at, text[i][j] = verdicts[at]?.[2] ?? "", failing[i][j] = row.predicted !== "stable";
    hover[i][j] = `ν<sub>h</sub> = ${shortNumber(row.nu)}, h k/d = ${shortNumber(row.to_damping)}<br><b>${
                      row.verdict}</b>; predicted: ${row.predicted}` +
        (Number.isFinite(row.error) ? `<br>error ${shortNumber(row.error)} ± ${shortNumber(row.uncertainty)}` : "") +
        (row.reason ? `<br>${row.reason}` : "");
  }
  const last = verdicts.length - 1,
        scale = verdicts.flatMap(([, colour], v) => [[v / (last + 1), colour], [(v + 1) / (last + 1), colour]]);
  const map = {
    type: "heatmap",
    z,
    text,
    customdata: hover,
    hovertemplate: `${rows[0].method}<br>%{customdata}<extra></extra>`,
    colorscale: scale,
    zmin: -0.5,
    zmax: last + 0.5,
    showscale: false,
    xgap: 1,
    ygap: 1,
    xaxis: `x${suffix}`,
    yaxis: `y${suffix}`
  };
  const symbols = text.flatMap((row, i) => row.map((symbol, j) => ({symbol, i, j}))).filter(({symbol}) => symbol);
  const letters = {
    type: "scatter",
    mode: "text",
    x: symbols.map(({j}) => j),
    y: symbols.map(({i}) => i),
    text: symbols.map(({symbol}) => symbol),
    hoverinfo: "skip",
    textfont: {color: "#000000", size: 10},
    showlegend: false,
    xaxis: `x${suffix}`,
    yaxis: `y${suffix}`
  };
  const ticks = (values) => ({
    tickvals: values.map((_, at) => at),
    ticktext: values.map(powerOfTen),
    showgrid: false,
    zeroline: false,
    ticks: "",
    automargin: true,
    fixedrange: true,
    linecolor: colours.line,
    tickfont: {size: 10},
    tickangle: 0
  });
  return {
    traces: [map, letters],
    failing,
    shapes: failingBorders(failing, `x${suffix}`, `y${suffix}`, "#000000"),
    axes: {[`xaxis${suffix}`]: ticks(ratios), [`yaxis${suffix}`]: ticks(nus)}
  };
}

function stabilityFigures(file, table) {
  const sheetOf = (row) => `${row.n} × ${row.n} particles, h = ${shortNumber(row.step)} s`;
  return [...groupBy(rowsOf(table), sheetOf)].map(([sheet, rows]) => {
    const methods = [...groupBy(rows, (row) => row.method)];
    const nus = unique(rows.map((row) => row.nu)).sort((a, b) => a - b),
          ratios = unique(rows.map((row) => row.to_damping)).sort((a, b) => a - b);
    const make = (width, colours) => {
      const columns = Math.min(methods.length, Math.max(1, Math.min(4, Math.floor(width / 180)))),
            lines = Math.ceil(methods.length / columns);
      const panels = methods.map(([, of], k) => stabilityPanel(of, nus, ratios, k, colours));
      const legend =
          verdicts.map(([name, colour, symbol]) => ({
                         type: "scatter",
                         mode: "markers",
                         name: symbol ? `${symbol} ${name}` : name,
                         x: [null],
                         y: [null],
                         marker: {symbol: "square", size: 12, color: colour, line: {color: "#555555", width: 1}}
                       }));
      const height = 190 * lines + 110;
      const titles =
          methods.map(([name, of], k) => ({
                        text: panels[k].failing.flat().every(Boolean) ? `${name}: predicted to fail everywhere` : name,
                        showarrow: false,
                        xref: `x${k ? k + 1 : ""} domain`,
                        yref: `y${k ? k + 1 : ""} domain`,
                        x: 0,
                        y: 1,
                        yanchor: "bottom",
                        xanchor: "left",
                        font: {size: 11, color: colours.text}
                      }));
      const notes = [{
        text: "across: h k/d (∞: undamped); up: ν<sub>h</sub> = h² k/(ρ l²)",
        showarrow: false,
        xref: "paper",
        yref: "paper",
        x: 0,
        y: 1,
        yshift: 36,
        xanchor: "left",
        font: {size: 11, color: colours.text}
      }];
      const layout = {
        ...baseLayout(width, colours, 0),
        height,
        grid: {rows: lines, columns, pattern: "independent", xgap: 0.18, ygap: 0.3},
        margin: {l: 40, r: 10, t: 60, b: 70},
        legend: {orientation: "h", x: 0, y: -40 / (height - 130), yanchor: "top"},
        annotations: [...titles, ...notes],
        shapes: panels.flatMap((panel) => panel.shapes),
        ...Object.assign({}, ...panels.map((panel) => panel.axes))
      };
      return {data: [...panels.flatMap((panel) => panel.traces), ...legend], layout};
    };
    return {
      file,
      make,
      title: `Stability: ${sheet}`,
      says:
          "Each cell is a run, its colour what became of it; thick lines go round what linear theory predicts to fail.",
      columns: () => columnsWhere(table, (row) => sheetOf(row) === sheet),
    };
  });
}

/** What a table of figure 4.3 has of each method over time: its columns are <method>_<curve>. */
const curvesOverTime =
    [["CG", "CG iterations a step"], ["updates", "updates a step"], ["contacts", "particles in contact"]];
const methodsOverTime = (table) => table.columns.map(({name}) => name)
                                       .filter((name) => name.endsWith("_contacts"))
                                       .map((name) => name.replace(/_contacts$/, ""));

/** The three of them below each other over one time. */
function overTimeFigure(file, table) {
  const t = cellsOf(table, "t"), methods = methodsOverTime(table);
  const make = (width, colours) => {
    const trace = (method, [curve, label], row) => ({
      type: "scatter",
      mode: "lines",
      name: method,
      legendgroup: method,
      showlegend: row === 0,
      x: t,
      y: cellsOf(table, `${method}_${curve}`),
      yaxis: `y${row ? row + 1 : ""}`,
      hovertemplate: `${method}<br>t = %{x:.4g} s: %{y:.4g} ${label}<extra></extra>`,
      line: lineStyle(method)
    });
    const curves = methods.flatMap((method) => curvesOverTime.map((curve, row) => trace(method, curve, row)));
    const rows = Object.fromEntries(curvesOverTime.map(
        ([, label], row) =>
            [`yaxis${row ? row + 1 : ""}`,
             axis(label, colours, {domain: [(2 - row) * 0.35, (2 - row) * 0.35 + 0.3], rangemode: "tozero"})]));
    const layout =
        {...baseLayout(width, colours, methods.length), height: 660, ...rows, xaxis: timeAxis(colours, {anchor: "y3"})};
    return {data: curves, layout};
  };
  return [{
    file,
    make,
    title: table.description,
    says: "How hard the steps are before, during and after the contact: what a method solves, " +
        "and how many particles obstacles constrain.",
    columns: () => table.columns.map(exactCells)
  }];
}

const figureMakers = {
  "convergence": convergenceFigures,
  "work-precision": trialsFigure,
  "stability": stabilityFigures,
  "over time": overTimeFigure
};

/** All figures of a table; none if it is only to be read. */
export const figuresOfTable = (file, table) => figureMakers[table.figure]?.(file, table) ?? [];
