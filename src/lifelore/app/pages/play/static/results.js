// Figures 4.18–4.20 of the thesis from the recorded rounds, people and scripted players apart.

import { ask, make, say } from "/static/shell/shell.js";
import { lineChart } from "/static/shell/charts.js";

const UNTESTED = "People untested: no person has played a size with both methods yet.";
const EMPTY = "No session is on record yet; begin the study above, and the figures appear here.";
const button = document.getElementById("show-results");
const message = document.getElementById("results-message");

button.addEventListener("click", showResults);
if (location.hash === "#results") showResults();

async function showResults() {
  let results;
  try {
    results = await ask("/v1/play/results");
  } catch (error) {
    say(message, error.message, "error");
    return;
  }
  const words = results.groups.length ? (results.people_untested ? UNTESTED : "") : `${EMPTY} ${UNTESTED}`;
  say(message, words, "warning");
  document.getElementById("groups").replaceChildren(...results.groups.map(showGroup));
  button.textContent = "Read the results again";
}

function showGroup(group) {
  const who = group.player === "person" ? "People" : "Scripted players (no people)";
  const players = `${group.sessions} ${group.sessions === 1 ? "session" : "sessions"}, ${group.finished} finished, ${group.rounds} rounds; ${group.pace}.`;
  return make("section", {}, make("h3", {}, who), make("p", {}, players), make("p", {}, describeBlocks(group.blocks)),
    make("div", { class: "figures" }, drawLosses(group, who), drawDiversity(group, who), drawNamed(group, who)));
}

function describeBlocks(blocks) {
  if (!blocks.pairs) return "No size has been played with both methods in the test yet.";
  const interval = blocks.interval ? `, 95 % interval ${blocks.interval.map((end) => end.toFixed(2)).join(" to ")}` : "";
  return `Blinded blocks: mean loss ${blocks.beat.toFixed(2)} with BEAT and ${blocks.static.toFixed(2)} at the best static speed ` +
    `of other players; difference ${blocks.difference.toFixed(2)}${interval}, from ${blocks.pairs} pairs of blocks (player, size).`;
}

function drawLosses(group, who) {
  const series = group.sizes.map((size) => {
    const cells = group.losses.filter((cell) => cell.size === size);
    return { name: `b = ${size}`, points: cells.map((cell) => [cell.speed, cell.loss]), half: cells.map((cell) => cell.interval) };
  });
  return lineChart({ title: `Figure 4.18. Loss by speed. ${who}`, xlabel: "speed (units a move)", ylabel: "mean loss, 95 %", series, logarithmic: true, xticks: group.speeds });
}

function drawDiversity(group, who) {
  const series = [["BEAT", "beat"], ["best static speed", "static"]].map(([name, key]) => ({
    name, points: group.diversity.map((point) => [point.types, point[key]]),
  }));
  return lineChart({ title: `Figure 4.19. Loss by diversity. ${who}`, xlabel: "ball sizes in the population", ylabel: "mean loss", series, xticks: group.diversity.map((point) => point.types) });
}

function drawNamed(group, who) {
  const series = group.named.map((one) => ({ name: `b = ${one.size}`, points: one.ratio.map((ratio, i) => [i + 1, ratio]) }));
  return lineChart({ title: `Figure 4.20. Recognised size. ${who}`, xlabel: "move of a round with BEAT", ylabel: "likely / true size", series, logarithmic: true, level: 1, markers: false });
}
