/** Keep a design that is none of the list: with a name and a note, in the store. */

import { go, link } from "../lib/address.js";
import { post } from "../lib/api.js";
import { fill, formOf, h } from "../lib/dom.js";
import { attempt, sayProblem } from "../lib/notices.js";
import { sentenceOf } from "../lib/refusals.js";

/**
 * Return the node. design: of the front, that it began as; dimensions(): its cells, null for the design itself; kept(): it is.
 * lengths(): that a search may begin near to; without it none is offered.
 * @param {{ job: string, design: number, dimensions: () => Record<string, Api.Row[string]> | null, kept?: () => unknown, lengths?: () => Page.Lengths }} options
 */
export function bookmarkForm({ job, design, dimensions, kept = () => {}, lengths }) {
  const name = h("input", {
    type: "text",
    maxlength: 200,
    autocomplete: "off",
    placeholder: "Kept",
  });
  const note = h("input", { type: "text", maxlength: 4000, autocomplete: "off" });
  const status = h("p", { class: "quiet", role: "status" });
  const button = h("button", {}, "Keep");
  const form = formOf(
    () => keep(),
    h("label", {}, "Name", name),
    h("label", {}, "Note", note),
    h("div", { class: "row" }, button),
    status,
  );

  /** Keep the design, and say where it is. */
  const keep = () =>
    attempt(
      async () => {
        const bookmark = await post(`jobs/${job}/kept`, {
          design,
          dimensions: dimensions() ?? {},
          name: name.value.trim(),
          note: note.value.trim(),
        });
        fill(
          status,
          `“${bookmark.name}” is kept `,
          h("a", { href: link(["jobs", job]) }, "beside the front"),
          bookmark.outside.length > 0 && "; it is outside the job",
          ".",
        );
        kept();
      },
      (problem) => (status.textContent = sentenceOf(problem)),
      button,
    );
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
  const search = async () => go(["jobs", (await post(`jobs/${job}/nearby`, lengths())).id]);
  return h(
    "button",
    {
      type: "button",
      title: "A run of its own, whose lengths vary by a tenth around these",
      "aria-label": name,
      "data-act": act,
      onclick: ({ currentTarget }) => attempt(search, sayProblem, currentTarget),
    },
    title,
  );
}
