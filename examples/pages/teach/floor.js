// The factory floor on a canvas: walls, numbered stations, robot; and the same in words.

const WALL = "#59616b", FREE = "#ffffff", LINE = "#eef0f3", PROCURE = "#23783f", ASSEMBLE = "#b03a34", DONE = "#dfe3e8", INK = "#22262b", ROBOT = "#0072b2";
const PALE_PROCURE = "#c5e3cf", PALE_ASSEMBLE = "#f0cfcc";

/** The letter of the assembly point of a component. */
export const letter = (component) => String.fromCharCode(96 + component);

/** Draw the floor; stations that are used already are grey, those of other components pale. */
export function drawFloor(canvas, floor, view) {
  const context = canvas.getContext("2d"), side = canvas.width / floor.length;
  floor.forEach((row, y) => [...row].forEach((sign, x) => {
    context.fillStyle = sign === "#" ? WALL : FREE;
    context.fillRect(x * side, y * side, side, side);
    if (sign === "#") return;
    context.strokeStyle = LINE;
    context.strokeRect(x * side + 0.5, y * side + 0.5, side - 1, side - 1);
  }));
  context.font = `bold ${Math.round(0.7 * side)}px system-ui, sans-serif`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  for (const cell of view.unused.procure) station(context, side, cell, "", PALE_PROCURE);
  for (const cell of view.unused.assemble) station(context, side, cell, "", PALE_ASSEMBLE);
  for (const item of view.items) {
    station(context, side, item.procure, `${item.component}`, item.stage === "raw" ? PROCURE : DONE);
    station(context, side, item.assemble, letter(item.component), item.stage === "assembled" ? DONE : ASSEMBLE);
  }
  const [row, column] = view.cell;
  context.strokeStyle = ROBOT;
  context.lineWidth = 5;
  context.beginPath();
  context.arc((column + 0.5) * side, (row + 0.5) * side, 0.42 * side, 0, 2 * Math.PI);
  context.stroke();
  context.lineWidth = 1;
}

function station(context, side, [row, column], text, colour) {
  context.fillStyle = colour;
  context.fillRect(column * side, row * side, side, side);
  context.fillStyle = colour === DONE ? INK : FREE;
  context.fillText(text, (column + 0.5) * side, (row + 0.55) * side);
}

/** Where the robot is and what is around it, in words. */
export function describeFloor(floor, view) {
  const [row, column] = view.cell;
  const walls = [["above", -1, 0], ["below", 1, 0], ["to the right", 0, 1], ["to the left", 0, -1]]
    .filter(([, down, across]) => floor[row + down]?.[column + across] === "#").map(([name]) => name);
  const goals = view.items.filter((item) => item.stage !== "assembled").map((item) => {
    const raw = item.stage === "raw";
    const [y, x] = raw ? item.procure : item.assemble;
    return `${raw ? `station ${item.component}` : `point ${letter(item.component)}`} lies ${steps(x - column, "right", "left")}, ${steps(y - row, "down", "up")}`;
  });
  return `Robot in row ${row}, column ${column}; walls ${walls.join(", ") || "nowhere beside it"}${goals.map((goal) => `; ${goal}`).join("")}.`;
}

const steps = (n, forward, backward) => `${Math.abs(n)} ${n < 0 ? backward : forward}`;
