/** What takes a moment: sensitivity and tolerances of a design, when the reader comes to it. */

import { fill } from "../lib/dom.js";

/** Put the topics into `place`. */
export function topics(place) {
  fill(place);
}
