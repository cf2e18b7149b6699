/** Downloads of a run. */

import { address, get } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { menu } from "../lib/menu.js";
import { apiSystem } from "../lib/numbers.js";
import { sentenceOf } from "../lib/refusals.js";

/** @type {Record<string, string>} */
const FRONT = { csv: "Designs as CSV", json: "Front as JSON", parquet: "Designs as Parquet" };

/**
 * Return a list of files behind a button; those that have to be asked for are asked for when it opens.
 * own: what those who show the front put among its files.
 * @param {Api.Job} job @param {{ designs: boolean, own: HTMLElement, signal: AbortSignal }} given
 */
export function downloads(job, { designs, own, signal }) {
  /** @param {string} path @param {string} name */
  const file = (path, name) =>
    h("li", {}, h("a", { href: address(`jobs/${job.id}/${path}`), download: "" }, name));
  // In the units that the reader prefers at the moment.
  /** @param {string} path @param {Dom.Attributes<HTMLAnchorElement>} attributes @param {string | undefined} name */
  const shown = (path, attributes, name) => {
    const link = h("a", { ...attributes }, name);
    const renew = () => (link.href = address(`jobs/${job.id}/${path}`, { units: apiSystem() }));
    renew();
    window.addEventListener("units", renew, { signal });
    return link;
  };
  const files = h("ul");
  const exported = h("ul");
  const figures = h("ul");
  const list = h(
    "div",
    { class: "chooser-list panel" },
    designs && [h("h2", {}, "Front"), exported, own],
    h("h2", {}, "Files of the job"),
    files,
    designs && [h("h2", {}, "Figures"), figures],
  );
  let asked = false;
  const node = menu("Download", list, {
    opened: () => {
      if (asked) return;
      asked = true;
      listFiles();
      if (designs) listFigures();
    },
  });

  async function listFiles() {
    try {
      const found = await get(`jobs/${job.id}/files`, {}, signal);
      fill(
        exported,
        found.exports.map((ending) =>
          h("li", {}, shown(`export.${ending}`, { download: "" }, FRONT[ending])),
        ),
      );
      fill(
        files,
        found.files.map((name) => file(`files/${encodeURIComponent(name)}`, name)),
      );
    } catch (problem) {
      fill(files, h("li", {}, sentenceOf(problem)));
    }
  }

  async function listFigures() {
    fill(figures, h("li", { class: "quiet" }, "Looking …"));
    try {
      const found = await get(`jobs/${job.id}/figures`, {}, signal);
      /** @param {string} name @param {string} kind */
      const as = (name, kind) =>
        shown(
          `figures/${name}.${kind}`,
          { download: `${name}.${kind}`, "aria-label": `${name} as ${kind.toUpperCase()}` },
          kind.toUpperCase(),
        );
      fill(
        figures,
        found.figures.map(({ name, title }) =>
          h("li", {}, `${title} `, as(name, "png"), " ", as(name, "svg")),
        ),
      );
    } catch (problem) {
      fill(figures, h("li", {}, sentenceOf(problem)));
    }
  }

  return node;
}
