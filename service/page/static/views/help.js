import { fill, h } from "../lib/dom.js";

export const title = "Help";

export async function show(place) {
  fill(place, h("h1", {}, title));
}
