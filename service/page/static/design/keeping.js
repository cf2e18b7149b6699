/** Keep a design that is none of the list: with a name and a note, in the store. */

import { go, link } from "../lib/address.js";
import { post, sentenceOf } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";

/**
 * Return the node. design: of the front, that it began as; dimensions(): its cells, null for the design itself; kept(): it is.
 * lengths(): that a search may begin near to; without it none is offered.
 * @param {{ job: string, design: number, dimensions: () => Record<string, Api.Row[string]> | null, kept?: () => unknown, lengths?: () => Page.Lengths }} given
 */
export function keeping({ job, design, dimensions, kept = () => {}, lengths }) {
  const name = h("input", { type: "text", maxlength: 200, autocomplete: "off", placeholder: "Kept" });
  const note = h("input", { type: "text", maxlength: 4000, autocomplete: "off" });
  const said = h("p", { class: "quiet", role: "status" });
  const button = h("button", {}, "Keep");
  const form = h("form", { onsubmit: (event) => { event.preventDefault(); keep(); } }, h("label", {}, "Name", name), h("label", {}, "Note", note), h("div", { class: "row" }, button), said);

  async function keep() {
    button.disabled = true;
    try {
      const found = await post(`jobs/${job}/kept`, { design, dimensions: dimensions() ?? {}, name: name.value.trim(), note: note.value.trim() });
      fill(said, `“${found.name}” is kept `, h("a", { href: link(["jobs", job]) }, "beside the front"), found.outside.length > 0 && "; it is outside the job", ".");
      kept();
    } catch (error) {
      said.textContent = sentenceOf(error);
    } finally {
      button.disabled = false;
    }
  }
  const failed = h("p", { class: "bad", role: "alert" });

  /** @param {HTMLButtonElement} near @param {Page.Lengths} around */
  async function search(near, around) {
    near.disabled = true;
    failed.textContent = "";
    try {
      const { id } = await post(`jobs/${job}/nearby`, around);
      go(["jobs", id]);
    } catch (error) {
      failed.textContent = sentenceOf(error);
    } finally {
      near.disabled = false;
    }
  }
  return h("div", { class: "row keep-or-search" }, h("details", { class: "keeping" }, h("summary", { class: "button" }, "Keep this design"), form),
    lengths && h("button", { type: "button", title: "A run of its own, whose lengths vary by a tenth around these", onclick: ({ currentTarget }) => search(currentTarget, lengths()) }, "Search near this"), failed);
}
