/** Keep a design that is none of the list: with a name and a note, in the store. */

import { go, link } from "../lib/address.js";
import { post } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { sayProblem } from "../lib/notices.js";
import { sentenceOf } from "../lib/refusals.js";

/**
 * Return the node. design: of the front, that it began as; dimensions(): its cells, null for the design itself; kept(): it is.
 * lengths(): that a search may begin near to; without it none is offered.
 * @param {{ job: string, design: number, dimensions: () => Record<string, Api.Row[string]> | null, kept?: () => unknown, lengths?: () => Page.Lengths }} given
 */
export function bookmarkForm({ job, design, dimensions, kept = () => {}, lengths }) {
  const name = h("input", {
    type: "text",
    maxlength: 200,
    autocomplete: "off",
    placeholder: "Kept",
  });
  const note = h("input", { type: "text", maxlength: 4000, autocomplete: "off" });
  const said = h("p", { class: "quiet", role: "status" });
  const button = h("button", {}, "Keep");
  const form = h(
    "form",
    {
      onsubmit: (event) => {
        event.preventDefault();
        keep();
      },
    },
    h("label", {}, "Name", name),
    h("label", {}, "Note", note),
    h("div", { class: "row" }, button),
    said,
  );

  async function keep() {
    if (button.getAttribute("aria-busy")) return;
    button.setAttribute("aria-busy", "true"); // not disabled, which would take the focus away
    try {
      const found = await post(`jobs/${job}/kept`, {
        design,
        dimensions: dimensions() ?? {},
        name: name.value.trim(),
        note: note.value.trim(),
      });
      fill(
        said,
        `“${found.name}” is kept `,
        h("a", { href: link(["jobs", job]) }, "beside the front"),
        found.outside.length > 0 && "; it is outside the job",
        ".",
      );
      kept();
    } catch (error) {
      said.textContent = sentenceOf(error);
    } finally {
      button.removeAttribute("aria-busy");
    }
  }
  return h(
    "div",
    { class: "row keep-or-search" },
    h("details", { class: "keeping" }, h("summary", { class: "button" }, "Keep this design"), form),
    lengths && searchButton(job, lengths, { title: "Search near this" }),
  );
}

/**
 * Return the button that searches near lengths. name: what it is called where the title does not say it; act: what it is called in a list
 * that is drawn anew.
 * @param {string} job @param {() => Page.Lengths} lengths @param {{ title: string, name?: string, act?: string }} looks
 */
export function searchButton(job, lengths, { title, name, act }) {
  /** @param {HTMLButtonElement} near */
  const search = async (near) => {
    near.disabled = true;
    try {
      const { id } = await post(`jobs/${job}/nearby`, lengths());
      go(["jobs", id]);
    } catch (error) {
      sayProblem(error);
    } finally {
      near.disabled = false;
    }
  };
  return h(
    "button",
    {
      type: "button",
      title: "A run of its own, whose lengths vary by a tenth around these",
      "aria-label": name,
      "data-act": act,
      onclick: ({ currentTarget }) => search(currentTarget),
    },
    title,
  );
}
