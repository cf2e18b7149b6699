/** Address after the #: the view and its choices, so that a link shows the same to others. */

/** Return {parts, query} of the address: "#/jobs/7?x=crank_mm" is {parts: ["jobs", "7"], query: URLSearchParams}. */
export function read() {
  const [path, query = ""] = location.hash.replace(/^#\/?/, "").split("?");
  return {
    parts: path.split("/").filter(Boolean).map(decodeURIComponent),
    query: new URLSearchParams(query),
  };
}

/**
 * Return a link to a view: link(["jobs", 7], {x: "crank_mm"}); null and empty values are omitted.
 * @param {readonly (string | number)[]} parts @param {Record<string, Dom.Value>} query
 */
export function link(parts, query = {}) {
  const parameters = new URLSearchParams(
    Object.entries(query)
      .filter(([, value]) => value !== null && value !== undefined && value !== "")
      .map(([key, value]) => [key, String(value)]),
  );
  const text = parameters.toString();
  return `#/${parts.map(encodeURIComponent).join("/")}${text ? `?${text}` : ""}`;
}

/**
 * Store choices in the address of this view, without a history entry and without redrawing.
 * @param {Record<string, Dom.Value>} query
 */
export function keepChoices(query) {
  history.replaceState(history.state, "", link(read().parts, query));
}

/**
 * Return the last address of a view with its choices, or the plain one.
 * @param {readonly (string | number)[]} parts
 */
export function lastAddress(parts) {
  return sessionStorage.getItem(`left ${link(parts)}`) ?? link(parts);
}

window.addEventListener("hashchange", ({ oldURL }) => {
  const { hash } = new URL(oldURL);
  sessionStorage.setItem(`left ${hash.split("?")[0]}`, hash);
});

/** Go to a view. @param {readonly (string | number)[]} parts @param {Record<string, Dom.Value>} query */
export function go(parts, query = {}) {
  location.hash = link(parts, query);
}
