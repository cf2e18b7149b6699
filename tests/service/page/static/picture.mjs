/** The little of a document in which drawings are made, and the outlines of what they show. */

/** An element, with what drawings use of it. */
export class Node {
  constructor(tag) {
    Object.assign(this, { tag, attributes: {}, children: [], clientWidth: 0 });
    this.classList = { toggle() {} };
  }
  append(...nodes) {
    for (const node of nodes) {
      node.parent?.children.splice(node.parent.children.indexOf(node), 1);
      if (node instanceof Node) node.parent = this;
      this.children.push(node);
    }
  }
  replaceChildren(...nodes) {
    this.children = [];
    this.append(...nodes);
  }
  setAttribute(name, value) {
    this.attributes[name] = String(value);
  }
  toggleAttribute(name, yes) {
    if (yes) this.attributes[name] = "";
    else delete this.attributes[name];
  }
  get textContent() {
    return this.children.map((child) => child.textContent ?? child).join("");
  }
  set textContent(words) {
    this.children = [words];
  }
  querySelectorAll(tag) {
    const within = this.children.filter((child) => child instanceof Node);
    return within.flatMap((child) => [
      ...(child.tag === tag ? [child] : []),
      ...child.querySelectorAll(tag),
    ]);
  }
}
Object.assign(globalThis, { Node });
globalThis.document = {
  createElement: (tag) => new Node(tag),
  createElementNS: (_, tag) => new Node(tag),
};
globalThis.ResizeObserver = class {
  observe() {}
  disconnect() {}
};

/** Return a function to the picture from the coordinates of a node. */
function placeOf(node) {
  const chain = [];
  for (let at = node; at; at = at.parent) chain.push(at.attributes.transform ?? "");
  return (point) =>
    chain.reduce((place, transform) => {
      const steps = [...transform.matchAll(/(\w+)\(([^)]*)\)/g)].reverse();
      return steps.reduce(([x, y], [, name, numbers]) => {
        const [a, b = 0] = numbers.split(" ").map(Number);
        const turn = (a * Math.PI) / 180;
        return name === "translate"
          ? [x + a, y + b]
          : [x * Math.cos(turn) - y * Math.sin(turn), x * Math.sin(turn) + y * Math.cos(turn)];
      }, place);
    }, point);
}

/** Return the corners in the picture of a box in the coordinates of a node. */
export function corners(node, [left, top, right, bottom]) {
  return [
    [left, top],
    [right, top],
    [right, bottom],
    [left, bottom],
  ].map(placeOf(node));
}

/** Return the corners of a text of 12 pixels. */
export function outline(text) {
  const { x = 0, y = 0, "text-anchor": anchor = "start" } = text.attributes;
  const wide = 6.6 * text.textContent.length;
  const left = Number(x) - { start: 0, middle: 0.5, end: 1 }[anchor] * wide;
  return corners(text, [left, Number(y) - 9, left + wide, Number(y) + 2]);
}

/** Whether two convex outlines overlap: no edge of either separates them. */
export function overlap(one, other) {
  return [one, other].every((shape) =>
    shape.every(([x, y], n) => {
      const [toX, toY] = shape[(n + 1) % shape.length];
      const across = (points) => points.map(([u, v]) => (u - x) * (toY - y) - (v - y) * (toX - x));
      const [ours, theirs] = [across(one), across(other)];
      return Math.max(...ours) > Math.min(...theirs) && Math.max(...theirs) > Math.min(...ours);
    }),
  );
}
