/** A requirement on a quantity: any value, exactly one, at least, at most, or between two. */

import { bounds } from "./bounds.js";
import { field, replace } from "./field.js";
import { kindOf } from "../lib/units.js";

/**
 * Return the field of the requirement on a quantity {name, title, unit, sentence}.
 * @param {Form.Whole} form @param {Api.Quantity} quantity @param {{ label?: string, place?: Form.Path }} given
 */
export function requirement(
  form,
  quantity,
  { label = quantity.title, place = ["constraints"] } = {},
) {
  const path = [...place, quantity.name];
  const here = () => replace(form, made, () => requirement(form, quantity, { label, place }));
  const { controls, mode } = bounds(
    form,
    { path, id: path },
    { label, kind: kindOf(quantity.unit), any: true, again: () => form.redraw(), here },
  );
  const made = field(form, path, label, controls, {
    sentence: quantity.sentence,
    name: quantity.name,
  });
  made.classList.toggle("two", mode === "between");
  return made;
}
