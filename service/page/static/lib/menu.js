/** Menu: a list that opens below a button, and closes on Escape, on a click elsewhere, and on loss of focus. */

import { h } from "./dom.js";

/**
 * Return a menu. title: title of its button, "…" for rare or dangerous actions. name: label if the title is not sufficient. content:
 * content of the menu. opened(): called when it opens.
 * @param {string} title @param {HTMLElement} content
 * @param {{ name?: string, opened?: () => void, act?: string }} options act: what the button is called in a list that is drawn anew
 */
export function menu(title, content, { name, opened, act } = {}) {
  content.tabIndex = -1; // ignore clicks between its parts: closing a menu during a click crashes Chromium
  const summary = h("summary", { class: "button", "aria-label": name, "data-act": act }, title);
  const node = h(
    "details",
    {
      class: "chooser",
      ontoggle: () => {
        if (node.open) opened?.();
        if (node.open) document.addEventListener("pointerdown", elsewhere);
        else document.removeEventListener("pointerdown", elsewhere);
      },
      onkeydown: (event) => {
        if (event.key !== "Escape" || !node.open) return;
        node.open = false;
        summary.focus();
      },
      onfocusout: (event) => {
        if (event.relatedTarget instanceof Node && !node.contains(event.relatedTarget))
          node.open = false;
      },
    },
    summary,
    content,
  );
  /** @param {PointerEvent} event */
  const elsewhere = (event) => {
    if (!(event.target instanceof Node && node.isConnected && node.contains(event.target)))
      node.open = false;
  };
  return node;
}
