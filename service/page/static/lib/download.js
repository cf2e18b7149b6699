/** Files that the page makes itself. */

import { h } from "./dom.js";

/** Let the browser save a text as a file. @param {string} content @param {string} type @param {string} name */
export function download(content, type, name) {
  const link = h("a", { href: URL.createObjectURL(new Blob([content], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
