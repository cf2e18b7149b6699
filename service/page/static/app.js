/** Frame of the page: header, preferences, and the view named by the address. */

import { isAbort } from "./lib/api.js";
import { read } from "./lib/address.js";
import { byId, fill, first, focused, h } from "./lib/dom.js";
import { watchDownloads } from "./lib/download.js";
import { sayProblem } from "./lib/notices.js";
import { chooseSystem, readySystem, system } from "./lib/numbers.js";
import { readyKinds } from "./lib/units.js";
import { rememberScroll, restoreScroll } from "./lib/scroll_position.js";
import { sentenceOf } from "./lib/refusals.js";
import { renewTimes } from "./jobs/times.js";

/**
 * Views. Each module exports title (text) and show(place, {parts, query, signal}), which fills `place`, may return a promise, and stops
 * once `signal` is aborted. Its errors are shown in the place of the view.
 * @type {{ name: string, match: (parts: string[]) => boolean, load: () => Promise<Page.View> }[]}
 */
const VIEWS = [
  { name: "runs", match: (parts) => parts.length === 0, load: () => import("./views/runs.js") },
  {
    name: "new-run",
    match: (parts) => parts[0] === "new" && parts.length === 1,
    load: () => import("./views/new_run.js"),
  },
  {
    name: "look",
    match: (parts) => parts[0] === "look" && parts.length === 1,
    load: () => import("./views/look.js"),
  },
  {
    name: "compare",
    match: (parts) => parts[0] === "compare" && parts.length === 1,
    load: () => import("./views/compare.js"),
  },
  {
    name: "run",
    match: (parts) => parts[0] === "jobs" && parts.length === 2,
    load: () => import("./views/run.js"),
  },
  {
    name: "design",
    match: (parts) => parts[0] === "jobs" && parts[2] === "designs" && parts.length === 4,
    load: () => import("./views/design.js"),
  },
  {
    name: "help",
    match: (parts) => parts[0] === "help" && parts.length <= 2,
    load: () => import("./views/help.js"),
  },
];
const NAVIGATION = [
  ["Runs", "#/"],
  ["New run", "#/new"],
  ["Help", "#/help"],
];

const RENEW = 20_000; // ms between updates of the times on the page

let leaving = new AbortController();

/** Show the view for the address. again: whether to show the same view in other units. */
async function showView({ again = false } = {}) {
  leaving.abort();
  leaving = new AbortController();
  const { signal } = leaving;
  const { parts, query } = read();
  const restore = restoreScroll(signal);
  const main = byId("main");
  markNavigation();
  const place = h("div", { class: "view" }, h("p", { class: "quiet" }, "Loading …"));
  const changed = first(main, ".view") !== null;
  fill(main, place);
  try {
    const view = VIEWS.find(({ match }) => match(parts));
    if (!view) throw new Error("There is no such page.");
    place.classList.add(`of-${view.name}`); // prefix of the view's style rules
    const module = await view.load();
    if (signal.aborted) return;
    document.title = `${module.title} · slidercrank`;
    await module.show(place, { parts, query, signal });
    restore();
    // Leave the focus alone if it is already in the view: an open menu closes when it loses the focus.
    if (changed && !again && !signal.aborted && !focused(main)) main.focus({ preventScroll: true });
  } catch (error) {
    if (signal.aborted || isAbort(error)) return;
    document.title = "slidercrank";
    fill(
      place,
      h("h1", {}, "This cannot be shown"),
      h("p", {}, sentenceOf(error)),
      h("p", {}, h("a", { href: "#/" }, "All runs")),
    );
  }
}

function markNavigation() {
  const here = `#/${read().parts[0] ?? ""}`;
  fill(
    byId("nav"),
    NAVIGATION.map(([title, href]) =>
      h(
        "a",
        {
          href,
          "aria-current": href === here || (href === "#/" && here === "#/jobs") ? "page" : null,
        },
        title,
      ),
    ),
  );
}

function showPreferences() {
  const scheme = localStorage.getItem("scheme") ?? "auto";
  document.documentElement.dataset.scheme = scheme;
  /** @param {string} label @param {[string, string][]} options @param {string} value @param {(value: string) => unknown} choose */
  const choice = (label, options, value, choose) =>
    h(
      "label",
      {},
      h("span", { class: "hidden" }, label),
      h(
        "select",
        { onchange: (event) => choose(event.currentTarget.value) },
        options.map(([key, title]) => h("option", { value: key, selected: key === value }, title)),
      ),
    );
  fill(
    byId("preferences"),
    choice(
      "Units",
      [
        ["si", "mm, N"],
        ["inch", "inch, lbf"],
      ],
      system(),
      (name) => chooseSystem(name).then(() => showView({ again: true }), sayProblem),
    ),
    choice(
      "Colours",
      [
        ["auto", "Auto"],
        ["light", "Light"],
        ["dark", "Dark"],
      ],
      scheme,
      (name) => {
        localStorage.setItem("scheme", name);
        document.documentElement.dataset.scheme = name;
        window.dispatchEvent(new Event("scheme"));
      },
    ),
  );
}

document.querySelector(".skip")?.addEventListener("click", (event) => {
  event.preventDefault(); // addresses with # belong to the views
  byId("main").focus();
});
window.addEventListener("hashchange", () => showView());
setInterval(renewTimes, RENEW);
watchDownloads();
rememberScroll();
showPreferences();
const units = Promise.all([readySystem(), readyKinds()]).catch(() => {}); // views report errors of the service
if (system() === "inch") units.then(() => showView());
else showView();
