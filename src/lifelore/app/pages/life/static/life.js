// The page /life: asks for the lives in memory, and draws the chosen one again whenever memory changes.

import { ask, make, say } from "/static/shell/shell.js";
import { short } from "./drawing.js";
import { mapLife } from "./map_life.js";
import { typesLife } from "./types_life.js";

const EVERY = 1000; // milliseconds between two looks at memory, and
const SHARE = 5; // more than this many times what the last look has taken, so that a large memory is not kept busy
const $ = (id) => document.getElementById(id);

const state = { revision: null, lives: [], life: null, tasks: [], number: null, asked: 0, failed: false, sizes: new Map() };

async function start() {
  $("choice").addEventListener("submit", (event) => event.preventDefault());
  $("which").addEventListener("change", () => chooseLife($("which").selectedIndex));
  $("task").addEventListener("change", () => chooseTask(Number($("task").value), false));
  $("earlier").addEventListener("click", () => step(-1));
  $("later").addEventListener("click", () => step(1));
  $("follow").addEventListener("change", () => $("follow").checked && chooseTask(newest(), true));
  $("part").addEventListener("change", draw);
  window.addEventListener("resize", later(draw));
  await look();
}

/** Look whether memory has changed, and again after a while. */
async function look() {
  const began = performance.now();
  try {
    if (!document.hidden || state.revision === null) {
      const { revision } = await ask("/v1/lives/revision");
      if (revision !== state.revision) await read(revision);
      if (state.failed) say($("message"), "");
      state.failed = false;
    }
  } catch (error) {
    state.failed = true;
    say($("message"), error.message, "error");
    if ([401, 403].includes(error.status)) return; // without a token it is no use to ask again
  }
  setTimeout(look, Math.max(EVERY, SHARE * (performance.now() - began)));
}

async function read(revision) {
  state.lives = (await ask("/v1/lives")).lives;
  state.revision = revision;
  $("empty").hidden = state.lives.length > 0;
  $("life").hidden = state.lives.length === 0;
  if (!state.lives.length) return;
  const options = state.lives.map((one) => make("option", {}, `${one.robot}: ${one.domain}, ${count(one.tasks, "task")}`));
  $("which").replaceChildren(...options);
  const known = state.lives.findIndex((one) => state.life && one.robot === state.life.robot && one.domain === state.life.domain);
  const grown = $("follow").checked ? state.lives.findIndex((one) => one.tasks > (state.sizes.get(nameOf(one)) ?? Infinity)) : -1;
  state.sizes = new Map(state.lives.map((one) => [nameOf(one), one.tasks]));
  await chooseLife(grown >= 0 ? grown : Math.max(0, known));
}

async function chooseLife(index) {
  const life = state.lives[index];
  const same = state.life && nameOf(life) === nameOf(state.life);
  $("which").selectedIndex = index;
  state.life = life;
  state.tasks = (await ask(`/v1/lives/tasks?${new URLSearchParams({ robot: life.robot, domain: life.domain })}`)).tasks;
  $("task").replaceChildren(...state.tasks.map((one) => make("option", { value: one.task }, String(one.task))).reverse());
  const stays = same && !$("follow").checked && state.tasks.some((one) => one.task === state.number);
  await chooseTask(stays ? state.number : newest(), $("follow").checked);
}

async function chooseTask(number, follows) {
  state.number = number;
  $("follow").checked = follows;
  $("task").value = String(number);
  const at = state.tasks.findIndex((one) => one.task === number);
  $("earlier").disabled = at <= 0;
  $("later").disabled = at >= state.tasks.length - 1;
  await draw();
}

function step(by) {
  const at = state.tasks.findIndex((one) => one.task === state.number) + by;
  if (state.tasks[at]) chooseTask(state.tasks[at].task, false);
}

async function draw() {
  const { life, tasks, number, revision } = state;
  if (!life) return;
  const asked = (state.asked += 1);
  try {
    const isMap = life.kind === "grid";
    const drawNow = await (isMap ? mapLife : typesLife)(life, tasks, number, revision);
    if (asked !== state.asked) return; // another task has been chosen meanwhile
    $("of-types").hidden = isMap;
    $("of-map").hidden = !isMap;
    const words = drawNow();
    const time = new Date().toLocaleTimeString("en-GB");
    $("summary").textContent = `${life.robot} has lived ${count(tasks.length, "task")} of ${life.domain}. ${words} Drawn at ${time}.`;
  } catch (error) {
    say($("message"), error.message, "error");
  }
}

const newest = () => state.tasks[state.tasks.length - 1].task;
const nameOf = (life) => `${life.robot}\n${life.domain}`;
const count = (n, noun) => `${short(n)} ${noun}${n === 1 ? "" : "s"}`;

function later(action, wait = 200) {
  let timer = null;
  return () => {
    clearTimeout(timer);
    timer = setTimeout(action, wait);
  };
}

start();
