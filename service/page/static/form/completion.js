/** Completion of the names of formulas while one is typed: a list below the input, for pointer and keyboard. */

import { fill, h } from "../lib/dom.js";

const MOST = 12; // visible names
const WORD = /[A-Za-z_][\w.]*$/;
const AFTER_NUMBER = /[\d.]\s*$/; // a unit follows here

/**
 * Return an input with a list of matching names below it. number: whether it is for numbers, where formulas are rare.
 * @param {HTMLInputElement} input @param {Form.Whole} form @param {{ number?: boolean }} options
 */
export function completing(input, form, { number = false } = {}) {
  const list = h("ul", {
    role: "listbox",
    id: `${input.id}-names`,
    class: "names",
    "aria-label": "Names of formulas",
    hidden: true,
    onmousedown: (event) => event.preventDefault(), // the input keeps the focus
    onclick: (event) => {
      const place = [...list.children].findIndex(
        (one) => event.target instanceof Node && one.contains(event.target),
      );
      if (place >= 0) take(offered[place]);
    },
  });
  const node = h("span", { class: number ? "completed" : "completed wide" }, input, list);
  for (const [name, value] of [
    ["role", "combobox"],
    ["aria-autocomplete", "list"],
    ["aria-expanded", "false"],
    ["aria-controls", list.id],
    ["spellcheck", "false"],
    ["autocapitalize", "none"],
  ])
    input.setAttribute(name, value);
  /** @type {Form.Name[]} */
  let offered = [];
  let active = -1;
  let typing = false; // a name whose list was not closed

  const close = () => {
    typing = false;
    offered = [];
    active = -1;
    list.hidden = true;
    input.setAttribute("aria-expanded", "false");
    input.removeAttribute("aria-activedescendant");
  };
  /** @param {number} place */
  const point = (place) => {
    active = place;
    [...list.children].forEach((one, n) => one.setAttribute("aria-selected", String(n === place)));
    if (place < 0) return input.removeAttribute("aria-activedescendant");
    input.setAttribute("aria-activedescendant", list.children[place].id);
    list.children[place].scrollIntoView({ block: "nearest" });
  };
  const open = ({ all = false } = {}) => {
    const word = wordAt(input);
    offered =
      word === null || (word === "" && !all)
        ? []
        : matching(word, form.names()).slice(0, all && word === "" ? undefined : MOST);
    if (offered.length === 1 && offered[0].name === word) offered = [];
    if (!offered.length) {
      close();
      typing = true;
      return;
    }
    fill(
      list,
      offered.map(({ name, title, unit }, n) =>
        h(
          "li",
          { role: "option", id: `${list.id}-${n}`, "aria-selected": "false", "data-name": name },
          h("code", {}, name),
          " ",
          h("span", { class: "quiet" }, [title, unit].filter(Boolean).join(", ")),
        ),
      ),
    );
    list.hidden = false;
    input.setAttribute("aria-expanded", "true");
    point(-1);
  };
  /** @param {Form.Name} chosen */
  const take = ({ name, behind = "" }) => {
    const caret = input.selectionStart ?? input.value.length;
    const before = input.value.slice(0, caret).replace(WORD, "");
    const after = input.value.slice(caret).replace(/^[\w.]+/, "");
    input.value = `${before}${name}${behind}${after}`;
    const place = before.length + name.length + behind.length;
    input.setSelectionRange(place, place);
    input.dispatchEvent(new Event("input", { bubbles: true }));
    close();
  };
  input.addEventListener("input", () => {
    typing = document.activeElement === input;
    if (typing) open();
    if (number) node.classList.toggle("long", /[A-Za-z_]{3}|\(/.test(input.value));
  });
  input.addEventListener("keydown", (event) => {
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      if (list.hidden) {
        if (number && !input.value) return;
        open({ all: true });
      }
      if (list.hidden) return;
      event.preventDefault();
      const by = event.key === "ArrowDown" ? 1 : -1;
      point(
        active < 0 && by < 0 ? offered.length - 1 : (active + by + offered.length) % offered.length,
      );
    } else if (event.key === "Enter" && active >= 0) {
      event.preventDefault();
      take(offered[active]);
    } else if (event.key === "Escape" && !list.hidden) {
      event.preventDefault();
      close();
    }
  });
  input.addEventListener("blur", close);
  input.addEventListener("names", () => {
    if (typing && active < 0) open();
  });
  node.classList.toggle("long", number && /[A-Za-z_]{3}|\(/.test(input.value));
  return node;
}

/** Return the beginning of a name before the caret; null after a number, where a unit follows. @param {HTMLInputElement} input */
function wordAt(input) {
  const before = input.value.slice(0, input.selectionStart ?? input.value.length);
  const word = WORD.exec(before)?.[0] ?? "";
  const rest = before.slice(0, before.length - word.length);
  return AFTER_NUMBER.test(rest) ? null : word;
}

/** Return the names that begin with a word, then those that contain it in name or title. @param {string} word @param {Form.Name[]} names */
function matching(word, names) {
  const sought = word.toLowerCase();
  /** @param {Form.Name} one */
  const rank = ({ name, title }) => {
    const lowerName = name.toLowerCase();
    if (lowerName.startsWith(sought)) return 0;
    if (lowerName.split(/[_.]/).some((part) => part.startsWith(sought))) return 1;
    return lowerName.includes(sought) || title.toLowerCase().includes(sought) ? 2 : 3;
  };
  return names
    .map((one) => ({ one, at: rank(one) }))
    .filter(({ at }) => at < 3)
    .sort((a, b) => a.at - b.at)
    .map(({ one }) => one);
}
