/** Elements in one expression: h("button", {type: "button", onclick: act}, "Start"). */

const SVG = "http://www.w3.org/2000/svg";
const MATHML = "http://www.w3.org/1998/Math/MathML";

/**
 * Return an HTML element. Null and false attributes are omitted; on... are listeners; children are nodes or text.
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Dom.Attributes<HTMLElementTagNameMap[Tag]>} attributes
 * @param {...Dom.Child} children
 * @returns {HTMLElementTagNameMap[Tag]}
 */
export function h(tag, attributes = {}, ...children) {
  return dress(document.createElement(tag), attributes, children);
}

/**
 * Return an SVG element, in the same way.
 * @template {keyof SVGElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Dom.Attributes} attributes
 * @param {...Dom.Child} children
 * @returns {SVGElementTagNameMap[Tag]}
 */
export function svg(tag, attributes = {}, ...children) {
  return dress(document.createElementNS(SVG, tag), attributes, children);
}

/** Return an element of MathML, in the same way. @param {string} tag @param {Dom.Attributes} attributes @param {...Dom.Child} children */
export function mathml(tag, attributes = {}, ...children) {
  return dress(document.createElementNS(MATHML, tag), attributes, children);
}

/** Return a form that calls a function on submission, and stays on the page. @param {() => void} send @param {...Dom.Child} children */
export function formOf(send, ...children) {
  const onsubmit = (/** @type {Event} */ event) => {
    event.preventDefault();
    send();
  };
  return h("form", { novalidate: true, onsubmit }, children);
}

/** Return a field for a number, perhaps with a unit. @param {Dom.Attributes<HTMLInputElement>} attributes */
export function numberField(attributes) {
  return h("input", {
    type: "text",
    inputmode: "decimal",
    autocomplete: "off",
    class: "number",
    ...attributes,
  });
}

/**
 * Mark a control as invalid, or as valid again. describedBy: id of the explanation.
 * @param {Element} control @param {unknown} wrong @param {string} describedBy
 */
export function markInvalid(control, wrong, describedBy = "") {
  if (wrong) control.setAttribute("aria-invalid", "true");
  else control.removeAttribute("aria-invalid");
  if (!describedBy) return;
  if (wrong) control.setAttribute("aria-describedby", describedBy);
  else control.removeAttribute("aria-describedby");
}

/** Enter text into a field as if it were typed. @param {HTMLInputElement} field @param {string} text */
export function typeInto(field, text) {
  field.value = text;
  field.dispatchEvent(new Event("input"));
}

/** Return the element with an id that exists in the page's document. @param {string} id */
export function byId(id) {
  return /** @type {HTMLElement} */ (document.getElementById(id));
}

/**
 * Return the first element within a node that matches a selector, or null.
 * @param {Element} node @param {string} selector @returns {HTMLElement | null}
 */
export function first(node, selector) {
  return node.querySelector(selector);
}

/** Return the focused element within a node, or null. @type {(node: Element) => HTMLElement | null} */
export function focused(node) {
  const { activeElement } = document;
  return activeElement instanceof HTMLElement && node.contains(activeElement)
    ? activeElement
    : null;
}

/** Replace the children of a node. @param {Element} node @param {...Dom.Child} children */
export function fill(node, ...children) {
  node.replaceChildren(...kept(children));
}

/**
 * @template {Element} Made
 * @param {Made} node
 * @param {object} attributes
 * @param {Dom.Child[]} children
 */
function dress(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name === "value" || name === "checked" || name === "selected" || name === "disabled")
      Object.assign(node, { [name]: value });
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...kept(children));
  return node;
}

/** @type {(children: readonly Dom.Child[]) => (Node | string)[]} */
function kept(children) {
  return children.flatMap((child) =>
    typeof child === "string" || child instanceof Node ? [child] : child ? kept(child) : [],
  );
}
