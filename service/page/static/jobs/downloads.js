/** Downloads of a run. */

import { address, get } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { menu } from "../lib/menu.js";
import { attempt } from "../lib/notices.js";
import { apiSystem } from "../lib/numbers.js";
import { sentenceOf } from "../lib/refusals.js";

/** @type {Record<string, string>} */
const FRONT = { csv: "Designs as CSV", json: "Front as JSON", parquet: "Designs as Parquet" };

/**
 * Return a list of files behind a button; their names are requested when it opens. own: further files from the caller.
 * @param {Api.Job} job @param {{ designs: boolean, own: HTMLElement, signal: AbortSignal }} options
 */
export function downloads(job, { designs, own, signal }) {
  /** @param {string} path @param {string} name */
  const file = (path, name) =>
    h("li", {}, h("a", { href: address(`jobs/${job.id}/${path}`), download: "" }, name));
  /**
   * Return a link to a file in display units.
   * @param {string} path @param {Dom.Attributes<HTMLAnchorElement>} attributes @param {string | undefined} name
   */
  const convertedLink = (path, attributes, name) =>
    h(
      "a",
      { ...attributes, href: address(`jobs/${job.id}/${path}`, { units: apiSystem() }) },
      name,
    );
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
  let isListed = false;
  const node = menu("Download", list, {
    opened: () => {
      if (isListed) return;
      isListed = true;
      attempt(listFiles, (problem) => fill(files, h("li", {}, sentenceOf(problem))));
      if (designs)
        attempt(listFigures, (problem) => fill(figures, h("li", {}, sentenceOf(problem))));
    },
  });

  const listFiles = async () => {
    const answer = await get(`jobs/${job.id}/files`, {}, signal);
    fill(
      exported,
      answer.exports.map((ending) =>
        h("li", {}, convertedLink(`export.${ending}`, { download: "" }, FRONT[ending])),
      ),
    );
    fill(
      files,
      answer.files.map((name) => file(`files/${encodeURIComponent(name)}`, name)),
    );
  };

  const listFigures = async () => {
    fill(figures, h("li", { class: "quiet" }, "Looking …"));
    const answer = await get(`jobs/${job.id}/figures`, {}, signal);
    /** @param {string} name @param {string} kind */
    const as = (name, kind) =>
      convertedLink(
        `figures/${name}.${kind}`,
        { download: `${name}.${kind}`, "aria-label": `${name} as ${kind.toUpperCase()}` },
        kind.toUpperCase(),
      );
    fill(
      figures,
      answer.figures.map(({ name, title }) =>
        h("li", {}, `${title} `, as(name, "png"), " ", as(name, "svg")),
      ),
    );
  };

  return node;
}
