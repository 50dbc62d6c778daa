// The page: header, findings with the best figure, motions, figures, summary, tables, sources, words.

import {element, fact, files, groupBy, overview, rowsOf, unique} from "./data.js";
import {figuresOfTable} from "./figures.js";
import {playersOf, playWhenSeen, showTime} from "./player.js";
import {drawAll, figureElement, foldElement, plots} from "./plots.js";
import {figuresOfRuns} from "./run_figures.js";
import {tableElement, tableSection} from "./tables.js";
import {glossaryElement, marked} from "./tips.js";

/** For those who drive the page from outside: report.allPictures() and so on. */
export {allPictures, plots, pngOf, svgOf} from "./plots.js";

const section = (id) => document.getElementById(id);

/** Appends to a section and shows it if there is anything. */
function fill(id, ...children) {
  section(id).append(...children);
  section(id).hidden = !children.length;
}

// --- Header ---------------------------------------------------------------------------------------------------------

const counted = (count, one, many = `${one}s`) => `${count} ${count === 1 ? one : many}`;

/** Some names in words, or how many there are. */
function enumerated(names, one) {
  if (names.length > 3) return counted(names.length, one);
  return names.length < 2 ? names.join("") : `${names.slice(0, -1).join(", ")} and ${names[names.length - 1]}`;
}

/** What the page is about: methods on scenes, or what its tables are. */
function subject() {
  const runs = files.flatMap((file) => file.runs), tables = files.flatMap((file) => file.tables);
  const about = [];
  if (runs.length)
    about.push(`${enumerated(unique(runs.map((run) => run.method)), "method")} on ${
        enumerated(unique(runs.map((run) => run.scene)), "scene")}`);
  const studies = unique(files.map((file) => fact(file, "command_line").match(/\bstudy (\S+)/)?.[1]))
                      .filter((name) => name && files.some((file) => file.tables.length));
  if (studies.length)
    about.push(enumerated(studies, "study").replace(/studys$/, "studies"));
  else if (!runs.length && tables.length)
    about.push(tables[0].description);
  return about.join("; ") || "Nothing was recorded";
}

const known =
    [["started", "when"], ["cpu", "machine"], ["cores", "cores"], ["git_commit", "commit"], ["build_type", "build"]];

/** One line on where the results come from. */
function provenanceLine() {
  const all = (name) => unique(files.map((file) => fact(file, name)));
  const days = unique(all("started").map((time) => time.slice(0, 10))).sort();
  return [
    counted(files.flatMap((file) => file.runs).length, "run"),
    counted(files.flatMap((file) => file.tables).length, "table"), all("cpu").join(", "),
    days.length > 1 ? `${days[0]} to ${days[days.length - 1]}` : days[0],
    `commit ${all("git_commit").map((commit) => commit.slice(0, 10)).join(", ")}`
  ].join(" · ");
}

function showHeader() {
  const about = subject();
  document.title = `${about} – drape`;
  document.querySelector("h1").textContent = about;
  section("header").append(
      element("p", {className: "quiet"}, `${provenanceLine()} · `, element("a", {href: "#sources"}, "all of it")));
  const unclean = files.filter((file) => fact(file, "sanitizers") !== "none");
  if (unclean.length)
    section("header").append(element(
        "p", {className: "bad"},
        `Times are worthless, built with sanitizers: ${unclean.map((file) => file.file).join(", ")}`));
}

function sourceElement(file) {
  const facts =
      known.map(([name, title]) => element("div", {}, element("dt", {}, title), element("dd", {}, fact(file, name))));
  const all = file.provenance.map(
      (any) => element(
          "tr", {}, element("th", {scope: "row"}, any.name), element("td", {}, any.value),
          element("td", {}, any.description)));
  const rest = element(
      "details", {}, element("summary", {}, "all that is known of it"),
      element("div", {className: "scroll"}, element("table", {}, element("tbody", {}, ...all))));
  return element(
      "div", {className: "source"},
      element("p", {}, element("strong", {}, file.file), " ", element("code", {}, fact(file, "command_line"))),
      element("dl", {}, ...facts), rest);
}

// --- Findings and summary -------------------------------------------------------------------------------------------

