// The map of a walk: what the person has seen so far, drawn on a canvas.

const COLOURS = {
  seen: "#cfd6dd", now: "#ffffff", wall: "#22262b", trail: "#56b4e9", person: "#0072b2", place: "#e69f00",
  goal: "#007a59", advice: "#b84f00", paper: "#ffffff",
};
const OFFSETS = [[-1, 0], [1, 0], [0, 1], [0, -1]]; // (row, column) of north, south, east, west
const [SMALLEST, LARGEST] = [16, 28]; // sides of a cell in pixels; a building that does not fit scrolls with the person

/** Draw a map with the person, the trail, places and advice. */
export function drawMap(canvas, walk) {
  const camera = cameraOf(canvas, walk);
  const { context, side } = camera;
  const [, columns] = walk.shape;
  // In the order of the building, so that the picture does not depend on the order in which the cells were seen.
  const cells = [...walk.cells].sort(([a], [b]) => a - b);
  const corner = (key) => camera.corner(Math.floor(key / columns), key % columns);
  for (const [now, colour] of [[false, COLOURS.seen], [true, COLOURS.now]]) {
    context.fillStyle = colour;
    for (const [key] of cells) if (walk.now.has(key) === now) context.fillRect(...corner(key), Math.ceil(side), Math.ceil(side));
  }
  for (const [key, bits] of cells) drawWalls(context, ...corner(key), side, bits);
  drawTrail(camera, walk.trail);
  for (const [name, place] of walk.landmarks) drawPlace(camera, place, name, name === walk.goal);
  drawPerson(camera, walk.at);
  if (walk.advise) walk.theta.forEach((share, move) => share > 0 && drawArrow(camera, walk.at, OFFSETS[move], share));
}

/** The part of the building that the canvas shows: as much as fits around the person. */
function cameraOf(canvas, walk) {
  const width = canvas.parentElement.clientWidth - 2 * parseFloat(getComputedStyle(canvas.parentElement).paddingLeft);
  const [rows, columns] = walk.shape;
  const side = Math.max(SMALLEST, width > 600 ? 20 : 0, Math.min(LARGEST, width / columns));
  const height = Math.min(rows * side, Math.max(260, Math.min(width, 0.48 * window.innerHeight)));
  const scale = window.devicePixelRatio || 1;
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  canvas.style.height = `${height}px`;
  const context = canvas.getContext("2d");
  context.scale(scale, scale);
  const left = shift(walk.at[1], columns, width / side);
  const top = shift(walk.at[0], rows, height / side);
  const corner = (row, column) => [Math.round((column - left) * side), Math.round((row - top) * side)]; // no seams
  const centre = ([row, column]) => corner(row + 0.5, column + 0.5);
  return { context, side, corner, centre, width, height };
}

/** First row or column in view, so that the person is in the middle and no room beside the building is wasted. */
function shift(place, length, shown) {
  if (shown >= length) return (length - shown) / 2;
  return Math.max(0, Math.min(length - shown, place + 0.5 - shown / 2));
}

function drawWalls(context, x, y, side, bits) {
  context.strokeStyle = COLOURS.wall;
  context.lineWidth = 2.5;
  context.beginPath();
  const edges = [[x, y, x + side, y], [x, y + side, x + side, y + side], [x + side, y, x + side, y + side], [x, y, x, y + side]];
  edges.forEach(([x0, y0, x1, y1], move) => {
    if (bits & (1 << move)) return;
    context.moveTo(x0, y0);
    context.lineTo(x1, y1);
  });
  context.stroke();
}

function drawTrail({ context, centre }, trail) {
  context.strokeStyle = COLOURS.trail;
  context.lineWidth = 2;
  context.beginPath();
  trail.forEach((cell, k) => (k ? context.lineTo(...centre(cell)) : context.moveTo(...centre(cell))));
  context.stroke();
}

function drawPlace({ context, side, centre, width }, cell, name, isGoal) {
  const [x, y] = centre(cell);
  context.fillStyle = isGoal ? COLOURS.goal : COLOURS.place;
  context.fillRect(x - 0.32 * side, y - 0.32 * side, 0.64 * side, 0.64 * side);
  context.font = `${isGoal ? "bold " : ""}13px system-ui, sans-serif`;
  const text = isGoal ? `${name} (goal)` : name;
  const half = context.measureText(text).width / 2;
  const middle = Math.max(half + 4, Math.min(width - half - 4, x));
  const above = y - 0.6 * side < 16;
  const base = above ? y + 0.6 * side + 12 : y - 0.6 * side;
  context.fillStyle = COLOURS.paper;
  context.fillRect(middle - half - 3, base - 12, 2 * half + 6, 16);
  context.fillStyle = COLOURS.wall;
  context.textAlign = "center";
  context.fillText(text, middle, base);
}

function drawPerson({ context, side, centre }, cell) {
  const [x, y] = centre(cell);
  context.fillStyle = COLOURS.person;
  context.strokeStyle = COLOURS.paper;
  context.lineWidth = 2;
  context.beginPath();
  context.arc(x, y, Math.max(6, 0.42 * side), 0, 2 * Math.PI);
  context.fill();
  context.stroke();
}

/** An arrow of advice, longer for a larger probability, with the probability at its tip. */
function drawArrow({ context, side, centre }, cell, [down, right], share) {
  const [x, y] = centre(cell);
  const first = Math.max(9, 0.55 * side);
  const last = first + 16 + 30 * share;
  const [x0, y0, x1, y1] = [x + first * right, y + first * down, x + last * right, y + last * down];
  context.strokeStyle = context.fillStyle = COLOURS.advice;
  context.lineWidth = 5;
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1 - 8 * right, y1 - 8 * down);
  context.stroke();
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x1 - 12 * right - 8 * down, y1 - 12 * down - 8 * right);
  context.lineTo(x1 - 12 * right + 8 * down, y1 - 12 * down + 8 * right);
  context.fill();
  const text = `${Math.round(100 * share)} %`;
  context.font = "bold 13px system-ui, sans-serif";
  const half = context.measureText(text).width / 2;
  const [cx, cy] = [x1 + (half + 6) * right, y1 + 12 * down];
  context.fillStyle = COLOURS.paper;
  context.fillRect(cx - half - 3, cy - 9, 2 * half + 6, 18);
  context.fillStyle = COLOURS.advice;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText(text, cx, cy);
  context.textBaseline = "alphabetic";
}
