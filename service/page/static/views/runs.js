import { fill, h } from "../lib/dom.js";

export const title = "Runs";

export async function show(place) {
  fill(place, h("h1", {}, title));
}
