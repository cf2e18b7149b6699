/** The job as a file: its text beside the form, synchronised with it; loaded from a file and saved as one. */

import { address, fetchResponse, get, post, Problem } from "../lib/api.js";
import { h, markInvalid } from "../lib/dom.js";
import { download } from "../lib/download.js";
import { attempt, say } from "../lib/notices.js";
import { sentenceOf } from "../lib/refusals.js";

const WAIT = 300; // ms from the last keystroke until the text is taken into the form

/**
 * Return {node, refresh}: the part of the form with the job as text. taken(job, source): called with a job from text or a file.
 * @param {Form.Whole} form @param {(job: Form.Job, source: string | null) => void} taken
 */
export function jobFile(form, taken) {
  const wrong = h("p", { class: "error", id: "job-text-error", hidden: true });
  const text = h("textarea", {
    id: "job-text",
    rows: 16,
    spellcheck: "false",
    "aria-describedby": "job-text-error",
    oninput: () => {
      clearTimeout(timer);
      timer = setTimeout(read, WAIT);
    },
  });
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  function read() {
    let job = null;
    let problem = "";
    try {
      job = JSON.parse(text.value);
      if (job === null || typeof job !== "object" || Array.isArray(job))
        problem = "A job is a JSON object; put it in braces.";
    } catch (error) {
      problem = `This is not valid JSON yet: ${sentenceOf(error)}`;
    }
    wrong.textContent = problem;
    wrong.hidden = !problem;
    markInvalid(text, problem);
    if (!problem) taken(job, null);
  }

  const file = h("input", {
    type: "file",
    id: "job-import",
    accept: ".toml,.json,application/json,application/toml",
    class: "hidden",
    tabindex: "-1",
    "aria-label": "Job file to import",
    onchange: () => {
      const [chosenFile] = file.files ?? [];
      if (chosenFile) load(chosenFile);
      file.value = "";
    },
  });
  /** @param {File} chosenFile */
  function load(chosenFile) {
    return attempt(async () => {
      taken(await jobOf(chosenFile), chosenFile.name);
      say(`${chosenFile.name} has been loaded into the form.`);
    });
  }

  /** @param {"json" | "toml"} kind */
  const save = (kind) =>
    attempt(async () =>
      download(
        kind === "json" ? `${JSON.stringify(form.job, null, 2)}\n` : await toml(form.job),
        `application/${kind}`,
        `${slug(form.job.name)}.${kind}`,
      ),
    );
  const node = h(
    "section",
    { class: "panel", "aria-labelledby": "s-file" },
    h("h2", { id: "s-file" }, "Job file"),
    h(
      "p",
      { class: "row" },
      h("button", { type: "button", onclick: () => file.click() }, "Import a file …"),
      h("button", { type: "button", onclick: () => save("toml") }, "Download TOML"),
      h("button", { type: "button", onclick: () => save("json") }, "Download JSON"),
      file,
      h("span", { class: "quiet" }, "or drop a .toml or .json file on the page"),
    ),
    h(
      "details",
      { class: "more" },
      h("summary", {}, "The job as text"),
      h(
        "p",
        { class: "quiet" },
        "Always the same as the form. Enter here anything that has no field in the form.",
      ),
      h("label", { class: "hidden", for: "job-text" }, "Job as JSON"),
      text,
      wrong,
    ),
  );
  return {
    node,
    load,
    refresh: () => {
      if (document.activeElement === text) return;
      text.value = JSON.stringify(form.job, null, 2);
      wrong.hidden = true;
      markInvalid(text, false);
    },
  };
}

/** @param {File} file @returns {Promise<Form.Job>} */
async function jobOf(file) {
  if (file.size > 1e6)
    throw new Problem(0, "A job file must be at most 1 MB in size; is it the right file?");
  const content = await file.text();
  if (!/\.json$/i.test(file.name))
    return (await post("parse", content, { headers: { "Content-Type": "application/toml" } })).job;
  let job = null;
  try {
    job = JSON.parse(content);
  } catch (error) {
    throw new Problem(0, `${file.name} is not valid JSON: ${sentenceOf(error)}`);
  }
  if (job === null || typeof job !== "object" || Array.isArray(job))
    throw new Problem(0, "A job is a JSON object; put it in braces.");
  return job;
}

/** @param {Form.Job} job */
async function toml(job) {
  const response = await fetchResponse("POST", address("toml"), {
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ job }),
  });
  if (!response.ok) throw new Problem(response.status, (await response.json()).detail);
  return response.text();
}

/** @param {unknown} name */
function slug(name) {
  return (
    String(name ?? "")
      .toLowerCase()
      .replace(/[^a-z0-9]+/g, "-")
      .replace(/^-|-$/g, "") || "job"
  );
}

/** Return the included jobs. @param {AbortSignal} signal */
export async function presets(signal) {
  return (await get("presets", {}, signal)).presets;
}
