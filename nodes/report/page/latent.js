"use strict";

const $ = (id) => document.getElementById(id);
const data = JSON.parse($("data").textContent);
const canvas = $("space"), brush = canvas.getContext("2d");
const start = { turn: -0.6, tilt: 0.42, zoom: 1 };
const view = { ...start };
const shown = data.phones.map(() => true);
const pointers = new Map();  // those that are down
let current = -1, waiting = false;

// ---------------------------------------------------------------- the space

/** Window and number in it of each frame. */
const places = data.lengths.flatMap((length, window) => Array.from({ length }, (_, frame) => ({ window, frame })));

/** Limits of the box; all axes have the scale of the longest. */
const middle = data.low.map((low, axis) => (low + data.high[axis]) / 2);
const half = Math.max(...data.low.map((low, axis) => data.high[axis] - low)) / 2;
const unit = (point) => point.map((v, axis) => (v - middle[axis]) / half);

const points = data.points.map(unit), paths = data.paths.map((path) => path.map(unit));
const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((bits) =>
  unit(data.low.map((low, axis) => ((bits >> axis) & 1 ? data.high[axis] : low))));
const radius = Math.hypot(...corners[7]);
const edges = corners.flatMap((_, a) => [1, 2, 4].filter((bit) => !(a & bit)).map((bit) => [a, a | bit]));

const share_of = (v) => (data.surest > data.least ? (v - data.least) / (data.surest - data.least) : 1);

/** Places of the cloud with their share of the range of precision, 0 to 1. */
const cloud = data.cloud.map((value, i) => {
  const n = data.resolution, at = [i % n, Math.floor(i / n) % n, Math.floor(i / n / n)];
  const place = unit(at.map((k, axis) => data.low[axis] + (data.high[axis] - data.low[axis]) * (k + 0.5) / n));
  return { place, share: value / 255 };
});

/** A soft round spot that the cloud is painted with. */
const spot = (() => {
  const sprite = document.createElement("canvas");
  sprite.width = sprite.height = 64;
  const paint = sprite.getContext("2d"), fade = paint.createRadialGradient(32, 32, 0, 32, 32, 32);
  fade.addColorStop(0, "rgba(60,60,60,1)");
  fade.addColorStop(0.5, "rgba(60,60,60,0.45)");
  fade.addColorStop(1, "rgba(60,60,60,0)");
  paint.fillStyle = fade;
  paint.fillRect(0, 0, 64, 64);
  return sprite;
})();

// ---------------------------------------------------------------- drawing

/** Pixels of a unit of the box, which fills the canvas at zoom 1. */
function scale() {
  const { width, height } = canvas.getBoundingClientRect();
  return 0.5 * Math.min(width, height) * view.zoom / radius;
}

/** From the box to pixels: the third axis stands upright, nearer things are larger. */
function camera() {
  const { width, height } = canvas.getBoundingClientRect();
  const [st, ct, si, ci] = [Math.sin(view.turn), Math.cos(view.turn), Math.sin(view.tilt), Math.cos(view.tilt)];
  const size = scale();
  return ([x, y, z]) => {
    const across = ct * x - st * y, away = st * x + ct * y;
    const depth = ci * away - si * z, near = 6 / (6 + depth);
    const up = ci * z + si * away;
    return { x: width / 2 + size * near * across, y: height / 2 - size * near * up, depth, size: near };
  };
}

function stroke(a, b, colour, width, alpha = 1) {
  brush.globalAlpha = alpha;
  brush.strokeStyle = colour;
  brush.lineWidth = width;
  brush.beginPath();
  brush.moveTo(a.x, a.y);
  brush.lineTo(b.x, b.y);
  brush.stroke();
}

function disc(p, radius, colour, rim) {
  brush.globalAlpha = 1;
  brush.fillStyle = colour;
  brush.strokeStyle = rim;
  brush.lineWidth = 1;
  brush.beginPath();
  brush.arc(p.x, p.y, radius, 0, 2 * Math.PI);
  brush.fill();
  brush.stroke();
}

const number = (v) => Number(v.toPrecision(3)).toString().replace("-", "−");

