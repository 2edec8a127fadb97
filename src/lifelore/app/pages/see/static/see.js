// The page /see: opens clouds, shows the scene that the service perceives in them, and lets a person choose objects.

import { ask, make, say } from "/static/shell/shell.js";
import { describeSource, lackOf, questionOf, sourceOf } from "./source_files.js";
import { colourOf, drawingOf, nameOf, NONE, NOTHING, relationColour, relationsOf, sceneOf, sentenceOf } from "./scene.js";

const EXAMPLES = "/static/see/examples/";
const BOXES = ["points", "contacts", "networks", "relations", "holes"];
const $ = (id) => document.getElementById(id);

const state = { scene: null, selected: null, source: new Map(), asked: 0 };
let view = null;

async function start() {
  view = await openView();
  $("example").addEventListener("change", openExample);
  $("file").addEventListener("change", () => openOwn($("file").files));
  for (const id of ["up", "vector", "units", "scale", "range", "roi"]) $(id).addEventListener("change", analyse);
  for (const id of [...BOXES.map((box) => `show-${box}`), "colours"]) $(id).addEventListener("change", () => draw());
  $("least").addEventListener("input", () => draw());
  $("plan").addEventListener("click", () => save("problem.pddl", (document) => document.pddl.problem, "domain.pddl", (document) => document.pddl.domain));
  $("graph").addEventListener("click", () => save("scene.dot", (document) => document.dot));
  $("source").addEventListener("submit", (event) => event.preventDefault());
  dropping($("view"));
  await openExample();
}

/** A 3-D view, or a flat one where the browser has no WebGL. */
async function openView() {
  const attributes = { role: "img", tabindex: "0", "aria-describedby": "help summary", "aria-label": "The cloud" };
  const canvas = make("canvas", attributes);
  const probe = document.createElement("canvas").getContext("webgl2");
  try {
    if (!probe) throw new Error("no WebGL");
    const { CloudView } = await import("./cloud_view.js");
    $("view").append(canvas);
    const found = new CloudView(canvas, choose);
    probe.getExtension("WEBGL_lose_context")?.loseContext();
    return found;
  } catch {
    const flat = make("canvas", attributes);
    $("view").replaceChildren(flat);
    $("help").textContent = "This browser has no WebGL, so the picture is flat. " + $("help").textContent;
    const { FlatView } = await import("./flat_view.js");
    return new FlatView(flat, choose);
  }
}

async function openExample() {
  const name = $("example").value;
  if (!name) return;
  $("file").value = "";
  const answer = await fetch(`${EXAMPLES}${name}.pcd`);
  const content = await answer.blob();
  if ($("example").value !== name) return; // another cloud has been chosen
  await openFiles([new File([content], `${name}.pcd`)]);
}

async function openOwn(files) {
  $("example").value = "";
  await openFiles(files);
}

/** Look at files that a person gives, once they are a whole source. */
async function openFiles(files) {
  if (!files.length) return;
  try {
    state.source = await sourceOf([...files], state.source);
  } catch (error) {
    clear();
    say($("message"), error.message, "error");
    return;
  }
  const isCloud = state.source.has("cloud");
  $("units-label").hidden = !isCloud;
  $("scale-label").hidden = isCloud;
  $("files").textContent = isCloud ? "" : describeSource(state.source);
  await analyse();
}

function dropping(area) {
  const over = (shown) => (event) => {
    event.preventDefault();
    area.classList.toggle("over", shown);
  };
  area.addEventListener("dragover", over(true));
  area.addEventListener("dragleave", over(false));
  area.addEventListener("drop", (event) => {
    over(false)(event);
    openOwn(event.dataTransfer.files);
  });
}

/** Ask for the scene of the source: its document, or with `points` an answer in bytes. */
async function question(points, options = {}) {
  const up = $("up").value === "vector" ? $("vector").value : $("up").value;
  const read = { up, units: $("units").value, scale: $("scale").value, ...region(), ...options };
  const [route, asked] = await questionOf(state.source, read, points);
  return ask(`/v1/perceive/${route}`, { ...asked, raw: points });
}

/** The box and the range that are filled in. */
function region() {
  const [roi, range] = [$("roi").value.trim(), $("range").value];
  return { ...(roi && { roi }), ...(range && { max_range: Number(range) }) };
}

