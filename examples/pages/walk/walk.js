// The page of a walk: asks for steps, and draws the map, the curves and the advice.

import { ask, make, say } from "/static/shell/shell.js";
import { lineChart } from "/static/shell/charts.js";
import { drawMap } from "/page/map.js";

const MOVES = ["north", "south", "east", "west"];
const KEYS = { ArrowUp: "north", ArrowDown: "south", ArrowRight: "east", ArrowLeft: "west" };
const at = (id) => document.getElementById(id);
const percent = (share) => `${Math.round(100 * share)} %`;

let walk, busy = false;

/** One question at a time; an error becomes a line on the page. */
async function guarded(action) {
  if (busy) return;
  busy = true;
  try {
    await action();
    say(at("error"), "");
  } catch (error) {
    say(at("error"), error.message, "error");
  } finally {
    busy = false;
  }
}

function begin(view) {
  walk = { advice: at("advice").checked, cells: new Map(), landmarks: new Map(), trail: [], history: [] };
  show(view);
}

function move(direction) {
  if (!walk || walk.reached) return;
  guarded(async () => {
    show(await ask("/step", { method: "POST", body: { move: direction } }));
    if (walk.reached) finish();
  });
}

/** Take in what the service answered, and draw everything again. */
function show(view) {
  Object.assign(walk, view);
  const [, columns] = view.shape;
  walk.now = new Set(view.seen.map(([row, column]) => row * columns + column));
  for (const [row, column, bits] of view.seen) walk.cells.set(row * columns + column, bits);
  for (const place of view.places) walk.landmarks.set(place.name, place.at);
  walk.trail.push(view.at);
  walk.history.push([view.p_normal, view.gain]);
  drawMap(at("map"), walk);
  const curve = (k, title, level) => lineChart({
    title, level, xlabel: "steps", ylabel: "", markers: false, xends: [0, Math.max(20, walk.steps)],
    series: [{ name: title, points: walk.history.map((values, step) => [step, values[k]]) }],
  });
  at("curves").replaceChildren(curve(0, "P(M | H)", 1), curve(1, `gain in nats; dotted: κ = ${view.kappa}`, view.kappa));
  at("errand").textContent = `${walk.reached ? "You found" : "Find"} the ${walk.goal} · ${walk.steps} ${walk.steps === 1 ? "step" : "steps"} (shortest way: ${walk.shortest})`;
  at("seen").textContent = `You can go ${walk.open.join(", ")}.` +
    (walk.places.length ? ` You see ${walk.places.map(({ name }) => `the ${name}`).join(", ")}.` : "");
  at("counsel").textContent = counsel();
  for (const button of document.querySelectorAll("#moves button")) {
    const share = walk.advise ? walk.theta[MOVES.indexOf(button.dataset.move)] : 0;
    button.classList.toggle("advised", share > 0);
    button.querySelector("span").textContent = share > 0 ? percent(share) : "";
    button.disabled = walk.reached;
  }
}

function counsel() {
  if (!walk.advice) return "Advice is off.";
  if (!walk.theta) return "No expert's walk leads on from here, so there is no advice.";
  if (!walk.advise) return "No advice now.";
  const moves = MOVES.map((name, k) => [name, walk.theta[k]]).filter(([, share]) => share > 0);
  return `Advice: ${moves.map(([name, share]) => `${name} ${percent(share)}`).join(", ")}.`;
}

function finish() {
  const number = (text) => make("td", { class: "number" }, `${text}`);
  at("walks").tBodies[0].prepend(make("tr", {}, make("td", {}, walk.advice ? "on" : "off"), make("td", {}, walk.goal),
    number(walk.steps), number(walk.shortest)));
  at("start").focus();
}

at("controls").addEventListener("submit", (event) => {
  event.preventDefault();
  guarded(async () => begin(await ask("/begin", { method: "POST", body: { advice: at("advice").checked } })));
  at("map").focus();
});
document.addEventListener("keydown", (event) => {
  if (!(event.key in KEYS) || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  move(KEYS[event.key]);
});
for (const button of document.querySelectorAll("#moves button")) button.addEventListener("click", () => move(button.dataset.move));
new ResizeObserver(() => walk && drawMap(at("map"), walk)).observe(at("map").parentElement);
guarded(async () => begin(await ask("/walk")));