function draw_box(project) {
  const at = corners.map(project);
  for (const [a, b] of edges) stroke(at[a], at[b], "#aab2bd", 1, 0.8);
  brush.globalAlpha = 1;
  brush.fillStyle = "#444b55";
  brush.textAlign = "center";
  brush.textBaseline = "middle";
  brush.font = "12px system-ui, sans-serif";
  const centre = project([0, 0, 0]);
  const write = (text, place, out) => {
    const p = project(place), away = Math.hypot(p.x - centre.x, p.y - centre.y) || 1;
    const margin = brush.measureText(text).width / 2 + 4, x = p.x + out * (p.x - centre.x) / away;
    const y = p.y + out * (p.y - centre.y) / away;
    brush.fillText(text, Math.min(canvas.clientWidth - margin, Math.max(margin, x)), y);
  };
  [1, 2, 4].forEach((bit, axis) => {
    if (!data.axes[axis]) return;
    // Of the four edges along an axis, the one farthest from the middle of the picture and lowest carries its name.
    const [a, b] = edges.filter(([a, b]) => b - a === bit).reduce((best, edge) => {
      const low = ([a, b]) => (axis < 2 ? at[a].y + at[b].y : -(at[a].x + at[b].x));
      return low(edge) > low(best) ? edge : best;
    });
    const mix = (share) => corners[a].map((v, i) => v + share * (corners[b][i] - v));
    write(data.axes[axis], mix(0.5), 34);
    write(number(data.low[axis]), mix(0.08), 15);
    write(number(data.high[axis]), mix(0.92), 15);
  });
}

function draw_cloud(project) {
  const strength = 0.24 * Number($("density").value) ** 2;
  const width = 4.8 / data.resolution * scale();
  for (const { place, share } of cloud) {
    const alpha = strength * share ** 3;
    if (alpha < 0.002) continue;
    const p = project(place), size = width * p.size;
    brush.globalAlpha = alpha;
    brush.drawImage(spot, p.x - size / 2, p.y - size / 2, size, size);
  }
}

/** Points and steps from the farthest to the nearest. */
function draw_frames(project) {
  const at = points.map(project), things = [];
  at.forEach((p, i) => {
    if (!shown[data.phone[i]]) return;
    const colour = data.phones[data.phone[i]].colour, { frame } = places[i];
    const radius = p.size * (points.length > 2000 ? 2 : 3.2) * (0.75 + 0.5 * share_of(data.precision[i]));
    things.push({ depth: p.depth, paint: () => disc(p, radius, colour, frame ? "#fff" : "#222") });
    if (frame && $("lines").checked && shown[data.phone[i - 1]])
      things.push({ depth: (p.depth + at[i - 1].depth) / 2, paint: () => stroke(at[i - 1], p, colour, 1.4, 0.6) });
  });
  if ($("paths").checked)
    for (const path of paths.map((path) => path.map(project)))
      path.forEach((p, i) => things.push({ depth: p.depth, paint: () => {
        if (i) stroke(path[i - 1], p, "#000", 2.2);
        disc(p, 2.4 * p.size, "#000", "#fff");
      } }));
  things.sort((a, b) => b.depth - a.depth).forEach((thing) => thing.paint());
  if (current >= 0) {
    const p = at[current];
    brush.globalAlpha = 1;
    brush.strokeStyle = "#000";
    brush.lineWidth = 2;
    brush.beginPath();
    brush.arc(p.x, p.y, 9, 0, 2 * Math.PI);
    brush.stroke();
  }
}

function draw() {
  waiting = false;
  const { width, height } = canvas.getBoundingClientRect(), dense = window.devicePixelRatio || 1;
  canvas.width = Math.round(width * dense);
  canvas.height = Math.round(height * dense);
  brush.setTransform(dense, 0, 0, dense, 0, 0);
  brush.lineCap = "round";
  const project = camera();
  if ($("cloud").checked) draw_cloud(project);
  draw_box(project);
  draw_frames(project);
}

function redraw() {
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(draw);
}

// ---------------------------------------------------------------- looking at frames

