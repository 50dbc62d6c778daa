// Tips: what explains a word or a column, shown where one points, tabs or taps.

import {element, words} from "./data.js";
import {glossary} from "./glossary.js";

const tip = element("div", {id: "tip", role: "tooltip", hidden: true});
const store = element("div", {hidden: true});  // what aria-describedby refers to

/** The element that keeps an explanation, the same for the same text. */
function idOf(says) {
  const kept = [...store.children].find((any) => any.textContent === says);
  if (kept) return kept.id;
  const id = `says-${store.children.length + 1}`;
  store.append(element("span", {id}, says));
  return id;
}

/** Gives an element a tip, which is shown at `target` or around it. */
export function explain(target, says) {
  target.dataset.says = says;
  target.setAttribute("aria-describedby", idOf(says));
  return target;
}

const texts = new Map([...glossary, ...words].map(({word, says}) => [word, says]));
const shown = new Set();  // the words that the page has marked

/** What the glossary says of the title of a column. */
export function explanationOf(title) {
  if (texts.has(title)) shown.add(title);
  return texts.get(title);
}

/** A text with its indices set: "ν_h" with h below. */
export function typeset(text) {
  const [before, ...after] = text.split("ν_h");
  return [before, ...after.flatMap((rest) => ["ν", element("sub", {}, "h"), rest])].filter((part) => part !== "");
}

const inTexts =
    [...words, ...glossary.filter(({head}) => !head)].map(({word}) => word).sort((a, b) => b.length - a.length);
const escaped = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
const pattern = new RegExp(`(?<![\\p{L}\\p{N}_-])(?:${inTexts.map(escaped).join("|")})(?![\\p{L}\\p{N}_-])`, "gu");

/** A text as parts of an element, its words marked except those seen before. */
export function marked(text, seen = new Set()) {
  const parts = [];
  let end = 0;
  for (const {0: word, index} of text.matchAll(pattern)) {
    if (seen.has(word)) continue;
    seen.add(word);
    parts.push(
        ...typeset(text.slice(end, index)),
        explain(element("span", {className: "word", tabIndex: 0}, ...typeset(word)), explanationOf(word)));
    end = index + word.length;
  }
  return [...parts, ...typeset(text.slice(end))];
}

/** All words that the page has marked with what they mean, as a list: for print, and for those who look one up. */
export function glossaryElement() {
  const known = [...shown].sort((a, b) => a.localeCompare(b, "en"));
  return element(
      "dl", {className: "words"},
      ...known.flatMap(
          (word) => [element("dt", {}, ...typeset(word)), element("dd", {}, ...typeset(texts.get(word)))]));
}

function show(target) {
  const place = target.getBoundingClientRect();
  tip.replaceChildren(...typeset(target.dataset.says));
  tip.hidden = false;
  const {width, height} = tip.getBoundingClientRect(), below = place.bottom + 6 + height <= innerHeight;
  const left = Math.max(8, Math.min(place.left, document.documentElement.clientWidth - width - 8));
  tip.style.left = `${scrollX + left}px`;
  tip.style.top = `${scrollY + (below ? place.bottom + 6 : place.top - height - 6)}px`;
}

const hide = () => {
  tip.hidden = true;
};

for (const event of ["pointerover", "focusin"])
  document.addEventListener(event, ({target}) => {
    const explained = target.closest?.("[data-says]");
    if (explained) show(explained);
  });
for (const event of ["pointerout", "focusout"]) document.addEventListener(event, hide);
document.addEventListener("keydown", ({key}) => {
  if (key === "Escape") hide();
});
document.body.append(tip, store);
