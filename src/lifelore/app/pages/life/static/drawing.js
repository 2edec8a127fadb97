// Pictures in SVG: curves, stacked columns, and a map with the arrows of a prior.

const INK = "var(--ink)", GREY = "var(--grey)", LIGHT = "var(--light)", PAPER = "var(--paper)", BLUE = "var(--blue)", ORANGE = "var(--orange)";
const ON_ORANGE = "#22262b";
const LEFT = 58, RIGHT = 12, TOP = 12, BOTTOM = 40, TEXT = 13;

/** An SVG element with attributes and children. */
export function svg(tag, attributes = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

function picture(container, height, words) {
  const width = Math.max(260, container.clientWidth);
  const drawn = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": words, class: "picture" });
  container.replaceChildren(drawn);
  return { drawn, width };
}

/**
 * Draw curves in a container.
 *
 * Each series has a name, a colour, points [x, y], and `dots` (marks without a line) or `dashed`. A logarithmic axis
 * needs positive values. The names stand above the picture, so that colours are not the only sign.
 */
export function drawCurves(container, series, { x, y, words, height = 230, log = false, whole = true }) {
  const { drawn, width } = picture(container, height, words);
  const all = series.flatMap((one) => one.points);
  if (!all.length) return;
  const shown = log ? (value) => Math.log10(Math.max(value, 1)) : (value) => value;
  const [x0, x1] = spread(all.map(([value]) => value), 0);
  const [y0, y1] = spread(all.map(([, value]) => shown(value)), 0.06);
  const names = legend(drawn, series, width);
  const top = TOP + names;
  const px = (value) => LEFT + ((value - x0) / (x1 - x0)) * (width - LEFT - RIGHT);
  const py = (value) => height - BOTTOM - ((shown(value) - y0) / (y1 - y0)) * (height - BOTTOM - top);
  for (const value of log ? powers(y0, y1) : ticks(y0, y1, 4)) {
    drawn.append(
      svg("line", { x1: LEFT, x2: width - RIGHT, y1: py(value), y2: py(value), stroke: LIGHT }),
      label(short(value), { x: LEFT - 6, y: py(value) + 4, "text-anchor": "end" }),
    );
  }
  for (const value of ticks(x0, x1, Math.max(2, Math.floor(width / 80)))) {
    if (whole && !Number.isInteger(value)) continue;
    drawn.append(label(short(value), { x: px(value), y: height - BOTTOM + 17, "text-anchor": "middle" }));
  }
  drawn.append(
    svg("line", { x1: LEFT, x2: width - RIGHT, y1: height - BOTTOM, y2: height - BOTTOM, stroke: GREY }),
    label(x, { x: (LEFT + width - RIGHT) / 2, y: height - 5, "text-anchor": "middle" }),
    label(y, { x: 14, y: (top + height - BOTTOM) / 2, "text-anchor": "middle", transform: `rotate(-90 14 ${(top + height - BOTTOM) / 2})` }),
  );
  for (const one of series) drawSeries(drawn, one, px, py);
}

function drawSeries(drawn, one, px, py) {
  if (!one.dots) {
    const path = one.points.map(([a, b], i) => `${i ? "L" : "M"}${px(a).toFixed(1)} ${py(b).toFixed(1)}`).join("");
    drawn.append(svg("path", { d: path, fill: "none", stroke: one.colour, "stroke-width": 2, "stroke-dasharray": one.dashed ? "5 4" : "none" }));
  }
  if (one.dots || one.points.length <= 60) {
    for (const [a, b] of one.points) {
      const size = one.dots ? 5 : 3;
      const attributes = { cx: px(a), cy: py(b), r: size, fill: one.dots ? PAPER : one.colour, stroke: one.colour, "stroke-width": 2 };
      drawn.append(svg("circle", attributes, svg("title", {}, `${one.name}: ${short(b)} at ${short(a)}`)));
    }
  }
}

/** Names of the series above the picture; the height that they take. */
function legend(drawn, series, width) {
  let [x, line] = [LEFT, 0];
  for (const one of series) {
    const needed = 30 + 7.2 * one.name.length;
    if (x > LEFT && x + needed > width) [x, line] = [LEFT, line + 1];
    const y = TOP + 8 + 18 * line;
    const mark = one.dots
      ? svg("circle", { cx: x + 9, cy: y - 4, r: 5, fill: PAPER, stroke: one.colour, "stroke-width": 2 })
      : svg("line", { x1: x, x2: x + 18, y1: y - 4, y2: y - 4, stroke: one.colour, "stroke-width": 3, "stroke-dasharray": one.dashed ? "5 3" : "none" });
    drawn.append(mark, label(one.name, { x: x + 23, y }));
    x += needed + 8;
  }
  return 18 * (line + 1) + 4;
}

/** Draw columns of shares that add up to at most 1: `columns` are lists of [share, colour]. */
export function drawStacks(container, columns, { x, y, words, height = 190 }) {
  const { drawn, width } = picture(container, height, words);
  const step = (width - LEFT - RIGHT) / columns.length, wide = Math.min(46, 0.8 * step), tall = height - BOTTOM - TOP;
  for (const share of [0, 0.5, 1]) {
    const at = TOP + (1 - share) * tall;
    drawn.append(
      svg("line", { x1: LEFT, x2: width - RIGHT, y1: at, y2: at, stroke: LIGHT }),
      label(`${100 * share} %`, { x: LEFT - 6, y: at + 4, "text-anchor": "end" }),
    );
  }
  const every = Math.ceil(columns.length / (width / 40));
  columns.forEach((shares, i) => {
    const middle = LEFT + (i + 0.5) * step;
    let filled = 0;
    for (const [share, colour] of shares) {
      drawn.append(svg("rect", { x: middle - wide / 2, width: wide, y: TOP + (1 - filled - share) * tall, height: share * tall, fill: colour }));
      filled += share;
    }
    if (i % every === 0) drawn.append(label(String(i + 1), { x: middle, y: height - BOTTOM + 17, "text-anchor": "middle" }));
  });
  drawn.append(
    label(x, { x: (LEFT + width - RIGHT) / 2, y: height - 5, "text-anchor": "middle" }),
    label(y, { x: 14, y: TOP + tall / 2, "text-anchor": "middle", transform: `rotate(-90 14 ${TOP + tall / 2})` }),
  );
}

const STEPS = [[-1, 0], [1, 0], [0, 1], [0, -1]]; // rows and columns of north, south, east, west
const NEGLIGIBLE = 0.05, SHADES = 4, NEAR = 12;

/** Draw the known cells of a map, walls, arrows of the prior, places with untried moves, named places, and goals [{row, column, text, chosen}]. */
export function drawMap(container, map, goals, { near, words }) {
  const rows = map.cells.map((cell) => cell[0]), columns = map.cells.map((cell) => cell[1]);
  const margin = Math.max(0.5, (Math.max(...columns) - Math.min(...columns)) / 60); // room for the circle of a goal
  let box = [Math.min(...columns) - margin, Math.min(...rows) - margin, Math.max(...columns) + 1 + margin, Math.max(...rows) + 1 + margin];
  if (near) box = [near.column - NEAR, near.row - 0.7 * NEAR, near.column + NEAR + 1, near.row + 0.7 * NEAR + 1];
  const [left, top, right, bottom] = box;
  const inside = map.cells.filter(([row, column]) => column + 1 > left && column < right && row + 1 > top && row < bottom);
  const size = { viewBox: `${left} ${top} ${right - left} ${bottom - top}`, role: "img", "aria-label": words, class: "picture" };
  const drawn = svg("svg", size, svg("rect", { x: left, y: top, width: right - left, height: bottom - top, fill: "var(--ground)" }));
  const floor = inside.map(([row, column]) => `M${column} ${row}h1v1h-1z`).join("");
  drawn.append(svg("path", { d: floor, fill: PAPER }));
  drawn.append(svg("path", { d: walls(inside), stroke: INK, "stroke-width": 0.14, "stroke-linecap": "round", fill: "none" }));
  arrows(inside, map.arrows).forEach((path, shade) => {
    const opacity = 0.3 + (0.7 * (shade + 1)) / SHADES;
    drawn.append(svg("path", { d: path, stroke: BLUE, "stroke-width": 0.1, "stroke-linecap": "round", fill: "none", opacity }));
  });
  const open = inside.filter((cell) => cell[4] > 0).map(([row, column]) => `M${column + 0.5} ${row + 0.15}l.35 .35l-.35 .35l-.35 -.35z`).join("");
  drawn.append(svg("path", { d: open, fill: ORANGE, stroke: INK, "stroke-width": 0.06 }));
  const letters = near ? 0.6 : Math.max(1, (right - left) / 60);
  for (const goal of goals) {
    const at = { cx: goal.column + 0.5, cy: goal.row + 0.5, r: (goal.chosen ? 0.95 : 0.6) * letters };
    drawn.append(svg("circle", { ...at, fill: goal.chosen ? ORANGE : PAPER, stroke: INK, "stroke-width": 0.12 }));
    if (goal.chosen) drawn.append(svg("text", { x: at.cx, y: at.cy + 0.37 * letters, "text-anchor": "middle", "font-size": letters, "font-weight": 700, fill: ON_ORANGE }, goal.text));
  }
  for (const { name, at: [row, column] } of map.names) {
    if (column + 1 < left || column > right || row + 1 < top || row > bottom) continue;
    // Moved in where the edge would cut it, and smaller where it is wider than the map.
    const font = Math.min(letters, (right - left) / (0.75 * name.length)), half = 0.36 * font * name.length;
    const x = Math.max(left + half, Math.min(right - half, column + 0.5)), above = row + 0.5 - 1.1 * letters;
    const y = above - font < top ? row + 0.5 + 1.9 * letters : above;
    const text = { x, y, "text-anchor": "middle", "font-size": font, "font-weight": 600, fill: INK };
    drawn.append(svg("text", { ...text, stroke: PAPER, "stroke-width": font / 4, "paint-order": "stroke" }, name));
  }
  container.replaceChildren(drawn);
}

/** Sides of cells whose move is refused; bits 0 to 3 of a percept are the moves that pass. */
function walls(cells) {
  const sides = ([row, column]) => [`M${column} ${row}h1`, `M${column} ${row + 1}h1`, `M${column + 1} ${row}v1`, `M${column} ${row}v1`];
  return cells.map((cell) => sides(cell).filter((_, move) => !((cell[2] >> move) & 1)).join("")).join("");
}

/** A path for each shade: arrows from the middle of a cell, the darker the more mass the prior gives to the move. */
function arrows(cells, probabilities) {
  const paths = Array.from({ length: SHADES }, () => []);
  for (const [row, column, , of] of cells) {
    if (of < 0) continue;
    probabilities[of].forEach((mass, move) => {
      if (mass <= NEGLIGIBLE) return;
      const [down, right] = STEPS[move], reach = 0.3 + 0.14 * Math.sqrt(mass);
      const [x, y] = [column + 0.5, row + 0.5], [tx, ty] = [x + reach * right, y + reach * down];
      const head = [-1, 1].map((side) => `M${fixed(tx)} ${fixed(ty)}L${fixed(tx - 0.13 * right + side * 0.1 * down)} ${fixed(ty - 0.13 * down + side * 0.1 * right)}`);
      const shade = Math.min(SHADES - 1, Math.floor(SHADES * Math.sqrt(mass)));
      paths[shade].push(`M${fixed(x + 0.06 * right)} ${fixed(y + 0.06 * down)}L${fixed(tx)} ${fixed(ty)}${head.join("")}`);
    });
  }
  return paths.map((parts) => parts.join(""));
}

const fixed = (value) => value.toFixed(2);

function label(text, attributes) {
  return svg("text", { "font-size": TEXT, fill: GREY, ...attributes }, text);
}

function spread(values, margin) {
  const low = Math.min(...values), high = Math.max(...values);
  const slack = margin * (high - low);
  return high > low ? [low - slack, high + slack] : [low - 0.5, high + 0.5];
}

function ticks(low, high, n) {
  const rough = (high - low) / n, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= rough);
  const found = [];
  for (let value = Math.ceil(low / step) * step; value <= high + 1e-9; value += step) found.push(Number(value.toPrecision(10)));
  return found;
}

/** Values with one significant digit between powers of ten; low and high are logarithms. */
function powers(low, high) {
  const found = [];
  for (let power = Math.floor(low); power <= high; power += 1)
    for (const factor of high - low > 2 ? [1] : [1, 2, 5]) {
      const value = factor * 10 ** power;
      if (Math.log10(value) >= low && Math.log10(value) <= high) found.push(value);
    }
  return found;
}

/** A number for people: 12k, 3.4, −61. */
export function short(value) {
  const size = Math.abs(value);
  const text = size >= 1e6 ? `${+(value / 1e6).toPrecision(3)}M` : size >= 1e4 ? `${+(value / 1e3).toPrecision(3)}k` : size >= 100 ? `${Math.round(value)}` : `${+value.toFixed(2)}`;
  return text.replace("-", "−");
}
