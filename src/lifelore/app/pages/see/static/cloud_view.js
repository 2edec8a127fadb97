// A drawing of a scene in 3-D with three.js; see drawingOf in scene.js for what it draws.

import { OrbitControls } from "/static/see/three/OrbitControls.js";
import * as THREE from "/static/see/three/three.module.min.js";
import { clicks, keys } from "./view_input.js";

const FADED = 0.25;
const PICK = 8; // pixels within which a click finds a point

export class CloudView {
  constructor(canvas, onPick) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setClearColor("#f5f7f9");
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.render());
    this.group = new THREE.Group();
    this.scene.add(this.group);
    this.bounds = null;
    this.drawing = null;
    new ResizeObserver(() => this.resize()).observe(canvas);
    clicks(canvas, (x, y) => onPick(this.pick(x, y)));
    keys(canvas, this);
    this.resize();
  }

  /** Draw; `fresh` also moves the camera so that all objects are in sight. */
  show(drawing, fresh) {
    this.drawing = drawing;
    for (const old of [...this.group.children]) {
      this.group.remove(old);
      old.geometry?.dispose();
      old.material?.map?.dispose();
      old.material?.dispose();
    }
    if (drawing.points) this.group.add(pointsOf(drawing.points));
    for (const bar of drawing.bars) this.group.add(barOf(bar, drawing.bounds.radius));
    for (const line of drawing.lines) this.group.add(...(line.thick ? rodsOf : linesOf)(line, drawing.bounds.radius));
    for (const dot of drawing.dots) this.group.add(dotOf(dot, drawing.bounds.radius));
    for (const name of drawing.names) this.group.add(nameOf(name, drawing.bounds.radius));
    if (fresh) {
      this.bounds = drawing.bounds;
      this.reset();
    }
    this.render();
  }

  reset() {
    const { centre, radius } = this.bounds;
    const narrow = Math.min(1, this.camera.aspect);
    const away = (0.92 * radius) / Math.sin((this.camera.fov * Math.PI) / 360) / narrow;
    this.controls.target.set(...centre);
    this.camera.position.set(centre[0] + 0.34 * away, centre[1] - 0.76 * away, centre[2] + 0.55 * away);
    this.camera.near = radius / 100;
    this.camera.far = 100 * radius;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.render();
  }

  /** Turn around the vertical axis and up or down, in radians. */
  turn(around, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const { theta, phi, radius } = spherical(offset);
    const tilt = Math.min(Math.PI - 0.05, Math.max(0.05, phi - up));
    const yaw = theta + around;
    offset.set(Math.sin(tilt) * Math.cos(yaw), Math.sin(tilt) * Math.sin(yaw), Math.cos(tilt)).multiplyScalar(radius);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.render();
  }

  zoom(factor) {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.render();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  render() {
    this.renderer.render(this.scene, this.camera);
  }

  /** The label of the nearest point under a pixel of the canvas; null where there is none. */
  pick(x, y) {
    const { points, labels } = this.drawing ?? {};
    if (!points) return null;
    const matrix = new THREE.Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
    const m = matrix.elements, { clientWidth: w, clientHeight: h } = this.canvas;
    let found = null, nearest = Infinity;
    for (let i = 0; i < labels.length; i += 1) {
      const [px, py, pz] = [points.xyz[3 * i], points.xyz[3 * i + 1], points.xyz[3 * i + 2]];
      const depth = m[3] * px + m[7] * py + m[11] * pz + m[15];
      if (depth <= 0 || depth >= nearest) continue;
      const sx = (0.5 + (0.5 * (m[0] * px + m[4] * py + m[8] * pz + m[12])) / depth) * w;
      const sy = (0.5 - (0.5 * (m[1] * px + m[5] * py + m[9] * pz + m[13])) / depth) * h;
      if (Math.hypot(sx - x, sy - y) > PICK) continue;
      nearest = depth;
      found = labels[i];
    }
    return found;
  }
}

