// The curves of the advisor over the steps of a walk: P(M | H), and the gain of advice beside its threshold.

const SVG = "http://www.w3.org/2000/svg";
const LEFT = 44;
const RIGHT = 392;
const PANELS = { p: { top: 24, bottom: 138 }, gain: { top: 186, bottom: 294 } };
const FEWEST = 20; // steps that the axis shows at least
const LARGEST = 3; // nats that the axis of the gain shows at least

/** Draw the curves of a history of {p, gain, advise} with the threshold of the rule. */
export function drawCurves(svg, history, kappa) {
  const last = Math.max(FEWEST, history.length - 1);
  const high = Math.max(LARGEST, ...history.map(({ gain }) => gain));
  const x = (step) => LEFT + ((RIGHT - LEFT) * step) / last;
  const height = ({ top, bottom }, share) => bottom - (bottom - top) * share;
  svg.replaceChildren();
  history.forEach(({ advise }, step) => {
    if (!advise) return;
    const width = (RIGHT - LEFT) / last;
    for (const { top, bottom } of Object.values(PANELS)) {
      const bar = { x: x(step), y: top, width: Math.min(width, RIGHT - x(step)), height: bottom - top };
      add(svg, "rect", { ...bar, fill: "#fbe3cc" });
    }
  });
  frame(svg, PANELS.p, "P(M | H): you walk as the experts do", ["1", "0"]);
  frame(svg, PANELS.gain, "gain of advice in nats; shaded: advised", [high.toFixed(1), "0"]);
  curve(svg, history.map(({ p }, step) => [x(step), height(PANELS.p, p)]), "#0072b2");
  curve(svg, history.map(({ gain }, step) => [x(step), height(PANELS.gain, gain / high)]), "#a3478a");
  const y = height(PANELS.gain, kappa / high);
  add(svg, "line", { x1: LEFT, x2: RIGHT, y1: y, y2: y, stroke: "#b84f00", "stroke-width": 1.5, "stroke-dasharray": "6 4" });
  write(svg, RIGHT, y - 4, `threshold κ = ${kappa}`, "end");
  write(svg, LEFT, 312, "0", "middle");
  write(svg, RIGHT, 312, String(last), "end");
  write(svg, (LEFT + RIGHT) / 2, 324, "steps", "middle");
  const now = history.at(-1);
  const advised = history.filter(({ advise }) => advise).length;
  svg.setAttribute(
    "aria-label",
    `Curves over ${history.length - 1} steps. P(M | H) is now ${now.p.toFixed(2)}, the gain ${now.gain.toFixed(2)} nats, ` +
      `the threshold ${kappa}. Advice was shown at ${advised} of them.`,
  );
}

function frame(svg, { top, bottom }, title, [high, low]) {
  add(svg, "path", { d: `M ${LEFT} ${top} V ${bottom} H ${RIGHT}`, fill: "none", stroke: "#5b636d" });
  write(svg, LEFT, top - 8, title, "start");
  write(svg, LEFT - 6, top + 6, high, "end");
  write(svg, LEFT - 6, bottom + 4, low, "end");
}

function curve(svg, points, stroke) {
  add(svg, "polyline", { points: points.map((point) => point.join(",")).join(" "), fill: "none", stroke, "stroke-width": 2.5 });
}

function write(svg, x, y, text, anchor) {
  add(svg, "text", { x, y, "text-anchor": anchor }).textContent = text;
}

function add(svg, tag, attributes) {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  svg.append(element);
  return element;
}
