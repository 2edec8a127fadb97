// The field of the ball game on a canvas: walls, goal and ball, and the same in words.

const WALL = "#3a5ca8", GOAL = "#269168", BALL = "#ce342e", PAPER = "#ffffff", INK = "#22262b";
const SEEN = 7; // Units: a smaller ball is drawn this large, so that it can be seen.

/** Draw the field; `ball` has x, y, radius and whether its last move hit a wall. */
export function drawField(canvas, game, ball) {
  const context = canvas.getContext("2d");
  const scale = canvas.width / game.side;
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.fillStyle = PAPER;
  context.fillRect(0, 0, game.side, game.side);
  const [left, top, right, bottom] = game.goal;
  context.fillStyle = GOAL;
  context.fillRect(left, top, right - left, bottom - top);
  context.fillStyle = PAPER;
  context.font = "bold 40px system-ui, sans-serif";
  context.textAlign = "center";
  context.fillText("goal", (left + right) / 2, (top + bottom) / 2 + 14);
  context.fillStyle = WALL;
  for (const polygon of game.polygons) {
    context.beginPath();
    for (const [x, y] of polygon) context.lineTo(x, y);
    context.fill();
  }
  context.lineWidth = 6;
  context.strokeStyle = WALL;
  context.strokeRect(0, 0, game.side, game.side);
  if (!ball) return;
  context.fillStyle = BALL;
  context.beginPath();
  context.arc(ball.x, ball.y, Math.max(ball.radius, SEEN), 0, 2 * Math.PI);
  context.fill();
  if (ball.hit) {
    context.strokeStyle = INK;
    context.lineWidth = 4;
    context.beginPath();
    context.arc(ball.x, ball.y, Math.max(ball.radius, SEEN) + 8, 0, 2 * Math.PI);
    context.stroke();
  }
}

/** Where the ball is, in words. */
export function describeField(game, ball) {
  const [left, top, right, bottom] = game.goal;
  const across = Math.round((left + right) / 2 - ball.x), down = Math.round((top + bottom) / 2 - ball.y);
  const way = `${Math.abs(across)} to the ${across < 0 ? "left" : "right"} and ${Math.abs(down)} ${down < 0 ? "up" : "down"}`;
  return `The ball is at ${Math.round(ball.x)}, ${Math.round(ball.y)}; the goal is ${way}. Moves ${ball.moves}, collisions ${ball.hits}.`;
}