/** Remove the scene: what is shown is never another cloud than the one that was asked for. */
function clear() {
  state.scene = null;
  state.selected = null;
  for (const id of ["warnings", "objects", "details", "relations"]) $(id).replaceChildren();
  $("summary").textContent = "No scene: see the message above the picture.";
  view.show(NOTHING, true);
  allowSaving(false);
}

function allowSaving(allowed) {
  for (const id of ["plan", "graph"]) $(id).disabled = !allowed;
}

async function analyse() {
  const asked = (state.asked += 1);
  $("vector-label").hidden = $("up").value !== "vector";
  const lack = lackOf(state.source);
  say($("message"), lack || `Looking at ${[...state.source.values()].map(({ name }) => name).join(", ")} …`, lack ? "warning" : "");
  if (lack) return;
  try {
    const answer = await question(true);
    const scene = sceneOf(await answer.arrayBuffer());
    if (asked !== state.asked) return; // a later question has been asked
    state.scene = scene;
    state.selected = null;
    say($("message"), "");
    allowSaving(true);
    draw(true);
  } catch (error) {
    if (asked !== state.asked) return;
    clear();
    // The service gives an uploaded cloud a name of its own.
    const name = (state.source.get("cloud") ?? state.source.get("depth")).name;
    say($("message"), `${name}: ${error.message.replace(/^(cloud|depth)\.\w+: /, "")}`, "error");
  }
}

function choose(label) {
  const known = state.scene?.objects.some((one) => one.id === label);
  state.selected = known && label !== state.selected ? label : null;
  draw();
}

function draw(fresh = false) {
  const { scene } = state;
  if (!scene) return;
  const least = Number($("least").value);
  const show = Object.fromEntries(BOXES.map((box) => [box, $(`show-${box}`).checked]));
  view.show(drawingOf(scene, { selected: state.selected, show, least, colours: $("colours").value }), fresh);
  $("least-value").textContent = percent(least);
  showWarnings(scene);
  showSummary(scene, least);
  showObjects(scene);
  showDetails(scene, least);
  showRelations(scene, least);
}

function showWarnings(scene) {
  $("warnings").replaceChildren(
    ...scene.warnings.map((one) => make("li", { class: "message warning" }, `Warning: ${one.message}`)),
  );
}

function showSummary(scene, least) {
  const stated = relationsOf(scene).filter((one) => one.confidence >= least).length;
  const contacts = scene.objects.reduce((sum, one) => sum + one.contact_points.length, 0);
  const { shown, of } = scene.points;
  const drawn = shown === of ? `${of.toLocaleString("en")} points` : `${shown.toLocaleString("en")} of ${of.toLocaleString("en")} points drawn`;
  const words =
    `${count(scene.objects.length, "object")}, ${count(stated, "relation")}, ${count(contacts, "contact point")}, ` +
    `${count(scene.holes.length, "hole")}; ${drawn}; perceived in ${scene.seconds.toFixed(2)} s.`;
  if ($("summary").textContent !== words) $("summary").textContent = words; // a screen reader reads each change
}

function showObjects(scene) {
  const focused = document.activeElement?.dataset?.object;
  const buttons = scene.objects.map((one) => {
    const swatch = make("span", { class: "swatch", "aria-hidden": "true" });
    swatch.style.background = colourOf(one.id);
    const pressed = String(one.id === state.selected);
    const button = make("button", { type: "button", "aria-pressed": pressed, "data-object": one.id }, swatch, `Object ${one.id}`);
    button.addEventListener("click", () => choose(one.id));
    return make("li", {}, button);
  });
  $("objects").replaceChildren(...buttons);
  if (focused) $("objects").querySelector(`[data-object="${focused}"]`)?.focus();
}

