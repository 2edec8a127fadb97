// The page of the lesson: steps by keys and buttons, the advice of the prior, and the curves of the learners.

import { ask, make, say } from "/static/shell/shell.js";
import { lineChart } from "/static/shell/charts.js";
import { describeFloor, drawFloor, letter } from "/page/floor.js";

const KEYS = { ArrowUp: 0, ArrowDown: 1, ArrowRight: 2, ArrowLeft: 3, p: 4, P: 4, a: 5, A: 5 };
const PART = 5; // Episodes of a point of a curve.
const COLOURS = ["var(--grey)", "var(--blue)", "var(--green)"];
const byId = (id) => document.getElementById(id);

let view, waiting = Promise.resolve();

inTurn(async () => show(await ask("/lesson")));

/** Questions in the order of the keys, one after the other. */
function inTurn(action) {
  waiting = waiting.then(async () => {
    try {
      say(byId("message"), "");
      await action();
    } catch (error) {
      say(byId("message"), error.message, "error");
    }
  });
}

function show(changed) {
  view = changed;
  drawFloor(byId("floor"), view.floor, view);
  byId("where").textContent = describeFloor(view.floor, view);
  byId("items").replaceChildren(...view.items.map((item) => make("li", {}, describeItem(item))));
  byId("progress").textContent = `Factory ${view.number + 1}: ${view.steps} steps, reward ${view.reward.toFixed(0)}. Tasks you finished: ${view.shown}.`;
  byId("next").textContent = view.over ? "Next factory" : "Skip this factory";
  byId("status").textContent = view.over ? "All is assembled; the demonstration is stored and counts in your prior."
    : view.collision ? "That is a wall: −100." : "Move with the arrow keys; P procures, A assembles.";
  byId("advised").textContent = view.advised ? "You have shown what to do in such a place:" : "You have not shown such a place yet; all steps are alike:";
  byId("advice").replaceChildren(...Object.entries(view.advice).map(([action, probability]) => {
    const bar = make("div", { class: "bar" }, make("span"));
    bar.firstChild.style.width = `${100 * probability}%`;
    return make("tr", {}, make("th", { scope: "row" }, action), make("td", { class: "wide" }, bar),
      make("td", { class: "number" }, `${Math.round(100 * probability)} %`));
  }));
}

function describeItem({ component, stage }) {
  if (stage === "raw") return `Component ${component}: fetch it at ${component} with P`;
  return stage === "procured" ? `Component ${component}: assemble it at ${letter(component)} with A` : `Component ${component}: assembled`;
}

function step(action) {
  inTurn(async () => {
    if (view.over) return;
    show(await ask("/step", { method: "POST", body: { action } }));
    if (view.over) {
      byId("next").focus();
      learn().catch((error) => say(byId("message"), error.message, "error"));
    }
  });
}

async function learn() {
  const shown = view.shown;
  byId("learning").textContent = "The learners learn …";
  const curves = await ask("/curves");
  const series = Object.entries(curves).map(([name, curve], i) => {
    const points = inParts(curve.mean), half = inParts(curve.deviation).map(([, deviation]) => deviation);
    return { name, colour: COLOURS[i], points, half };
  });
  byId("learning").textContent = `Learners with a prior from ${shown} ${shown === 1 ? "task" : "tasks"}, each kind in eight new factories. Bars: one standard deviation.`;
  byId("curves").replaceChildren(lineChart({ title: `Figure 3.16. Reward of an episode (means of ${PART} episodes)`, xlabel: "episode", ylabel: "reward", series, digits: 0 }));
}

/** Means over parts, as [last episode, mean]. */
function inParts(values) {
  const points = [];
  for (let end = PART; end <= values.length; end += PART)
    points.push([end, values.slice(end - PART, end).reduce((sum, value) => sum + value, 0) / PART]);
  return points;
}

byId("next").addEventListener("click", () => inTurn(async () => {
  show(await ask("/go_on", { method: "POST", body: {} }));
  byId("floor").focus();
}));
window.addEventListener("keydown", (event) => {
  const action = KEYS[event.key];
  if (action === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  step(action);
});
for (const button of document.querySelectorAll("[data-action]"))
  button.addEventListener("click", () => step(Number(button.dataset.action)));
