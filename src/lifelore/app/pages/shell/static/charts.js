// Line charts as SVG, with a table of the same numbers for those who do not see them.

import { make } from "/static/shell/shell.js";

const NS = "http://www.w3.org/2000/svg";
const WIDTH = 360, HEIGHT = 240, RIGHT = 12, TOP = 12, BOTTOM = 44;
const INK = "var(--ink)", LIGHT = "var(--light)", PAPER = "var(--paper)";
const DASHES = ["", "7 4", "2 3", "9 3 2 3", "4 2", "1 2"];
export const COLOURS = ["var(--blue)", "var(--vermilion)", "var(--green)", "var(--purple)", "var(--grey)", "var(--orange)"];

function draw(tag, attributes, text) {
  const element = document.createElementNS(NS, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

/** Round numbers between two ends, about `count` of them. */
export function ticksBetween(low, high, count = 5) {
  const span = high - low || 1;
  const raw = span / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => span / size <= count);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * span; i++) ticks.push(Number((i * step).toPrecision(12)));
  return ticks;
}

/**
 * A figure of lines.
 *
 * `series` are {name, points: [[x, y], …], half: [number or null, …]}: `half` is half of an interval around y.
 * `xends` are the ends of the x axis, by default those of the points; `xname` writes an x. `level` draws a horizontal line. Series differ in colour, dash and marker.
 */
export function lineChart({ title, xlabel, ylabel, series, level = null, xticks = null, xends = null, markers = true, digits = 2, xname = (x) => `${x}` }) {
  const figure = make("figure");
  figure.append(make("figcaption", {}, make("strong", {}, title)));
  const drawn = series.filter((one) => one.points.length);
  if (!drawn.length) {
    figure.append(make("p", { class: "quiet" }, "Nothing is recorded for this figure yet."));
    return figure;
  }
  const xs = drawn.flatMap((one) => one.points.map(([x]) => x));
  const ys = drawn.flatMap((one) => one.points.flatMap(([, y], i) => [y - (one.half?.[i] ?? 0), y + (one.half?.[i] ?? 0)]));
  if (level !== null) ys.push(level);
  let [low, high] = [Math.min(...ys), Math.max(...ys)];
  if (low === high) [low, high] = [low - (Math.abs(low) / 2 || 0.5), high + (Math.abs(high) / 2 || 0.5)];
  const [x0, x1] = xends ?? [Math.min(...xs), Math.max(...xs)];
  const marks = ticksBetween(low, high);
  const left = 26 + 7 * Math.max(...marks.map((y) => `${y}`.length));
  const margin = 0.06 * (high - low || 1);
  low -= margin;
  high += margin;
  const px = (x) => left + ((x - x0) / (x1 - x0 || 1)) * (WIDTH - left - RIGHT);
  const py = (y) => HEIGHT - BOTTOM - ((y - low) / (high - low)) * (HEIGHT - TOP - BOTTOM);
  const svg = draw("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "picture", role: "img", "aria-label": `${title}; the table below has the numbers`, "font-size": 11, fill: INK });
  for (const y of marks) {
    svg.append(draw("line", { x1: left, x2: WIDTH - RIGHT, y1: py(y), y2: py(y), stroke: LIGHT }));
    svg.append(draw("text", { x: left - 6, y: py(y) + 4, "text-anchor": "end" }, `${y}`));
  }
  for (const x of xticks ?? ticksBetween(x0, x1, 6))
    svg.append(draw("text", { x: px(x), y: HEIGHT - BOTTOM + 16, "text-anchor": "middle" }, xname(x)));
  svg.append(draw("text", { x: (left + WIDTH - RIGHT) / 2, y: HEIGHT - 8, "text-anchor": "middle" }, xlabel));
  svg.append(draw("text", { transform: `translate(12 ${(HEIGHT - BOTTOM + TOP) / 2}) rotate(-90)`, "text-anchor": "middle" }, ylabel));
  if (level !== null) svg.append(draw("line", { x1: left, x2: WIDTH - RIGHT, y1: py(level), y2: py(level), stroke: INK, "stroke-dasharray": "1 3" }));
  series.forEach((one, i) => {
    const look = { colour: one.colour ?? COLOURS[i % COLOURS.length], dash: DASHES[i % DASHES.length] };
    const path = one.points.map(([x, y], k) => `${k ? "L" : "M"}${px(x).toFixed(1)} ${py(y).toFixed(1)}`).join("");
    one.points.forEach(([x, y], k) => {
      const half = one.half?.[k];
      if (half) svg.append(draw("line", { x1: px(x), x2: px(x), y1: py(y - half), y2: py(y + half), stroke: look.colour, "stroke-opacity": 0.5 }));
    });
    svg.append(draw("path", { d: path, fill: "none", stroke: look.colour, "stroke-width": 2, "stroke-dasharray": look.dash }));
    if (markers)
      for (const [x, y] of one.points) svg.append(draw("circle", { cx: px(x), cy: py(y), r: 3, fill: PAPER, stroke: look.colour, "stroke-width": 1.5 }));
  });
  figure.append(svg, legend(series), numbers(xlabel, series, digits, xname));
  return figure;
}

function legend(series) {
  const list = make("ul", { class: "legend" });
  series.forEach((one, i) => {
    const key = draw("svg", { viewBox: "0 0 28 8", width: 28, height: 8, "aria-hidden": "true" });
    key.append(draw("line", { x1: 0, x2: 28, y1: 4, y2: 4, stroke: one.colour ?? COLOURS[i % COLOURS.length], "stroke-width": 2.5, "stroke-dasharray": DASHES[i % DASHES.length] }));
    list.append(make("li", {}, key, ` ${one.name}`));
  });
  return list;
}

function numbers(xlabel, series, digits, xname) {
  const xs = [...new Set(series.flatMap((one) => one.points.map(([x]) => x)))].sort((a, b) => a - b);
  const every = Math.ceil(xs.length / 25);
  const rows = xs.filter((_, i) => i % every === 0 || i === xs.length - 1).map((x) => [xname(x), ...series.map((one) => {
    const point = one.points.find(([at]) => at === x);
    return point ? point[1].toFixed(digits) : "–";
  })]);
  const grid = table([xlabel, ...series.map((one) => one.name)], rows);
  return make("details", {}, make("summary", {}, "The numbers"), make("div", { class: "scroll" }, grid));
}

/** A table whose first column names the rows; the others are right-aligned where they begin with a number. A narrow window shows a cell's head beside it. */
export function table(heads, rows) {
  const numeric = heads.map((_, k) => k > 0 && rows.every((row) => typeof row[k] !== "string" || /^[-−+–\d][^/]*$|^no |^not |^too|^by|^imp/.test(row[k])));
  const look = (k) => (numeric[k] ? { class: "number" } : {});
  const cells = (row) => row.map((cell, k) => make(k ? "td" : "th", k ? { ...look(k), "data-head": heads[k] } : { scope: "row" }, cell));
  return make("table", { class: "pairs" }, make("thead", {}, make("tr", {}, ...heads.map((head, k) => make("th", { scope: "col", ...look(k) }, head)))), make("tbody", {}, ...rows.map((row) => make("tr", {}, ...cells(row)))));
}
