/** Draft of the form, kept in this tab until the run is started or started over. */

const KEY = "new-run";

/** Return the draft {job, submission, source, key}; null if there is none. @returns {Form.Draft | null} */
export function kept() {
  try {
    const draft = JSON.parse(sessionStorage.getItem(KEY) ?? "null");
    return draft && typeof draft.job === "object" ? draft : null;
  } catch {
    return null;
  }
}

/** Keep a draft; null forgets it. @param {Form.Draft | null} draft */
export function keepDraft(draft) {
  try {
    if (draft === null) sessionStorage.removeItem(KEY);
    else sessionStorage.setItem(KEY, JSON.stringify(draft));
  } catch {
    // The browser stores nothing: the form works until it is closed.
  }
}

/** Return a new key of a submission: the same form sent twice is one job. */
export function newKey() {
  const bytes = crypto.getRandomValues(new Uint8Array(16)); // randomUUID is there on https and localhost only
  return [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}
