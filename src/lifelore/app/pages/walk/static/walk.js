// The page /walk: asks for steps, and joins map, curves and controls.

import { ask, make, say } from "/static/shell/shell.js";
import { drawCurves } from "/static/walk/curves.js";
import { drawMap, newMap, remember } from "/static/walk/map.js";

const MOVES = ["north", "south", "east", "west"];
const KEYS = { ArrowUp: "north", ArrowDown: "south", ArrowRight: "east", ArrowLeft: "west" };
const at = (id) => document.getElementById(id);
const WALKS = "lifelore walks"; // the walk in progress and the finished ones, in this tab until it is closed
const percent = (share) => `${Math.round(100 * share)}\u00a0%`;

let walk = null;
let busy = false;
let renewal = false; // whether a new start waits for the present request
let { current, finished } = JSON.parse(sessionStorage.getItem(WALKS)) ?? { current: null, finished: [] };

async function main() {
  const { buildings } = await ask("/v1/walks");
  at("building").replaceChildren(...buildings.map(({ name, title }) => make("option", { value: name }, title)));
  at("controls").addEventListener("submit", (event) => {
    event.preventDefault();
    current = null;
    renew();
    at("map").focus();
  });
  document.addEventListener("keydown", onKey);
  for (const button of document.querySelectorAll("#moves button")) {
    button.addEventListener("click", () => guarded(() => move(button.dataset.move)));
  }
  new ResizeObserver(() => walk && drawMap(at("map"), walk)).observe(at("map").parentElement);
  showFinished();
  if (buildings.some(({ name }) => name === current?.building)) {
    at("building").value = current.building;
    at("advice").checked = current.advice;
  } else {
    current = null;
  }
  // A visit stores nothing: a walk begins where a person asks for it.
  if (current) renew();
  else invite();
}

/** Ask for the first start. */
function invite() {
  at("errand").textContent = "Choose a building and press New start";
}

function onKey(event) {
  const direction = KEYS[event.key];
  if (!direction || event.target.closest("select") || event.ctrlKey || event.altKey || event.metaKey || !walk || walk.reached) return;
  event.preventDefault();
  guarded(() => move(direction));
}

/** Go on with the current walk or begin a new one, after the present request if there is one. */
function renew() {
  walk = null;
  at("errand").textContent = "Preparing the building …";
  renewal = busy;
  if (!busy) guarded(enter);
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

/** Go on with the walk of this tab, or begin a new one. */
async function enter() {
  try {
    await (current ? resume() : begin());
  } catch (error) {
    at("errand").textContent = "No building is open";
    throw error;
  }
}

async function begin() {
  const building = at("building").value;
  const advice = at("advice").checked;
  const name = `walk-${crypto.getRandomValues(new Uint32Array(2)).join("-")}`;
  const view = await ask(`/v1/walks/${name}`, { method: "PUT", body: { building, advice } });
  if (renewal) return;
  current = { name, building, advice };
  store();
  openWalk({ ...view, way: [view], known: view });
}

/** Go on with the current walk; the service has its steps. Where it has none, the person can begin another. */
async function resume() {
  const { name, building, advice } = current;
  let view;
  try {
    view = await ask(`/v1/walks/${name}?${new URLSearchParams({ building, advice })}`);
  } catch (error) {
    if (error.status !== 404) throw error;
    current = null;
    store();
    invite();
    return;
  }
  if (!renewal) openWalk(view);
}

/** Open a walk as it is now, with its way of {at, p_normal, gain, advise} so far and all cells and places known. */
function openWalk({ way, known, ...view }) {
  walk = { ...current, ...newMap(view.shape), trail: [], history: [] };
  say(at("found"), "");
  for (const step of way.slice(0, -1)) note(step);
  remember(walk, known);
  show(view);
  if (walk.reached) finish();
}

async function move(direction) {
  if (!walk || walk.reached) return;
  const { name, building, advice, step, state } = walk;
  const body = { building, advice, step: step + 1, state, move: direction };
  const view = await ask(`/v1/walks/${name}/steps`, { method: "POST", body });
  if (walk?.name !== name) return;
  if (view.step !== body.step) return resume(); // another tab or a lost answer: the service knows more steps
  show(view);
  if (view.reached) finish();
}

/** Take in what the service answered, and draw everything again. */
function show(view) {
  Object.assign(walk, view);
  remember(walk, view);
  note(view);
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

/** Take a step into the trail and the curves. */
function note({ at: cell, p_normal: p, gain, advise }) {
  walk.trail.push(cell);
  walk.history.push({ p, gain, advise });
}

function surroundings() {
  const places = walk.places.map(({ name }) => (name === walk.goal ? `the ${name}, your goal` : `the ${name}`));
  const open = walk.open.length ? `You can go ${walk.open.join(", ")}.` : "You cannot move.";
  return places.length ? `${open} You see ${places.join(", ")}.` : open;
}

function counsel() {
  const numbers = `P(M | H) ${walk.p_normal.toFixed(2)}; gain ${walk.gain.toFixed(2)} nats, threshold ${walk.kappa}.`;
  if (!walk.advice) return `Advice is off. ${numbers}`;
  if (!walk.theta) return `No expert's walk leads on from here, so there is no advice. ${numbers}`;
  if (!walk.advise) return `No advice now. ${numbers}`;
  const moves = MOVES.map((name, k) => [name, walk.theta[k]]).filter(([, share]) => share > 0);
  return `Advice: ${moves.map(([name, share]) => `${name} ${percent(share)}`).join(", ")}. ${numbers}`;
}

function finish() {
  const { name, advice, goal, step, shortest } = walk;
  if (!finished.some((earlier) => earlier.name === name)) finished.unshift({ name, advice, goal, step, shortest });
  store();
  showFinished();
  const words = `You found the ${goal} in ${counted(step, "step")}; the shortest way has ${shortest}.`;
  say(at("found"), `${words} Press New start for another errand; turn the advice ${advice ? "off" : "on"} to compare.`);
  at("start").focus();
}

function showFinished() {
  const row = ({ advice, goal, step, shortest }) => {
    const cells = [step, shortest, (step / shortest).toFixed(1)];
    return make("tr", {}, make("td", {}, advice ? "on" : "off"), make("td", {}, goal),
      ...cells.map((text) => make("td", { class: "number" }, String(text))));
  };
  if (finished.length) at("walks").tBodies[0].replaceChildren(...finished.map(row));
}

function store() {
  sessionStorage.setItem(WALKS, JSON.stringify({ current, finished }));
}

const counted = (number, noun) => `${number} ${noun}${number === 1 ? "" : "s"}`;

main().catch((error) => say(at("error"), error.message, "error"));
