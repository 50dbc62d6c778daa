// The page: header, summary, motion, figures, tables.

import {element, fact, files, overview} from "./data.js";
import {figuresOfTable} from "./figures.js";
import {playersOf, showTime} from "./player.js";
import {drawAll, figureElement, plots} from "./plots.js";
import {figuresOfRuns} from "./run_figures.js";
import {tableElement, tableSection} from "./tables.js";

/** For those who drive the page from outside: report.allPictures() and so on. */
export {allPictures, plots, pngOf, svgOf} from "./plots.js";

function sourceElement(file) {
  const known =
      [["started", "when"], ["cpu", "machine"], ["cores", "cores"], ["git_commit", "commit"], ["build_type", "build"]];
  const facts =
      known.map(([name, title]) => element("div", {}, element("dt", {}, title), element("dd", {}, fact(file, name))));
  const all = file.provenance.map(
      (any) => element(
          "tr", {}, element("th", {scope: "row", title: any.description}, any.name), element("td", {}, any.value)));
  const rest = element(
      "details", {}, element("summary", {}, "all that is known of it"),
      element("div", {className: "scroll"}, element("table", {}, element("tbody", {}, ...all))));
  return element(
      "div", {className: "source"},
      element("p", {}, element("strong", {}, file.file), " ", element("code", {}, fact(file, "command_line"))),
      element("dl", {}, ...facts), rest);
}

function showHeader() {
  const names = files.map((file) => file.file.replace(/\.h5$/, ""));
  document.title = `drape: ${names.join(", ")}`;
  document.querySelector("h1").textContent = names.length > 4 ? `Results of ${names.length} files` : names.join(", ");
  const sources = element("div", {className: "sources"}, ...files.map(sourceElement));
  const unclean = files.filter((file) => fact(file, "sanitizers") !== "none");
  if (unclean.length)
    sources.append(element(
        "p", {className: "bad"},
        `Times are worthless, built with sanitizers: ${unclean.map((file) => file.file).join(", ")}`));
  document.getElementById("header").append(sources);
}

/** What the files come to: a table that report also prints. */
const card = (table) => element(
    "div", {className: "card"}, element("h3", {}, table.description),
    element(
        "div", {className: "scroll", tabIndex: 0, role: "region", "aria-label": table.description},
        tableElement(table)));

function contentsElement() {
  const titled =
      [...document.querySelectorAll("main figure[id], main article[id]")].filter((any) => any.querySelector("h3"));
  const items = titled.map(
      (any) => element(
          "li", {},
          element(
              "a", {href: `#${any.id}`, title: any.querySelector("h3").textContent},
              any.querySelector("h3").textContent)));
  return element(
      "details", {}, element("summary", {}, `Contents: ${items.length} figures and tables`),
      element("ul", {}, ...items));
}

function showAll() {
  showHeader();
  document.getElementById("summary").append(element("div", {className: "cards"}, ...overview.map(card)));
  showMotions();
  const figures =
      files.flatMap((file) => [...figuresOfRuns(file), ...file.tables.flatMap((table) => figuresOfTable(file, table))]);
  document.getElementById("figures").append(...figures.map((figure, k) => figureElement(figure, `figure-${k + 1}`)));
  document.getElementById("figures").hidden = !figures.length;
  const tables = files.flatMap(
      (file) => [...(file.runs_table ? [{...file.runs_table, description: `Runs of ${file.file}`}] : []),
                 ...file.tables]
                    .map((table) => ({file, table})));
  document.getElementById("tables").append(
      ...tables.map(({file, table}, k) => tableSection(file, table, `table-${k + 1}`)));
  document.getElementById("contents").append(contentsElement());
}

/** Motions are shown from half of their time on: the start is the same for all. */
function showMotions() {
  const players = files.flatMap(playersOf), section = document.getElementById("motion");
  section.hidden = !players.length;
  section.append(...players.flatMap(
      ({figure, more}, k) => [figure, ...more.map((any, m) => figureElement(any, `distance-${k + 1}-${m + 1}`))]));
  for (const {player} of players) showTime(player, player.end / 2);
}

showAll();
drawAll().then(() => document.documentElement.setAttribute("data-drawn", plots.length));
