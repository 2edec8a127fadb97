// The page /play: consent, the socket of the rounds, keys and buttons, belief, and the record of the player.

import { ask, make, openSocket, saveAs, say } from "/static/shell/shell.js";
import { describeField, drawField } from "/static/play/field.js";

const KEYS = { ArrowUp: 0, ArrowDown: 1, ArrowRight: 2, ArrowLeft: 3, w: 0, s: 1, d: 2, a: 3 };
const NAMES = ["up", "down", "right", "left"];
const SESSION = "lifelore play session";
const PHASES = { practice: "Practice", training: "Training", test: "Test", free: "Free round", finished: "Finished" };
const byId = (id) => document.getElementById(id);
const canvas = byId("field"), message = byId("message");

let game, session, socket, socketPath, ball, running = false, described = 0;

start();

async function start() {
  try {
    game = await ask("/v1/play/game");
  } catch (error) {
    say(message, error.message, "error");
    return;
  }
  byId("consent-text").textContent = game.consent;
  for (const [length, rounds] of Object.entries(game.lengths))
    byId("length").append(make("option", { value: length }, `${length}: ${rounds} rounds`));
  for (const size of game.sizes) byId("size").append(make("option", { value: size }, `${size}`));
  byId("size").value = "20";
  drawField(canvas, game, { x: game.start[0], y: game.start[1], radius: 10 });
  const earlier = sessionStorage.getItem(SESSION);
  if (!earlier) return;
  try {
    showSession(await ask(`/v1/play/sessions/${earlier}`));
  } catch {
    sessionStorage.removeItem(SESSION);
  }
}

function connect(path) {
  if (socket && socketPath === path && socket.readyState === WebSocket.OPEN) return Promise.resolve();
  if (socket) {
    socket.onclose = null;
    socket.close();
  }
  socketPath = path;
  const opened = openSocket(path);
  socket = opened;
  opened.onmessage = (event) => {
    if (opened === socket) receive(JSON.parse(event.data));
  };
  return new Promise((resolve, reject) => {
    opened.onopen = resolve;
    opened.onclose = () => {
      if (opened !== socket) return;
      if (running) say(message, "The connection is lost; rounds that were reported as over are stored. Start the round again.", "error");
      finishRound();
      reject(new Error("The service did not open the game; reload the page to try again."));
    };
  });
}

function send(document) {
  if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(document));
}

function receive(document) {
  if (document.kind === "scene") beginRound(document);
  else if (document.kind === "frame" && running) showFrame(document);
  else if (document.kind === "over") endRound(document);
  else if (document.kind === "error") say(message, document.message, "error");
}

function beginRound(scene) {
  say(message, "");
  running = true;
  ball = { ...scene, moves: 0, hits: 0, hit: false };
  Object.assign(canvas.dataset, { phase: scene.phase, size: scene.size, running: "true", heading: "" });
  const about = [`ball size ${scene.size}`];
  if (scene.speed) about.push(`speed ${scene.speed}`);
  const place = scene.phase === "free" ? "" : ` ${scene.number + 1} of ${scene.rounds}`;
  byId("round").textContent = `${PHASES[scene.phase]}${place}: ${about.join(", ")}. Press an arrow key to start the ball.`;
  byId("next").disabled = byId("free").disabled = true;
  byId("stop").hidden = false;
  byId("belief").hidden = scene.phase !== "free" || !byId("show-belief").checked;
  showFrame(ball);
  canvas.scrollIntoView({ block: "nearest" });
}

function showFrame(frame) {
  Object.assign(ball, frame);
  drawField(canvas, game, ball);
  Object.assign(canvas.dataset, { x: ball.x, y: ball.y, moves: ball.moves, hits: ball.hits });
  if (frame.belief) showBelief(frame);
  const now = performance.now();
  if (now - described < 500) return;
  described = now;
  byId("where").textContent = describeField(game, ball);
}

function showBelief(frame) {
  byId("speed").textContent = frame.speed ?? "–";
  const rows = Object.entries(frame.belief).map(([size, probability]) => {
    const bar = make("div", { class: "bar" }, make("span"));
    bar.firstChild.style.width = `${100 * probability}%`;
    return make("tr", {}, make("th", { scope: "row" }, size), make("td", { class: "wide" }, bar),
      make("td", { class: "number" }, `${Math.round(100 * probability)} %`));
  });
  byId("belief-rows").replaceChildren(...rows);
}

