"use strict";
// The page: header, summary, motion, figures, tables.

function sourceElement(file) {
  const known = [["started", "when"], ["cpu", "machine"], ["cores", "cores"], ["git_commit", "commit"], ["build_type", "build"]];
  const facts = known.map(([name, title]) => element("div", {}, element("dt", {}, title), element("dd", {}, fact(file, name))));
  const all = file.provenance.map((any) => element("tr", {}, element("th", {scope: "row", title: any.description}, any.name), element("td", {}, any.value)));
  const rest = element("details", {}, element("summary", {}, "all that is known of it"), element("div", {className: "scroll"}, element("table", {}, element("tbody", {}, ...all))));
  return element("div", {className: "source"}, element("p", {}, element("strong", {}, file.file), " ", element("code", {}, fact(file, "command_line"))), element("dl", {}, ...facts), rest);
}

function showHeader() {
  const names = files.map((file) => file.file.replace(/\.h5$/, ""));
  document.title = `drape: ${names.join(", ")}`;
  document.querySelector("h1").textContent = names.length > 4 ? `Results of ${names.length} files` : names.join(", ");
  const sources = element("div", {className: "sources"}, ...files.map(sourceElement));
  const unclean = files.filter((file) => fact(file, "sanitizers") !== "none");
  if (unclean.length) sources.append(element("p", {className: "bad"}, `Times are worthless, built with sanitizers: ${unclean.map((file) => file.file).join(", ")}`));
  document.getElementById("header").append(sources);
}

const card = (title, big, className, ...content) =>
  element("div", {className: "card"}, element("h3", {}, title), element("p", {className: `big ${className}`}, big), ...content);

/** Orders that were fitted: how many are as declared, and which are not. */
function ordersCard() {
  const rows = files.flatMap((file) => file.tables.filter((table) => hasColumns(table, "fitted_order", "verdict")).flatMap((table) => rowsOf(table).filter((row) => row.verdict)
    .map((row) => ({name: [row.scene ?? row.experiment, row.method ?? row.form].filter((text) => text).join(", "), fitted: row.fitted_order, verdict: row.verdict}))));
  if (!rows.length) return null;
  const right = rows.filter((row) => /as declared$/.test(row.verdict)), wrong = rows.filter((row) => isBad(row.verdict)), none = rows.length - right.length - wrong.length;
  const list = element("ul", {}, ...wrong.map((row) => element("li", {}, `${row.name}: ${shortNumber(row.fitted)}, ${row.verdict}`)));
  return card("Orders of convergence", `${right.length} of ${rows.length} as declared`, wrong.length ? "bad" : "good",
              none ? element("p", {className: "quiet"}, `${none} not declared, or with no order to be seen`) : null, wrong.length ? list : null);
}

/** Who is the quickest of runs with an error of at most 1e-1 … 1e-7. */
function quickestRuns(file) {
  return comparedRuns(file).flatMap(([name, runs]) => {
    const rows = runs.map(workPrecisionRow).filter((row) => row);
    const best = [1, 2, 3, 4, 5, 6, 7].map((k) => {
      const able = rows.filter((row) => row.error <= 10 ** -k).sort((a, b) => a.time - b.time);
      return able.length ? {scene: name, error: 10 ** -k, best: `${able[0].method}, h = ${shortNumber(able[0].step)} s`, ms: able[0].time} : undefined;
    });
    return best.filter((row) => row);
  });
}

/** The same of the study work-precision, with the ratio of the best peer. */
function quickestTrials(table) {
  const peers = table.columns.map((column) => column.name).filter((name) => /^(cvode|arkode|ida).*_ratio$/.test(name));
  return rowsOf(table).filter((row) => row.best).map((row) => {
    const ratios = peers.map((peer) => row[peer]).filter((ratio) => ratio > 0);
    return {scene: row.scene, error: row.error, best: row.best, ms: row.ours_ms, peer: ratios.length ? Math.min(...ratios) : NaN};
  });
}

