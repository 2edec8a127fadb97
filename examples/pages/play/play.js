// The page of the study: consent, rounds move by move, keys and buttons.

import { ask, say } from "/static/shell/shell.js";
import { describeField, drawField } from "/page/field.js";

const KEYS = { ArrowUp: 0, ArrowDown: 1, ArrowRight: 2, ArrowLeft: 3, w: 0, s: 1, d: 2, a: 3 };
const PHASES = { practice: "Practice", training: "Training", test: "Test" };
const byId = (id) => document.getElementById(id);
const post = (path, body = {}) => ask(path, { method: "POST", body });
const frame = () => new Promise(requestAnimationFrame);

let game, session, heading = null, round = 0; // `round` counts what was begun: a number that changes stops the loop

attempt(async () => {
  game = await ask("/game");
  byId("consent-text").textContent = `${game.consent} A session has ${game.rounds} rounds.`;
  drawField(byId("field"), game, { x: game.start[0], y: game.start[1], radius: 10 });
  if (game.session) show(game.session);
});

async function attempt(action) {
  try {
    say(byId("message"), "");
    await action();
  } catch (error) {
    stop();
    say(byId("message"), error.message, "error");
  }
}

async function play() {
  const own = ++round, { next } = session;
  const begun = await post("/begin");
  heading = null;
  let ball = begun;
  byId("next").disabled = true;
  byId("round").textContent = `${PHASES[next.phase]} ${session.number + 1} of ${session.rounds}: ball size ${next.size}` +
    `${next.speed ? `, speed ${next.speed}` : ""}. Press an arrow key to start the ball.`;
  byId("field").scrollIntoView({ block: "nearest" });
  while (own === round && !ball.over) {
    draw({ ...begun, ...ball });
    if (heading === null) {
      await frame();
      continue;
    }
    const before = ball, end = performance.now() + (1000 / 30) * session.frames_per_move;
    ball = await post("/move", { heading });
    await glide({ ...begun, ...before }, ball, end, own);
  }
  if (own !== round) return;
  draw({ ...begun, ...ball });
  byId("last").textContent = byId("round").textContent =
    `${ball.reached ? "Goal reached" : "Out of moves"} after ${ball.moves} moves with ${ball.hits} collisions: loss ${ball.loss.toFixed(2)}.`;
  show(ball.session);
  byId("next").focus();
}

/** Draw the ball on its way from one place to the next, until the time of the move is over. */
async function glide(before, after, end, own) {
  const began = performance.now();
  for (let now = began; now < end && own === round; now = performance.now()) {
    const share = (now - began) / (end - began);
    const at = (axis) => before[axis] + share * (after[axis] - before[axis]);
    drawField(byId("field"), game, { ...before, x: at("x"), y: at("y") });
    await frame();
  }
}

function draw(ball) {
  drawField(byId("field"), game, ball);
  byId("where").textContent = describeField(game, ball);
}

function stop() {
  round++;
  byId("next").disabled = !session?.next;
}

function show(view) {
  session = view;
  byId("session").hidden = false;
  byId("consent-panel").hidden = true;
  byId("identifier").textContent = view.session;
  byId("progress").textContent = !view.next ? `All ${view.rounds} rounds are played and stored. Thank you.`
    : `${PHASES[view.next.phase]}: round ${view.number + 1} of ${view.rounds}, ball size ${view.next.size}` +
      (view.next.phase === "test" ? ". In the test you are not told how the speed is chosen." : ".");
  byId("next").disabled = !view.next;
}

byId("consent").addEventListener("change", () => { byId("take-part").disabled = !byId("consent").checked; });
byId("take-part").addEventListener("click", () => attempt(async () => {
  show(await post("/take_part", { consent: byId("consent").checked }));
  byId("next").focus();
}));
byId("next").addEventListener("click", () => attempt(play));
byId("another").addEventListener("click", () => {
  stop();
  byId("consent").checked = false;
  byId("take-part").disabled = true;
  byId("session").hidden = true;
  byId("consent-panel").hidden = false;
});
window.addEventListener("keydown", (event) => {
  if (event.key === "Escape") {
    stop();
    byId("round").textContent = "The round is stopped; nothing of it is recorded.";
  }
  if (!(event.key in KEYS) || event.ctrlKey || event.altKey || event.metaKey || !session) return;
  event.preventDefault();
  heading = KEYS[event.key];
});
for (const button of document.querySelectorAll("[data-heading]"))
  button.addEventListener("click", () => { heading = Number(button.dataset.heading); });
