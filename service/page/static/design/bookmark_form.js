/** Choose a design, keep it, or search near it. */

import { go, link } from "../lib/address.js";
import { post } from "../lib/api.js";
import { fill, first, formOf, h } from "../lib/dom.js";
import { menu } from "../lib/menu.js";
import { attempt, sayProblem } from "../lib/notices.js";
import { sentenceOf } from "../lib/refusals.js";

/**
 * Return the node. design: of the front, that it began as; dimensions(): its cells, null for the design itself; kept(bookmark): it is.
 * lengths(): that a search begins near to.
 * @param {{ job: string, design: number, dimensions: () => Record<string, Api.Row[string]> | null, kept: (bookmark: Api.Kept) => unknown, lengths: () => Page.Lengths }} options
 */
export function bookmarkForm({ job, design, dimensions, kept, lengths }) {
  const status = h("span", { class: "quiet", role: "status" });
  /** @param {string} verb @param {"reason" | "note"} key @param {string} label */
  const part = (verb, key, label) => {
    const [name, words] = [200, 4000].map((maxlength) =>
      h("input", { type: "text", maxlength, autocomplete: "off" }),
    );
    const decided = key === "reason";
    const button = h("button", { class: decided ? "primary" : null }, verb);
    /** Keep the design, and say where it is. */
    const keep = async () => {
      const bookmark = await post(`jobs/${job}/kept`, {
        design,
        dimensions: dimensions() ?? {},
        name: name.value.trim(),
        [key]: words.value.trim(),
        decided,
      });
      fill(
        status,
        `${bookmark.decision || `“${bookmark.name}” is kept`}; see it `,
        h("a", { href: link(["jobs", job]) }, "beside the front"),
        ".",
      );
      kept(bookmark);
      node.open = false;
      first(node, "summary")?.focus();
    };
    const form = formOf(
      () => attempt(keep, (problem) => (status.textContent = sentenceOf(problem)), button),
      h("label", {}, "Name", name),
      h("label", {}, label, words),
      button,
    );
    const node = menu(
      decided ? "Choose this design" : verb,
      h("div", { class: "chooser-list panel at-left keeping" }, form),
    );
    return node;
  };
  const deciding = part("Choose", "reason", "Because");
  first(deciding, "summary")?.classList.add("primary");
  return h(
    "div",
    { class: "row keep-or-search" },
    deciding,
    part("Keep", "note", "Note"),
    searchButton(job, lengths, { title: "Search near it" }),
    status,
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
      title: "A separate run whose lengths vary by 10 % around these",
      "aria-label": name,
      "data-act": act,
      onclick: ({ currentTarget }) => attempt(search, sayProblem, currentTarget),
    },
    title,
  );
}
