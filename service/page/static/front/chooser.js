/** Choice of the displayed quantities: a drop-down list of check boxes. */

import { h } from "../lib/dom.js";
import { menu } from "../lib/menu.js";
import { headed } from "./columns.js";

/**
 * Return a list of all columns behind a heading. chosen(): the checked keys. choose(keys): called with the checked keys in order.
 * @param {string} heading @param {Api.Column[]} columns @param {() => string[]} chosen @param {(keys: string[]) => void} choose
 */
export function chooser(heading, columns, chosen, choose) {
  const ticks = columns.map((column) => {
    const { key } = column;
    const tick = h("input", {
      type: "checkbox",
      value: key,
      onchange: () => {
        const before = chosen().filter((one) => one !== key);
        choose(tick.checked ? [...before, key] : before);
        if (!chosen().includes(key)) tick.checked = false;
      },
    });
    return { tick, label: h("label", {}, tick, " ", headed(column)) };
  });
  const find = h("input", {
    type: "search",
    "aria-label": `Find a quantity for ${heading.toLowerCase()}`,
    placeholder: "Find",
    oninput: () => {
      const wanted = find.value.trim().toLowerCase();
      for (const { label } of ticks)
        label.hidden = !label.textContent.toLowerCase().includes(wanted);
    },
  });
  return menu(
    heading,
    h(
      "div",
      { class: "chooser-list panel", role: "group", "aria-label": heading },
      find,
      ticks.map(({ label }) => label),
    ),
    {
      opened: () => {
        for (const { tick } of ticks) tick.checked = chosen().includes(tick.value);
      },
    },
  );
}
