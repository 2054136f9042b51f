"use strict";

const svgns = "http://www.w3.org/2000/svg";
const $ = (id) => document.getElementById(id);
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const steps_kept = 100;

let scheme, frames = [];
let current = null, opened = null, selected = 0;  // opened: the frame whose picture is shown
let view = { scale: 1, x: 0, y: 0 }, size = null;  // a point p is drawn at scale · p + (x, y)
let drag = null;
let trouble = "", note = "";  // trouble: why the server takes no changes
const gone = "the server does not answer", moved_on = "the server has other frames now";
const remedies = { [gone]: ": start it again", [moved_on]: ": start it as it was before, or reload" };

// ---------------------------------------------------------------- talking to the server

async function request(path, options) {
  const response = await fetch(path, options);
  const answer = await response.json();
  return { status: response.status, answer };
}

async function get(path) {
  const { status, answer } = await request(path);
  if (status !== 200) throw new Error(answer.error);
  return answer;
}

const what_failed = (error) => (error instanceof TypeError ? gone : error.message);
const url_of = (frame) => `api/frames/${frame.key}`;

const rounded = (points) => points.map(([x, y]) => [Math.round(100 * x) / 100, Math.round(100 * y) / 100]);
const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

function take_state(frame, { state, tag, reason }) {
  Object.assign(frame, { state, tag, reason });
}

function take(frame, answer) {
  take_state(frame, answer);
  frame.by = answer.by;
  frame.done = answer.state === "done";
  if (answer.points) frame.points = rounded(answer.points);
}

/** Takes what the server has, unless the person is faster. */
async function load(frame) {
  const edits = frame.edits;
  const answer = await get(url_of(frame));
  if (frame.edits !== edits || frame.saving || drag) return;
  if (frame.points && answer.tag !== "none" && !same(frame.points, rounded(answer.points))) keep_step(frame);
  take(frame, answer);
}

function save(frame) {
  frame.unsaved = true;
  if (!frame.saving) frame.settled = send(frame);
}

/** Sends the newest points until the server has them. */
async function send(frame) {
  frame.saving = true;
  while (frame.unsaved) {
    frame.unsaved = false;
    try {
      trouble = await put(frame);
    } catch (error) {
      trouble = what_failed(error);
    }
    if (!trouble) continue;
    frame.unsaved = true;
    show_status();
    await sleep(500);
  }
  frame.saving = false;
  remember(frame);
  show();
}

/** What keeps the server from taking the points, or "". */
async function put(frame) {
  const sent = { points: frame.points, done: frame.done };
  if (!same(frame.sent.at(-1), sent)) frame.sent.push(sent);
  const { status, answer } = await request(url_of(frame), {
    method: "PUT",
    keepalive: true,
    headers: { "Content-Type": "application/json", "If-Match": frame.tag },
    body: JSON.stringify(sent),
  });
  if (status === 404) return moved_on;
  if (status >= 500) return answer.error;
  if (status === 412) {
    meet_other_state(frame, answer);
  } else if (status === 200) {
    take_state(frame, answer);
  } else {
    note = answer.error;
    frame.done = frame.state === "done";
  }
  frame.sent = [];
  return "";
}

/** The server has another state than was changed: what was sent before it was killed, or another's work. */
function meet_other_state(frame, answer) {
  take_state(frame, answer);
  const points = answer.points && rounded(answer.points);
  if (!points || frame.sent.some((sent) => same(sent.points, points))) {
    frame.unsaved = true;
  } else {
    keep_step(frame);
    frame.points = points;
    frame.done = answer.state === "done";
    frame.unsaved = false;
    note = "changed in another window; Undo brings yours back";
  }
}

/** Sees what other windows and programs do. */
async function watch() {
  for (;;) {
    await sleep(1000);
    try {
      await follow(await get("api/frames"));
    } catch (error) {
      trouble = what_failed(error);
    }
    if (!drag) show();
  }
}

const waiting = () => frames.filter((frame) => frame.unsaved || frame.saving);