/** What the files come to in words, a paragraph for each subject. */
function findingsElement(conclusion) {
  const seen = new Set();
  return element(
      "dl", {className: "findings"},
      ...[...groupBy(rowsOf(conclusion), (row) => row.subject)].flatMap(
          ([about, rows]) =>
              [element("dt", {}, ...marked(about, seen)),
               ...rows.map((row) => element("dd", {}, ...marked(row.conclusion, seen)))]));
}

/** A table that report also prints. */
function card(table) {
  const seen = new Set();
  return element(
      "div", {className: "card"}, element("h3", {}, table.description),
      element(
          "div", {className: "scroll", tabIndex: 0, role: "region", "aria-label": table.description},
          tableElement(table, (text) => marked(text, seen))));
}

// --- Figures --------------------------------------------------------------------------------------------------------

// Kinds of figures, the most telling first; of each a few are shown and the others are folded.
const kinds =
    ["work-precision", "runs", "map", "stability", "convergence", "curves", "clearance", "over time", "steps"];
const mostOfAKind = 4;

/** Elements of figures, in the order of their kinds. */
function figureElements(figures) {
  let count = 0;
  const drawn = ({figure}) => figureElement(figure, `figure-${++count}`);
  return kinds.flatMap((kind) => {
    const ofKind = figures.filter((figure) => figure.kind === kind);
    const foldOf = (figure, k) =>
        figure.fold ?? (k < mostOfAKind ? "" : `${ofKind.length - mostOfAKind} more like these`);
    const groups = groupBy(ofKind.map((figure, k) => ({figure, fold: foldOf(figure, k)})), ({fold}) => fold);
    return [...groups].flatMap(([fold, items]) => (fold ? [foldElement(fold, ...items.map(drawn))] : items.map(drawn)));
  });
}

/** Motions are shown from half of their time on: the start is the same for all. They play when they come into view. */
function showMotions() {
  const players = files.flatMap(playersOf);
  fill(
      "motion",
      ...players.flatMap(
          ({figure, more}, k) => [figure, ...more.map((any, m) => figureElement(any, `distance-${k + 1}-${m + 1}`))]));
  for (const {player} of players) {
    showTime(player, player.end / 2);
    playWhenSeen(player);
  }
}

// --- The page -------------------------------------------------------------------------------------------------------

/** Links to all figures and tables; what is folded opens. */
function contentsElement() {
  const titled =
      [...document.querySelectorAll("main figure[id], main article[id]")].filter((any) => any.querySelector("h3"));
  const unfold = (any) => {
    const fold = any.closest("details");
    if (fold) fold.open = true;
  };
  const items = titled.map((any) => {
    const title = any.querySelector("h3").textContent;
    return element("li", {}, element("a", {href: `#${any.id}`, title, on: {click: () => unfold(any)}}, title));
  });
  return element(
      "details", {}, element("summary", {}, `Contents: ${items.length} figures and tables`),
      element("ul", {}, ...items));
}

function showAll() {
  showHeader();
  const figures =
      files.flatMap((file) => [...file.tables.flatMap((table) => figuresOfTable(file, table)), ...figuresOfRuns(file)]);
  const [conclusion, ...others] = overview[0]?.name === "conclusion" ? overview : [undefined, ...overview];
  const drawn = figureElements(figures), [first] = drawn;
  const leads = first?.tagName === "FIGURE" ? [first] : [];
  fill("findings", ...(conclusion ? [findingsElement(conclusion)] : []), ...leads);
  showMotions();
  fill("figures", ...drawn.slice(leads.length));
  fill("summary", ...(others.length ? [element("div", {className: "cards"}, ...others.map(card))] : []));
  const tables = files.flatMap(
      (file) => [...file.tables,
                 ...(file.runs_table ? [{...file.runs_table, description: `Runs of ${file.file}`}] : [])]
                    .map((table) => ({file, table})));
  fill("tables", ...tables.map(({file, table}, k) => tableSection(file, table, `table-${k + 1}`)));
  section("sources").append(element("div", {className: "sources"}, ...files.map(sourceElement)));
  fill("words", glossaryElement());
  section("contents").append(contentsElement());
}

showAll();
drawAll().then(() => document.documentElement.setAttribute("data-drawn", plots.length));
