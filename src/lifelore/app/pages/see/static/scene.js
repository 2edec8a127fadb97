// A perceived scene: its bytes become points, colours, lines and words; no drawing here.

const PALETTE = ["#0072b2", "#e69f00", "#007a59", "#b84f00", "#a3478a", "#56b4e9", "#7a6a00", "#5d4bb5", "#c2185b", "#3f7f3f"];
const RELATION_COLOURS = { on: "#b84f00", adjacent: "#0072b2", both: "#a3478a" };
const OTHER_RELATION = "#22262b", CONTACT = "#22262b", HOLE = "#007a59", TABLE_COLOUR = "#b4bcc6", NO_OBJECT = "#d9dee3";
const TABLE = 1;

export const NONE = "none";

/** A scene from the bytes of /v1/perceive/points. */
export function sceneOf(buffer) {
  const n = new DataView(buffer).getUint32(0, true);
  const labels = new Int32Array(buffer, 4 + 12 * n, n);
  return {
    n,
    xyz: new Float32Array(buffer, 4, 3 * n),
    labels,
    rgb: new Uint8Array(buffer, 4 + 16 * n, 3 * n),
    ...JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4 + 19 * n))),
  };
}

/** Colour of an object, of the table, or of what belongs to no object, as #rrggbb. */
export function colourOf(id) {
  if (id === "table" || id === TABLE) return TABLE_COLOUR;
  return id > TABLE ? PALETTE[(id - 2) % PALETTE.length] : NO_OBJECT;
}

export function relationColour(relation) {
  return RELATION_COLOURS[relation] ?? OTHER_RELATION;
}

/** Name of an object for people. */
export function nameOf(id) {
  return id === "table" ? "the table" : `object ${id}`;
}

/** Relations that a person wants to see: those of pairs that have one. */
export function relationsOf(scene) {
  return scene.relations.filter((one) => one.relation !== NONE);
}

/** A sentence about a relation. */
export function sentenceOf({ a, b, relation }) {
  const words = { on: "is on", adjacent: "is beside", both: "is on and beside", none: "has no relation with" };
  return `${nameOf(a)} ${words[relation] ?? relation} ${nameOf(b)}`;
}

/** What a view draws without a scene. */
export const NOTHING = { bounds: { centre: [0, 0, 0], radius: 1 }, points: null, labels: [], dots: [], lines: [], bars: [], names: [] };

/** All that a view draws, under the settings of the page; positions in metres, colours as #rrggbb. */
export function drawingOf(scene, settings) {
  const { selected, show, least } = settings;
  return {
    bounds: boundsOf(scene),
    points: show.points ? { xyz: scene.xyz, colours: pointColours(scene, settings) } : null,
    labels: scene.labels,
    dots: show.contacts ? contactDots(scene, selected) : [],
    lines: [...(show.networks ? networkLines(scene, selected) : []), ...(show.holes ? holeLines(scene) : [])],
    bars: show.relations ? relationBars(scene, selected, least) : [],
    names: namesOf(scene),
  };
}

function pointColours(scene, { selected, colours }) {
  const out = new Float32Array(3 * scene.n);
  const cache = new Map();
  for (let i = 0; i < scene.n; i += 1) {
    const label = scene.labels[i];
    const faded = selected !== null && label !== selected;
    let rgb;
    if (colours === "camera") rgb = [scene.rgb[3 * i], scene.rgb[3 * i + 1], scene.rgb[3 * i + 2]];
    else {
      if (!cache.has(label)) cache.set(label, bytesOf(colourOf(label)));
      rgb = cache.get(label);
    }
    for (let k = 0; k < 3; k += 1) out[3 * i + k] = (faded ? 0.35 * rgb[k] + 0.65 * 235 : rgb[k]) / 255;
  }
  return out;
}

function contactDots(scene, selected) {
  return scene.objects.flatMap((one) =>
    one.contact_points.map((point) => ({
      at: point.xyz,
      colour: colourOf(one.id),
      faded: selected !== null && one.id !== selected && point.other !== selected,
    })),
  );
}

function networkLines(scene, selected) {
  const positions = new Map(scene.objects.map((one) => [one.id, one.contact_points.map((point) => point.xyz)]));
  positions.set("table", scene.table_contact_points);
  const inside = scene.objects.flatMap((one) =>
    one.edges.map(([i, j]) => ({
      path: [one.contact_points[i].xyz, one.contact_points[j].xyz],
      colour: darker(colourOf(one.id)), // to stand out from the object's own points
      thick: true,
      faded: selected !== null && one.id !== selected,
    })),
  );
  const between = scene.contact_edges.map(([[a, i], [b, j]]) => ({
    path: [positions.get(a)[i], positions.get(b)[j]],
    colour: CONTACT,
    dashed: true,
    faded: selected !== null && a !== selected && b !== selected,
  }));
  return [...inside, ...between];
}

function holeLines(scene) {
  return scene.holes
    .filter((hole) => hole.outline && hole.outline.length > 1)
    .map((hole) => ({ path: [...hole.outline, hole.outline[0]], colour: HOLE, thick: true }));
}

function relationBars(scene, selected, least) {
  const centres = new Map(scene.objects.map((one) => [one.id, one.centroid]));
  return relationsOf(scene)
    .filter((one) => one.confidence >= least)
    .map((one) => {
      const known = [centres.get(one.a), centres.get(one.b)];
      const foot = (other) => [other[0], other[1], 0];
      return {
        from: known[0] ?? foot(known[1]),
        to: known[1] ?? foot(known[0]),
        colour: relationColour(one.relation),
        weight: one.confidence,
        faded: selected !== null && one.a !== selected && one.b !== selected,
      };
    });
}

/** A value that is computed once for each scene. */
function once(compute) {
  const known = new WeakMap();
  return (scene) => {
    if (!known.has(scene)) known.set(scene, compute(scene));
    return known.get(scene);
  };
}

const namesOf = once((scene) => scene.objects.map((one) => ({ at: above(scene, one), text: String(one.id) })));
const boundsOf = once(boundsOfObjects);

function above(scene, one) {
  let top = -Infinity;
  for (let i = 0; i < scene.n; i += 1) if (scene.labels[i] === one.id) top = Math.max(top, scene.xyz[3 * i + 2]);
  return [one.centroid[0], one.centroid[1], Number.isFinite(top) ? top : one.centroid[2]];
}

/** Middle and radius of the objects; of all points where there is no object. */
function boundsOfObjects(scene) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const only = scene.objects.length > 0;
  for (let i = 0; i < scene.n; i += 1) {
    if (only && scene.labels[i] <= TABLE) continue;
    for (let k = 0; k < 3; k += 1) {
      low[k] = Math.min(low[k], scene.xyz[3 * i + k]);
      high[k] = Math.max(high[k], scene.xyz[3 * i + k]);
    }
  }
  if (!Number.isFinite(low[0])) return { centre: [0, 0, 0], radius: 1 };
  const centre = low.map((value, k) => (value + high[k]) / 2);
  return { centre, radius: Math.max(0.02, Math.hypot(...high.map((value, k) => value - low[k])) / 2) };
}

function darker(colour) {
  return `#${bytesOf(colour).map((value) => Math.round(0.5 * value).toString(16).padStart(2, "0")).join("")}`;
}

export function bytesOf(colour) {
  return [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
}
