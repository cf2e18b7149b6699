/** Mass of a link: none, as a mass, or by its section. */

import { h } from "../lib/dom.js";
import { byschema } from "./controls.js";
import { field } from "./field.js";
import { idOf, isTable } from "./path.js";
import { fixedOrVarying } from "./strength.js";

/** @type {Record<string, { title: string, first: Form.Job | undefined, keys: string[], more: string[] }>} */
const WAYS = {
  none: { title: "without mass", first: undefined, keys: [], more: [] },
  mass: {
    title: "by its mass",
    first: { mass: "0.5 kg" },
    keys: ["mass"],
    more: ["inertia", "centre", "centre_across"],
  },
  section: {
    title: "bar of rectangular section",
    first: { width: "30 mm", depth: "20 mm", density: "7850 kg/m^3" },
    keys: ["width", "depth", "density"],
    more: [],
  },
};

const VARY = ["width", "depth"]; // of a bar

/** Return the fields of crank or rod. @param {Form.Whole} form @param {Form.Path} path @param {string} label */
export function link(form, path, label) {
  const jobValue = form.at(path);
  const way =
    jobValue === undefined
      ? "none"
      : isTable(jobValue) && ("width" in jobValue || "depth" in jobValue || "density" in jobValue)
        ? "section"
        : "mass";
  const select = h(
    "select",
    {
      id: idOf(path, "c"),
      onchange: () => {
        form.put(["variables", ...path], undefined);
        form.put(path, structuredClone(WAYS[select.value].first));
        form.redraw();
      },
    },
    Object.entries(WAYS).map(([key, { title }]) =>
      h("option", { value: key, selected: key === way }, title),
    ),
  );
  const { keys, more } = WAYS[way];
  /** @param {string[]} names */
  const fields = (names) =>
    names.map((key) =>
      byschema(form, [...path, key], {
        label: `${label}, ${key.replace("_", " ")}`,
        required: true,
      }),
    );
  return [
    field(
      form,
      path,
      `mass of the ${label}`,
      [select],
      "A link given by its mass has the same mass at every length; the mass of a bar grows with its length.",
    ),
    way === "section"
      ? keys.map((key) =>
          VARY.includes(key)
            ? fixedOrVarying(form, [...path, key], `${label}, ${key}`)
            : fields([key]),
        )
      : fields(keys),
    more.length
      ? h(
          "details",
          { class: "more" },
          h("summary", {}, `Mass centre and inertia of the ${label}`),
          h("div", { class: "fields" }, fields(more)),
        )
      : null,
  ];
}
