// The page /study: asks for the studies, then for the traffic, the report and a user of the chosen one.

import { ask, make, say } from "/static/shell/shell.js";
import { drawCalibration, drawPolicies, drawTraffic, drawUplift, drawUser } from "./parts.js";

const $ = (id) => document.getElementById(id);
const address = new URLSearchParams(location.search);
let asked = 0; // answers for a study that was chosen before are dropped

async function start() {
  $("choice").addEventListener("submit", (event) => (event.preventDefault(), read()));
  $("which").addEventListener("change", read);
  $("days").addEventListener("change", read);
  $("ask").addEventListener("submit", (event) => (event.preventDefault(), readUser()));
  const studies = await listed();
  $("empty").hidden = studies.length > 0;
  $("choice").hidden = !studies.length;
  if (!studies.length) return;
  const options = studies.map((one) => make("option", { value: one.name }, one.name + (one.state === "archived" ? " (archived)" : "")));
  $("which").replaceChildren(...options);
  const active = studies.filter((one) => one.state === "active");
  const begin = studies.find((one) => one.name === address.get("study")) ?? active.find((one) => one.name === "default") ?? active[0] ?? studies[0];
  $("which").value = begin.name;
  if ([...$("days").options].some((one) => one.value === address.get("days"))) $("days").value = address.get("days");
  await read();
}

/** All studies; a token for one study may not list them, so the address names it. */
async function listed() {
  try {
    return (await ask("/v1/studies")).studies;
  } catch (error) {
    if (error.status === 403 && address.has("study")) return [{ name: address.get("study"), state: "active" }];
    throw error;
  }
}

async function read() {
  const turn = (asked += 1), study = $("which").value, days = $("days").value;
  history.replaceState(null, "", `?${new URLSearchParams({ study, days })}`);
  $("study").hidden = false;
  say($("message"), "");
  say($("user-message"), "");
  for (const id of ["alarms", "traffic", "uplift", "policies", "calibration", "user"]) $(id).replaceChildren();
  $("traffic-words").textContent = "Reading the traffic…";
  $("report-words").textContent = "Computing the report; this takes seconds where there are millions of decisions…";
  const of = `/v1/studies/${encodeURIComponent(study)}`;
  const shown = (id, promise, draw) =>
    promise.then((found) => turn === asked && draw(found), (error) => {
      if (turn !== asked) return;
      $(id).textContent = "";
      say($("message"), error.message, "error");
    });
  const traffic = ask(`${of}/traffic?days=${days}`);
  await shown("traffic-words", traffic, drawTraffic);
  const report = ask(`${of}/report`);
  await shown("report-words", report, (found) => {
    drawUplift(found);
    drawCalibration(found.calibration);
  });
  await shown("report-words", Promise.all([traffic, report]), ([first, second]) => drawPolicies(first, second));
}

async function readUser() {
  const turn = asked, name = $("name").value;
  $("user").replaceChildren();
  say($("user-message"), "");
  try {
    const found = await ask(`/v1/studies/${encodeURIComponent($("which").value)}/user?${new URLSearchParams({ name })}`);
    if (turn === asked) drawUser(found);
  } catch (error) {
    say($("user-message"), error.message, "error");
  }
}

start().catch((error) => say($("message"), error.message, "error"));
