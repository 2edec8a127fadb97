// The same drawing on a 2-D canvas, for browsers without WebGL; see drawingOf in scene.js for what it draws.

import { bytesOf } from "./scene.js";
import { clicks, keys } from "./view_input.js";

const FADED = 0.25, PICK = 8, GROUND = "#f5f7f9";

export class FlatView {
  constructor(canvas, onPick) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    this.drawing = null;
    this.bounds = null;
    this.reset();
    new ResizeObserver(() => this.render()).observe(canvas);
    clicks(canvas, (x, y) => onPick(this.pick(x, y)));
    keys(canvas, this);
    this.dragging();
  }

  show(drawing, fresh) {
    this.drawing = drawing;
    if (fresh) {
      this.bounds = drawing.bounds;
      this.reset();
    }
    this.render();
  }

  reset() {
    [this.yaw, this.tilt, this.scale] = [0.4, 0.6, 1];
    this.render();
  }

  turn(around, up) {
    this.yaw += around;
    this.tilt = Math.min(Math.PI / 2, Math.max(0, this.tilt + up));
    this.render();
  }

  zoom(factor) {
    this.scale /= factor;
    this.render();
  }

  dragging() {
    let last = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      last = [event.clientX, event.clientY];
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      if (!last) return;
      this.turn(-(event.clientX - last[0]) / 150, (event.clientY - last[1]) / 150);
      last = [event.clientX, event.clientY];
    });
    this.canvas.addEventListener("pointerup", () => (last = null));
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(event.deltaY > 0 ? 1.1 : 0.91);
    }, { passive: false });
  }

  /** Pixel and depth of a position in metres, seen without perspective. */
  projected([x, y, z]) {
    const { centre, radius } = this.bounds;
    const [dx, dy, dz] = [x - centre[0], y - centre[1], z - centre[2]];
    const right = Math.cos(this.yaw) * dx + Math.sin(this.yaw) * dy;
    const away = -Math.sin(this.yaw) * dx + Math.cos(this.yaw) * dy;
    const { clientWidth: w, clientHeight: h } = this.canvas;
    const unit = (this.scale * 0.42 * Math.min(w, h)) / radius;
    return [
      w / 2 + unit * right,
      h / 2 - unit * (Math.cos(this.tilt) * dz + Math.sin(this.tilt) * away),
      Math.cos(this.tilt) * away - Math.sin(this.tilt) * dz,
    ];
  }

  pick(x, y) {
    const { points, labels } = this.drawing ?? {};
    if (!points) return null;
    let found = null, nearest = Infinity;
    for (let i = 0; i < labels.length; i += 1) {
      const [sx, sy, depth] = this.projected(points.xyz.subarray(3 * i, 3 * i + 3));
      if (depth >= nearest || Math.hypot(sx - x, sy - y) > PICK) continue;
      [found, nearest] = [labels[i], depth];
    }
    return found;
  }

  render() {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    if (!this.drawing || !w || !h) return;
    [this.canvas.width, this.canvas.height] = [w, h];
    this.pen.globalAlpha = 1;
    if (this.drawing.points) this.drawPoints(w, h);
    else {
      this.pen.fillStyle = GROUND;
      this.pen.fillRect(0, 0, w, h);
    }
    for (const bar of this.drawing.bars) this.stroke([bar.from, bar.to], bar.colour, 6 * bar.weight, [], bar.faded);
    for (const line of this.drawing.lines) this.stroke(line.path, line.colour, line.thick ? 3 : 1.5, line.dashed ? [4, 3] : [], line.faded);
    for (const dot of this.drawing.dots) this.dot(dot);
    for (const name of this.drawing.names) this.name(name);
  }

  drawPoints(w, h) {
    const picture = this.pen.createImageData(w, h), depths = new Float32Array(w * h).fill(Infinity);
    const ground = bytesOf(GROUND), { points } = this.drawing;
    for (let i = 0; i < w * h; i += 1) picture.data.set([...ground, 255], 4 * i);
    for (let i = 0; i < points.xyz.length / 3; i += 1) {
      const [sx, sy, depth] = this.projected(points.xyz.subarray(3 * i, 3 * i + 3));
      for (const [column, row] of [[sx, sy], [sx + 1, sy], [sx, sy + 1], [sx + 1, sy + 1]]) {
        const [c, r] = [Math.floor(column), Math.floor(row)];
        if (c < 0 || r < 0 || c >= w || r >= h || depth >= depths[r * w + c]) continue;
        depths[r * w + c] = depth;
        for (let k = 0; k < 3; k += 1) picture.data[4 * (r * w + c) + k] = 255 * points.colours[3 * i + k];
      }
    }
    this.pen.putImageData(picture, 0, 0);
  }

  stroke(path, colour, width, dashes, faded) {
    this.pen.globalAlpha = faded ? FADED : 0.9;
    this.pen.strokeStyle = colour;
    this.pen.lineWidth = width;
    this.pen.setLineDash(dashes);
    this.pen.beginPath();
    path.forEach((at, i) => this.pen[i ? "lineTo" : "moveTo"](...this.projected(at).slice(0, 2)));
    this.pen.stroke();
    this.pen.setLineDash([]);
  }

  dot({ at, colour, faded }) {
    const [x, y] = this.projected(at);
    this.pen.globalAlpha = faded ? FADED : 1;
    this.pen.beginPath();
    this.pen.arc(x, y, 5, 0, 2 * Math.PI);
    this.pen.fillStyle = colour;
    this.pen.fill();
    this.pen.lineWidth = 1.5;
    this.pen.strokeStyle = "#ffffff";
    this.pen.stroke();
  }

  name({ at, text }) {
    const [x, y] = this.projected(at);
    this.pen.globalAlpha = 1;
    this.pen.font = "bold 16px system-ui, sans-serif";
    this.pen.textAlign = "center";
    this.pen.lineWidth = 4;
    this.pen.strokeStyle = "#ffffff";
    this.pen.strokeText(text, x, y - 8);
    this.pen.fillStyle = "#22262b";
    this.pen.fillText(text, x, y - 8);
  }
}
