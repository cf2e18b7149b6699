/** What can be taken away of a design: drawings, motion, report, its sheet, a link. */

import { address } from "../lib/api.js";
import { h } from "../lib/dom.js";
import { say } from "../lib/notices.js";

const FILES = [
  ["linkage.dxf", "DXF", "The linkage at true scale, for CAD"],
  ["linkage.svg", "SVG", "The linkage at true scale, as a picture"],
  ["motion.html", "Motion", "The motion in one HTML file"],
  ["motion.gif", "GIF", "The motion as an animated picture"],
  ["report.html", "Report", "The report in one HTML file"],
  ["report.pdf", "PDF", "The report to print"],
];

/** Return the links; job, number: of the design. */
export function takeAway(job, number) {
  const files = FILES.map(([file, title, words]) =>
    h("a", { class: "button", href: address(`jobs/${job}/designs/${number}/${file}`), download: "", title: words }, title));
  const sheet = ["png", "svg"].map((kind) =>
    h("a", { class: "button", href: address(`jobs/${job}/figures/design_${number}.${kind}`), download: "", title: "All curves on one sheet" }, `Sheet ${kind.toUpperCase()}`));
  const copy = h("button", { type: "button", onclick: copyLink }, "Copy link");
  return h("nav", { class: "take-away row", "aria-label": "Take away" }, files, sheet, copy);
}

async function copyLink() {
  try {
    await navigator.clipboard.writeText(location.href);
    say("The link is copied; it shows the same to a colleague who may open this service.");
  } catch {
    say(`The browser did not let the link be copied; it is ${location.href}`, "error");
  }
}
