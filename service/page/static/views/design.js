import { get } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { drawing } from "../mechanism/drawing.js";

export const title = "Design";

export async function show(place, { parts, signal }) {
  const path = `jobs/${parts[1]}/designs/${parts[3]}`;
  const [{ design }, { curves, ...centres }] = await Promise.all([get(path, {}, signal), get(`${path}/curves`, {}, signal)]);
  const stage = h("div", { class: "panel" });
  fill(place, h("h1", {}, `Design ${parts[3]}`), stage);
  const mechanism = drawing(stage, { label: "The mechanism" });
  mechanism.show(design, curves, { dead_centres_deg: [centres.inner_dead_centre_deg, centres.outer_dead_centre_deg] });
  mechanism.forces(true);
  mechanism.turn(50);
}