function tell(frame) {
  current = frame;
  if (frame >= 0) {
    const { window, frame: inside } = places[frame];
    const coordinates = data.points[frame].filter((_, axis) => data.axes[axis]).map(number).join(", ");
    $("status").textContent = `Frame ${frame + 1}: ${data.labels[data.label[frame]]}, number ${inside + 1} of window ` +
      `${window + 1}, at (${coordinates}), ln precision ${number(data.precision[frame])}`;
  }
  redraw();
}

/** The frame drawn nearest to a place of the canvas, within reach. */
function nearest(x, y) {
  const project = camera();
  let best = -1, least = 12;
  points.forEach((point, i) => {
    if (!shown[data.phone[i]]) return;
    const p = project(point), distance = Math.hypot(p.x - x, p.y - y);
    if (distance < least) { least = distance; best = i; }
  });
  return best;
}

function step(by) {
  const visible = points.map((_, i) => i).filter((i) => shown[data.phone[i]]);
  if (!visible.length) return;
  const at = visible.indexOf(current), next = at < 0 ? (by > 0 ? 0 : -1) : at + by;
  tell(visible.at(Math.min(visible.length - 1, next)) ?? visible[0]);
}

// ---------------------------------------------------------------- mouse, fingers, keys

function turn(across, up) {
  view.turn += across;
  view.tilt = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, view.tilt + up));
  redraw();
}

function zoom(factor) {
  view.zoom = Math.min(20, Math.max(0.2, view.zoom * factor));
  redraw();
}

function reset() {
  Object.assign(view, start);
  redraw();
}

/** How far apart two fingers are. */
function spread() {
  const [a, b] = [...pointers.values()];
  return Math.hypot(a.x - b.x, a.y - b.y);
}

const place_of = (event) => ({ x: event.offsetX, y: event.offsetY });

canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, place_of(event));
});
canvas.addEventListener("pointermove", (event) => {
  const now = place_of(event), before = pointers.get(event.pointerId);
  if (!before) return tell(nearest(now.x, now.y));
  const apart = pointers.size === 2 ? spread() : 0;
  pointers.set(event.pointerId, now);
  if (apart) zoom(spread() / apart);
  else turn((now.x - before.x) / 150, (now.y - before.y) / 150);
});
for (const end of ["pointerup", "pointercancel"])
  canvas.addEventListener(end, (event) => {
    pointers.delete(event.pointerId);
    tell(nearest(event.offsetX, event.offsetY));
  });
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  zoom(Math.exp(-event.deltaY / 500));
}, { passive: false });

const keys = {
  ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, -0.1),
  ArrowDown: () => turn(0, 0.1), "+": () => zoom(1.15), "=": () => zoom(1.15), "-": () => zoom(1 / 1.15),
  Home: reset, PageDown: () => step(1), PageUp: () => step(-1),
};
canvas.addEventListener("keydown", (event) => {
  if (!keys[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  keys[event.key]();
});

// ---------------------------------------------------------------- the legend

const boxes = data.phones.map(({ name, colour, count }, i) => {
  const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: true });
  const swatch = Object.assign(document.createElement("span"), { className: "swatch" });
  const frames = Object.assign(document.createElement("span"), { className: "count", textContent: count });
  const label = document.createElement("label"), item = document.createElement("li");
  swatch.style.background = colour;
  label.append(box, swatch, name, frames);
  item.append(label);
  $("legend").append(item);
  box.addEventListener("change", () => {
    shown[i] = box.checked;
    if (current >= 0 && !shown[data.phone[current]]) current = -1;
    redraw();
  });
  return box;
});

function show_all(yes) {
  for (const box of boxes)
    if (box.checked !== yes) box.click();
}
$("all").addEventListener("click", () => show_all(true));
$("none").addEventListener("click", () => show_all(false));
$("reset").addEventListener("click", reset);
$("with_paths").hidden = !paths.length;
for (const id of ["lines", "paths", "cloud", "density"]) $(id).addEventListener("input", redraw);
new ResizeObserver(redraw).observe(canvas);
redraw();
