import { fill, h } from "../lib/dom.js";

export const title = "New run";

export async function show(place) {
  fill(place, h("h1", {}, title));
}
