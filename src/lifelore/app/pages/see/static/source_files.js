// What a person gives to look at: a cloud, or a depth image with its camera, colours and masks.

const CLOUDS = ["pcd", "ply", "npz"];
const CAMERAS = ["json", "yaml", "yml"];
const NEEDS_CAMERA =
  "is a depth image: choose or drop the file of its camera too (a camera_info YAML, or JSON with fx, fy, cx, cy, width, height).";
const NEEDS_DEPTH = "belongs to a depth image: choose or drop the image too (a 16-bit PNG or an npy file).";

/** The role of a file: cloud, depth, camera, colour or masks; null where it is none of them. */
async function roleOf(file, hasCamera) {
  const kind = kindOf(file);
  if (CLOUDS.includes(kind)) return "cloud";
  if (isCamera(file)) return "camera";
  if (kind === "npy") return hasCamera ? "depth" : "cloud";
  if (kind === "jpg" || kind === "jpeg") return "colour";
  if (kind !== "png") return null;
  // Bytes 24 and 25 of a PNG are its bits for each channel and its kind of colour: 0 grey, 3 palette.
  const [bits, colour] = new Uint8Array(await file.slice(24, 26).arrayBuffer());
  if (colour !== 0 && colour !== 3) return "colour";
  return bits === 16 && !/mask|label/i.test(file.name) ? "depth" : "masks";
}

/**
 * The source after further files: a Map of roles to files. A cloud replaces all, a depth image all but its camera;
 * a camera, colours and masks join the depth image that is open.
 */
export async function sourceOf(files, earlier = new Map()) {
  const open = earlier.get("cloud");
  // Only its camera tells that an npy file holds depth.
  const all = open && kindOf(open) === "npy" && files.every(isCamera) ? [open, ...files] : files;
  const hasCamera = earlier.has("camera") || all.some(isCamera);
  const given = new Map();
  for (const file of all) {
    const role = await roleOf(file, hasCamera);
    if (role === null) throw new Error(`${file.name} is no PCD, PLY, npz or npy file and no depth image; choose another file.`);
    if (given.has(role)) throw new Error(`${given.get(role).name} and ${file.name} are both ${PLURALS[role]}; choose one of them.`);
    given.set(role, file);
  }
  const source = new Map(earlier);
  if (given.has("cloud") || source.has("cloud")) source.clear();
  if (given.has("depth") && source.has("depth")) for (const role of ["depth", "colour", "masks"]) source.delete(role);
  for (const [role, file] of given) source.set(role, file);
  return source;
}

/** What a source lacks, as a sentence; empty where it is complete. */
export function lackOf(source) {
  if (source.has("cloud")) return source.size > 1 ? "A label image goes with a depth image here; `lifelore perceive --masks` takes it with a cloud too." : "";
  if (!source.has("depth")) return `${[...source.values()][0].name} ${NEEDS_DEPTH}`;
  return source.has("camera") ? "" : `${source.get("depth").name} ${NEEDS_CAMERA}`;
}

const PLURALS = { cloud: "clouds", depth: "depth images", camera: "files of a camera", colour: "colour images", masks: "label images" };
const ROLES = { cloud: "the cloud", depth: "depth", camera: "camera", colour: "colours", masks: "masks of the objects" };

/** Which file is used as what, as a sentence. */
export function describeSource(source) {
  return `${[...source].map(([role, file]) => `${file.name}: ${ROLES[role]}`).join("; ")}.`;
}

/** The route below /v1/perceive and the options of `ask` for a source; `scale` in metres, or empty. */
export async function questionOf(source, { up, units, scale, ...options }, points) {
  if (source.has("cloud")) {
    const file = source.get("cloud");
    const query = new URLSearchParams({ format: kindOf(file), up, units, ...options });
    const headers = { "Content-Type": "application/octet-stream" };
    return [`${points ? "points" : "cloud"}?${query}`, { method: "POST", body: await file.arrayBuffer(), headers }];
  }
  const body = { up, ...options, intrinsics: await source.get("camera").text() };
  for (const part of ["depth", "colour", "masks"]) if (source.has(part)) body[part] = await base64(source.get(part));
  if (scale) body.depth_scale = Number(scale);
  return [points ? "depth/points" : "depth", { method: "POST", body }];
}

const kindOf = (file) => file.name.split(".").pop().toLowerCase();
const isCamera = (file) => CAMERAS.includes(kindOf(file));

function base64(file) {
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(reader.result.slice(reader.result.indexOf(",") + 1));
    reader.onerror = () => reject(new Error(`${file.name} cannot be read; choose it again.`));
    reader.readAsDataURL(file);
  });
}
