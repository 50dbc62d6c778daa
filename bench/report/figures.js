// Figures of tables: a table names its figure.

import {cellsOf, groupBy, partOf, partsOf, rowsOf, shortNumber, titleOf, unique, unitOf, withRole} from "./data.js";
import {looks} from "./looks.js";
import {along, axis, baseLayout, labelled, lineStyle, logRange, logTicks} from "./plots.js";
import {isNarrow, moreCurves, plotText, style, uncertainBand} from "./plots.js";
import {columnsWhere, exactCells} from "./tables.js";

export const finitePositive = (value) => value > 0 && Number.isFinite(value);

const axisTitle = (column) => `${titleOf(column)} ${unitOf(column)}`.trim();

/** What a column is, for a sentence. */
const explained = (column) => [titleOf(column), column.description].filter((text) => text).join(": ");

/** A cell as users see it. */
const cellText = (column, row) => (column.numeric ? shortNumber(row[column.name]) : row[column.name]);

/** What users see of a row where they point. */
function detailsOf(table) {
  const columns = partsOf(table, "detail");
  const detail = (column, row) => cellText(column, row) && `${titleOf(column)}: ${cellText(column, row)}`;
  return (row) => columns.map((column) => detail(column, row)).filter((text) => text).join("<br>");
}

/** A cell in a name: a text as it is, a number by its column's title. */
const named = (column, row) =>
    (column.numeric ? `${titleOf(column)} = ${cellText(column, row)} ${unitOf(column).slice(1, -1)}`.trim() :
                      cellText(column, row));

/** The figure that a row of a table is in. */
const figureOf = (table) => (row) => partsOf(table, "figure").map((column) => named(column, row)).join(", ");

/** The largest uncertainty of the errors in some rows. */
function largestUncertainty(table, rows) {
  const column = withRole(table, "uncertainty");
  return column ? Math.max(0, ...rows.map((row) => row[column.name] || 0)) : 0;
}

/** Indices of what is beaten in neither error nor time, from the smallest time on. */
function paretoFront(rows) {
  const front = [];
  let best = Infinity;
  for (const row of [...rows].sort((a, b) => a.time - b.time || a.error - b.error))
    if (row.error < best) front.push(row), best = row.error;
  return front;
}

