/** The API of the service that this page came from. */

const PREFIX = "api/v1";

/** What the service refused, in its own sentence; status 0 is no answer at all. */
export class Problem extends Error {
  constructor(status, detail) {
    super(detail);
    this.status = status;
  }
}

/** Return the address of something in the API; query: an object, its arrays repeat a key, null leaves one out. */
export function address(path, query = {}) {
  const parameters = new URLSearchParams();
  for (const [key, value] of Object.entries(query)) {
    for (const one of Array.isArray(value) ? value : [value]) {
      if (one !== null && one !== undefined) parameters.append(key, one);
    }
  }
  const text = parameters.toString();
  return `${PREFIX}/${path}${text ? `?${text}` : ""}`;
}

/** Return what is at a path, as JSON. Throws a Problem; AbortError once `signal` is aborted. */
export function get(path, query = {}, signal = undefined) {
  return ask("GET", address(path, query), undefined, signal);
}

/** Send JSON and return the answer. headers: further ones. */
export function post(path, body = undefined, { signal, headers } = {}) {
  return ask("POST", address(path), body, signal, headers);
}

/** Delete what is at a path. */
export function remove(path) {
  return ask("DELETE", address(path));
}

async function ask(method, url, body, signal, headers = {}) {
  const options = { method, signal, headers: { Accept: "application/json", ...headers } };
  if (body !== undefined) {
    options.headers["Content-Type"] ??= "application/json";
    options.body = typeof body === "string" ? body : JSON.stringify(body);
  }
  let response;
  try {
    response = await fetch(url, options);
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Problem(0, "The service does not answer; the page goes on when it is back.");
  }
  if (response.status === 401) location.reload(); // the service asks for its token, and comes back to this view
  if (response.status === 204) return null;
  const text = await response.text();
  let answer = null;
  try {
    answer = text ? JSON.parse(text) : null;
  } catch {
    throw new Problem(response.status, `The answer was no JSON (status ${response.status}).`);
  }
  if (!response.ok) throw new Problem(response.status, answer?.detail ?? `The service answered ${response.status}.`);
  return answer;
}
