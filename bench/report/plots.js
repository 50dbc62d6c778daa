// Figures around Plotly: colours of the page, its width, and what is saved from them.

import {commandLine, csvLink, element, fact, fileName} from "./data.js";
import {looks} from "./looks.js";
import {marked, typeset} from "./tips.js";

/** Takes from a list in turn: the next for each text that it has not seen. */
function dealer(list) {
  const dealt = new Map();
  return (text) => {
    if (!dealt.has(text)) dealt.set(text, list[dealt.size % list.length]);
    return dealt.get(text);
  };
}
const otherColour = dealer(looks.other_colours), otherMark = dealer(looks.other_marks);

/**
 * The look of a method with its solvers, "bdf2/newton/cholesky", or of a kind: {color, symbol, dash}. What looks.js
 * does not know also has a look of its own on this page.
 */
export function style(name) {
  if (looks.kinds[name]) {
    const [color, symbol, dash] = looks.kinds[name];
    return {color, symbol, dash};
  }
  const [method, ...solvers] = name.split("/"), solver = solvers.join("/");
  const [symbol, dash] = looks.solvers[solver] ?? otherMark(solver);
  return {color: looks.methods[method] ?? otherColour(method), symbol, dash};
}

/** The look of a curve without marks. */
export function lineStyle(name) {
  const {color, dash} = style(name);
  return {color, dash, width: 1.6};
}

const symbolOf = (marker) => [marker?.symbol ?? ""].flat()[0].replace("-open", "");
const lookOf = ({line, marker}) => [line.color, line.dash, symbolOf(marker)].join();

/** Another symbol in the place of the one of a curve, open where that is. */
const replaced = (symbols, symbol) =>
    (Array.isArray(symbols) ? symbols.map((any) => (any.endsWith("-open") ? `${symbol}-open` : symbol)) : symbol);

/** Marks and dashes for curves whose own look another one of the figure has. */
const spareMarks = [...Object.values(looks.solvers), ...looks.other_marks];

/** Gives what would look as a curve before it, as the same method with another step, the next mark and dash. */
export function distinct(curves) {
  const taken = new Set();
  return curves.map((curve) => {
    const withMark = ([symbol, dash]) => ({
      ...curve,
      line: {...curve.line, dash},
      ...(curve.marker && {marker: {...curve.marker, symbol: replaced(curve.marker.symbol, symbol)}})
    });
    const own =
        taken.has(lookOf(curve)) ? spareMarks.map(withMark).find((other) => !taken.has(lookOf(other))) ?? curve : curve;
    taken.add(lookOf(own));
    return own;
  });
}

const mostCurves = 8;  // shown at first; a click in the legend shows the others

/**
 * The curves with their names beside them where there is room, the first shown and the others in the legend. `share`:
 * where along a curve its name stands.
 */
export function labelled(curves, width, share = () => 1) {
  return distinct(curves).map((curve, k) => {
    const points = curve.x.length, at = Math.min(points - 1, Math.round(share(k, curves.length) * (points - 1)));
    const named = isNarrow(width) ? {} : {
      mode: `${curve.mode}+text`,
      texttemplate: curve.x.map((_, place) => (place === at ? curve.name : "")),
      textposition: "top center",
      textfont: {size: 11, color: curve.line.color},
      cliponaxis: false
    };
    return {...curve, ...named, visible: k < mostCurves ? true : "legendonly"};
  });
}

/** What is said where not all curves are shown. */
export const moreCurves = (count) =>
    (count > mostCurves ? ` ${count - mostCurves} more curves are in the legend: a click shows them.` : "");

/** Where names stand on curves that begin and end together. */
export const along = (k, count) => 0.25 + (0.65 * (k % mostCurves)) / Math.max(1, Math.min(count, mostCurves) - 1);

const paper = {
  text: "#000000",
  line: "#cccccc",
  band: "rgba(120, 130, 140, 0.16)",
  page: "#ffffff"
};

function pageColours() {
  const css = getComputedStyle(document.documentElement);
  const colour = (name) => css.getPropertyValue(`--${name}`).trim();
  return {text: colour("text"), line: colour("line"), band: colour("band"), page: colour("page")};
}

const paperWidth = 700;  // what A4 and Letter leave between their margins

export const isNarrow = (width) => width < 600;

/** A text for Plotly, its indices set. */
export const plotText = (text) => text.replaceAll("ν_h", "ν<sub>h</sub>");

/** An axis with a title; more wins over what all axes share. */
export function axis(title, colours, more = {}) {
  const exponents = more.type === "log" ? {dtick: 1, exponentformat: "power", minor: {}} : {exponentformat: "power"};
  return {
    title: {text: plotText(title), standoff: 8},
    gridcolor: colours.line,
    zeroline: false,
    linecolor: colours.line,
    ticks: "outside",
    tickcolor: colours.line,
    automargin: true,
    tickangle: 0,
    ...exponents,
    ...more
  };
}

