// The page /walk: asks for steps, and joins map, curves and controls.

import { ask, make, say } from "/static/shell/shell.js";
import { drawCurves } from "/static/walk/curves.js";
import { drawMap, newMap, remember } from "/static/walk/map.js";

const MOVES = ["north", "south", "east", "west"];
const KEYS = { ArrowUp: "north", ArrowDown: "south", ArrowRight: "east", ArrowLeft: "west" };
const at = (id) => document.getElementById(id);
const percent = (share) => `${Math.round(100 * share)}\u00a0%`;

let walk = null;
let busy = false;
let renewal = false; // whether a new start waits for the present request
let finished = 0;

async function main() {
  const { buildings } = await ask("/v1/walks");
  at("building").replaceChildren(...buildings.map(({ name, title }) => make("option", { value: name }, title)));
  at("controls").addEventListener("submit", (event) => {
    event.preventDefault();
    renew();
    at("map").focus();
  });
  document.addEventListener("keydown", onKey);
  for (const button of document.querySelectorAll("#moves button")) {
    button.addEventListener("click", () => guarded(() => move(button.dataset.move)));
  }
  new ResizeObserver(() => walk && drawMap(at("map"), walk)).observe(at("map").parentElement);
  renew();
}

function onKey(event) {
  const direction = KEYS[event.key];
  if (!direction || event.target.closest("select") || event.ctrlKey || event.altKey || event.metaKey || !walk || walk.reached) return;
  event.preventDefault();
  guarded(() => move(direction));
}

/** Begin a new walk, after the present request if there is one. */
function renew() {
  walk = null;
  at("errand").textContent = "Preparing the building …";
  renewal = busy;
  if (!busy) guarded(begin);
}

/** Run one action at a time; an error becomes a line on the page, and the next action may go on. */
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
    if (renewal) renew();
  }
}

async function begin() {
  const building = at("building").value;
  const advice = at("advice").checked;
  const name = `walk-${crypto.getRandomValues(new Uint32Array(2)).join("-")}`;
  let view;
  try {
    view = await ask(`/v1/walks/${name}`, { method: "PUT", body: { building, advice } });
  } catch (error) {
    at("errand").textContent = "No building is open";
    throw error;
  }
  if (renewal) return;
  walk = { name, building, advice, ...newMap(view.shape), history: [], trail: [view.at] };
  Object.assign(walk, { goal: view.goal, shortest: view.shortest, kappa: view.kappa });
  say(at("found"), "");
  show(view);
}

async function move(direction) {
  if (!walk || walk.reached) return;
  const { name, building, advice, step, state } = walk;
  const body = { building, advice, step: step + 1, state, move: direction };
  const view = await ask(`/v1/walks/${name}/steps`, { method: "POST", body });
  if (walk?.name !== name) return;
  walk.trail.push(view.at);
  show(view);
  if (view.reached) finish();
}

/** Take in what the service answered, and draw everything again. */
function show(view) {
  Object.assign(walk, view);
  remember(walk, view);
  walk.history.push({ p: view.p_normal, gain: view.gain, advise: view.advise });
  drawMap(at("map"), walk);
  drawCurves(at("curves"), walk.history, walk.kappa);
  const errand = walk.reached ? `You found the ${walk.goal}` : `Find the ${walk.goal}`;
  at("errand").textContent = `${errand} · ${counted(walk.step, "step")} (shortest way: ${walk.shortest})`;
  at("seen").textContent = surroundings();
  at("counsel").textContent = counsel();
  for (const button of document.querySelectorAll("#moves button")) {
    const share = walk.advise ? walk.theta[MOVES.indexOf(button.dataset.move)] : 0;
    button.classList.toggle("advised", share > 0);
    button.querySelector(".share").textContent = share > 0 ? percent(share) : "";
    button.disabled = walk.reached;
  }
}

function surroundings() {
  const places = walk.places.map(({ name }) => (name === walk.goal ? `the ${name}, your goal` : `the ${name}`));
  const open = walk.open.length ? `You can go ${walk.open.join(", ")}.` : "You cannot move.";
  return places.length ? `${open} You see ${places.join(", ")}.` : open;
}

function counsel() {
  const numbers = `P(M | H) ${walk.p_normal.toFixed(2)}; gain ${walk.gain.toFixed(2)} nats, threshold ${walk.kappa}.`;
  if (!walk.advice) return `Advice is off. ${numbers}`;
  if (!walk.advise) return `No advice now. ${numbers}`;
  const moves = MOVES.map((name, k) => [name, walk.theta[k]]).filter(([, share]) => share > 0);
  return `Advice: ${moves.map(([name, share]) => `${name} ${percent(share)}`).join(", ")}. ${numbers}`;
}

function finish() {
  const ratio = (walk.step / walk.shortest).toFixed(1);
  const cells = [[walk.step, "number"], [walk.shortest, "number"], [ratio, "number"]];
  const row = make("tr", {}, make("td", {}, walk.advice ? "on" : "off"), make("td", {}, walk.goal));
  row.append(...cells.map(([text, kind]) => make("td", { class: kind }, String(text))));
  const body = at("walks").tBodies[0];
  if (!finished) body.replaceChildren();
  finished += 1;
  body.prepend(row);
  const words = `You found the ${walk.goal} in ${counted(walk.step, "step")}; the shortest way has ${walk.shortest}.`;
  say(at("found"), `${words} Press New start for another errand; turn the advice ${walk.advice ? "off" : "on"} to compare.`);
  at("start").focus();
}

const counted = (number, noun) => `${number} ${noun}${number === 1 ? "" : "s"}`;

main().catch((error) => say(at("error"), error.message, "error"));
