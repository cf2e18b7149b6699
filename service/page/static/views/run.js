import { actions } from "../jobs/actions.js";
import { downloads } from "../jobs/downloads.js";
import { outcome } from "../jobs/outcome.js";
import { badge, ENDED } from "../jobs/states.js";
import { moment } from "../jobs/times.js";
import { get, isAbort, Problem, statusOf } from "../lib/api.js";
import { go, link, read } from "../lib/address.js";
import { fill, first, focused, h } from "../lib/dom.js";
import { counted, grouped, readySystem } from "../lib/numbers.js";

export const title = "Run";

const SIZES = ["crank_mm", "rod_mm", "offset_mm"];

/** View of a run: its progress during the search, then the explorer of its front. @param {HTMLElement} place @param {Page.Visit} options */
export async function show(place, { parts, signal }) {
  const number = Number(parts[1]);
  if (!Number.isInteger(number) || number < 1)
    throw new Problem(404, "A run must be given by its number; choose one from the list.");
  const head = h("header", { class: "run-head" });
  const body = h("div", { class: "run-body" });
  const files = h("ul"); // written by the explorer of the front
  const decision = h("p", { class: "decision", hidden: true });
  /** @type {{ control: AbortController, live: boolean } | null} */
  let inner = null; // ends the current body
  const explorer = import("../front/explorer.js"); // loads during the request for the job

  /** Show a job in its current state; null if it was deleted. @param {Api.Job | null} job */
  async function showJob(job) {
    if (signal.aborted) return;
    if (job === null) {
      inner?.control.abort();
      fill(
        place,
        h("h1", {}, `Run ${number} no longer exists`),
        h("p", {}, "It was deleted, here or elsewhere."),
        h("p", {}, h("a", { class: "button", href: "#/" }, "All runs")),
      );
      return;
    }
    document.title = `${job.name} · slidercrank`;
    const live = !ENDED.includes(job.state);
    const watched = live && inner?.live;
    if (!watched) {
      inner?.control.abort();
      const control = new AbortController();
      inner = { control, live };
      signal.addEventListener("abort", () => control.abort(), { signal: control.signal });
    }
    const bodySignal = /** @type {{ control: AbortController }} */ (inner).control.signal;
    const pendingFront =
      live || !job.summary?.designs ? null : designs(job.id, job.summary.best, bodySignal); // requested while the head is drawn
    pendingFront?.catch(() => {}); // whoever awaits it reports the failure
    const hadFocus = focused(head);
    drawHead(job);
    if (hadFocus) first(head, "button:not(.skip), summary, a")?.focus();
    if (watched) return;
    if (live) {
      const [{ showProgress }] = await Promise.all([import("../jobs/live.js"), readySystem()]);
      if (!bodySignal.aborted) showProgress(body, job, { signal: bodySignal, changed: showJob });
    } else await ended(job, pendingFront, bodySignal);
  }

  /**
   * Request the columns that the explorer shows by default.
   * @param {number} id @param {object} best of the objectives, by column @param {AbortSignal} own
   */
  function designs(id, best, own) {
    const columns = [...SIZES, ...Object.keys(best)].join(",");
    return Promise.all([
      get(`jobs/${id}/front`, {}, own),
      get(`jobs/${id}/columns`, { columns }, own),
    ]);
  }

  /** @param {Api.Job} job */
  function drawHead(job) {
    const summary = ENDED.includes(job.state) ? job.summary : null; // outdated after a resumed search
    const facts = [
      `run ${job.id}`,
      summary && counted(summary.designs, "design"),
      summary && `${grouped(summary.evaluations)} evaluated`,
    ];
    fill(
      head,
      summary?.designs
        ? h(
            "button",
            { type: "button", class: "skip", onclick: skipToTable },
            "Skip to the table of designs",
          )
        : null,
      h(
        "div",
        {},
        h("h1", {}, job.name),
        h(
          "p",
          { class: "quiet facts" },
          badge(job),
          " · ",
          facts.filter(Boolean).join(" · "),
          " · ",
          moment(job),
          job.origin
            ? [
                " · changed from ",
                h("a", { href: link(["jobs", job.origin]) }, `run ${job.origin}`),
              ]
            : null,
        ),
        decision,
      ),
      h(
        "div",
        { class: "row acts" },
        actions(job, (now) => (now === null ? gone() : showJob(now)), { primary: true }),
        downloads(job, { designs: Boolean(summary?.designs), own: files, signal }),
      ),
    );
  }

  /** Skips the charts. */
  function skipToTable() {
    const part = first(body, ".the-table");
    if (!part) return;
    part.tabIndex = -1;
    part.focus();
    part.scrollIntoView();
  }

  function gone() {
    go([]);
  }

  /** @param {Api.Job} job @param {ReturnType<typeof designs> | null} asked @param {AbortSignal} own */
  async function ended(job, asked, own) {
    const place = asked && h("div", { class: "explorer" });
    fill(body, outcome(job), place);
    if (!place || !asked) return;
    try {
      const [[front, { values }], { explore }] = await Promise.all([asked, explorer]);
      await explore(place, {
        job,
        front,
        values,
        query: read().query,
        files,
        decision,
        signal: own,
      });
    } catch (problem) {
      if (isAbort(problem)) return;
      if (statusOf(problem) === 404) await showJob(null);
      else throw problem;
    }
  }

  const job = await get(`jobs/${number}`, {}, signal);
  fill(place, head, body);
  await showJob(job);
}
