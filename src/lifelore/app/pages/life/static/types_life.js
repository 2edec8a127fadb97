// A life of tasks with hidden types: returns, beliefs, reasons, expectations and curiosity.

import { ask, make } from "/static/shell/shell.js";
import { drawCurves, drawStacks, short } from "./drawing.js";

const PALETTE = ["var(--blue)", "var(--orange)", "var(--green)", "var(--vermilion)", "var(--purple)", "var(--sky)", "#7a6a00", "#5d4bb5", "#c2185b", "#3f7f3f"];
const UNKNOWN = "an unknown type", UNKNOWN_COLOUR = "#8a929b", OTHERS = "var(--light)";
const SHOWN = 8; // types and contexts that are listed, the first ones
const $ = (id) => document.getElementById(id);

const asked = { about: null, family: null }; // the last answer about a family: it is the same for all tasks of a life

/** Ask for what the picture of a task needs; a function that draws it and answers a sentence about the life. */
export async function typesLife(life, tasks, number, revision) {
  const query = new URLSearchParams({ robot: life.robot, domain: life.domain, number });
  const task = await ask(`/v1/lives/task?${query}`);
  const about = `${revision} ${new URLSearchParams({ domain: life.domain, seed: task.seed ?? 0 })}`;
  if (asked.about !== about) {
    asked.family = await ask(`/v1/lives/family?${about.split(" ")[1]}`);
    asked.about = about;
  }
  const { family } = asked;
  return () => drawn(family, task, tasks, number);
}

function drawn(family, task, tasks, number) {
  const colourOf = colours(family, task);
  drawLife(tasks, number);
  drawTask(task, colourOf);
  drawExpected(family, colourOf);
  drawCurious(family);
  const half = tasks.slice(Math.floor(tasks.length / 2));
  const missed = half.reduce((sum, one) => sum + one.best - one.first, 0) / half.length;
  return `It knows ${plural(family.types.length, "type")}; in the second half, first episodes miss ${short(missed)} points of the best possible return.`;
}

function colours(family, task) {
  const names = [...new Set([...family.types.map((one) => one.name), ...Object.keys(task.prior), ...task.first_episode.flatMap((one) => Object.keys(one.belief))])];
  const known = names.filter((name) => name !== UNKNOWN).sort();
  return (name) => (name === UNKNOWN ? UNKNOWN_COLOUR : PALETTE[known.indexOf(name) % PALETTE.length]);
}

function drawLife(tasks, number) {
  const series = [
    { name: "first episode", colour: "var(--blue)", points: tasks.map((one) => [one.task, one.best - one.first]) },
    { name: "last episode", colour: "var(--orange)", dashed: true, points: tasks.map((one) => [one.task, one.best - one.last]) },
    { name: "a new type was found", colour: "var(--purple)", dots: true, points: tasks.filter((one) => one.new_type).map((one) => [one.task, one.best - one.first]) },
  ].filter((one) => one.points.length);
  const words = `Points below the best possible return, by task, in ${plural(tasks.length, "task")}.`;
  drawCurves($("curve"), series, { x: "task", y: "points below the best", words });
  $("curve-words").textContent = `Lower is better; 0 is the best possible return, which knows the hidden type. Shown below: task ${number}.`;
}

function drawTask(task, colourOf) {
  $("task-title").textContent = `Task ${task.task}`;
  const expected = shares(task.prior);
  $("task-context").textContent = expected
    ? `It came in context ${task.context}, in which the agent expected ${expected}.`
    : `It came in context ${task.context}. The agent knew no type yet.`;
  const names = [...new Set(task.first_episode.flatMap((one) => Object.keys(one.belief)))].sort();
  const columns = task.first_episode.map((one) => {
    const parts = names.map((name) => [one.belief[name] ?? 0, colourOf(name)]);
    const rest = 1 - parts.reduce((sum, [share]) => sum + share, 0);
    return [...parts, [Math.max(0, rest), OTHERS]];
  });
  drawStacks($("beliefs"), columns, {
    x: "act of the first episode", y: "belief", words: `Belief before each of ${plural(columns.length, "act")}: at first ${shares(task.first_episode[0].belief)}.`,
  });
  $("legend").replaceChildren(...names.map((name) => make("li", {}, swatch(colourOf(name)), name)), make("li", {}, swatch(OTHERS), "other types"));
  const returns = [
    { name: "return", colour: "var(--blue)", points: task.returns.map((value, i) => [i + 1, value]) },
    { name: "best possible", colour: "var(--grey)", dashed: true, points: task.returns.map((_, i) => [i + 1, task.best_return]) },
  ];
  const words = `Returns of ${plural(task.returns.length, "episode")}: from ${short(task.returns[0])} to ${short(task.returns.at(-1))}; best possible ${short(task.best_return)}.`;
  drawCurves($("episodes"), returns, { x: "episode", y: "return", words, height: 180 });
  $("why").replaceChildren(...task.first_episode.map(reason));
  $("conclusion").textContent = upper(task.words.at(-1).trim()) + ".";
  $("words").textContent = task.words.join("\n");
}

