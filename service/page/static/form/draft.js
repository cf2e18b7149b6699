/** Draft of the form, kept in this tab until the run is started or started over. */

const KEY = "new-run";

/** Return the draft {job, submission, source, key}; null if there is none. @returns {Form.Draft | null} */
export function storedDraft() {
  try {
    const draft = JSON.parse(sessionStorage.getItem(KEY) ?? "null");
    return draft && typeof draft.job === "object" ? draft : null;
  } catch {
    return null;
  }
}

/** Store a draft; null deletes it. @param {Form.Draft | null} draft */
export function keepDraft(draft) {
  try {
    if (draft === null) sessionStorage.removeItem(KEY);
    else sessionStorage.setItem(KEY, JSON.stringify(draft));
  } catch {
    // Without storage in the browser, the form works until it is closed.
  }
}

/** Return a new submission key: the same form sent twice is one job. */
export function newKey() {
  const bytes = crypto.getRandomValues(new Uint8Array(16)); // randomUUID exists only on https and localhost
  return [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}