function winnersCard() {
  const rows = files.flatMap((file) => [...file.tables.filter((table) => table.name === "winners").flatMap(quickestTrials), ...quickestRuns(file)]);
  if (!rows.length) return null;
  const column = (name, title, unit, description) => ({name, title, unit, description, cells: rows.map((row) => row[name] ?? null)});
  const table = {description: "Who wins at which error", columns: [
    column("error", "error ≤", "1", "over the scene's size"), column("best", "quickest", "", "of all that were run"), column("ms", "time", "ms", "median"),
    {...column("peer", "SUNDIALS", "1", "time of the best of SUNDIALS over it"), shown: rows.map(({peer}) => (peer > 0 ? `${shortNumber(peer)} ×` : ""))}]};
  const scenes = unique(rows.map((row) => row.scene));
  if (scenes.length > 1) table.columns.unshift(column("scene", "scene", "", "and what was set differently"));
  const wins = [...groupBy(rows, (row) => row.best.split(/[ ,/]/)[0])].sort((a, b) => b[1].length - a[1].length)[0];
  return card("Who wins at which error", `${wins[0]}, ${wins[1].length} of ${rows.length} times`, "",
              scenes.length > 1 ? null : element("p", {className: "quiet"}, `on ${scenes[0]}`),
              element("div", {className: "scroll", tabIndex: 0, role: "region", "aria-label": "Who wins at which error"}, tableElement(table)));
}

/** What a row says beside its verdict. */
const describeRow = (table, row) => visibleColumns(table).filter((column) => column.name !== "verdict" && row[column.name] !== "" && !Number.isNaN(row[column.name]))
  .map((column) => (isNumeric(column) ? `${column.title || column.name} ${shortNumber(row[column.name])}` : row[column.name])).join(", ");

/** Runs that failed and verdicts that are not as they should be, each with its reason. */
function failuresCard() {
  const runs = files.flatMap((file) => file.runs);
  const failed = runs.filter((run) => run.outcome !== "success")
    .map((run) => `${run.method}, h = ${shortNumber(run.step)} s on ${runTitle(run)}: ${run.outcome} at ${shortNumber(toNumber(run.last_good_time))} s${run.message ? ` (${run.message})` : ""}`);
  const judged = files.flatMap((file) => file.tables.filter((table) => hasColumns(table, "verdict")).flatMap((table) => rowsOf(table).filter((row) => isBad(row.verdict)).map((row) => {
    return `${table.name}: ${describeRow(table, row)}: ${row.verdict}`;
  })));
  const all = [...failed, ...judged], trials = files.flatMap((file) => file.tables).filter((table) => table.name.startsWith("trials: ")).flatMap(rowsOf);
  const outcomes = [...groupBy(trials.filter((row) => row.outcome !== "success"), (row) => row.outcome)].map(([outcome, of]) => `${of.length} ${of.length > 1 ? "trials" : "trial"}: ${outcome}`);
  const lines = [...all, ...outcomes];
  const counts = [failed.length ? `${failed.length} of ${runs.length} runs` : "", judged.length ? `${judged.length} ${judged.length > 1 ? "verdicts" : "verdict"}` : ""];
  const list = element("div", {className: "scroll", tabIndex: 0, role: "region", "aria-label": "Failures"}, element("ul", {}, ...lines.map((line) => element("li", {}, line))));
  return card("What failed, and why", counts.filter((text) => text).join(", ") || "nothing", all.length ? "bad" : "good", lines.length ? list : null);
}

function contentsElement() {
  const titled = [...document.querySelectorAll("main figure[id], main article[id]")].filter((any) => any.querySelector("h3"));
  const items = titled.map((any) => element("li", {}, element("a", {href: `#${any.id}`, title: any.querySelector("h3").textContent}, any.querySelector("h3").textContent)));
  return element("details", {}, element("summary", {}, `Contents: ${items.length} figures and tables`), element("ul", {}, ...items));
}

function showAll() {
  showHeader();
  document.getElementById("summary").append(element("div", {className: "cards"}, ...[ordersCard(), winnersCard(), failuresCard()].filter((any) => any)));
  showMotions();
  const figures = files.flatMap((file) => [...figuresOfRuns(file), ...file.tables.flatMap((table) => figuresOfTable(file, table))]);
  document.getElementById("figures").append(...figures.map((figure, k) => figureElement(figure, `figure-${k + 1}`)));
  document.getElementById("figures").hidden = !figures.length;
  const tables = files.flatMap((file) => [...(file.runs_table ? [{...file.runs_table, description: `Runs of ${file.file}`}] : []), ...file.tables].map((table) => ({file, table})));
  document.getElementById("tables").append(...tables.map(({file, table}, k) => tableSection(file, table, `table-${k + 1}`)));
  document.getElementById("contents").append(contentsElement());
}

/** Motions are shown from half of their time on: the start is the same for all. */
function showMotions() {
  const players = files.flatMap(playersOf), section = document.getElementById("motion");
  section.hidden = !players.length;
  section.append(...players.flatMap(({figure, more}, k) => [figure, ...more.map((any, m) => figureElement(any, `distance-${k + 1}-${m + 1}`))]));
  for (const {player} of players) showTime(player, player.end / 2);
}

showAll();
drawAll().then(() => document.documentElement.setAttribute("data-drawn", plots.length));
