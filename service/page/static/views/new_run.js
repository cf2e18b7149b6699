/** View of a new run: the job form, checked during typing, with a sketch. */

import { checker } from "../form/check.js";
import { keepDraft, storedDraft, newKey } from "../form/draft.js";
import { showFacts } from "../form/facts.js";
import { showWrong } from "../form/field.js";
import { jobFile, presets } from "../form/job_file.js";
import { at, parsedPath, put, withRenamedKey, valueOf, pathText } from "../form/path.js";
import { reader } from "../form/schema.js";
import { sections } from "../form/sections.js";
import { readyKinds } from "../lib/units.js";
import { sketch } from "../form/sketch.js";
import { firstJob, jobAround } from "../form/start.js";
import { go, keepChoices, link } from "../lib/address.js";
import { get, isInfeasible, post, statusOf } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { system } from "../lib/numbers.js";
import { sentenceOf } from "../lib/refusals.js";

export const title = "New run";
const IMPOSSIBLE = "Impossible: no design can meet the requirements of this job.";

/** Return the remedy for the marked fields. @param {Api.Wrong[]} wrong */
const correction = (wrong) =>
  wrong.every(({ infeasible }) => infeasible)
    ? `${IMPOSSIBLE} Change the marked fields.`
    : "Correct the marked fields first.";

/** Show the form with the draft, an included job, or a copy of a job. @param {HTMLElement} place @param {Page.Visit} options */
export async function show(place, { query, signal }) {
  const [schema, { quantities, functions }, shipped] = await Promise.all([
    get("schema", {}, signal),
    get("quantities", {}, signal),
    presets(signal),
    readyKinds(),
  ]);
  const draft = await first(query, shipped, signal);
  if (signal.aborted) return;
  const before = storedDraft();
  build(place, {
    draft,
    before: before?.key === draft.key ? null : before,
    schema: reader(schema),
    quantities,
    functions,
    shipped,
    signal,
  });
}

/**
 * Return the draft for the address: first what was typed in it before.
 * @param {URLSearchParams} query @param {Api.Preset[]} shipped @param {AbortSignal} signal @returns {Promise<Form.Draft>}
 */
async function first(query, shipped, signal) {
  const [preset, from, around] = ["preset", "from", "around"].map((key) => query.get(key));
  const source = preset
    ? `preset ${preset}`
    : from
      ? `job ${from}`
      : around
        ? `around ${around}`
        : null;
  const before = storedDraft();
  if (before && (source === null || before.source === source)) return before;
  if (from)
    return {
      ...begin(await get(`jobs/${encodeURIComponent(from)}/job`, {}, signal), `job ${from}`),
      submission: history.state?.submission ?? {},
    };
  if (around) return begin(jobAround(system(), around.split(",").map(Number)), `around ${around}`);
  if (!preset) return begin(firstJob(system()), "");
  const machine = shipped.find(({ name }) => name === preset);
  if (!machine) throw new Error(`No example is called "${preset}".`);
  return begin(machine.job, `preset ${preset}`);
}

/** @param {Form.Job} job @param {string} source @returns {Form.Draft} */
function begin(job, source) {
  return { job: structuredClone(job), submission: {}, source, key: newKey() };
}

/** Return the origin of a draft that the address states. @param {string} source */
function addressOf(source) {
  const [kind, name] = source.split(" ");
  const key = { preset: "preset", job: "from", around: "around" }[kind];
  return key ? { [key]: name } : {};
}

/**
 * @param {HTMLElement} place
 * @param {{ draft: Form.Draft, before: Form.Draft | null, schema: ReturnType<typeof reader>, quantities: Api.Quantity[], functions: Api.Function[], shipped: Api.Preset[], signal: AbortSignal }} options
 */
