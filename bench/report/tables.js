// Tables that sort by a click on a column's head.

import {cellsOf, commandLine, csvLink, element, rowsOf, shortNumber, titleOf, unitOf} from "./data.js";
import {explain, explanationOf, typeset} from "./tips.js";

function compareCells(a, b) {
  const number = (value) => typeof value === "number";
  const missing = (value) => value === "" || Number.isNaN(value);
  if (missing(a) || missing(b)) return missing(a) - missing(b);  // last
  return number(a) && number(b) ? a - b : String(a).localeCompare(String(b), "en", {numeric: true});
}

/** What users see of a column: its title, unit and cells as texts. */
function shownCells(column) {
  if (column.shown) return column.shown;
  return column.numeric ? cellsOf(column).map(shortNumber) : cellsOf(column);
}

/** Those with a value, and with a title unless the table is for the file. */
const visibleColumns = (table) => table.columns.filter(
    (column) => (column.title || table.for_file) && shownCells(column).some((text) => text !== ""));

function sortBy(head, body, values) {
  const down = head.getAttribute("aria-sort") === "ascending";
  for (const other of head.parentElement.children) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", down ? "descending" : "ascending");
  const rows = [...body.children].sort((a, b) => {
    const order = compareCells(values[a.dataset.row], values[b.dataset.row]);
    return down && values[a.dataset.row] !== "" ? -order : order;
  });
  body.append(...rows);
}

function columnHead(column, body) {
  const values = column.shown && !column.numeric ? column.shown : cellsOf(column);
  const head = element("th", {scope: "col", className: column.numeric ? "number" : ""});
  const button =
      element("button", {type: "button", on: {click: () => sortBy(head, body, values)}}, ...typeset(titleOf(column)));
  const says = column.description || explanationOf(titleOf(column));
  head.append(says ? explain(button, says) : button, unitOf(column) && element("small", {}, unitOf(column)));
  return head;
}

/** The table element for a table of the page's data. `mark`: gives the text of a cell as parts of an element. */
export function tableElement(table, mark = (text) => [text]) {
  const columns = visibleColumns(table);
  const body = element("tbody");
  const texts = columns.map(shownCells);
  for (let k = 0; k < (columns[0]?.cells.length ?? 0); ++k) {
    const row = element("tr", {"data-row": k});
    columns.forEach((column, c) => {
      const className = [column.numeric ? "number" : "", column.missed?.[k] ? "bad" : ""].join(" ").trim();
      row.append(
          c === 0 ? element("th", {scope: "row", className}, ...mark(texts[c][k])) :
                    element("td", {className}, ...mark(texts[c][k])));
    });
    body.append(row);
  }
  const heads = columns.map((column) => columnHead(column, body));
  return element(
      "table", {}, element("caption", {hidden: true}, table.description),
      element("thead", {}, element("tr", {}, ...heads)), body);
}

export const exactCells = (column) => ({name: column.name, cells: column.cells});

/** The columns of a table for CSV, only the rows for which wanted(row). */
export function columnsWhere(table, wanted) {
  const rows = rowsOf(table);
  return table.columns.map((column) => ({name: column.name, cells: column.cells.filter((_, k) => wanted(rows[k]))}));
}

const mostRows = 20;

/** The table with its title, source and CSV; long ones are folded. */
export function tableSection(file, table, id) {
  const scroll = element(
      "div", {className: "scroll", tabIndex: 0, role: "region", "aria-label": table.description}, tableElement(table));
  const rows = table.columns[0]?.cells.length ?? 0;
  const content = rows > mostRows ? element("details", {}, element("summary", {}, `${rows} rows`), scroll) : scroll;
  const actions = element("div", {className: "actions"}, csvLink(table.name, () => table.columns.map(exactCells)));
  return element(
      "article", {className: "table", id}, element("h3", {}, ...typeset(table.description || table.name)), content,
      actions, commandLine(file));
}
