/** Faults of a view as it stands, measured in a browser: what is wider than the window, clipped, over other text, too small to hit or read, or too large. */
/* global document, getComputedStyle, NodeFilter */

const [WIDE, LEAST_TEXT, MOST_TEXT] = [1280, 12, 20]; // px: of the window, from where on texts in pictures have the least size

/** Return the faults by their kind. least: of what is clicked, px. */
export function findFaults(least) {
  const seen = (node) =>
    node.checkVisibility({ checkOpacity: true, checkVisibilityCSS: true }) &&
    !node.closest(".hidden, .skip, #notices");
  const name = (node) =>
    `${node.tagName.toLowerCase()}.${node.getAttribute("class") ?? ""} "${(node.textContent || node.value || "").trim().slice(0, 50)}"`;
  /** Return a function of a node that keeps what it found. */
  const once =
    (find, kept = new Map()) =>
    (node) => {
      if (!kept.has(node)) kept.set(node, find(node));
      return kept.get(node);
    };
  const style = once((node) => {
    const { position, display, overflowX, overflowY } = getComputedStyle(node);
    return { position, display, overflows: [overflowX, overflowY] };
  });
  const edges = once((node) => node.getBoundingClientRect());
  const pictured = once((node) => node.tagName !== "svg" && node.closest("svg") !== null);
  const lifted = once(
    (node) =>
      ["sticky", "fixed"].includes(style(node).position) ||
      (style(node).position === "absolute" && !node.closest("svg, .plot, .layers")),
  );
  const cutting = (node, kinds) => style(node).overflows.some((one) => kinds.includes(one));
  const found = { wider: [], clipped: [], over: [], small: [], tiny: [], huge: [] };
  const width = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > width) {
    const wide = [...document.querySelectorAll("main *")].filter(
      (node) => seen(node) && node.getBoundingClientRect().right > width + 1,
    );
    found.wider = [`${document.documentElement.scrollWidth} px`, ...wide.slice(-3).map(name)];
  }

  // Texts, each with the boxes of its lines, as far as what is scrolled away leaves them.
  const texts = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let text = walker.nextNode(); text; text = walker.nextNode()) {
    const node = text.parentElement;
    if (!text.data.trim() || node.closest("option, script, style, noscript") || !seen(node))
      continue;
    const range = document.createRange();
    range.selectNodeContents(text);
    let boxes = [...range.getClientRects()].map(({ left, right, top, bottom }) => ({
      left,
      right,
      top,
      bottom,
    }));
    let layer = null;
    for (let above = node; above && above !== document.body; above = above.parentElement) {
      if (!layer && lifted(above)) layer = above;
      if (pictured(above)) continue;
      const edge = edges(above);
      if (cutting(above, ["hidden", "clip"])) {
        const cut = boxes.some(
          (box) =>
            box.right > edge.right + 1.5 ||
            box.left < edge.left - 1.5 ||
            box.bottom > edge.bottom + 3 ||
            box.top < edge.top - 3,
        );
        if (cut && !above.classList.contains("hidden"))
          found.clipped.push(`${name(node)} in ${name(above).slice(0, 40)}`);
      } else if (cutting(above, ["auto", "scroll"])) {
        boxes = boxes.map((box) => ({
          left: Math.max(box.left, edge.left),
          right: Math.min(box.right, edge.right),
          top: Math.max(box.top, edge.top),
          bottom: Math.min(box.bottom, edge.bottom),
        }));
      }
    }
    for (const box of boxes)
      if (box.right - box.left > 1 && box.bottom - box.top > 1) texts.push({ ...box, node, layer });
  }
  for (const input of document.querySelectorAll(
    "input[type=text], input[type=search], input[type=number], input:not([type])",
  ))
    if (seen(input) && input.value && input.scrollWidth > input.clientWidth + 2)
      found.clipped.push(name(input));

  // Texts in pictures, as large as they are drawn; on a phone pictures shrink with the screen.
  for (const text of document.querySelectorAll("svg text")) {
    const drawn = text.getScreenCTM();
    const size =
      drawn && seen(text) && text.textContent.trim()
        ? parseFloat(getComputedStyle(text).fontSize) * Math.hypot(drawn.a, drawn.b)
        : LEAST_TEXT;
    if (width >= WIDE && size < LEAST_TEXT - 0.05)
      found.tiny.push(`${name(text)} of ${size.toFixed(1)} px`);
    if (size > MOST_TEXT) found.huge.push(`${name(text)} of ${size.toFixed(1)} px`);
  }

  // Texts over texts: by more than a third of a line in height, and more than two pixels across.
  texts.sort((one, other) => one.top - other.top);
  for (let i = 0; i < texts.length; i += 1) {
    for (let j = i + 1; j < texts.length && texts[j].top < texts[i].bottom; j += 1) {
      const [one, other] = [texts[i], texts[j]];
      if (one.node === other.node || one.layer !== other.layer) continue;
      const across = Math.min(one.right, other.right) - Math.max(one.left, other.left);
      const down = Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top);
      if (across > 2 && down > 0.35 * Math.min(one.bottom - one.top, other.bottom - other.top))
        found.over.push(`${name(one.node)} and ${name(other.node)}`);
    }
  }

  // What is clicked: large enough, or alone in a circle of that size; links within a sentence are as large as its text.
  const targets = [
    ...document.querySelectorAll(
      "a[href], button, input, select, textarea, summary, [role=button], [tabindex='0']",
    ),
  ]
    .filter(seen)
    .map((node) => {
      const label = node.matches("[type=checkbox], [type=radio]")
        ? (node.closest("label") ?? document.querySelector(`label[for="${node.id}"]`))
        : null;
      const own = node.getBoundingClientRect();
      const more = label?.getBoundingClientRect() ?? own;
      return {
        node,
        left: Math.min(own.left, more.left),
        right: Math.max(own.right, more.right),
        top: Math.min(own.top, more.top),
        bottom: Math.max(own.bottom, more.bottom),
      };
    });
  const layerOf = once((node) =>
    !node || node === document.body
      ? null
      : ["sticky", "fixed"].includes(style(node).position)
        ? node
        : layerOf(node.parentElement),
  );
  const inText = (node) =>
    node.matches("a") &&
    style(node).display === "inline" &&
    [...node.parentElement.childNodes].some(
      (other) => other !== node && other.nodeType === 3 && other.data.trim(),
    );
  for (const target of targets) {
    if (target.right - target.left >= least - 0.5 && target.bottom - target.top >= least - 0.5)
      continue;
    if (inText(target.node)) continue;
    const [x, y] = [(target.left + target.right) / 2, (target.top + target.bottom) / 2];
    const near = targets.find(
      (other) =>
        other !== target &&
        Math.hypot(
          Math.max(other.left - x, 0, x - other.right),
          Math.max(other.top - y, 0, y - other.bottom),
        ) <
          least / 2 - 0.5 &&
        layerOf(other.node) === layerOf(target.node) &&
        !other.node.contains(target.node) &&
        !target.node.contains(other.node),
    );
    if (near)
      found.small.push(
        `${name(target.node)} of ${Math.round(target.right - target.left)} x ${Math.round(target.bottom - target.top)} px beside ${name(near.node)}`,
      );
  }
  return Object.fromEntries(
    Object.entries(found)
      .map(([kind, all]) => [kind, [...new Set(all)]])
      .filter(([, all]) => all.length),
  );
}
