// What is in the page: the files, their tables by column, the overview of them, words that the program explains, and
// the texts that numbers are shown as.

export const {files, overview, words} = JSON.parse(document.getElementById("data").textContent);

/** An element with properties and children; strings become text, never HTML. */
export function element(name, properties = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key === "on")
      for (const [event, react] of Object.entries(value)) made.addEventListener(event, react);
    else if (key in made)
      made[key] = value;
    else
      made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

export const fact = (file, name) => file.provenance.find((any) => any.name === name)?.value ?? "unknown";

/** A number of the page's data, which has texts in place of infinities. */
export function toNumber(cell) {
  if (cell === "inf") return Infinity;
  return cell === "-inf" ? -Infinity : cell ?? NaN;
}

/** Four digits, as in the program's own tables. */
export function shortNumber(value) {
  if (value === null || Number.isNaN(value)) return "";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  if (Number.isInteger(value) && Math.abs(value) < 1e7) return String(value);
  const text = value.toPrecision(4);
  const [digits, exponent] = text.split("e");
  const trimmed = digits.includes(".") ? digits.replace(/\.?0+$/, "") : digits;
  if (exponent) return `${trimmed}e${exponent}`;
  return Math.abs(value) < 1e-4 ? value.toExponential(3).replace(/\.?0+e/, "e") : trimmed;
}

const lengths = [["m", 1], ["mm", 1e-3], ["µm", 1e-6], ["nm", 1e-9]];

/** A length with three digits, in the unit in which it is between 1 and 1000. */
export function lengthText(metres) {
  const [unit, size] = lengths.find(([, any]) => metres >= 0.9995 * any) ?? lengths[lengths.length - 1];
  return metres === 0 ? "0 m" : `${shortNumber(Number((metres / size).toPrecision(3)))} ${unit}`;
}

/** The cells of a column, numbers as numbers. */
export const cellsOf = (column) =>
    (column.numeric ? column.cells.map(toNumber) : column.cells.map((cell) => cell ?? ""));

/**
 * The columns that the figure of a table takes for a part, the first of them, and the first with a role, if there is
 * one.
 */
export const partsOf = (table, part) => table.columns.filter((column) => column.part === part);
export const partOf = (table, part) => partsOf(table, part)[0];
export const withRole = (table, role) => table.columns.find((column) => column.role === role);

export const titleOf = (column) => column.title || column.name;
export const unitOf = (column) => (column.numeric && column.unit !== "1" ? `[${column.unit}]` : "");

/** Rows of a table as objects. */
export function rowsOf(table) {
  const columns = table.columns.map((column) => [column.name, cellsOf(column)]);
  const length = table.columns[0]?.cells.length ?? 0;
  return Array.from({length}, (_, k) => Object.fromEntries(columns.map(([name, cells]) => [name, cells[k]])));
}

/** A Map from key(item) to the items of that key, in order of appearance. */
export function groupBy(items, key) {
  const groups = new Map();
  for (const item of items) {
    const name = key(item);
    if (!groups.has(name)) groups.set(name, []);
    groups.get(name).push(item);
  }
  return groups;
}

export const unique = (items) => [...new Set(items)];

/** Columns {name, unit, cells} as CSV [RFC 4180]: numbers read back as the same numbers. */
function toCsv(columns) {
  const quoted = (text) => (/[",\n\r]/.test(text) ? `"${text.replaceAll("\"", "\"\"")}"` : text);
  const cell = (value) => (value === null || value === undefined || Number.isNaN(value) ? "" : quoted(String(value)));
  const text = (value) => (value === Infinity ? "inf" : value === -Infinity ? "-inf" : cell(value));
  const lines = [columns.map((column) => quoted(column.name)).join(",")];
  const length = Math.max(0, ...columns.map((column) => column.cells.length));
  for (let k = 0; k < length; ++k) lines.push(columns.map((column) => text(column.cells[k])).join(","));
  return lines.join("\n") + "\n";
}

/** A link that saves a table as CSV; columns() is asked when it is used. */
export function csvLink(name, columns) {
  const link = element("a", {className: "action", href: "#", download: `${fileName(name)}.csv`}, "CSV");
  link.addEventListener("click", () => {
    URL.revokeObjectURL(link.href);
    link.href = URL.createObjectURL(new Blob([toCsv(columns())], {type: "text/csv"}));
  });
  return link;
}

export const fileName = (text) => text.replace(/[^\p{L}\p{N}.]+/gu, "-").replace(/^[-.]+|-$/g, "");

export const commandLine = (file) => element(
    "p", {className: "command"}, "from ", element("code", {}, file.file), ", made by ",
    element("code", {}, fact(file, "command_line")));
