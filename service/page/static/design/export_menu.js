/** Export menu of a design: drawings, motion, report, datasheet; and a link beside it. */

import { address } from "../lib/api.js";
import { h } from "../lib/dom.js";
import { menu } from "../lib/menu.js";
import { attempt, say, sayProblem } from "../lib/notices.js";
import { printComplete } from "../lib/deferred.js";
import { apiSystem } from "../lib/numbers.js";

const FILES = [
  ["linkage.dxf", "DXF", "The linkage at true scale for CAD, always in mm"],
  ["linkage.svg", "SVG", "The linkage at true scale, as a picture"],
  ["motion.html", "Motion", "The motion in one HTML file"],
  ["motion.gif", "GIF", "The motion as an animation"],
  ["report.html", "Report", "The report in one HTML file"],
  ["report.pdf", "PDF", "The report to print"],
];

const WITHOUT_UNITS = /\.dxf$/; // the file states millimetres, and CAD converts

/**
 * Return {node, show(lengths)}: links to the files of a design; after show(lengths), of the design with other lengths; after show(null),
 * of the unchanged design.
 * @param {string} job @param {number} number
 */
export function exportMenu(job, number) {
  /** @param {string} path @param {string} title @param {string} words */
  const anchor = (path, title, words) => ({ path, node: h("a", { download: "" }, title), words });
  const links = [
    ...FILES.map(([file, title, words]) =>
      anchor(`jobs/${job}/designs/${number}/${file}`, title, words),
    ),
    ...["png", "svg"].map((kind) =>
      anchor(
        `jobs/${job}/figures/design_${number}.${kind}`,
        `Sheet ${kind.toUpperCase()}`,
        "All curves on one sheet",
      ),
    ),
  ];
  const print = h(
    "button",
    {
      type: "button",
      title: "The whole view on paper or as PDF, with all its parts",
      onclick: ({ currentTarget }) => attempt(printComplete, sayProblem, currentTarget),
    },
    "Print",
  );
  const copy = h("button", { type: "button", onclick: copyLink }, "Copy link");
  /** @param {Page.Numbers | null} lengths */
  const show = (lengths) => {
    for (const { path, node } of links) {
      const units = WITHOUT_UNITS.test(path) ? {} : { units: apiSystem() };
      node.href = address(path, { ...lengths, ...units });
    }
  };
  show(null);
  const list = h(
    "ul",
    { class: "files" },
    links.map(({ node, words: about }) => h("li", {}, node, h("span", { class: "quiet" }, about))),
  );
  const button = menu("Export", h("div", { class: "chooser-list panel at-left" }, list));
  return {
    node: h("nav", { class: "exports row", "aria-label": "Exports" }, button, print, copy),
    show,
  };
}

/** Copy the address of this view, and confirm it. */
export async function copyLink() {
  try {
    await navigator.clipboard.writeText(location.href);
    say("Link copied. It shows the same view to anyone with access to this service.");
  } catch {
    say(`The browser refused to copy the link: ${location.href}`, "error");
  }
}
