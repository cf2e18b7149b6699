/** A field of the form: label, control, explanation and mistakes, linked for assistive technology. */

import { byId, focused, h } from "../lib/dom.js";
import { idOf, pathText } from "./path.js";
import { capitalised, inWords, WORDS } from "../lib/words.js";

const CONTROLS = "input, select, textarea";

/**
 * Return a field for a path. controls: elements; the first has the label. why: a sentence, or {sentence, name} of a quantity with a help
 * page. The field is registered with the form, which shows mistakes in it.
 * @param {Form.Whole} form @param {Form.Path} path @param {string} label @param {HTMLElement[]} controls @param {Form.Why | undefined} why
 * @param {{ wide?: boolean, labelled?: boolean, register?: boolean, tell?: () => void }} looks
 */
export function field(
  form,
  path,
  label,
  controls,
  why = "",
  { wide = false, labelled = true, register = true, tell = undefined } = {},
) {
  const inputs = controls.flatMap((one) =>
    one.matches(CONTROLS)
      ? [one]
      : /** @type {HTMLElement[]} */ ([...one.querySelectorAll(CONTROLS)]),
  );
  const id = (inputs[0].id ||= idOf(path, "c"));
  const understood = h("p", { class: "understood", role: "status", hidden: true });
  const error = h("p", { class: "error", id: `${id}-error`, hidden: true });
  const explained = explanation(`${id}-why`, label, why);
  const node = h(
    "div",
    {
      class: wide ? "field wide" : "field",
      oninput: ({ target }) => {
        if (target instanceof HTMLElement) target.dataset.touched = "yes";
      },
    },
    h(
      "div",
      { class: "field-label" },
      labelled ? h("label", { for: inputs[0].id }, label) : h("span", {}, label),
      explained?.button,
    ),
    h("div", { class: "field-controls" }, controls),
    understood,
    explained?.text,
    error,
  );
  if (register)
    form.register({
      path,
      key: pathText(path),
      node,
      controls: inputs.filter((one) => !one.classList.contains("unit")),
      error,
      tell,
    });
  return node;
}

/**
 * Replace a field with a new version and keep the focus within it.
 * @param {Form.Whole} form @param {HTMLElement} node @param {() => HTMLElement} make
 */
export function replace(form, node, make) {
  const focus = focused(node)?.id;
  form.forget((one) => one.node === node);
  node.replaceWith(make());
  if (focus) byId(focus)?.focus();
}

/**
 * Return a button "?" and the sentence that it shows and hides; null without a sentence.
 * @param {string} id @param {string} label @param {Form.Why | undefined} why
 */
export function explanation(id, label, why) {
  const { sentence, name } = typeof why === "string" ? { sentence: why, name: null } : (why ?? {});
  if (!sentence) return null;
  const text = h(
    "p",
    {
      class: "why",
      id,
      hidden: true,
      onkeydown: (event) => {
        if (event.key !== "Escape") return;
        button.click();
        button.focus();
      },
    },
    capitalised(sentence),
    name ? [" ", h("a", { href: `#/help/${name}` }, `More about ${label}`)] : null,
  );
  const button = h(
    "button",
    {
      type: "button",
      class: "ask",
      "aria-label": `What is ${label}?`,
      "aria-expanded": "false",
      "aria-controls": id,
      onclick: () => {
        text.hidden = !text.hidden;
        button.setAttribute("aria-expanded", String(!text.hidden));
      },
    },
    "?",
  );
  return { button, text };
}

/**
 * Show mistakes at their fields; return the sentences without a field. Empty untouched fields are marked only once the user tries to
 * start the search.
 * @param {Form.Field[]} fields @param {Api.Wrong[]} wrong @param {{ missing?: boolean }} options
 */
export function showWrong(fields, wrong, { missing = false } = {}) {
  for (const item of fields) say(item, []);
  /** @type {Map<Form.Field, string[]>} */
  const sentencesOf = new Map();
  /** @type {string[]} */
  const elsewhere = [];
  for (const { path, sentence, infeasible } of wrong) {
    const nearestField = path === "" ? null : nearest(fields, path);
    const text = inWords(sentence);
    const before = infeasible ? "Impossible: " : "";
    if (!nearestField) elsewhere.push(before + (path ? `${path}: ${text}` : text));
    else
      sentencesOf.set(nearestField, [
        ...(sentencesOf.get(nearestField) ?? []),
        before + partOfField(nearestField, path) + text,
      ]);
  }
  for (const [one, sentences] of sentencesOf) {
    if (missing) for (const { dataset } of one.controls) dataset.touched = "yes";
    say(one, sentences);
  }
  return { elsewhere, first: fields.find((one) => sentencesOf.has(one)) ?? null };
}

/** Show what is wrong with a field; unreadable text is reported instead of its consequences. @param {Form.Field} one @param {string[]} found */
function say(one, found) {
  const unread = one.controls.flatMap(({ dataset }) => dataset.wrong ?? []);
  const sentences = unread.length ? unread : found;
  const isUntouched =
    !unread.length &&
    one.controls.some(
      (control) =>
        control instanceof HTMLInputElement &&
        control.type === "text" &&
        control.value.trim() === "" &&
        !control.dataset.touched,
    );
  const bad = sentences.length > 0 && !isUntouched;
  one.error.hidden = !sentences.length;
  one.error.classList.toggle("needed", isUntouched);
  one.error.textContent = sentences.map(capitalised).join(" ");
  for (const control of one.controls) {
    if (bad) {
      control.setAttribute("aria-invalid", "true");
      control.setAttribute("aria-describedby", one.error.id);
    } else {
      control.removeAttribute("aria-invalid");
      control.removeAttribute("aria-describedby");
    }
  }
  if (bad)
    for (
      let fold = one.node.closest("details");
      fold;
      fold = fold.parentElement?.closest("details") ?? null
    )
      fold.open = true;
}

/** @param {Form.Field[]} fields @param {string} path */
function nearest(fields, path) {
  /** @param {string} outer @param {string} inner */
  const within = (outer, inner) =>
    inner === outer || inner.startsWith(`${outer}.`) || inner.startsWith(`${outer} #`);
  const above = fields
    .filter((one) => within(one.key, path))
    .sort((a, b) => b.key.length - a.key.length);
  return above[0] ?? fields.find((one) => within(path, one.key)) ?? null;
}

/**
 * Return, in words, the part of a field to which a sentence refers; "" for a single number, or for the whole field.
 * @param {Form.Field} one @param {string} path
 */
function partOfField(one, path) {
  if (one.key === path) return "";
  if (!path.startsWith(one.key)) return `${path}: `;
  const key = path.slice(one.key.length).replace(/^[. ]/, "");
  const numbers = one.controls.filter((control) => control instanceof HTMLInputElement);
  return key in WORDS && numbers.length < 2
    ? ""
    : `${WORDS[key] ?? key.replaceAll("_", " ").replaceAll(".", ", ")}: `;
}
