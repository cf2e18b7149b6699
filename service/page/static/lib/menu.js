/** Menu: a list that opens below a button, and closes on Escape, on a click elsewhere, and on loss of focus. */

import { h } from "./dom.js";

/**
 * Return a menu. title: of its button, "…" for what is dangerous or rare; name: what the button is called where the title does not say it;
 * content: what opens; opened(): called when it does.
 * @param {string} title @param {HTMLElement} content
 * @param {{ name?: string, opened?: () => void, act?: string }} options act: what the button is called in a list that is drawn anew
 */
export function menu(title, content, { name, opened, act } = {}) {
  content.tabIndex = -1; // a click between its parts stays within: closing a menu in the midst of one crashes Chromium
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