function endRound(over) {
  finishRound();
  const end = over.reached ? "Goal reached" : "Out of moves";
  const text = `${end} after ${over.moves} moves with ${over.hits} collisions: loss ${over.loss.toFixed(2)}.`;
  byId("where").textContent = describeField(game, ball);
  if (over.recorded) {
    byId("round").textContent = `${text} The round is stored.`;
    showSession(over.session);
    byId("last").textContent = text;
    if (over.session.phase !== "finished") byId("next").focus();
  } else {
    byId("round").textContent = `${text} Nothing was recorded.`;
    byId("free").focus();
  }
}

function finishRound() {
  running = false;
  byId("stop").hidden = true;
  canvas.dataset.running = "false";
  byId("next").disabled = session?.phase === "finished";
  byId("free").disabled = session?.phase === "test";
}

/** Leave the round that is running; nothing of it is recorded, and a round of the study begins again. */
function stopRound() {
  if (!running) return;
  send({ do: "leave" });
  finishRound();
  byId("round").textContent = "The round is stopped; nothing of it is recorded.";
}

function showSession(view) {
  session = view;
  sessionStorage.setItem(SESSION, view.session);
  byId("next-panel").hidden = false;
  byId("consent-panel").hidden = true;
  byId("identifier").textContent = view.session;
  const done = view.phase === "finished";
  const others = view.others.player === "person" ? `${view.others.players} other people` : "scripted players, for no other person has played yet";
  byId("progress").textContent = done
    ? `All ${view.rounds} rounds are played and stored. Thank you. The static speed was the best of ${others}. The results are below.`
    : `${PHASES[view.phase]}: round ${view.number + 1} of ${view.rounds}, ball size ${view.next.size}` +
      (view.phase === "test" ? ". In the test you are not told how the speed is chosen." : ".");
  byId("next").hidden = done;
  byId("next").disabled = done || running;
  byId("free").disabled = view.phase === "test" || running;
}

async function attempt(action) {
  try {
    say(message, "");
    await action();
  } catch (error) {
    say(message, error.message, "error");
  }
}

byId("consent").addEventListener("change", () => { byId("begin").disabled = !byId("consent").checked; });

byId("begin").addEventListener("click", () => attempt(async () => {
  stopRound();
  byId("begin").disabled = true;
  byId("round").textContent = "The session is being prepared.";
  try {
    const body = {
      consent: byId("consent").checked, length: byId("length").value, player: byId("player").value,
      frames_per_move: Number(byId("pace").value),
    };
    showSession(await ask("/v1/play/sessions", { method: "POST", body }));
    byId("round").textContent = "The session is ready; start the first round.";
    byId("next").focus();
  } finally {
    byId("begin").disabled = false;
  }
}));

byId("next").addEventListener("click", () => attempt(async () => {
  await connect(`/v1/play/sessions/${session.session}/live`);
  send({ do: "begin" });
}));

byId("free").addEventListener("click", () => attempt(async () => {
  await connect("/v1/play/free/live");
  send({ do: "belief", show: byId("show-belief").checked });
  send({ do: "free", size: Number(byId("size").value) });
}));

byId("show-belief").addEventListener("change", (event) => {
  byId("belief").hidden = !event.target.checked;
  send({ do: "belief", show: event.target.checked });
});

for (const [id, address] of [["json", "record"], ["csv", "record.csv"]])
  byId(id).addEventListener("click", () => attempt(() =>
    saveAs(`/v1/play/sessions/${session.session}/${address}`, `play_${session.session}.${id}`)));

byId("delete").addEventListener("click", () => attempt(async () => {
  if (!confirm("Delete all that is stored of this session, for ever?")) return;
  stopRound();
  if (socket) socket.close();
  await ask(`/v1/play/sessions/${session.session}`, { method: "DELETE" });
  sessionStorage.removeItem(SESSION);
  session = undefined;
  byId("next-panel").hidden = true;
  byId("consent-panel").hidden = false;
  byId("round").textContent = "Your record is deleted.";
  byId("free").disabled = false;
}));

byId("stop").addEventListener("click", stopRound);

function steer(heading) {
  if (!running) return;
  send({ do: "steer", heading });
  canvas.dataset.heading = NAMES[heading];
}

window.addEventListener("keydown", (event) => {
  if (event.key === "Escape") stopRound();
  const heading = KEYS[event.key];
  if (heading === undefined || event.ctrlKey || event.altKey || event.metaKey || !running) return;
  event.preventDefault();
  if (!event.repeat) steer(heading);
});

for (const button of document.querySelectorAll("[data-heading]"))
  button.addEventListener("click", () => steer(Number(button.dataset.heading)));
