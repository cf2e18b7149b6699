import { get, isAbort } from "../lib/api.js";
import { keepChoices, link } from "../lib/address.js";
import { fill, first, focused, h } from "../lib/dom.js";
import { gallery } from "../jobs/gallery.js";
import { STATES, stateWord } from "../jobs/states.js";
import { pictures } from "../jobs/pictures.js";
import { readySystem } from "../lib/numbers.js";
import { runRow } from "../jobs/row.js";
import { sentenceOf } from "../lib/refusals.js";

export const title = "Runs";

const EACH = 2000; // ms between polls while the page is visible
const PAGE = 25;
const SORTS = /** @type {const} */ (["newest", "oldest", "name", "state", "decided"]);

/** View of the list of runs, kept up to date while visible. @param {HTMLElement} place @param {Page.Visit} options */
export async function show(place, { query, signal }) {
  /** @type {{ state: string, name: string, before: string, sort: typeof SORTS[number] }} */
  const filters = {
    sort: SORTS.find((sort) => sort === query.get("sort")) ?? SORTS[0],
    state: query.get("state") ?? "",
    name: query.get("name") ?? "",
    before: query.get("before") ?? "",
  };
  const compared = new Set((query.get("jobs") ?? "").split(",").filter(Boolean).map(Number));
  /** @type {Map<number, { text: string, node: HTMLElement, held: string | null }>} */
  const rows = new Map(); // number: {text, node}
  const { picture, forget } = pictures(signal);
  const list = h("ul", { class: "runs" });
  const status = h("p", { class: "quiet", role: "status" });
  const pages = h("nav", { class: "row", "aria-label": "Pages" });
  const comparing = h("div", { class: "row" });
  const workers = h("span", { class: "quiet workers" });
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;

  const changed = () => {
    const sort = filters.sort === SORTS[0] ? null : filters.sort;
    keepChoices({ ...filters, sort, jobs: [...compared].join(",") });
  };
  const search = h(
    "form",
    { class: "row search", role: "search", onsubmit: (event) => event.preventDefault() },
    h(
      "label",
      {},
      "Name ",
      h("input", {
        type: "search",
        name: "name",
        value: filters.name,
        maxlength: 200,
        oninput: (event) => choose("name", event.currentTarget.value),
      }),
    ),
    h(
      "label",
      {},
      "State ",
      h(
        "select",
        { name: "state", onchange: (event) => choose("state", event.currentTarget.value) },
        h("option", { value: "" }, "all"),
        STATES.map((state) =>
          h("option", { value: state, selected: state === filters.state }, stateWord(state)),
        ),
      ),
    ),
    h(
      "label",
      {},
      "Sort by ",
      h(
        "select",
        {
          name: "sort",
          "aria-label": "Sort by",
          onchange: (event) => choose("sort", event.currentTarget.value),
        },
        SORTS.map((sort) => h("option", { selected: sort === filters.sort }, sort)),
      ),
    ),
    comparing,
    workers,
  );
  /** @param {"name" | "state" | "sort"} key @param {string} value */
  const choose = (key, value) => {
    Object.assign(filters, { [key]: value });
    filters.before = "";
    changed();
    clearTimeout(timer);
    timer = setTimeout(look, key === "name" ? 200 : 0);
  };
  /** @param {string} before */
  const turn = (before) => {
    filters.before = before;
    changed();
    look().then(() => first(place, "h1")?.scrollIntoView());
  };
  /** @param {number} number @param {boolean} yes */
  const compare = (number, yes) => {
    if (yes) compared.add(number);
    else compared.delete(number);
    changed();
    showComparing();
  };
  const showComparing = () => {
    const numbers = [...compared].sort((a, b) => a - b);
    fill(
      comparing,
      numbers.length > 1 &&
        h(
          "a",
          { class: "button primary", href: link(["compare"], { jobs: numbers.join(",") }) },
          `Compare ${numbers.length} runs`,
        ),
      numbers.length === 1 && h("span", { class: "quiet" }, "Tick another run to compare"),
    );
  };

  /** Poll now, and again after an interval. */
  async function look() {
    clearTimeout(timer);
    const before = filters.before || null;
    try {
      const [page] = await Promise.all([
        get(
          "jobs",
          {
            limit: PAGE,
            state: filters.state || null,
            name: filters.name || null,
            sort: filters.sort,
            before,
          },
          signal,
        ),
        readySystem(),
      ]);
      if (before !== (filters.before || null)) return;
      draw(page);
    } catch (problem) {
      if (isAbort(problem)) return;
      status.textContent = sentenceOf(problem);
    }
    if (!signal.aborted) timer = setTimeout(() => (document.hidden ? null : look()), EACH);
  }

  /** @param {Api.JobPage} page */
  function draw(page) {
    const wanted = page.jobs.map((job) => {
      const text = `${JSON.stringify(job)}${Math.floor(Date.now() / 60_000)}`;
      const drawnRow = rows.get(job.id);
      if (drawnRow?.text === text) return drawnRow.node;
      const focusedAct = (drawnRow && focused(drawnRow.node)?.dataset.act) ?? null;
      const node = runRow(job, {
        picture: picture(job),
        chosen: compared.has(job.id),
        compare,
        changed: look,
      });
      rows.set(job.id, { text, node, held: focusedAct });
      return node;
    });
    const same =
      wanted.length === list.children.length &&
      wanted.every((node, index) => list.children[index] === node);
    if (!same) {
      const focusedRow = page.jobs.map(({ id }) => rows.get(id)).find((row) => row?.held);
      fill(list, wanted);
      if (focusedRow)
        (
          first(focusedRow.node, `[data-act="${focusedRow.held}"]`) ?? first(focusedRow.node, "a")
        )?.focus();
      for (const row of rows.values()) row.held = null;
    }
    for (const number of rows.keys()) {
      if (page.jobs.some(({ id }) => id === number)) continue;
      rows.delete(number);
      forget(number);
    }
    workers.textContent = page.workers;
    const some = filters.name || filters.state || filters.before;
    const empty = !page.jobs.length && !some;
    place.classList.toggle("empty", empty);
    search.hidden = empty;
    welcome.hidden = !empty;
    single.hidden = empty; // shown by the welcome
    first(place, "h1")?.replaceChildren(empty ? "No runs yet" : title);
    if (empty) machines.begin();
    status.textContent =
      page.jobs.length || empty
        ? ""
        : filters.before
          ? "There are no further runs."
          : "No run matches; change the name or the state.";
    const { next } = page;
    fill(
      pages,
      filters.before && h("button", { type: "button", onclick: () => turn("") }, "First page"),
      next !== null &&
        h("button", { type: "button", onclick: () => turn(String(next)) }, "Next page"),
    );
  }

  const machines = gallery(signal);
  const single = h(
    "a",
    { class: "button", href: link(["look"]), hidden: true }, // shown while there are no runs
    "Look at one mechanism",
  );
  const welcome = h(
    "section",
    { class: "welcome", hidden: true },
    h(
      "p",
      { class: "lead" },
      "State what a slider-crank must do and what may vary: the search finds the best compromises and proves how good they are.",
    ),
    h(
      "p",
      { class: "row" },
      h("a", { class: "button primary", href: "#/new" }, "New run"),
      h("a", { class: "button", href: link(["look"]) }, "Look at one mechanism"),
    ),
    h("h2", {}, "Start from an example"),
    machines.node,
  );
  await new Promise((ready) => {
    fill(
      place,
      h(
        "div",
        { class: "row spread" },
        h("h1", {}, title),
        h(
          "div",
          { class: "row" },
          single,
          h("a", { class: "button primary", href: "#/new" }, "New run"),
        ),
      ),
      search,
      welcome,
      list,
      status,
      pages,
    );
    showComparing();
    look().then(ready);
  });
  const seen = () => document.hidden || look();
  document.addEventListener("visibilitychange", seen, { signal });
  signal.addEventListener("abort", () => clearTimeout(timer));
}