/**
 * What a log axis of such values needs: where they span few powers of ten, digits between these are labelled as well.
 */
export function logTicks(values) {
  const seen = values.filter((value) => value > 0 && Number.isFinite(value)),
        decades = Math.log10(Math.max(...seen) / Math.min(...seen));
  return {type: "log", dtick: decades < 1 ? "D1" : decades < 2 ? "D2" : 1};
}

/** The axis of times that begin at 0. */
export const timeAxis = (colours, more = {}) => axis("t [s]", colours, {rangemode: "tozero", ...more});

/** The height at which as many entries of a legend stand beside the plot. */
const heightFor = (entries) => 110 + 21 * entries;

/**
 * The layout that all figures share: legend beside the plot, or below it where there is no room, a line an entry.
 * Plotly gives that at most half of the height, 22 entries.
 */
export function baseLayout(width, colours, entries) {
  const narrow = isNarrow(width), plotHeight = 330, titleHeight = 62, legendHeight = 19 * Math.min(entries, 22) + 8;
  return {
    width,
    height: narrow ? 34 + plotHeight + titleHeight + legendHeight : Math.max(430, heightFor(Math.min(entries, 26))),
    showlegend: true,
    paper_bgcolor: colours.page,
    plot_bgcolor: colours.page,
    font: {family: "system-ui, Liberation Sans, sans-serif", size: narrow ? 11 : 13, color: colours.text},
    margin: {l: 10, r: 10, t: 34, b: narrow ? titleHeight + legendHeight : 10},
    hovermode: "closest",
    legend: narrow ? {x: 0, y: -titleHeight / plotHeight, yanchor: "top", tracegroupgap: 0} :
                     {x: 1.02, y: 1, tracegroupgap: 4},
    hoverlabel: {align: "left", namelength: -1},
  };
}

/** A figure as it is on paper: without the curves that only a click would show, and no higher than it must be. */
function onPaper({data, layout}, least) {
  const shown = data.filter(({visible}) => visible !== "legendonly");
  const entries = shown.filter(({name, showlegend}) => name && showlegend !== false).length;
  const isFree = layout.legend.x > 1 && layout.yaxis.domain === undefined;  // else the figure has a height of its own
  return {data: shown, layout: isFree ? {...layout, height: Math.max(least, heightFor(entries))} : layout};
}

/** Where errors are beyond what the reference can tell. */
export function uncertainBand(limit, lowest, colours) {
  if (!(limit > lowest)) return [];
  return [{
    type: "rect",
    xref: "x",
    yref: "paper",
    x0: lowest,
    x1: limit,
    y0: 0,
    y1: 1,
    fillcolor: colours.band,
    line: {width: 0},
    layer: "below"
  }];
}

/**
 * Powers of ten around errors as a range of a log axis; beyond ten sizes of the scene, where the unstable are, it
 * ends.
 */
export function logRange(errors, reversed = false) {
  const logs =
      errors.filter((error) => error > 0 && Number.isFinite(error)).map((error) => Math.min(1, Math.log10(error)));
  const low = Math.min(...logs), high = Math.max(...logs), edge = 0.05 * (high - low) + 0.1;
  return reversed ? [high + edge, low - edge] : [low - edge, high + edge];
}

export const plots =
    [];  // every plot that was made: {div, make, name, title, file}; those that were drawn have a width

let printing = false;

