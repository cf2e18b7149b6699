/** Freehand line around some designs. */

const MOST = 32; // corners, to keep links short

/**
 * Return whether a point is inside a closed line [[x, y], ...]: a ray from the point crosses the line an odd number of times.
 * @param {readonly Page.Point[]} line @param {number} x @param {number} y
 */
export function isInside(line, x, y) {
  let odd = false;
  for (let here = 0, before = line.length - 1; here < line.length; before = here, here += 1) {
    const [[x1, y1], [x2, y2]] = [line[here], line[before]];
    if (y1 > y !== y2 > y && x < x1 + ((y - y1) / (y2 - y1)) * (x2 - x1)) odd = !odd;
  }
  return odd;
}

/** Return a line with at most 32 of its corners, evenly spread. @param {readonly Page.Point[]} line */
export function thinned(line) {
  const step = Math.max(1, line.length / MOST);
  return Array.from(
    { length: Math.min(MOST, line.length) },
    (_, index) => line[Math.floor(index * step)],
  );
}

/** Draw a closed line of pixels on canvas. @param {Page.Canvas} context @param {readonly Page.Point[]} line @param {Page.Ink} ink */
export function drawLasso(context, line, ink) {
  context.beginPath();
  line.forEach(([x, y], index) => (index ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.closePath();
  Object.assign(context, { fillStyle: ink.mark, strokeStyle: ink.mark, lineWidth: 1.5 });
  context.globalAlpha = 0.12;
  context.fill();
  context.globalAlpha = 1;
  context.stroke();
}