async function follow(states) {
  if (!same(states.map(({ key }) => key), frames.map(({ key }) => key))) {
    trouble = moved_on;
    if (!waiting().length && !drag) location.reload();
    return;
  }
  if (!waiting().length) trouble = "";
  for (const [index, now] of states.entries()) {
    const frame = frames[index];
    if (frame.saving || frame.unsaved || frame.tag === now.tag) continue;
    if (frame === current) await load(frame);
    else Object.assign(frame, now, { reason: now.reason, points: null, done: now.state === "done" });
  }
}

// ---------------------------------------------------------------- what a person changes

function keep_step(frame) {
  frame.past.push(frame.points);
  if (frame.past.length > steps_kept) frame.past.shift();
  frame.future = [];
}

/** What a reload shall find again: steps, and what is not saved. */
function remember(frame) {
  const { past, future, points, done, tag } = frame;
  const waits = frame.unsaved || frame.saving ? { points, done, tag } : null;
  try {
    sessionStorage.setItem(frame.key, JSON.stringify({ past, future, waits }));
  } catch {
    // No room: they end with the page.
  }
}

function recall(frame) {
  const { waits, ...steps } = JSON.parse(sessionStorage.getItem(frame.key) ?? "{}");
  Object.assign(frame, steps, waits);
  if (waits) save(frame);
}

function edited(frame) {
  frame.edits++;
  note = "";
  save(frame);
  remember(frame);
  show();
}

/** A little beside the picture is as far as a point gets. */
const near_picture = (points) =>
  rounded(points.map((point) => point.map((v, axis) => Math.min(1.5 * size[axis], Math.max(-0.5 * size[axis], v)))));

function change(points) {
  const next = near_picture(points);
  if (same(next, current.points)) return;
  keep_step(current);
  current.points = next;
  edited(current);
}

function step(from, to) {
  if (!from.length) return;
  to.push(current.points);
  current.points = from.pop();
  edited(current);
}
const undo = () => step(current.past, current.future);
const redo = () => step(current.future, current.past);

async function afresh() {
  const frame = current;
  try {
    const { points } = await get(`${url_of(frame)}/begin`);
    if (frame === current) change(points);
  } catch (error) {
    note = what_failed(error);
    show();
  }
}

function set_done(done) {
  const outside = current.points.findIndex(([x, y]) => x < 0 || y < 0 || x > size[0] - 1 || y > size[1] - 1);
  if (done && outside >= 0) {
    selected = outside;
    note = `point ${outside} lies outside the picture: nothing could be learnt from it`;
    return show();
  }
  current.done = done;
  edited(current);
  if (!done) return;
  const later = [...frames.slice(current.index + 1), ...frames.slice(0, current.index)];
  const next = later.find((frame) => !frame.done);
  if (next) open_frame(next.index);
}

// ---------------------------------------------------------------- moving points

/** Whether points may be moved. */
const ready = () => current?.points && opened === current;

const mode = () => document.querySelector("input[name=mode]:checked").value;

/** The points that move with one. */
function moved_with(point) {
  if (mode() === "whole") return new Set(current.points.keys());
  const set = new Set([point]);
  if (mode() === "group")
    for (const group of scheme.groups) if (group.points.includes(point)) group.points.forEach((p) => set.add(p));
  return set;
}

/** Unit vector from the left of the face to its right. */
function across(points) {
  let x = 0, y = 0;
  for (const [left, right] of scheme.pairs) {
    x += points[right][0] - points[left][0];
    y += points[right][1] - points[left][1];
  }
  const length = Math.hypot(x, y);
  return length > 0 ? [x / length, y / length] : [1, 0];
}

/** Points with those of the set carried on by `move`, and their mirrored partners the mirrored way. */
function moved(points, set, move) {
  const next = points.map((point, i) => (set.has(i) ? move(point) : point));
  if (!$("mirror").checked) return next;
  const [ux, uy] = across(points);
  for (const [a, b] of scheme.pairs)
    for (const [i, j] of [[a, b], [b, a]]) {
      if (!set.has(i) || set.has(j)) continue;
      const dx = next[i][0] - points[i][0], dy = next[i][1] - points[i][1], along = dx * ux + dy * uy;
      next[j] = [points[j][0] + dx - 2 * along * ux, points[j][1] + dy - 2 * along * uy];
    }
  return next;
}

