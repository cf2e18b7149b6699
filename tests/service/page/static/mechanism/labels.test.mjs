import assert from "node:assert/strict";
import { test } from "node:test";

import "../browser.mjs";
import { corners, Node, outline, overlap } from "../picture.mjs";
import { draws } from "../draws.mjs";

const { drawing } = await import("../../../../../service/page/static/mechanism/drawing.js");
const { deadCentresOf, motionOf } =
  await import("../../../../../service/page/static/mechanism/motion.js");

/** Return a linkage that turns fully, its curves and options of its drawing; some are crossed, some have a piston in a cylinder. */
function machine({ number, one }) {
  const crank_mm = number(5, 150);
  const offset_mm = one([0, 1, 1, 1]) * crank_mm * number(-2, 2);
  const rod_mm = crank_mm * number(1.02, 5) + Math.abs(offset_mm);
  const linkage = { crank_mm, offset_mm, rod_mm };
  const { inner, outer } = deadCentresOf(linkage);
  const side = one([1, 1, 1, -1]);
  const motion = Object.fromEntries(
    Object.entries(motionOf(linkage)).map(([key, values]) => [
      key,
      side > 0
        ? values
        : values.map((_, n) => (key.endsWith("mm") ? -1 : 1) * values[(540 - n) % 360]),
    ]),
  );
  const bore = crank_mm * number(0.4, 1.2);
  const [foot, head] = [inner - bore / 2, outer + bore * 0.6].map((x) => side * x);
  const extent_mm = [
    Math.min(-crank_mm, foot, head),
    Math.min(-crank_mm, offset_mm - 0.72 * bore),
    Math.max(crank_mm, foot, head),
    Math.max(crank_mm, offset_mm + 0.72 * bore),
  ];
  const piston = {
    slider_length_mm: bore,
    slider_height_mm: bore,
    extent_mm,
    cylinders: [{ bore_mm: bore, foot_mm: foot, head_mm: head }],
  };
  const options = { slider_ends_mm: [side * inner, side * outer], direction: one([1, -1]) };
  return {
    linkage,
    motion,
    options: { ...options, outlines: one([undefined, undefined, piston]) },
  };
}

/** Return the outlines of hatching: of the guide, and of the bearing. */
function hatchings(node) {
  return node
    .querySelectorAll("path")
    .filter(({ attributes }) => attributes.class === "guide")
    .map((path) => {
      const [left, y, right] = path.attributes.d
        .match(/^M(\S+) (\S+)H([-\d.]+)/)
        .slice(1)
        .map(Number);
      const depth = Number(path.attributes.d.match(/l\S+ (-?[\d.]+)/)?.[1] ?? 0);
      return corners(path, [left, Math.min(y, y + depth), right, Math.max(y, y + depth)]);
    });
}

test("labels of 1,000 linkages lie in the picture, off each other, off hatching and off links at every angle", () => {
  const source = draws(74);
  for (let n = 0; n < 1000; n += 1) {
    const { linkage, motion, options } = machine(source);
    const place = new Node("div");
    place.clientWidth = source.one([330, 500, 800]);
    const grips = source.one([null, { nodes: [], isHeld: () => false, move() {} }]);
    const picture = drawing(place, { label: "", grips });
    picture.show(linkage, motion, options);
    const links = picture.node
      .querySelectorAll("path")
      .filter(({ attributes }) => attributes.class?.startsWith("link") && attributes.d);
    const [, , width, height] = picture.node.children[0].attributes.viewBox.split(" ").map(Number);
    const hatched = hatchings(picture.node);
    for (let angle = 0; angle < 360; angle += 30) {
      picture.turn(angle);
      const said = (text) =>
        `${text.textContent}, ${JSON.stringify(linkage)} at ${angle} in ${width}`;
      const texts = picture.node
        .querySelectorAll("text")
        .filter((text) => text.textContent && !("hidden" in text.attributes));
      texts.forEach((text, at) => {
        const own = outline(text);
        const of = text.attributes.class.split(" ")[0];
        for (const [x, y] of own)
          assert.ok(x > -1 && y > -1 && x < width + 1 && y < height + 1, `outside: ${said(text)}`);
        for (const other of texts.slice(at + 1))
          assert.ok(!overlap(own, outline(other)), `${other.textContent} over ${said(text)}`);
        if (of === "length" || (of === "transmission" && options.outlines)) return; // in rod or piston
        for (const hatching of hatched)
          assert.ok(!overlap(own, hatching), `over hatching: ${said(text)}`);
        if (of !== "dimension") return; // marks an angle of a link
        for (const link of links) {
          const [long, half] = link.attributes.d
            .match(/H([\d.]+)A([\d.]+)/)
            .slice(1)
            .map(Number);
          assert.ok(
            !overlap(own, corners(link, [0, -half, long, half])),
            `over a link: ${said(text)}`,
          );
        }
      });
    }
    picture.close();
  }
});