function spherical(offset) {
  const radius = offset.length();
  return { radius, theta: Math.atan2(offset.y, offset.x), phi: Math.acos(offset.z / radius) };
}

function pointsOf({ xyz, colours }) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(xyz, 3));
  const attribute = new THREE.BufferAttribute(new Float32Array(colours), 3);
  const colour = new THREE.Color();
  for (let i = 0; i < attribute.count; i += 1) {
    colour.setRGB(attribute.getX(i), attribute.getY(i), attribute.getZ(i), THREE.SRGBColorSpace);
    attribute.setXYZ(i, colour.r, colour.g, colour.b);
  }
  geometry.setAttribute("color", attribute);
  return new THREE.Points(geometry, new THREE.PointsMaterial({ size: 2.5, sizeAttenuation: false, vertexColors: true }));
}

function seenThrough(colour, faded) {
  return new THREE.MeshBasicMaterial({ color: colour, transparent: true, opacity: faded ? FADED : 1, depthTest: false });
}

function dotOf({ at, colour, faded }, radius) {
  const group = new THREE.Mesh(new THREE.SphereGeometry(0.024 * radius, 16, 12), seenThrough(colour, faded));
  const rim = new THREE.Mesh(new THREE.SphereGeometry(0.031 * radius, 16, 12), seenThrough("#ffffff", faded));
  group.position.set(...at);
  group.renderOrder = 5;
  rim.renderOrder = 4;
  group.add(rim);
  return group;
}

function linesOf({ path, colour, dashed, faded }, radius) {
  const geometry = new THREE.BufferGeometry().setFromPoints(path.map((at) => new THREE.Vector3(...at)));
  const common = { color: colour, transparent: true, opacity: faded ? FADED : 1, depthTest: false };
  const material = dashed
    ? new THREE.LineDashedMaterial({ ...common, dashSize: 0.03 * radius, gapSize: 0.02 * radius })
    : new THREE.LineBasicMaterial(common);
  const line = new THREE.Line(geometry, material);
  line.computeLineDistances();
  line.renderOrder = 3;
  return [line];
}

/** A path of thin rods, because WebGL draws all lines one pixel wide. */
function rodsOf({ path, colour, faded }, radius) {
  return path.slice(1).map((to, i) => {
    const rod = rodOf(path[i], to, 0.006 * radius, seenThrough(colour, faded));
    rod.renderOrder = 3;
    return rod;
  });
}

function rodOf(from, to, thick, material) {
  const a = new THREE.Vector3(...from), along = new THREE.Vector3(...to).sub(a);
  const length = Math.max(along.length(), 1e-6);
  const rod = new THREE.Mesh(new THREE.CylinderGeometry(thick, thick, length, 12), material);
  rod.position.copy(a).addScaledVector(along, 0.5);
  rod.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.divideScalar(length));
  return rod;
}

function barOf({ from, to, colour, weight, faded }, radius) {
  const bar = rodOf(from, to, 0.014 * radius * weight, seenThrough(colour, faded));
  if (!faded) bar.material.opacity = 0.35 + 0.6 * weight;
  bar.renderOrder = 2;
  return bar;
}

function nameOf({ at, text }, radius) {
  const canvas = document.createElement("canvas");
  canvas.width = 128;
  canvas.height = 64;
  const pen = canvas.getContext("2d");
  pen.font = "bold 44px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.lineWidth = 8;
  pen.strokeStyle = "#ffffff";
  pen.strokeText(text, 64, 32);
  pen.fillStyle = "#22262b";
  pen.fillText(text, 64, 32);
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: texture, depthTest: false }));
  sprite.position.set(at[0], at[1], at[2] + 0.1 * radius);
  sprite.scale.set(0.3 * radius, 0.15 * radius, 1);
  sprite.renderOrder = 6;
  return sprite;
}