const shift = (dx, dy) => ([x, y]) => [x + dx, y + dy];

/** Turns and scales about the centre of the set so that `from` comes to `to`. */
function turn(points, set, from, to) {
  let cx = 0, cy = 0;
  for (const i of set) { cx += points[i][0] / set.size; cy += points[i][1] / set.size; }
  const fx = from[0] - cx, fy = from[1] - cy, tx = to[0] - cx, ty = to[1] - cy, square = fx * fx + fy * fy;
  if (set.size < 2 || square < 1) return shift(to[0] - from[0], to[1] - from[1]);
  const a = (tx * fx + ty * fy) / square, b = (ty * fx - tx * fy) / square;
  return ([x, y]) => [cx + a * (x - cx) - b * (y - cy), cy + b * (x - cx) + a * (y - cy)];
}

function nudge(dx, dy) {
  change(moved(current.points, moved_with(selected), shift(dx, dy)));
}

// ---------------------------------------------------------------- the mouse

function place(event) {
  const box = $("picture").getBoundingClientRect();
  return [(event.clientX - box.left - view.x) / view.scale, (event.clientY - box.top - view.y) / view.scale];
}

/** The point within reach, or one of the line under the pointer, or -1. */
function grabbed(event) {
  if (!$("shown").checked) return -1;
  const [x, y] = place(event), reach = 10 / view.scale;
  let best = -1, least = reach;
  current.points.forEach(([px, py], i) => {
    const distance = Math.hypot(px - x, py - y);
    if (distance < least) { least = distance; best = i; }
  });
  if (best < 0 && mode() !== "point" && event.target.dataset.group)
    best = scheme.groups[event.target.dataset.group].points[0];
  return best;
}

function pointer_down(event) {
  if (!ready() || drag) return;
  $("picture").focus();
  $("picture").setPointerCapture(event.pointerId);
  const point = event.button === 0 ? grabbed(event) : -1;
  if (point < 0) {
    drag = { pan: [event.clientX - view.x, event.clientY - view.y] };
  } else {
    selected = point;
    drag = { from: place(event), set: moved_with(point), points: current.points };
  }
  event.preventDefault();
}

function pointer_move(event) {
  if (!drag) return;
  if (drag.pan) {
    view.x = event.clientX - drag.pan[0];
    view.y = event.clientY - drag.pan[1];
  } else {
    const { from, set } = drag, to = place(event);
    const move = event.shiftKey ? turn(current.points, set, from, to) : shift(to[0] - from[0], to[1] - from[1]);
    drag.points = moved(current.points, set, move);
  }
  draw();
}

function pointer_up() {
  const ended = drag;
  drag = null;
  if (ended?.set) change(ended.points);
  draw();
}

function give_up_drag() {
  drag = null;
  draw();
}

function zoom(factor, x, y) {
  const box = $("picture").getBoundingClientRect();
  x ??= box.width / 2;
  y ??= box.height / 2;
  const scale = Math.min(64, Math.max(0.05, view.scale * factor));
  view.x = x - (x - view.x) * scale / view.scale;
  view.y = y - (y - view.y) * scale / view.scale;
  view.scale = scale;
  draw();
}

function fit() {
  const box = $("picture").getBoundingClientRect();
  view.scale = Math.min(box.width / size[0], box.height / size[1]);
  view.x = (box.width - view.scale * (size[0] - 1)) / 2;
  view.y = (box.height - view.scale * (size[1] - 1)) / 2;
  draw();
}

function wheel(event) {
  const box = $("picture").getBoundingClientRect();
  zoom(Math.exp(-0.0015 * event.deltaY), event.clientX - box.left, event.clientY - box.top);
  event.preventDefault();
}

// ---------------------------------------------------------------- the keyboard

const choose_mode = (value) => { document.querySelector(`input[value=${value}]`).checked = true; };
const toggle = (id) => $(id).click();
const go = (by) => open_frame((current.index + by + frames.length) % frames.length);
const pick = (by) => { selected = (selected + by + scheme.points) % scheme.points; draw(); };

