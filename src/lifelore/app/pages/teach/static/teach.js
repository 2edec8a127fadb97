// The page /teach: steps by keys and buttons, the advice of the prior, and the curves of the learners.

import { ask, make, saveAs, say } from "/static/shell/shell.js";
import { lineChart } from "/static/shell/charts.js";
import { describeFloor, drawFloor, letter } from "/static/teach/floor.js";

const KEYS = { ArrowUp: 0, ArrowDown: 1, ArrowRight: 2, ArrowLeft: 3, p: 4, P: 4, a: 5, A: 5 };
const LESSON = "lifelore lesson";
const PARTS = [5, 10, 20, 40, 70, 100]; // Episodes after which the curves are drawn.
const COLOURS = { "without a prior": "#5b636d", "with your prior": "#0072b2", "with a prior from exact policies": "#007a59" };
const byId = (id) => document.getElementById(id);
const canvas = byId("floor"), message = byId("message");

let view, floor, waiting = Promise.resolve(), learning = 0;

resume();

async function resume() {
  const earlier = sessionStorage.getItem(LESSON);
  if (!earlier) return;
  try {
    show(await ask(`/v1/teach/lessons/${earlier}`));
    if (view.shown) learn();
  } catch {
    sessionStorage.removeItem(LESSON);
  }
}

function show(changed) {
  view = { ...view, ...changed };
  floor = view.floor;
  sessionStorage.setItem(LESSON, view.lesson);
  byId("begin-panel").hidden = true;
  byId("work").hidden = false;
  byId("lesson-panel").hidden = false;
  byId("identifier").textContent = view.lesson;
  drawFloor(canvas, floor, view);
  Object.assign(canvas.dataset, { number: view.number, steps: view.steps, over: view.over, shown: view.shown, row: view.cell[0], column: view.cell[1] });
  byId("where").textContent = describeFloor(floor, view);
  byId("items").replaceChildren(...view.items.map((item) => make("li", {}, describeItem(item))));
  byId("progress").textContent = `Factory ${view.number + 1}: ${view.steps} steps, reward ${view.reward.toFixed(0)}. Tasks you finished: ${view.shown}. ` +
    `The memory holds ${count(view.memory.demonstrations, "demonstration")} of ${count(view.memory.lessons, "lesson")}.`;
  byId("next").hidden = !view.over;
  byId("skip").hidden = view.over;
  byId("status").textContent = describeStatus();
  showAdvice();
}

const count = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;

function describeItem(item) {
  const n = item.component;
  if (item.stage === "raw") return `Component ${n}: fetch it at ${n} with P`;
  return item.stage === "procured" ? `Component ${n}: assemble it at ${letter(n)} with A` : `Component ${n}: assembled`;
}

function describeStatus() {
  if (view.over) return "All is assembled; the demonstration is stored and counts in your prior. Go on to the next factory, or watch the learners.";
  return view.collision ? "That is a wall: −100." : "Move with the arrow keys; P procures, A assembles.";
}

function showAdvice() {
  byId("advice").hidden = !byId("show-advice").checked;
  byId("advised").textContent = view.advised ? "You have shown what to do in such a place:" : "You have not shown such a place yet; all steps are alike:";
  byId("advice-rows").replaceChildren(...Object.entries(view.advice).map(([action, probability]) => {
    const bar = make("div", { class: "bar" }, make("span"));
    bar.firstChild.style.width = `${100 * probability}%`;
    return make("tr", {}, make("th", { scope: "row" }, action), make("td", { class: "wide" }, bar),
      make("td", { class: "number" }, `${Math.round(100 * probability)} %`));
  }));
}

/** Questions in the order of the keys, one after the other. */
function inTurn(action) {
  waiting = waiting.then(async () => {
    try {
      await action();
    } catch (error) {
      say(message, error.message, "error");
    }
  });
  return waiting;
}

function step(action) {
  return inTurn(async () => {
    if (!view || view.over) return;
    const before = view.shown;
    show(await ask(`/v1/teach/lessons/${view.lesson}/steps`, { method: "POST", body: { action } }));
    say(message, "");
    if (view.shown === before) return;
    show(await ask(`/v1/teach/lessons/${view.lesson}`));
    byId("next").focus();
    learn();
  });
}

async function learn() {
  const own = ++learning;
  for (const episodes of PARTS) {
    if (own !== learning) return;
    let found;
    try {
      found = await ask(`/v1/teach/lessons/${view.lesson}/curves`, { method: "POST", body: { episodes } });
    } catch (error) {
      say(message, error.message, "error");
      return;
    }
    if (own !== learning) return;
    drawCurves(found);
  }
}

function drawCurves(found) {
  const done = found.episodes === found.most ? "have learnt" : "are learning";
  byId("learning-status").textContent = `Learners ${done}: episode ${found.episodes} of ${found.most}, each kind in ${found.learners} new factories, ` +
    `with a prior from ${count(found.demonstrations, "demonstration")}. Bars: one standard deviation.`;
  const series = Object.entries(found.curves).map(([name, curve]) => {
    const parts = inParts(curve.mean, found.episodes), spread = inParts(curve.deviation, found.episodes);
    return { name, colour: COLOURS[name], points: parts, half: spread.map(([, half]) => half) };
  });
  byId("curves").replaceChildren(lineChart({ title: "Figure 3.16. Reward of an episode (means of 5 episodes)", xlabel: "episode", ylabel: "reward", series, digits: 0, xends: [0, found.most] }));
  byId("curves").dataset.episodes = found.episodes;
}

/** Means over parts of five episodes, as [last episode, mean]. */
function inParts(values, episodes) {
  const points = [];
  for (let end = 5; end <= episodes; end += 5)
    points.push([end, values.slice(end - 5, end).reduce((sum, value) => sum + value, 0) / 5]);
  return points;
}

byId("begin").addEventListener("click", () => inTurn(async () => {
  say(message, "");
  show(await ask("/v1/teach/lessons", { method: "POST", body: { components: Number(byId("components").value) } }));
  canvas.focus();
}));

function goOn() {
  inTurn(async () => {
    show(await ask(`/v1/teach/lessons/${view.lesson}/next`, { method: "POST" }));
    canvas.focus();
  });
}

byId("next").addEventListener("click", goOn);
byId("skip").addEventListener("click", goOn);
byId("show-advice").addEventListener("change", showAdvice);

byId("record").addEventListener("click", () => inTurn(() =>
  saveAs(`/v1/teach/lessons/${view.lesson}/record`, `teach_${view.lesson}.jsonl`)));

byId("delete").addEventListener("click", () => inTurn(async () => {
  if (!confirm("Delete all that is stored of this lesson, for ever?")) return;
  learning++; // no more questions about its curves
  await ask(`/v1/teach/lessons/${view.lesson}`, { method: "DELETE" });
  sessionStorage.removeItem(LESSON);
  view = undefined;
  byId("lesson-panel").hidden = true;
  byId("begin-panel").hidden = false;
  byId("work").hidden = true;
  byId("status").textContent = "Your demonstrations are deleted.";
  byId("curves").replaceChildren();
}));

window.addEventListener("keydown", (event) => {
  const action = KEYS[event.key];
  if (action === undefined || event.ctrlKey || event.altKey || event.metaKey || !view || view.over) return;
  if (event.target.closest("select, input")) return;
  event.preventDefault();
  step(action);
});

for (const button of document.querySelectorAll("[data-action]"))
  button.addEventListener("click", () => step(Number(button.dataset.action)));
