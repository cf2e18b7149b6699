/** Canvas layers and the colours of values. */

import { h } from "../lib/dom.js";

export const FONT = "12px Inter, system-ui, sans-serif"; // of charts on canvas
const VIRIDIS = [
  "#440154",
  "#482475",
  "#414487",
  "#355f8d",
  "#2a788e",
  "#21918c",
  "#22a884",
  "#44bf70",
  "#7ad151",
  "#bddf26",
  "#fde725",
]; // in steps of a tenth

/**
 * Return stacked layers: {place, resize(width, height), contexts}; lengths in CSS pixels.
 * @param {number} count @param {string} label
 */
export function canvasLayers(count, label) {
  const canvases = Array.from({ length: count }, () => h("canvas", { "aria-hidden": "true" }));
  const place = h("div", { class: "layers", role: "img", "aria-label": label }, canvases);
  const contexts = canvases.map((canvas) => /** @type {Page.Canvas} */ (canvas.getContext("2d")));
  const fine = Math.min(2, window.devicePixelRatio || 1);
  return {
    place,
    contexts,
    top: canvases[count - 1],
    /**
     * Resize and clear all layers. plain: layers in CSS pixels instead of device pixels.
     * @param {number} width @param {number} height @param {readonly number[]} plain
     */
    resize(width, height, plain = []) {
      place.style.height = `${height}px`;
      canvases.forEach((canvas, index) => {
        const factor = plain.includes(index) ? 1 : fine;
        canvas.width = Math.round(width * factor);
        canvas.height = Math.round(height * factor);
        contexts[index].setTransform(factor, 0, 0, factor, 0, 0);
      });
    },
    /** Show or hide a layer. @param {number} index @param {boolean} shown */
    show(index, shown) {
      canvases[index].style.visibility = shown ? "visible" : "hidden";
    },
    /** Clear a layer. @param {number} index */
    clear(index) {
      const context = contexts[index];
      context.save();
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.clearRect(0, 0, canvases[index].width, canvases[index].height);
      context.restore();
    },
  };
}

/**
 * Draw 3-pixel squares in colours[of[i]] for the rows of `mask`, or for all rows without a mask. They replace the content of the layer,
 * which is in CSS pixels.
 * @param {Page.Canvas} context @param {ArrayLike<number>} across @param {ArrayLike<number>} up @param {Uint8Array | null} mask @param {Uint8Array} of
 * @param {string[]} colours
 */
export function drawSquares(context, across, up, mask, of, colours) {
  const { width, height } = context.canvas;
  const image = new ImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  const inks = Uint32Array.from(colours, (colour) => {
    const [red, green, blue] = rgb(colour);
    return ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
  });
  for (let row = 0; row < across.length; row += 1) {
    if (mask && !mask[row]) continue;
    const [x, y] = [Math.round(across[row]) - 1, Math.round(up[row]) - 1];
    if (!(x >= 0 && y >= 0 && x < width - 2 && y < height - 2)) continue;
    const ink = inks[of[row]];
    for (let place = y * width + x, line = 0; line < 3; line += 1, place += width)
      pixels[place] = pixels[place + 1] = pixels[place + 2] = ink;
  }
  context.putImageData(image, 0, 0);
}

/**
 * Write text that stays readable on any drawing, with an outline in the background colour.
 * @param {Page.Canvas} context @param {string} words @param {number} x @param {number} y @param {Page.Ink} ink @param {number} edge pixels
 */
export function writeOver(context, words, x, y, ink, edge = 3) {
  Object.assign(context, { lineWidth: edge, strokeStyle: ink.panel, fillStyle: ink.text });
  context.strokeText(words, x, y);
  context.fillText(words, x, y);
}

/** Return [r, g, b] for a colour such as "#0b5c8a" or one of a ramp. @param {string} colour @returns {number[]} */
export function rgb(colour) {
  if (colour.startsWith("rgb")) return (colour.match(/\d+/g) ?? []).map(Number);
  const digits = parseInt(colour.slice(1), 16);
  return [digits >> 16, (digits >> 8) & 255, digits & 255];
}

/**
 * Return `count` colours from low to high: viridis, by S. van der Walt and N. Smith (public domain), perceptually uniform, without the
 * end that blends into the background.
 * @param {Page.Ink} ink @param {number} count
 */
export function ramp(ink, count) {
  const dark = rgb(ink.panel).reduce((sum, part) => sum + part, 0) < 384;
  const stops = (dark ? VIRIDIS.slice(3) : VIRIDIS.slice(0, -2)).map(rgb);
  return Array.from({ length: count }, (_, index) => {
    const place = (index / Math.max(1, count - 1)) * (stops.length - 1);
    const left = Math.min(stops.length - 2, Math.floor(place));
    const share = place - left;
    const mixed = stops[left].map((part, channel) =>
      Math.round(part + share * (stops[left + 1][channel] - part)),
    );
    return `rgb(${mixed.join(" ")})`;
  });
}

/** Return the colours of categories: the series colours, repeated. @param {Page.Ink} ink @param {number} count */
export function palette(ink, count) {
  return Array.from({ length: count }, (_, index) => ink[`series-${1 + (index % 6)}`]);
}
