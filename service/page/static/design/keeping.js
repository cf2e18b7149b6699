/** Keep a design that is none of the list: with a name and a note, in the store. */

import { link } from "../lib/address.js";
import { post, sentenceOf } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";

/**
 * Return the node. design: of the front, that it began as; dimensions(): its cells, null for the design itself; kept(): it is.
 * @param {{ job: string, design: number, dimensions: () => Record<string, Api.Row[string]> | null, kept?: () => unknown }} given
 */
export function keeping({ job, design, dimensions, kept = () => {} }) {
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
  return h("details", { class: "keeping" }, h("summary", { class: "button" }, "Keep this design"), form);
}
