/** Remaining designs as a file: their numbers and all quantities, in the order of the table. */

import { getText } from "../lib/api.js";
import { h } from "../lib/dom.js";
import { download } from "../lib/download.js";
import { sayProblem } from "../lib/notices.js";
import { apiSystem, grouped } from "../lib/numbers.js";
import { linesOf } from "./listed_order.js";

/** @import { Explorer } from "./explorer.js" */

/** Return {node, draw()} of the button that saves the remaining designs of an explorer. @param {Explorer} explorer */
export function saving(explorer) {
  const node = h("button", {
    type: "button",
    class: "linked",
    onclick: () => save().catch(sayProblem),
  });

  async function save() {
    node.disabled = true;
    try {
      const all = await getText(
        `jobs/${explorer.job.id}/export.csv`,
        { units: apiSystem() },
        explorer.signal,
      );
      download(
        linesOf(all, explorer.table.numbers()),
        "text/csv",
        `${explorer.front.run}-listed.csv`,
      );
    } finally {
      draw();
    }
  }

  function draw() {
    const { open, chosen } = explorer.limits;
    node.textContent = open
      ? "In the order of the table, as CSV"
      : `${grouped(chosen)} listed, in the order of the table, as CSV`;
    node.disabled = chosen === 0;
  }
  return { node, draw };
}
