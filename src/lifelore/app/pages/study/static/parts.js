// The parts of the page /study, drawn from answers of the service.

import { make, say } from "/static/shell/shell.js";
import { lineChart, table } from "/static/shell/charts.js";

const $ = (id) => document.getElementById(id);
const GROUPS = [["personal", "chosen by belief"], ["control", "control group"]];
const COLOURS = { personal: "var(--blue)", control: "var(--vermilion)" };
const EVIDENCE = 8; // outcomes whose evidence is listed

/** Alarms, and curves of decisions, outcomes and their mean by hour or day. */
export function drawTraffic(found) {
  const alarms = found.alarms.map((one) => {
    const line = make("p");
    say(line, one.message, "warning");
    return line;
  });
  const tested = [found.ratio && "share of the control group", found.missing && "missing outcomes",
    (found.drift.personal?.ci95 || found.drift.control?.ci95) && "drift of the mean outcome", found.beliefs && "users whom no type fits"].filter(Boolean);
  const fine = tested.length ? `No alarm. Tested: ${tested.join(", ")}.` : "Nothing can be tested yet.";
  $("alarms").replaceChildren(...(alarms.length ? alarms : [make("p", {}, fine)]));
  const all = found.points.flatMap((one) => [one.personal, one.control]);
  const [decisions, outcomes] = ["decisions", "outcomes"].map((name) => all.reduce((sum, one) => sum + one[name], 0));
  $("traffic-words").textContent = `${count(decisions)} decisions and ${count(outcomes)} outcomes in this window, by the time of the decision (UTC); the last ${found.step > 3600 ? "day" : "hour"} is not over. Read ${Math.round(found.age)}\u00a0s\u00a0ago.`;
  if (!decisions) return;
  const xname = (time) => new Date(1000 * time).toISOString().slice(...(found.step > 3600 ? [5, 10] : [8, 16])).replace("T", ". ");
  const every = Math.ceil(found.points.length / 5);
  const xends = [found.points[0].time, found.points.at(-1).time];
  const common = { xlabel: found.step > 3600 ? "day" : "day of the month and hour", xname, xends, markers: found.points.length < 30, xticks: found.points.map((one) => one.time).filter((_, i) => i % every === Math.floor(every / 2)) };
  const drawn = GROUPS.filter(([group]) => found.points.some((one) => one[group].decisions));
  const counts = drawn.flatMap(([group, words]) => ["decisions", "outcomes"].map((name) => ({ name: `${name}, ${words}`, colour: COLOURS[group], points: found.points.map((one) => [one.time, one[group][name]]) })));
  const means = drawn.map(([group, words]) => ({ name: words, colour: COLOURS[group], points: found.points.filter((one) => one[group].outcomes).map((one) => [one.time, one[group].sum / one[group].outcomes]) }));
  $("traffic").replaceChildren(
    lineChart({ title: "Decisions and their outcomes", ylabel: "number", series: counts, level: 0, digits: 0, ...common }),
    lineChart({ title: "Mean outcome", ylabel: "mean of the outcomes", series: means, digits: 3, ...common }),
  );
}

/** The gain over control, the best single policy and the incumbent, as a table with intervals. */
export function drawUplift(report) {
  const { personal, control, best_single: best, incumbent } = report;
  $("report-words").textContent = personal
    ? `Users chosen for by belief have a mean outcome of ${estimate(personal)}. ${count(report.decisions)} decisions so far, ${count(report.pending)} without an outcome. Each user counts once.`
    : "There is no outcome of a user chosen for by belief yet.";
  if (!personal) return;
  const rows = [
    [`Control group (${report.control_gets})`, control, report.uplift],
    [`Best single policy: ${best.name}`, best.outcome, best.uplift],
    ...(incumbent ? [[`Incumbent: ${incumbent.name}`, incumbent.outcome, incumbent.uplift]] : []),
  ];
  const ends = rows.flatMap(([, , gain]) => gain?.ci95 ?? []).concat(0);
  $("uplift").replaceChildren(table(["Compared with", "Its mean outcome", "Uplift", "95 % interval of the uplift", "Drawn"], rows.map(([name, other, gain]) => [
    name, other ? estimate(other) : "no outcome yet", gain ? signed(gain.value) : "–",
    gain?.ci95 ? range(gain.ci95, signed) : "too few users", gain?.ci95 ? interval(gain, Math.min(...ends), Math.max(...ends)) : "",
  ])));
}