/** One curve of time against error, with the quartiles of the times as bars. */
export function workPrecisionTrace(name, rows, look, text, unit = "ms") {
  return {
    type: "scatter",
    mode: "lines+markers",
    name,
    x: rows.map((row) => row.error),
    y: rows.map((row) => row.time),
    text: rows.map(text),
    hovertemplate: `%{text}<br>error %{x:.3e}, %{y:.4g} ${unit}<extra></extra>`,
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

/** `curves`: what is drawn of the rows, with `entries` in the legend. `titles`: of both axes. */
export function workPrecisionLayout(width, colours, rows, uncertainty, curves, entries, titles) {
  const range = logRange(rows.map((row) => row.error), true);
  return {
    ...baseLayout(width, colours, entries),
    xaxis: axis(titles.x, colours, {type: "log", range, dtick: isNarrow(width) && range[0] - range[1] > 6 ? 2 : 1}),
    yaxis: axis(titles.y, colours, logTicks(curves.filter(({visible}) => visible === true).flatMap(({y}) => y))),
    shapes: uncertainBand(10 * uncertainty, 10 ** range[1], colours),
  };
}

// Curves of sides lie below others that they consist of.
const sideWidths = [6, 2.5], dotSymbols = ["circle", "x"];

/** A study's trials: all of them as dots, and those that no other of a side or a kind beats in both as curves. */
function trialsFigures(file, table) {
  const [x, y, lower, upper, side] = ["x", "y", "lower", "upper", "side"].map((part) => partOf(table, part));
  const details = detailsOf(table), caption = partOf(table, "caption"), figure = figureOf(table);
  const all =
      rowsOf(table)
          .map(
              (row) =>
                  ({...row, error: row[x.name], time: row[y.name], lower: row[lower.name], upper: row[upper.name]}))
          .filter((row) => finitePositive(row.error) && finitePositive(row.time));
  return [...groupBy(all, figure)].map(([title, rows]) => {
    const sides = [...groupBy(rows, (row) => row[side.name])],
          kinds = partsOf(table, "curve")
                      .flatMap(({name}) => [...groupBy(rows.filter((row) => row[name]), (row) => row[name])]);
    const uncertainty = largestUncertainty(table, rows);
    const make = (width, colours) => {
      const dots = ([name, of], k) => ({
        type: "scatter",
        mode: "markers",
        name: `all of ${name}`,
        x: of.map((row) => row.error),
        y: of.map((row) => row.time),
        text: of.map(details),
        hovertemplate: `%{text}<br>error %{x:.3e}, %{y:.4g} ${y.unit}<extra></extra>`,
        marker: {color: "#999999", size: 3, symbol: dotSymbols[k % dotSymbols.length]}
      });
      const best = ([name, of], title = name, lineWidth = undefined) =>
          workPrecisionTrace(title, paretoFront(of), {...style(name), width: lineWidth}, details, y.unit);
      const curves = labelled(
          [
            ...sides.map((any, k) => best(any, `best of ${any[0]}`, sideWidths[k % sideWidths.length])),
            ...kinds.map((any) => best(any))
          ],
          width, along);
      return {
        data: [...sides.map(dots), ...curves],
        layout: workPrecisionLayout(
            width, colours, rows, uncertainty, curves, curves.length + sides.length, {x: axisTitle(x), y: axisTitle(y)})
      };
    };
    return {
      file,
      make,
      title: [`Work–precision: ${table.description}`, title].filter((text) => text).join(": "),
      columns: () => columnsWhere(table, (row) => figure(row) === title),
      says: "Lower is quicker, further right more accurate; curves join what no other of its kind beats in both. " +
          `${explained(x)}. ${explained(y)}, with quartiles as bars. In the grey band, below 10 × the reference's ` +
          `uncertainty of ${shortNumber(uncertainty)}, errors say nothing. ${caption ? rows[0][caption.name] : ""}`,
    };
  });
}

/** Straight lines of the orders that were fitted, through the middle of the errors. */
function slopeLines(orders, rows, x, y) {
  const all = rows.map((row) => row[x.name]), low = Math.min(...all), high = Math.max(...all);
  const largest = rows.reduce((a, b) => (b[y.name] > a[y.name] ? b : a)), top = largest[y.name];
  return unique(orders.map(Math.round)).filter((order) => order > 0).sort().map((order) => {
    const ratio = (high / low) ** order, falls = largest[x.name] ** 2 < low * high,
          ends = falls ? [top, top / ratio] : [top / ratio, top];
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

/** Errors against steps or resolutions, a curve for each method or form. */
function convergenceFigures(file, table) {
  const [x, y, curve] = ["x", "y", "curve"].map((part) => partOf(table, part)), order = withRole(table, "order");
  const details = detailsOf(table), figure = figureOf(table);
  return [...groupBy(rowsOf(table), figure)].flatMap(([name, all]) => {
    const rows = all.filter((row) => finitePositive(row[y.name]));
    if (rows.length < 2) return [];
    const series = [...groupBy(rows, (row) => row[curve.name])];
    const fittedOf = (of) => (order ? of.map((row) => row[order.name]).find((fitted) => fitted > 0) : undefined);
    const fits = new Map([...groupBy(all, (row) => row[curve.name])].map(([key, of]) => [key, fittedOf(of)]));
    const uncertainty = largestUncertainty(table, rows);
    const make = (width, colours) => {
      const curves = labelled(
          series.map(([key, of]) => {
            const look = style(key), fitted = fits.get(key);
            return {
              type: "scatter",
              mode: "lines+markers",
              name: fitted ? `${key}: ${fitted.toFixed(2)}` : key,
              x: of.map((row) => row[x.name]),
              y: of.map((row) => row[y.name]),
              text: of.map(details),
              hovertemplate: `${key}<br>${titleOf(x)} = %{x}, ${titleOf(y)} %{y:.3e}<br>%{text}<extra></extra>`,
              line: {color: look.color, dash: look.dash, width: 1.5},
              marker: {color: look.color, symbol: look.symbol, size: 7}
            };
          }),
          width, () => 0);
      const slopes = slopeLines([...fits.values()].filter((fitted) => fitted), rows, x, y);
      const errors = rows.map((row) => row[y.name]), range = logRange(errors);
      const layout = {
        ...baseLayout(width, colours, curves.length + slopes.length),
        xaxis: axis(axisTitle(x), colours, {type: "log", dtick: undefined, exponentformat: "e", tickangle: 0}),
        yaxis: axis(axisTitle(y), colours, {...logTicks(errors), range}),
        shapes: uncertainBand(10 * uncertainty, 10 ** range[0], colours)
                    .map((band) => ({...band, xref: "paper", yref: "y", x0: 0, x1: 1, y0: band.x0, y1: band.x1})),
      };
      return {data: [...curves, ...slopes], layout};
    };
    return [{
      file,
      make,
      title: `Convergence: ${name}`,
      says:
          `${explained(y)}. ${explained(x)}. The legend has the order fitted over the window that the program found.` +
          (uncertainty ?
               ` In the grey band, below 10 × the uncertainty of ${shortNumber(uncertainty)}, errors say nothing.` :
               "") +
          moreCurves(series.length),
      columns: () => columnsWhere(table, (row) => figure(row) === name),
    }];
  });
}

// Looks of classes, the best first: colours of Okabe and Ito, and marks for those who print in black and white.
const classLooks = [
  ["#56B4E9", ""], ["#F0E442", "–"], ["#CFE8F7", "·"], ["#D55E00", "×"], ["#CC79A7", "+"], ["#999999", "…"],
  ["#009E73", "△"], ["#E69F00", "□"]
];

/** The look of a class: that of its place, in its own colour if it has one in all figures. */
function classLook(name, place) {
  const [color, mark] = classLooks[place % classLooks.length];
  return [looks.kinds[name]?.[0] ?? color, mark];
}

const isPowerOfTen = (value) =>
    !Number.isFinite(value) || Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9;

/** Texts at some values of an axis: powers of ten where all are, else the numbers. */
function ticksOf(values) {
  const powers = values.every(isPowerOfTen),
        finite = (value) => (powers ? `10<sup>${Math.round(Math.log10(value))}</sup>` : shortNumber(value));
  return values.map((value) => (Number.isFinite(value) ? finite(value) : "∞"));
}

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

/**
 * The heat map of one curve in its place k of the figure; xs and ys: the values that there are, from the least on.
 * `ends`: whether the map is the lowest of its column and the first of its line, which have the labels for the others.
 */
function mapPanel(table, rows, xs, ys, k, ends, colours) {
  const [x, y, colour, outline] = ["x", "y", "colour", "outline"].map((part) => partOf(table, part));
  const details = detailsOf(table), classes = colour.classes.map(classLook);
  const suffix = k ? String(k + 1) : "", grid = () => ys.map(() => xs.map(() => null));
  const z = grid(), text = grid(), hover = grid(), failing = ys.map(() => xs.map(() => false));
  for (const row of rows) {
    const i = ys.indexOf(row[y.name]), j = xs.indexOf(row[x.name]), at = colour.classes.indexOf(row[colour.name]);
    z[i][j] = at, text[i][j] = classes[at]?.[1] ?? "", failing[i][j] = outline.classes.indexOf(row[outline.name]) > 0;
    hover[i][j] = plotText(`${titleOf(y)} = ${cellText(y, row)}, ${titleOf(x)} = ${cellText(x, row)}<br><b>${
        row[colour.name]}</b>; ${titleOf(outline)}: ${row[outline.name]}<br>${details(row)}`);
  }
  const last = classes.length - 1,
        scale = classes.flatMap(([of], v) => [[v / (last + 1), of], [(v + 1) / (last + 1), of]]);
  const map = {
    type: "heatmap",
    z,
    text,
    customdata: hover,
    hovertemplate: `${rows[0][partOf(table, "curve").name]}<br>%{customdata}<extra></extra>`,
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
  const ticks = (values, showticklabels) => ({
    showticklabels,
    tickvals: values.map((_, at) => at),
    ticktext: ticksOf(values),
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
    axes: {[`xaxis${suffix}`]: ticks(xs, ends.lowest), [`yaxis${suffix}`]: ticks(ys, ends.first)}
  };
}

/** `words`: the title, what the figure says, and what stands beside a curve whose every cell is outlined. */
function mapFigures(file, table, words) {
  const [x, y, curve, colour] = ["x", "y", "curve", "colour"].map((part) => partOf(table, part));
  const sheetOf = figureOf(table),
        valuesOf = (column, rows) => unique(rows.map((row) => row[column.name])).sort((a, b) => a - b);
  return [...groupBy(rowsOf(table), sheetOf)].map(([sheet, rows]) => {
    const methods = [...groupBy(rows, (row) => row[curve.name])], xs = valuesOf(x, rows), ys = valuesOf(y, rows);
    const make = (width, colours) => {
      const columns = Math.min(methods.length, Math.max(1, Math.min(4, Math.floor(width / 180)))),
            lines = Math.ceil(methods.length / columns);
      const ends = (k) => ({lowest: k + columns >= methods.length, first: k % columns === 0});
      const panels = methods.map(([, of], k) => mapPanel(table, of, xs, ys, k, ends(k), colours));
      const legend = colour.classes.map((name, v) => {
        const [color, mark] = classLook(name, v);
        return {
          type: "scatter",
          mode: "markers",
          name: `${mark} ${name}`.trim(),
          x: [null],
          y: [null],
          marker: {symbol: "square", size: 12, color, line: {color: "#555555", width: 1}}
        };
      });
      const height = 190 * lines + 110;
      const titles = methods.map(([name, of], k) => ({
                                   text: panels[k].failing.flat().every(Boolean) ? `${name}${words.everywhere}` : name,
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
        text: plotText(`across: ${explained(x)}; up: ${explained(y)}`),
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
      title: `${words.title}: ${sheet}`,
      says: words.says,
      columns: () => columnsWhere(table, (row) => sheetOf(row) === sheet),
    };
  });
}

/** The columns of each group, a curve for each group and an axis for each of its columns, below each other. */
function overTimeFigure(file, table) {
  const x = partOf(table, "x"), groups = [...groupBy(partsOf(table, "y"), (column) => column.group)];
  const count = Math.max(...groups.map(([, columns]) => columns.length)), suffix = (k) => (k ? String(k + 1) : "");
  const make = (width, colours) => {
    const trace = (name, column, k) => ({
      type: "scatter",
      mode: "lines",
      name,
      legendgroup: name,
      showlegend: k === 0,
      x: cellsOf(x),
      y: cellsOf(column),
      yaxis: `y${suffix(k)}`,
      hovertemplate: `${name}<br>${titleOf(x)} = %{x:.4g} ${x.unit}: %{y:.4g} ${column.description}<extra></extra>`,
      line: lineStyle(name)
    });
    const curves = groups.flatMap(([name, columns]) => columns.map((column, k) => trace(name, column, k)));
    const below = (k) => (count - 1 - k) / count, domain = (k) => [below(k), below(k) + 0.85 / count];
    const axes = Object.fromEntries(groups[0][1].map(
        (column,
         k) => [`yaxis${suffix(k)}`, axis(column.description, colours, {domain: domain(k), rangemode: "tozero"})]));
    const layout = {
      ...baseLayout(width, colours, groups.length),
      height: 220 * count,
      ...axes,
      xaxis: axis(axisTitle(x), colours, {rangemode: "tozero", anchor: `y${suffix(count - 1)}`})
    };
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

/** A curve through the rows of each kind, in their order: loops as well. */
function curvesFigures(file, table) {
  const [x, y, curve] = ["x", "y", "curve"].map((part) => partOf(table, part)), figure = figureOf(table);
  return [...groupBy(rowsOf(table), figure)].map(([title, rows]) => {
    const kinds = [...groupBy(rows, (row) => named(curve, row))];
    const make = (width, colours) => {
      const curves = kinds.map(([name, of]) => ({
                                 type: "scatter",
                                 mode: "lines",
                                 name,
                                 x: of.map((row) => row[x.name]),
                                 y: of.map((row) => row[y.name]),
                                 hovertemplate: `${name}<br>%{x:.4g}: %{y:.4g}<extra></extra>`,
                                 line: lineStyle(name)
                               }));
      return {
        data: labelled(curves, width, along),
        layout: {
          ...baseLayout(width, colours, kinds.length),
          xaxis: axis(axisTitle(x), colours),
          yaxis: {...axis(axisTitle(y), colours), ...(x.unit === y.unit && {scaleanchor: "x"})}  // shapes keep theirs
        }
      };
    };
    return {
      file,
      make,
      title: [table.description, title].filter((text) => text).join(": "),
      says: `${explained(x)}. ${explained(y)}.${moreCurves(kinds.length)}`,
      columns: () => columnsWhere(table, (row) => figure(row) === title)
    };
  });
}

const stabilityWords = {
  title: "Stability",
  says: "Each cell is a run, its colour what became of it; thick lines go round what linear theory predicts to fail.",
  everywhere: ": predicted to fail everywhere"
};

const winnersWords = {
  title: "The quickest",
  says: "Each cell is an error on a scene, its colour the family of the quickest method; thick lines go round " +
      "where it does not clearly lead.",
  everywhere: ""
};

const figureMakers = {
  "convergence": convergenceFigures,
  "work-precision": trialsFigures,
  "stability": (file, table) => mapFigures(file, table, stabilityWords),
  "map": (file, table) => mapFigures(file, table, winnersWords),
  "over time": overTimeFigure,
  "curves": curvesFigures
};

/** All figures of a table; none if it is only to be read. */
export const figuresOfTable = (file, table) =>
    (figureMakers[table.figure]?.(file, table) ?? []).map((figure) => ({...figure, kind: table.figure}));