function showDetails(scene, least) {
  const one = scene.objects.find((object) => object.id === state.selected);
  if (!one) {
    const words = scene.objects.length ? "Choose an object to see what supports it and what it touches." : "No object was found.";
    $("details").replaceChildren(make("p", { class: "quiet" }, words));
    return;
  }
  const mine = relationsOf(scene).filter((r) => r.a === one.id || r.b === one.id);
  const held = mine.filter((r) => r.a === one.id && ["on", "both"].includes(r.relation));
  const carried = mine.filter((r) => r.b === one.id && ["on", "both"].includes(r.relation));
  const beside = mine.filter((r) => ["adjacent", "both"].includes(r.relation));
  const others = mine.filter((r) => ![...held, ...carried, ...beside].includes(r));
  const near = scene.relations.filter((r) => r.relation === NONE && (r.a === one.id || r.b === one.id));
  const holes = scene.holes.filter((hole) => hole.objects.includes(one.id));
  const rows = [
    ["Points", one.n_points.toLocaleString("en")],
    one.cut_confidence === undefined ? null : ["A true object", `${percent(one.cut_confidence)} sure (cut automatically)`],
    ["Rests on", listed(held, one.id, least)],
    ["Carries", listed(carried, one.id, least)],
    ["Beside", listed(beside, one.id, least)],
    ...others.map((r) => [r.relation, `${nameOf(r.a === one.id ? r.b : r.a)} (${percent(r.confidence)})`]),
    near.length ? ["Near, unrelated", listed(near, one.id, 0)] : null,
    ["Contact points", contactsOf(one)],
    holes.length ? ["Holes", holes.map((hole) => `with ${hole.objects.filter((id) => id !== one.id).map(nameOf).join(", ")}, opening ${centimetres(hole.opening)}`).join("; ")] : null,
    isHidden(scene, one.id) ? ["Its top", "other objects hide it in part, so it may carry more"] : null,
  ].filter(Boolean);
  const list = make("dl", {}, ...rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
  const title = make("h3", {}, `Object ${one.id}`);
  if ($("details").textContent !== title.textContent + list.textContent) $("details").replaceChildren(title, list);
}

function listed(relations, id, least) {
  if (!relations.length) return "nothing";
  return relations
    .map((r) => `${nameOf(r.a === id ? r.b : r.a)} (${percent(r.confidence)}${r.confidence < least ? ", doubtful" : ""})`)
    .join(", ");
}

function contactsOf(one) {
  const counts = new Map();
  for (const point of one.contact_points) counts.set(point.other, (counts.get(point.other) ?? 0) + 1);
  if (!counts.size) return "none";
  return [...counts].map(([other, n]) => `${n} with ${nameOf(other)}`).join(", ");
}

function isHidden(scene, id) {
  return scene.unknown.some((one) => one.reason === "hidden" && one.fact === `clear(${id})`);
}

function showRelations(scene, least) {
  const head = make("tr", {}, ...["Relation", "Confidence", "Gap"].map((name) => make("th", { scope: "col" }, name)));
  const rows = relationsOf(scene).map((one) => {
    const doubtful = one.confidence < least;
    const swatch = make("span", { class: "swatch", "aria-hidden": "true" });
    swatch.style.background = relationColour(one.relation);
    const filled = make("span");
    filled.style.width = `${100 * one.confidence}%`;
    filled.style.background = relationColour(one.relation);
    const bar = make("span", { class: "bar share", "aria-hidden": "true" }, filled);
    const chosen = [one.a, one.b].includes(state.selected);
    const names = [doubtful ? "doubtful" : "", chosen ? "chosen" : ""].filter(Boolean).join(" ");
    return make(
      "tr",
      names ? { class: names } : {},
      make("td", {}, swatch, ` ${upper(sentenceOf(one))}${doubtful ? " (doubtful)" : ""}`),
      make("td", {}, bar, percent(one.confidence)),
      make("td", {}, one.gap === null ? "unknown" : `${(1000 * one.gap).toFixed(0)} mm`),
    );
  });
  const empty = make("tr", {}, make("td", { colspan: "3" }, "No object is near another object or a table."));
  $("relations").replaceChildren(make("thead", {}, head), make("tbody", {}, ...(rows.length ? rows : [empty])));
}

/** Ask again with the least confidence of the page, and save texts of the answer as files. */
async function save(...namesAndTexts) {
  try {
    const document = await question(false, { min_confidence: Number($("least").value) });
    for (let i = 0; i < namesAndTexts.length; i += 2) download(namesAndTexts[i], namesAndTexts[i + 1](document));
  } catch (error) {
    say($("message"), error.message, "error");
  }
}

function download(name, text) {
  const link = make("a", { href: URL.createObjectURL(new Blob([text], { type: "text/plain" })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

const percent = (share) => `${Math.round(100 * share)} %`;
const centimetres = (metres) => (metres === null ? "of unknown size" : `${(100 * metres).toFixed(1)} cm`);
const count = (n, noun) => `${n} ${noun}${n === 1 ? "" : "s"}`;
const upper = (text) => text[0].toUpperCase() + text.slice(1);

start();