/** A row for each policy of a study. */
export function drawPolicies(traffic, report) {
  const measured = new Map(report.policies.map((one) => [one.name, one.outcome]));
  const rows = traffic.policies.map((one) => {
    const outcome = measured.get(one.name);
    return [one.name, one.state ?? "removed", one.share === null ? "–" : percent(one.share), outcome ? estimate(outcome) : "–", outcome ? count(outcome.n) : "0", one.expected === null ? "–" : number(one.expected)];
  });
  $("policies").replaceChildren(table(["Policy", "State", "Share of decisions", "Mean outcome in the control group", "Users behind it", "Expected for a stranger"], rows));
}

/** Predicted against observed shares of outcomes. */
export function drawCalibration({ outcomes }) {
  if (!outcomes) return $("calibration").replaceChildren(make("p", {}, "No outcome yet."));
  const { predicted, observed, ci95, groups, error } = outcomes;
  const half = ci95.map((ends) => (ends ? (ends[1] - ends[0]) / 2 : null));
  const series = [
    { name: "observed", points: predicted.map((x, i) => [Number(x.toFixed(3)), observed[i]]), half },
    { name: "as predicted", colour: "var(--grey)", points: [[0, 0], [1, 1]] },
  ];
  const figure = lineChart({ title: "Outcomes: quantiles", xlabel: "level of the quantile", ylabel: "share at or below", series, xends: [0, 1] });
  figure.append(make("p", { class: "quiet" }, `${count(groups)} users; mean distance from the diagonal ${number(error)}.`));
  $("calibration").replaceChildren(figure);
}

/** The belief about a user, and what it follows from. */
export function drawUser(user) {
  const facts = `${user.user} is ${user.control ? "in the control group" : "chosen for by belief"} and has ${count(user.decisions)} decisions, ${count(user.open)} without an outcome` + (user.context ? `; context ${user.context}.` : ".");
  const beliefs = Object.entries(user.belief).flatMap(([type, share]) => {
    const bar = make("span");
    bar.style.width = `${100 * share}%`;
    return [make("p", {}, type), make("div", { class: "bar", "aria-hidden": "true" }, bar), make("p", {}, percent(share))];
  });
  const types = Object.keys(user.belief);
  const evidence = user.evidence.slice(-EVIDENCE).reverse().map((one) => [one.policy, ...types.map((type) => (one.types[type] === null ? "impossible" : number(one.types[type])))]);
  const last = user.last.toReversed().map((one) => [one.policy, new Date(1000 * one.chosen).toLocaleString("en-GB"), percent(one.probability), one.outcome === null ? "not known" : number(one.outcome)]);
  $("user").replaceChildren(
    make("p", {}, facts),
    make("h3", {}, "Belief over types"), make("div", { class: "beliefs" }, ...beliefs),
    make("h3", {}, "Next choice"), make("div", { class: "scroll", tabindex: "0" }, table(["Policy", "Expected outcome", "Probability"], Object.entries(user.expected).map(([policy, value]) => [policy, number(value), user.probabilities ? percent(user.probabilities[policy]) : "by the control group"]))),
    make("h3", {}, "Last decisions"), make("div", { class: "scroll", tabindex: "0" }, table(["Policy", "Time", "Probability", "Outcome"], last)),
    make("h3", {}, "Evidence of the last outcomes"), make("p", { class: "quiet" }, "Log likelihood of each type less that of the best, in nats: 0 is the type that the outcome speaks for."),
    make("div", { class: "scroll", tabindex: "0" }, table(["Policy", ...types], evidence)),
  );
}

/** A dot with its interval between two ends, and a line at 0. */
function interval({ value, ci95 }, low, high) {
  const x = (at) => 4 + (92 * (at - low)) / (high - low || 1);
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  for (const [name, text] of Object.entries({ viewBox: "0 0 100 12", class: "interval", "aria-hidden": "true" })) svg.setAttribute(name, text);
  for (const [tag, attributes] of [
    ["line", { x1: x(0), x2: x(0), y1: 0, y2: 12, stroke: "var(--grey)", "stroke-dasharray": "2 1" }],
    ["line", { x1: x(ci95[0]), x2: x(ci95[1]), y1: 6, y2: 6, stroke: COLOURS.personal, "stroke-width": 2 }],
    ["circle", { cx: x(value), cy: 6, r: 3, fill: COLOURS.personal }],
  ]) {
    const part = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, text] of Object.entries(attributes)) part.setAttribute(name, text);
    svg.append(part);
  }
  return svg;
}

const count = (n) => n.toLocaleString("en-GB");
const number = (value) => `${Number(value.toPrecision(3))}`.replace("-", "−");
const signed = (value) => (value > 0 ? "+" : "") + number(value);
const percent = (share) => `${(100 * share).toFixed(share < 0.1 ? 1 : 0)} %`;
const range = ([low, high], text) => `${text(low)} to ${text(high)}`;
const estimate = (one) => number(one.value) + (one.ci95 ? ` (${range(one.ci95, number)})` : "");
