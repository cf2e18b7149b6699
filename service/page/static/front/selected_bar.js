/** Selected designs, and the link that shows them side by side. */

import { link } from "../lib/address.js";
import { fill, h } from "../lib/dom.js";

/** @import { Explorer } from "./explorer.js" */

/** Return {place, draw()} for the selected designs of an explorer. @param {Explorer} explorer */
export function selectedBar(explorer) {
  const place = h("div", { class: "row selected-designs" });
  /** @type {string | null} */
  let selectedNumbers = null;

  function draw() {
    const { selected } = explorer.chosen;
    if (selectedNumbers === selected.join()) return;
    selectedNumbers = selected.join();
    const [first, ...others] = selected;
    fill(
      place,
      selected.length === 0 &&
        h("span", { class: "quiet" }, "Tick two or three designs to see them side by side"),
      selected.length === 1 &&
        h("span", { class: "quiet" }, `Design ${first} is selected; tick another one`),
      selected.length > 1 &&
        h(
          "a",
          {
            class: "button primary",
            href: link(["jobs", explorer.job.id, "designs", first], { beside: others.join(",") }),
          },
          `Designs ${selected.join(", ")} side by side`,
        ),
      selected.length > 0 &&
        h(
          "button",
          { type: "button", onclick: () => explorer.change({ selected: [] }, "marks") },
          "Select none",
        ),
    );
  }
  return { place, draw };
}