const keys = {
  Enter: () => set_done(true), PageDown: () => go(1), PageUp: () => go(-1), Escape: give_up_drag,
  ".": () => pick(1), ",": () => pick(-1), "+": () => zoom(1.25), "=": () => zoom(1.25), "-": () => zoom(0.8), 0: fit,
  1: () => choose_mode("point"), 2: () => choose_mode("group"), 3: () => choose_mode("whole"),
  m: () => toggle("mirror"), h: () => toggle("shown"), r: afresh,
};
const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

function key_down(event) {
  if (!current || event.altKey || event.metaKey) return;
  const on_button = event.target.closest("button, input");
  if (on_button && ["Enter", " ", ...Object.keys(arrows)].includes(event.key)) return;
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  let act = keys[key];
  if (event.ctrlKey) act = key === "z" ? (event.shiftKey ? redo : undo) : key === "y" ? redo : null;
  else if (arrows[key]) act = () => nudge(...arrows[key].map((d) => d * (event.shiftKey ? 5 : 0.5)));
  if (!act || (drag && key !== "Escape") || (!ready() && !key.startsWith("Page"))) return;
  event.preventDefault();
  act();
}

// ---------------------------------------------------------------- drawing

function element(name, attributes, parent) {
  const made = document.createElementNS(svgns, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return parent.appendChild(made);
}

const colour = (group) => `hsl(${Math.round(360 * group / scheme.groups.length)} 80% 65%)`;

function make_marks() {
  scheme.groups.forEach((group, g) => element("path", { "data-group": g, stroke: colour(g) }, $("lines")));
  for (let i = 0; i < scheme.points; i++) {
    const group = scheme.groups.findIndex(({ points }) => points.includes(i));
    element("circle", { "data-point": i, fill: group < 0 ? "#ddd" : colour(group) }, $("points"));
  }
}

function make_list() {
  for (const frame of frames) {
    const button = document.createElement("button");
    button.textContent = `${frame.clip} · ${frame.number}${frame.phone ? ` · ${frame.phone}` : ""}`;
    button.title = button.textContent;
    button.addEventListener("click", () => open_frame(frame.index));
    frame.item = document.createElement("li");
    frame.item.append(button);
    $("frames").append(frame.item);
  }
}

/** The picture with its points: what changes while dragging. */
function draw() {
  $("view").setAttribute("transform", `translate(${view.x} ${view.y}) scale(${view.scale})`);
  const points = drag?.points ?? (ready() ? current.points : null);
  $("marks").setAttribute("visibility", points && $("shown").checked ? "visible" : "hidden");
  if (!points) return;
  const circles = $("points").children;
  points.forEach(([x, y], i) => {
    circles[i].setAttribute("cx", x);
    circles[i].setAttribute("cy", y);
    circles[i].setAttribute("r", 4 / view.scale);
    circles[i].setAttribute("class", i === selected ? "selected" : "");
  });
  scheme.groups.forEach((group, g) => {
    const line = group.points.map((p) => points[p].join(" ")).join(" L ");
    $("lines").children[g].setAttribute("d", `M ${line}${group.closed ? " Z" : ""}`);
  });
  const names = scheme.groups.filter((group) => group.points.includes(selected)).map((group) => group.name);
  $("selected").textContent = `point ${selected}: ${points[selected].map((v) => v.toFixed(1)).join(", ")}`;
  $("legend").textContent = `${selected}, ${names.join(", ").replaceAll("_", " ") || "in no group"}`;
}

const beginnings = {
  scheme: "new: the mean shape of the scheme; move the whole face (3) into place first",
  examples: "new: where the face was on average",
  model: "new: the model's own fit",
};

function state_text() {
  if (current?.state === "new") return beginnings[current.by] ?? "";
  if (current?.state === "broken")
    return current.reason + (ready() ? "; a change begins the frame anew and puts the file aside" : "");
  return current?.done ? "done, saved" : "draft, saved";
}

function show_status() {
  const unsaved = waiting().length;
  let text = state_text();
  if (unsaved) text = "saving …";
  if (opened !== current) text = "opening …";
  if (note) text = note;
  if (trouble) text = trouble + (unsaved ? `; what is not saved waits here${remedies[trouble] ?? ""}` : "");
  $("status").textContent = text;
  $("status").className = trouble || note || current?.state === "broken" ? "bad" : "";
}

/** All that is beside the picture, and the picture. */
function show() {
  for (const frame of frames) {
    frame.item.className = frame.state;
    if (frame === current) frame.item.firstChild.setAttribute("aria-current", "true");
    else frame.item.firstChild.removeAttribute("aria-current");
  }
  $("progress").textContent = `${frames.filter((f) => f.state === "done").length} of ${frames.length} done`;
  $("undo").disabled = !current?.past.length;
  $("redo").disabled = !current?.future.length;
  $("reopen").hidden = !current?.done;
  $("done").disabled = $("afresh").disabled = !ready();
  show_status();
  draw();
}

// ---------------------------------------------------------------- frames

function load_picture(frame) {
  return new Promise((resolve, reject) => {
    const picture = new Image();
    picture.onload = () => resolve(picture);
    picture.onerror = () => reject(new Error(`the picture of ${frame.clip}, frame ${frame.number}, cannot be read`));
    picture.src = `${url_of(frame)}/picture`;
  });
}

async function show_picture(frame) {
  const picture = await load_picture(frame);
  if (current !== frame) return;
  const before = size;
  size = [picture.naturalWidth, picture.naturalHeight];
  $("image").setAttribute("href", picture.src);
  $("image").setAttribute("width", size[0]);
  $("image").setAttribute("height", size[1]);
  if (!same(before, size)) fit();
}

/** What the model is built of is saved first, unless the server does not answer. */
const all_saved = () => Promise.race([Promise.all(frames.map((frame) => frame.settled)), sleep(3000)]);

/** A frame that nobody has begun begins with the newest model. */
async function load_points(frame) {
  if (frame.state === "new") await all_saved();
  if (frame.state === "new" || !frame.points) await load(frame);
}

async function open_frame(index) {
  const frame = frames[index];
  current = frame;
  opened = null;
  history.replaceState(null, "", `#${frame.key}`);
  note = "";
  show();
  try {
    await Promise.all([show_picture(frame), load_points(frame)]);
    if (current !== frame) return;
    opened = frame;
  } catch (error) {
    if (current === frame) note = frame.reason ?? what_failed(error);
  }
  frame.item.scrollIntoView({ block: "nearest" });
  show();
}

function listen() {
  const picture = $("picture");
  picture.addEventListener("pointerdown", pointer_down);
  picture.addEventListener("pointermove", pointer_move);
  picture.addEventListener("pointerup", pointer_up);
  picture.addEventListener("pointercancel", give_up_drag);
  picture.addEventListener("contextmenu", (event) => event.preventDefault());
  picture.addEventListener("wheel", wheel, { passive: false });
  addEventListener("keydown", key_down);
  addEventListener("resize", draw);
  // Keys go to the picture again once a button has been clicked.
  addEventListener("click", (event) => { if (event.detail > 0) picture.focus(); });
  addEventListener("beforeunload", (event) => {
    if (trouble && waiting().length) event.preventDefault();
  });
  const buttons = { undo, redo, afresh, fit, done: () => set_done(true), reopen: () => set_done(false),
    larger: () => zoom(1.25), smaller: () => zoom(0.8), shown: draw };
  for (const [id, act] of Object.entries(buttons)) $(id).addEventListener("click", () => ready() && act());
}

async function main() {
  const project = await get("api/project");
  scheme = project.scheme;
  frames = project.frames.map((frame, index) => ({
    ...frame, index, state: "new", tag: "none", done: false,
    points: null, edits: 0, unsaved: false, saving: false, settled: null, sent: [], past: [], future: [],
  }));
  await follow(await get("api/frames"));
  document.title = `${project.manifest} – talkgraph annotate`;
  make_marks();
  make_list();
  listen();
  frames.forEach(recall);
  const wanted = frames.findIndex((frame) => frame.key === location.hash.slice(1));
  await open_frame(wanted >= 0 ? wanted : Math.max(0, frames.findIndex((frame) => !frame.done)));
  watch();
}

main().catch((error) => {
  $("status").textContent = error.message;
  $("status").className = "bad";
});