function drawPlot(plot) {
  const width = printing ? paperWidth : plot.div.clientWidth || 700;
  const {data, layout} = printing ? onPaper(plot.make(width, paper), 340) : plot.make(width, pageColours());
  plot.width = width;
  return Plotly.react(
      plot.div, data, layout, {displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d", "toImage"]});
}

/** A text in lines of at most `most` characters, unless a word is longer. */
function inLines(text, most) {
  const lines = [""];
  for (const word of text.split(" "))
    if (lines[lines.length - 1].length + word.length < most)
      lines[lines.length - 1] += ` ${word}`;
    else
      lines.push(word);
  return lines.map((line) => line.trim()).filter((line) => line);
}

/** Where a figure comes from: a picture of it may be all that is passed on. */
const sourceOf = (file) =>
    `${fact(file, "command_line")}, ${fact(file, "cpu")}, ${fact(file, "started").slice(0, 10)}, ` +
    `commit ${fact(file, "git_commit").slice(0, 10)}`;

/** A layout with the title of its figure and where it comes from above the plot. */
function titled({title, file}, layout) {
  const heading = inLines(title, 95), source = inLines(sourceOf(file), 140);
  const small = source.map((line) => `<span style="font-size:11px">${line}</span>`),
        above = 20 * heading.length + 17 * small.length;
  return {
    ...layout,
    title: {
      text: [...heading.map(plotText), ...small].join("<br>"),
      font: {size: 16},
      x: 0,
      y: 1 - 22 / (layout.height + above),
      yanchor: "auto",
      pad: {l: 10}
    },
    height: layout.height + above,
    margin: {...layout.margin, t: layout.margin.t + above}
  };
}

/**
 * A plot for papers, on white, 900 pixels wide, as the text of an SVG, with its title and source. Unlike Plotly's, its
 * lines scale with it, and its names are always the same.
 */
export async function svgOf(plot) {
  const made = plot.make(900, paper), shown = plot.div.data ?? made.data;
  const traces = made.data.map((trace, k) => ({...trace, uid: `t${k}`, visible: shown[k]?.visible ?? true}));
  const {data, layout: untitled} = onPaper({...made, data: traces}, 430), layout = titled(plot, untitled);
  const svg =
      await Plotly.toImage({data, layout}, {format: "svg", width: 900, height: layout.height, imageDataOnly: true});
  const [, random] = svg.match(/id="defs-([0-9a-f]+)"/), known = `f${plots.indexOf(plot)}`;
  return svg.replace(/vector-effect: ?non-scaling-stroke;?/g, "")
      .replace(new RegExp(`\\b(defs-|topdefs-|clip|legend|g)${random}`, "g"), `$1${known}`);
}

/** The same as PNG with three dots a pixel: its bytes in base 64. */
export async function pngOf(svg) {
  const image = new Image();
  image.src = `data:image/svg+xml,${encodeURIComponent(svg)}`;
  await image.decode();
  const canvas = element("canvas", {width: 3 * image.width, height: 3 * image.height});
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  return canvas.toDataURL("image/png").replace(/^.*,/, "");
}

/** Saves a plot as a file. */
async function savePlot(plot, format) {
  const svg = await svgOf(plot),
        url = format === "png" ? `data:image/png;base64,${await pngOf(svg)}` :
                                 `data:image/svg+xml,${encodeURIComponent(svg)}`;
  element("a", {href: url, download: `${plot.name}.${format}`}).click();
}

/** All figures as such pictures: [{name, svg, png}]. */
export async function allPictures() {
  const pictures = [];
  for (const plot of plots) {
    const svg = await svgOf(plot);
    pictures.push({name: plot.name, svg, png: await pngOf(svg)});
  }
  return pictures;
}

/** A name for the files of a figure, as no other has it. */
function plotName(title) {
  const name = fileName(title).slice(0, 100), taken = (any) => plots.some((plot) => plot.name === any);
  let free = name;
  for (let k = 2; taken(free); ++k) free = `${name}-${k}`;
  return free;
}

/**
 * A figure: {title, says (one sentence), make(width, colours) -> {data, layout}, columns() for the CSV, file,
 * controls}. Drawn when drawAll() is called, and again when colours or widths change.
 */
export function figureElement(figure, id) {
  const plot = {
    div: element("div", {className: "plot", role: "img", "aria-label": `${figure.title}. ${figure.says}`}),
    make: figure.make,
    name: plotName(figure.title),
    title: figure.title,
    file: figure.file
  };
  plots.push(plot);
  for (const control of figure.controls ?? []) control.addEventListener("change", () => drawPlot(plot));
  const save = (format) =>
      element("button", {type: "button", on: {click: () => savePlot(plot, format)}}, format.toUpperCase());
  return element(
      "figure", {id},
      element("figcaption", {}, element("h3", {}, ...typeset(figure.title)), element("p", {}, ...marked(figure.says))),
      figure.controls ?
          element(
              "div", {className: "actions"}, ...figure.controls.map((control) => control.parentElement ?? control)) :
          null,
      plot.div, element("div", {className: "actions"}, csvLink(plot.name, figure.columns), save("svg"), save("png")),
      commandLine(figure.file));
}

/** Figures that are folded, and drawn when they are unfolded. */
export function foldElement(title, ...figures) {
  const fold = element("details", {className: "fold"}, element("summary", {}, title), ...figures);
  fold.addEventListener("toggle", () => plots.filter(({div, width}) => !width && fold.contains(div)).forEach(drawPlot));
  return fold;
}

/** Draws all figures that are not folded, one after the other so that the page answers meanwhile. */
export async function drawAll() {
  for (const plot of plots) {
    if (plot.div.closest("details:not([open])")) continue;
    await drawPlot(plot);
    await new Promise((resolve) => setTimeout(resolve));
  }
}

const redrawAll = () => plots.filter(({width}) => width).forEach(drawPlot);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redrawAll);
for (const [event, before] of [["beforeprint", true], ["afterprint", false]])
  window.addEventListener(event, () => {
    printing = before;
    redrawAll();
  });
new ResizeObserver(() => plots.forEach((plot) => {
  if (!printing && plot.width && plot.div.clientWidth && plot.width !== plot.div.clientWidth) drawPlot(plot);
})).observe(document.body);