function build(place, { draft, before, schema, quantities, functions, shipped, signal }) {
  /** @type {Api.Preview | null} */
  let checked = null; // the service's findings on the current job; null while unknown
  let undone = before; // the draft of another address
  const drawn = sketch(signal);
  const facts = h("div", {});
  const status = h("p", { role: "status", class: "status", tabindex: -1 });
  const general = h("ul", { class: "error", hidden: true });
  const refusal = h("p", { class: "error", role: "alert", hidden: true });
  const start = h("button", { type: "submit", class: "primary" }, "Start the search");
  const undo = h(
    "button",
    { type: "button", hidden: undone === null, onclick: () => undone && take(undone) },
    "Restore the previous job",
  );
  const body = h("div", { class: "sections" });

  /** @type {Form.Whole} */
  const form = {
    ...{
      schema,
      fields: [],
      quantities: new Map(quantities.map((one) => [one.name, one])),
      submission: draft.submission,
    },
    job: draft.job,
    at: (path) => at(form.job, path),
    put: (path, value) => {
      put(form.job, path, value);
      changed();
    },
    submit: (key, value) => {
      if (value === undefined) delete form.submission[key];
      else form.submission[key] = value;
      changed();
    },
    rename: (path, from, to, within) => {
      const table = /** @type {Record<string, unknown>} */ (at(form.job, path));
      put(form.job, path, withRenamedKey(table, from, to));
      for (const field of form.fields) {
        if (!within.contains(field.node)) continue;
        field.path = [...path, to, ...field.path.slice(path.length + 1)];
        field.key = pathText(field.path);
      }
      changed();
    },
    register: (one) => void form.fields.push(one),
    forget: (which) => void (form.fields = form.fields.filter((one) => !which(one))),
    said: null,
    names: () => [
      ...quantities,
      ...(form.said?.names ?? []),
      ...functions.map(({ name }) => ({ name, title: "function", unit: null, behind: "(" })),
    ],
    quantity: (name) => /** @type {Api.Quantity} */ (form.quantities.get(name)), // problems that the form itself reports
    judging: () => quantities.filter(({ name }) => schema.property(["objectives", name])),
    why: (name) => ({ sentence: form.quantity(name).sentence, name }),
    redraw,
  };
  const file = jobFile(form, (job, source) =>
    take(
      {
        ...begin(job, source === null ? draft.source : `file ${source}`),
        submission: form.submission,
      },
      { text: source === null },
    ),
  );
  const check = checker(({ answer, problem }) => {
    checked = answer ?? null;
    if (answer) showCheck(answer);
    else say(sentenceOf(problem));
  }, signal);

  function changed() {
    draft.key = newKey();
    keepDraft(draft);
    file.refresh();
    refusal.hidden = true;
    start.ariaDisabled = null;
    showChecking();
    check(form);
  }
  /** Show that what is said is of an earlier job. */
  function showChecking() {
    checked = null;
    facts.ariaBusy = "true";
    status.classList.remove("good");
    say("Checking …");
  }

  /** @param {string | null | undefined} focus */
  function redraw(focus = document.activeElement?.id) {
    /** @param {Element} one its title, without the line of what it has */
    const titled = (one) => one.querySelector(":scope > summary")?.firstChild?.textContent ?? "";
    const folds = [...body.querySelectorAll("details[open]")].map(titled);
    fill(body, sections(form));
    for (const fold of body.querySelectorAll("details")) fold.open = folds.includes(titled(fold));
    if (focus) document.getElementById(focus)?.focus();
    if (checked) mark(checked.wrong);
  }
  /**
   * Replace the draft; the old one can be restored.
   * @param {Pick<Form.Draft, "job" | "submission" | "source">} other @param {{ text?: boolean }} options
   */
  function take(other, { text = false } = {}) {
    if (!text) undone = structuredClone({ ...draft });
    Object.assign(draft, structuredClone(other), { key: newKey() });
    form.job = draft.job;
    form.said = null;
    form.submission = draft.submission;
    undo.hidden = undone === null;
    keepDraft(draft);
    keepChoices(addressOf(draft.source));
    redraw();
    file.refresh();
    showChecking();
    check(form, { now: true });
  }
  /** @param {Api.Wrong[]} wrong @param {{ missing?: boolean }} options */
  function mark(wrong, options = {}) {
    const { elsewhere, first: worst } = showWrong(form.fields, wrong, options);
    fill(
      general,
      elsewhere.map((sentence) => h("li", {}, sentence)),
    );
    general.hidden = !elsewhere.length;
    return worst;
  }
  /** @param {string} sentence */
  function say(sentence) {
    status.textContent = sentence;
  }
  /** @param {Api.Preview} answer */
  function showCheck(answer) {
    form.said = answer;
    facts.ariaBusy = "false";
    for (const field of form.fields.slice()) field.tell?.();
    document.activeElement?.dispatchEvent(new Event("names")); // the mistakes may have changed
    const worst = mark(answer.wrong);
    const count = answer.wrong.filter(({ infeasible }) => !infeasible).length;
    status.classList.toggle("good", answer.wrong.length === 0);
    if (count)
      fill(
        status,
        h(
          "button",
          { type: "button", onclick: () => worst?.controls[0].focus() },
          count === 1 ? "One thing to correct." : `${count} things to correct.`,
        ),
      );
    else say(answer.wrong.length ? IMPOSSIBLE : "Ready to start.");
    start.ariaDisabled = answer.wrong.length && !count ? "true" : null; // not disabled, so that Enter still reports what to change
    showFacts(facts, answer, ({ path, value }) => {
      form.put(parsedPath(path), value ?? undefined);
      redraw();
      status.focus();
    });
    if (answer.swing) drawn.swing(answer.swing);
    else drawn.show(answer.example, answer.allowed !== null);
  }

  /** @param {SubmitEvent} event */
  async function submit(event) {
    event.preventDefault();
    refusal.hidden = true;
    if (checked?.wrong.length) {
      const worst = mark(checked.wrong, { missing: true });
      worst?.controls[0].focus();
      refuse(correction(checked.wrong));
      return;
    }
    start.disabled = true;
    keepDraft(draft); // with its key: after a lost response, the same submission is sent again
    const { priority, ...limits } = form.submission;
    const { from } = addressOf(draft.source);
    try {
      const job = await post(
        "jobs",
        {
          job: form.job,
          ...(priority === undefined ? {} : { priority }),
          limits,
          origin: from ? Number(from) : null,
        },
        { headers: { "Idempotency-Key": draft.key } },
      );
      keepDraft(null);
      if (signal.aborted) return;
      history.replaceState({ ...history.state, submission: form.submission }, ""); // the Back button leads to the form as submitted
      keepChoices({ from: job.id });
      go(["jobs", String(job.id)]);
    } catch (error) {
      start.disabled = false;
      const lines = (error instanceof Error ? error.message : "")
        .split("\n")
        .map((line) => line.trim())
        .filter((line) => line && !/^\d+ problems$/.test(line));
      const wrong = lines
        .flatMap((line) => [/^([^:]+): (.+)$/s.exec(line.replace(/^body (limits\.)?/, "")) ?? []])
        .filter((found) => found.length);
      const infeasible = isInfeasible(error);
      const refused = wrong.map(([, path, sentence]) => ({
        path: path in form.submission ? `submission.${path}` : path,
        sentence,
        infeasible,
      }));
      const { first: marked, elsewhere } =
        statusOf(error) === 422 ? showWrong(form.fields, refused) : { first: null, elsewhere: [] };
      refuse(marked && !elsewhere.length ? correction(refused) : sentenceOf(error));
    }
  }
  /** @param {string} sentence */
  function refuse(sentence) {
    refusal.textContent = sentence;
    refusal.hidden = false;
  }

  const from = h(
    "select",
    {
      id: "preset",
      onchange: () => {
        const chosen = shipped.find(({ name }) => name === from.value);
        if (!chosen) return;
        take(begin(chosen.job, `preset ${chosen.name}`));
        from.value = "";
      },
    },
    h("option", { value: "" }, "choose …"),
    shipped.map(({ name, title: text }) => h("option", { value: name }, text)),
  );
  const over = h(
    "button",
    {
      type: "button",
      onclick: () => {
        take(begin(firstJob(system()), ""));
        keepDraft(null);
      },
    },
    "Start over",
  );

  const whole = h(
    "form",
    {
      class: "new-run",
      novalidate: true,
      autocomplete: "off",
      onsubmit: submit,
      ondragover: (event) => event.preventDefault(),
      ondrop: (event) => {
        event.preventDefault();
        const [droppedFile] = event.dataTransfer?.files ?? [];
        if (droppedFile) file.load(droppedFile);
      },
    },
    h(
      "div",
      { class: "head" },
      h("h1", {}, title),
      h(
        "div",
        { class: "row" },
        h("label", { for: "preset" }, "Start from an example"),
        from,
        over,
        undo,
        h("a", { href: link(["look"]) }, "Look at one mechanism"),
      ),
    ),
    h(
      "div",
      { class: "both" },
      h("div", {}, body, file.node),
      h(
        "aside",
        { class: "beside panel", "aria-label": "What this allows" },
        h("h2", {}, "What this allows"),
        drawn.node,
        facts,
        general,
        h("div", { class: "go" }, status, start, refusal),
      ),
    ),
  );
  whole.addEventListener("value-of", (event) => {
    if (event instanceof CustomEvent) event.detail.value = valueOf(form, event.detail.name);
  });
  fill(place, whole);
  redraw(null);
  file.refresh();
  say("Checking …");
  check(form, { now: true });
}
