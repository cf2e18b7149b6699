/** API of the service that delivered this page. */

import { askForToken } from "./token.js";

const PREFIX = "api/v1";
const LONGEST = 30; // default wait before a request is repeated, s

/** Refusal by the service, in its own words; status 0: no response. */
export class Problem extends Error {
  /** @param {number} status @param {string} detail @param {string} [type] */
  constructor(status, detail, type = "about:blank") {
    super(detail);
    this.status = status;
    this.type = type;
  }
}

/** Whether an error is an abort. @type {(error: unknown) => boolean} */
export function isAbort(error) {
  return error instanceof Error && error.name === "AbortError";
}

/** Return the HTTP status of a Problem; null for any other error. @type {(error: unknown) => number | null} */
export function statusOf(error) {
  return error instanceof Problem ? error.status : null;
}

/** Whether the request is valid but no design can meet it. @type {(error: unknown) => boolean} */
export function isInfeasible(error) {
  return error instanceof Problem && error.type === "infeasible";
}

/**
 * Return an address in the API. query: arrays repeat their key, null omits it.
 * @param {string} path @param {Api.Query} query
 */
export function address(path, query = {}) {
  const parameters = new URLSearchParams();
  for (const [key, value] of Object.entries(query)) {
    for (const item of Array.isArray(value) ? value : [value]) {
      if (item !== null && item !== undefined) parameters.append(key, String(item));
    }
  }
  const text = parameters.toString();
  return `${PREFIX}/${path}${text ? `?${text}` : ""}`;
}

/**
 * Return the JSON at a path. Throws a Problem, or an AbortError once `signal` is aborted.
 * @template {Api.Text} Path
 * @param {Path} path
 * @param {Api.Query} query
 * @param {AbortSignal} [signal]
 * @returns {Promise<Api.Answer<"get", Path>>}
 */
export function get(path, query = {}, signal = undefined) {
  return ask("GET", address(path, query), undefined, signal);
}

/** Return the text at a path. Throws as `get` does. @param {string} path @param {Api.Query} query @param {AbortSignal} [signal] */
export async function getText(path, query = {}, signal = undefined) {
  const response = await fetchResponse("GET", address(path, query), { signal });
  const text = await response.text();
  if (!response.ok)
    throw new Problem(response.status, `The service answered with status ${response.status}.`);
  return text;
}

/**
 * Send JSON and return the response. headers: further headers.
 * @template {Api.Text} Path
 * @param {Path} path
 * @param {unknown} body
 * @param {{ query?: Api.Query, signal?: AbortSignal, headers?: Record<string, string> }} options
 * @returns {Promise<Api.Answer<"post", Path>>}
 */
export function post(path, body = undefined, { query, signal, headers } = {}) {
  return ask("POST", address(path, query), body, signal, headers);
}

/**
 * Send JSON and return the last event of the response stream; told(data): called with each earlier event. The service stops once `signal`
 * is aborted.
 * @template {Api.Text} Path
 * @param {Path} path
 * @param {unknown} body
 * @param {{ query?: Api.Query, signal: AbortSignal, told: (data: Record<string, unknown>) => void }} options
 * @returns {Promise<Api.Answer<"post", Path>>}
 */
export async function postWithProgress(path, body, { query, signal, told: onProgress }) {
  const headers = { Accept: "text/event-stream", "Content-Type": "application/json" };
  const response = await fetchResponse("POST", address(path, query), {
    headers,
    signal,
    body: JSON.stringify(body),
  });
  if (!response.ok) return jsonOf(response);
  const reader = /** @type {ReadableStream<Uint8Array>} */ (response.body).getReader();
  const decoder = new TextDecoder();
  let text = "";
  for (let chunk = await reader.read(); !chunk.done; chunk = await reader.read()) {
    text += decoder.decode(chunk.value, { stream: true });
    const events = text.split("\n\n");
    text = /** @type {string} */ (events.pop());
    for (const event of events) {
      const data = parsed(event.replace(/^.*?^data: /ms, ""));
      if (event.startsWith("event: progress")) onProgress(data);
      else return data;
    }
  }
  throw new Problem(0, "The service did not finish its answer; try again.");
}

/**
 * Change the resource at a path, and return it.
 * @template {Api.Text} Path
 * @param {Path} path
 * @param {unknown} body
 * @returns {Promise<Api.Answer<"patch", Path>>}
 */
export function patch(path, body) {
  return ask("PATCH", address(path), body);
}

/**
 * Delete the resource at a path.
 * @template {Api.Text} Path
 * @param {Path} path
 */
export function remove(path) {
  return ask("DELETE", address(path));
}

/**
 * The tests of the service ensure that responses match the API description.
 * @param {string} method @param {string} url @param {unknown} [body] @param {AbortSignal} [signal] @param {Record<string, string>} [more]
 */
async function ask(method, url, body, signal, more = {}) {
  /** @type {Record<string, string>} */
  const headers = { Accept: "application/json", ...more };
  if (body !== undefined) headers["Content-Type"] ??= "application/json";
  const sent = body === undefined || typeof body === "string" ? body : JSON.stringify(body);
  return jsonOf(await fetchResponse(method, url, { signal, headers, body: sent }));
}

/** Return the JSON of a response. Throws a Problem for a refusal. @param {Response} response */
async function jsonOf(response) {
  if (response.status === 204) return null;
  const text = await response.text();
  let answer = null;
  try {
    answer = text ? parsed(text) : null;
  } catch {
    throw new Problem(response.status, `The answer was not JSON (status ${response.status}).`);
  }
  if (!response.ok)
    throw new Problem(
      response.status,
      answer?.detail ?? `The service answered with status ${response.status}.`,
      answer?.type,
    );
  return answer;
}

/** @param {string} text */
function parsed(text) {
  return JSON.parse(text, /"-?inf"/.test(text) ? infinite : undefined);
}

/** Return an infinite number from its text in a table cell. @param {string} key @param {unknown} value */
function infinite(key, value) {
  if (
    (value !== "inf" && value !== "-inf") ||
    key === "name" ||
    key === "title" ||
    key.startsWith("choice_")
  )
    return value;
  return value === "inf" ? Infinity : -Infinity;
}

/**
 * Return a response of any status. If the token is missing, the user is asked for it and the request is repeated. A GET that a busy
 * service postpones is repeated at the stated time, at most three times.
 * @param {string} method @param {string} url @param {RequestInit} options @param {number} left times that it may be sent again @returns {Promise<Response>}
 */
export async function fetchResponse(method, url, options = {}, left = 3) {
  let response;
  try {
    response = await fetch(url, { method, ...options });
  } catch (error) {
    if (isAbort(error)) throw error;
    throw new Problem(
      0,
      "The service is not responding; this page will continue when it is back up.",
    );
  }
  const seconds = Number(response.headers.get("Retry-After"));
  if (response.status === 503 && method === "GET" && left > 0 && seconds > 0) {
    await waitFor(1000 * Math.min(seconds, LONGEST), options.signal);
    return fetchResponse(method, url, options, left - 1);
  }
  return response.status === 401 && (await askForToken())
    ? fetchResponse(method, url, options)
    : response;
}

/** Wait for a number of ms. Throws an AbortError once `signal` is aborted. @param {number} ms @param {AbortSignal | null} [signal] */
async function waitFor(ms, signal) {
  signal?.throwIfAborted();
  await new Promise((resolve, reject) => {
    setTimeout(resolve, ms);
    signal?.addEventListener("abort", () => reject(signal.reason), { once: true });
  });
}
