/** Files made by the page, and files of the service, with a message while they are being made. */

import { fetchResponse, Problem, statusOf } from "./api.js";
import { h } from "./dom.js";
import { say, sayProblem } from "./notices.js";

const SOON = 400; // ms without a message

/** Let the browser save a text as a file. @param {string} content @param {string} type @param {string} name */
export function download(content, type, name) {
  save(new Blob([content], { type }), name);
}

/** @param {Blob} content @param {string} name */
function save(content, name) {
  const link = h("a", { href: URL.createObjectURL(content), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Handle links to files of the service: show them as busy while a file is made, and report failures. */
export function watchDownloads() {
  document.addEventListener("click", (event) => {
    const link = event.target instanceof Element ? event.target.closest("a[download]") : null;
    if (
      !(link instanceof HTMLAnchorElement) ||
      !link.href.includes("/api/") ||
      event.ctrlKey ||
      event.metaKey ||
      event.shiftKey ||
      event.altKey
    )
      return;
    event.preventDefault();
    if (link.getAttribute("aria-busy") !== "true") fetched(link).catch(sayProblem);
  });
}

/** @param {HTMLAnchorElement} link */
async function fetched(link) {
  link.setAttribute("aria-busy", "true");
  const title = link.getAttribute("aria-label") ?? link.textContent ?? "";
  const notice = setTimeout(() => say(`${title} is being made.`), SOON);
  try {
    const response = await fetchResponse("GET", link.href);
    if (!response.ok) {
      const problem = await response.json().catch(() => ({}));
      throw new Problem(
        response.status,
        problem.detail ?? `The service answered with status ${response.status}.`,
      );
    }
    const named = /filename="([^"]+)"/.exec(response.headers.get("Content-Disposition") ?? "");
    save(
      await response.blob(),
      named?.[1] ?? (link.download || new URL(link.href).pathname.split("/").at(-1) || "file"),
    );
  } catch (error) {
    throw error instanceof TypeError || statusOf(error) === 0
      ? new Problem(0, "The service is not responding; try again when it is back up.")
      : error;
  } finally {
    clearTimeout(notice);
    link.removeAttribute("aria-busy");
  }
}