function reason(one) {
  const rival = one.next_best === null ? "" : `, the next best ${short(one.next_best)}`;
  return make(
    "li",
    {},
    make("strong", {}, upper(one.act)),
    ` as for ${one.as_for}: it expected ${short(one.expected)}${rival}; reward ${short(one.reward)}.`,
    make("span", { class: "quiet" }, `Saw ${one.scene}; believed in ${shares(one.belief)}.${one.effects.length ? ` Then: ${one.effects.slice(0, 3).join("; ")}${one.effects.length > 3 ? "; …" : "."}` : ""}`),
  );
}

function drawExpected(family, colourOf) {
  const entries = [...family.contexts].sort((a, b) => a.context - b.context).slice(0, SHOWN).map((one) => {
    const parts = Object.entries(one.expected).sort((a, b) => b[1] - a[1]);
    const bars = parts.map(([name, share]) => {
      const bar = make("span", { title: `${name} ${percent(share)}` });
      bar.style.width = `${100 * share}%`;
      bar.style.background = colourOf(name);
      return bar;
    });
    const likely = parts.slice(0, 2).map(([name, share]) => `${name} ${percent(share)}`).join(", ");
    const words = `Context ${one.context} (${plural(one.tasks, "task")}): ${likely}`;
    return make("div", { class: "expected" }, make("div", {}, words), make("div", { class: "stack", "aria-hidden": "true" }, ...bars));
  });
  const more = family.contexts.length > SHOWN ? [make("p", { class: "quiet" }, `and ${family.contexts.length - SHOWN} more contexts`)] : [];
  const none = make("p", { class: "quiet" }, "Nothing yet: only the full agent stores what it learns.");
  $("expects").replaceChildren(...(entries.length ? [...entries, ...more] : [none]));
}

function drawCurious(family) {
  const interesting = family.contexts.filter((one) => one.interest > 0);
  const contexts = interesting.slice(0, 5).map((one) =>
    make("li", {}, make("strong", {}, `Context ${one.context}`), ` comes in ${percent(one.frequency)} of the tasks, and ${doubt(one)}.`),
  );
  $("curious-contexts").replaceChildren(...(contexts.length ? contexts : [make("li", {}, "No context: each has had a single type so far.")]));
  $("types").replaceChildren(
    ...family.types.slice(0, SHOWN).map((one) => {
      const untried = one.untried >= 0.005 ? `; ${percent(one.untried)} of what usual tasks show is untried` : "";
      const head = make("summary", {}, `${one.name}: ${short(one.tasks)} tasks behind it${untried}`);
      return make("details", {}, head, make("ul", {}, ...one.telling.map((line) => make("li", {}, line))));
    }),
  );
}

/** Why a context is interesting, in words. */
function doubt(one) {
  const left = `its type is open by ${one.entropy.toFixed(2)} nats`;
  if (one.unsure < 0.01) return `${left}, because its tasks are of different types`;
  return `${left}, of which ${one.unsure.toFixed(2)} would go with more episodes`;
}

function shares(belief) {
  return Object.entries(belief).sort((a, b) => b[1] - a[1]).filter(([, share]) => share >= 0.005).map(([name, share]) => `${name} ${percent(share)}`).join(", ");
}

function swatch(colour) {
  const mark = make("span", { class: "swatch", "aria-hidden": "true" });
  mark.style.background = colour;
  return mark;
}

const percent = (share) => `${Math.round(100 * share)} %`;
const plural = (n, noun) => `${short(n)} ${noun}${n === 1 ? "" : "s"}`;
const upper = (text) => text[0].toUpperCase() + text.slice(1);
