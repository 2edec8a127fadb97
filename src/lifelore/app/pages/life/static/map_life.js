// A life of tasks with goals on a map: steps to learn each task, and the known map with the arrows of the prior.

import { ask, make } from "/static/shell/shell.js";
import { drawCurves, drawMap, short } from "./drawing.js";

const COLOURS = ["var(--blue)", "var(--orange)", "var(--green)", "var(--vermilion)", "var(--purple)", "#5d4bb5", "#7a6a00"];
const LISTED = 12, GOALS = 8; // last tasks in the table, and last goals on the map
const $ = (id) => document.getElementById(id);

/** Ask for what the picture of a task needs; a function that draws it and answers a sentence about the life. */
export async function mapLife(life, tasks, number) {
  const task = tasks.find((one) => one.task === number);
  const map = await knownMap(task);
  return () => {
    drawSteps(tasks.filter((one) => one.agents && isDriven(one) === isDriven(task)));
    drawPlaces(tasks.filter((one) => one.places !== undefined));
    list(tasks.slice(-LISTED).reverse(), number);
    return drawKnown(map, tasks, task);
  };
}

const isDriven = (task) => task.how === "driven";

/** Seconds of a drive to a known goal, steps of a search. */
const cost = (task, name) => isDriven(task) ? task.agents[name].seconds : task.agents[name].steps_to_80;

/** What a task cost an agent, with units where they are not `known` to be steps. */
function costWords(task, name, known) {
  const found = task.agents?.[name];
  if (!found) return "–";
  if (isDriven(task)) return `${short(found.metres)} m in ${short(found.seconds)} s`;
  return known ? short(found.steps_to_80) : `${short(found.steps_to_80)} steps`;
}

async function knownMap(task) {
  const [row, column] = task.goal;
  return (await ask(`/v1/lives/map?${new URLSearchParams({ world: task.world, row, column })}`)).map;
}

function drawSteps(tasks) {
  const names = [...new Set(tasks.flatMap((one) => Object.keys(one.agents)))];
  const series = names.map((name, i) => ({
    name: name === "scratch" ? "scratch, which remembers nothing" : name,
    colour: COLOURS[i % COLOURS.length],
    dashed: name === "scratch" || name === "map only",
    points: tasks.filter((one) => one.agents[name]).map((one) => [one.task, cost(one, name)]),
  }));
  if (!series.length) {
    $("curve").replaceChildren(make("p", {}, "These tasks were stored without their results, by an earlier version of Lifelore."));
    $("curve-words").textContent = "";
    return;
  }
  const driven = isDriven(tasks[0]);
  const words = `${driven ? "Seconds" : "Steps"} that each agent needed for each of ${tasks.length} tasks.`;
  drawCurves($("curve"), series, { x: "task", y: driven ? "seconds to the goal" : "steps to 80 % of the best", words, log: true });
  $("curve-words").textContent = driven
    ? `Lower is better: the seconds of each drive to a known goal${names.includes("map only") ? ", with memory and planned on the map alone" : ""}, on a logarithmic scale.`
    : "Lower is better: the steps until the agent's way has 80 % of the value of the best way, on a logarithmic scale.";
}

function drawPlaces(tasks) {
  if (!tasks.length) {
    $("places").replaceChildren(make("p", { class: "quiet" }, "This life does not store how many places it knows."));
    return;
  }
  const points = tasks.map((one) => [one.task, one.places]);
  const words = `Known places: ${short(tasks[0].places)} after task ${tasks[0].task}, ${short(tasks.at(-1).places)} after task ${tasks.at(-1).task}.`;
  drawCurves($("places"), [{ name: "known places", colour: COLOURS[2], points }], { x: "task", y: "places", words, height: 180 });
}

function list(tasks, number) {
  const names = [...new Set(tasks.flatMap((one) => Object.keys(one.agents ?? {})))];
  const searched = !tasks.some(isDriven);
  const agents = names.map((name) => make("th", { scope: "col", class: "number" }, searched ? `Steps, ${name}` : name));
  const head = make("tr", {}, ...["Task", "Goal"].map((text) => make("th", { scope: "col" }, text)), ...agents);
  const rows = tasks.map((one) => {
    const steps = names.map((name) => make("td", { class: "number" }, costWords(one, name, searched)));
    const goal = one.name ?? `row ${one.goal[0]}, column ${one.goal[1]}`;
    return make("tr", one.task === number ? { class: "chosen" } : {}, make("td", {}, String(one.task)), make("td", {}, goal), ...steps);
  });
  $("list").replaceChildren(make("thead", {}, head), make("tbody", {}, ...rows));
}

function drawKnown(map, tasks, task) {
  const [row, column] = task.goal;
  if (!map) {
    $("map").replaceChildren(make("p", {}, "This agent remembers no map."));
    $("map-words").textContent = "";
    return "It remembers no map.";
  }
  const here = tasks.filter((one) => one.world === task.world && one.task <= task.task).slice(-GOALS);
  const goals = here.map((one) => ({ row: one.goal[0], column: one.goal[1], text: String(one.task), chosen: one === task }));
  const given = { observation: "the surroundings of a place", state: "the place" }[map.prior];
  const about = given ? `An arrow shows where the prior, given ${given}, sends the agent; stronger arrows have more probability.` : "There is no prior in memory.";
  const words = `${short(map.known)} known places of a map of ${map.shape[0]} by ${map.shape[1]} cells. ${about}`;
  const near = $("part").value === "near" ? { row, column } : null;
  drawMap($("map"), map, goals, { near, words });
  const open = map.untried ? ` A diamond marks a place from which it has never made some open move; ${short(map.untried)} in all.` : "";
  $("map-words").textContent = `${words} The filled circle is the goal of task ${task.task}, the others are goals before it.${open}`;
  return `It knows ${short(map.known)} places.`;
}
