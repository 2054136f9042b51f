"use strict";

const $ = (id) => document.getElementById(id);
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const base = location.pathname;
const sections = ["consent", "profile", "intro", "clip", "done", "failed"];
const formats = [["webm", 'video/webm; codecs="vp9, opus"'], ["mp4", 'video/mp4; codecs="avc1.64001f, mp4a.40.2"']];
const most_seconds = 1e6, most_plays = 1e4;

let state = null;
let note = null;  // of the clip that is shown: {clip, plays, seconds, chosen}
let since = null;  // when this sight of it began
let begun = false;  // a clip may play without being asked for

// ---------------------------------------------------------------- what a reload finds again

function recall(key) {
  try {
    return JSON.parse(localStorage.getItem(key));
  } catch {
    return null;
  }
}

function remember(key, value) {
  try {
    localStorage.setItem(key, JSON.stringify(value));
  } catch {
    // No room, or not allowed: it ends with the page.
  }
}

// ---------------------------------------------------------------- talking to the server

function say(text, bad = false) {
  if ($("status").textContent !== text) $("status").textContent = text;
  $("status").classList.toggle("bad", bad);
}

/** Of the server, not of a proxy before it or of a request that broke off. */
const is_answer = (response) =>
  response.ok || (response.status < 500 && response.headers.get("Content-Type") === "application/json");

/** An answer of the server; asks until there is one. */
async function request(path, options, trouble) {
  for (;;) {
    try {
      const response = await fetch(`${base}/${path}`, options);
      if (is_answer(response)) return response;
    } catch {
      // No connection.
    }
    say(trouble, true);
    await sleep(1000);
  }
}

async function post(path, body) {
  const options = { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) };
  const response = await request(path, options, "Not saved yet. Your answer is kept here: trying again …");
  say("");
  return { ok: response.ok, answer: await response.json() };
}

/** Where this person stands. */
async function ask() {
  const response = await request("state", {}, "The server cannot be reached: trying again …");
  say("");
  if (!response.ok) return { stage: "failed", title: document.title };
  return response.json();
}

// ---------------------------------------------------------------- clips

const clips = new Map();  // addresses of those that are loaded, by id
let format = formats.findIndex(([, type]) => $("video").canPlayType(type));

function load(id) {
  if (!clips.has(id)) clips.set(id, fetch_clip(id));
  return clips.get(id);
}

async function fetch_clip(id) {
  const path = `clips/${id}.${formats[Math.max(format, 0)][0]}`;
  for (;;) {
    const response = await request(path, {}, "The clip cannot be loaded yet: trying again …");
    try {
      if (response.ok) return URL.createObjectURL(await response.blob());
    } catch {
      // It broke off.
    }
    await sleep(1000);
  }
}

async function preload(test) {
  for (const { id } of test.clips) await load(id);
}

/** A browser that cannot play one format may play the other. */
async function try_other_format() {
  const other = 1 - Math.max(format, 0);
  if ($("video").dataset.tried) return say("This browser cannot play the clips: please try another one.", true);
  $("video").dataset.tried = "yes";
  format = other;
  clips.clear();
  $("video").src = await load(note.clip);
  play();
}

async function play() {
  try {
    await $("video").play();
  } catch {
    update();  // A person must ask for it.
  }
}

function replay() {
  if ($("replay").disabled) return;
  $("video").currentTime = 0;
  play();
}

/** Whether all of it has been on the screen. */
function seen_whole() {
  const { played, duration } = $("video");
  let seen = 0;
  for (let i = 0; i < played.length; i++) seen += played.end(i) - played.start(i);
  return seen >= Math.max(0.8 * duration, duration - 0.3);
}

function ended() {
  if (!note) return;
  if (!seen_whole()) return update();
  note.plays = Math.min(note.plays + 1, most_plays);
  keep_note();
  const first = $("lock").disabled;
  update();
  if (!first) return;
  say("Please answer.");
  if (!$("lock").contains(document.activeElement)) question_to_answer().focus();
}

// ---------------------------------------------------------------- questions

function paragraphs(box, texts) {
  box.replaceChildren(...texts.map((text) => Object.assign(document.createElement("p"), { textContent: text })));
}

function option(name, text, index) {
  const label = document.createElement("label"), input = document.createElement("input");
  label.className = "option";
  Object.assign(input, { type: "radio", name, value: index, required: true });
  label.append(input, Object.assign(document.createElement("span"), { textContent: text }));
  return label;
}

function key_hint(index) {
  const hint = Object.assign(document.createElement("kbd"), { textContent: index + 1 });
  hint.setAttribute("aria-hidden", "true");
  return hint;
}

function question(prefix, { id, text, options }, keys) {
  const box = document.createElement("fieldset"), list = document.createElement("div");
  box.className = "question";
  box.dataset.question = id;
  box.tabIndex = -1;
  list.className = options.some((o) => o.length > 16) ? "options long" : "options";
  options.forEach((o, index) => {
    const label = option(`${prefix}-${id}`, o, index);
    if (keys && index < 9) label.append(key_hint(index));
    list.append(label);
  });
  box.append(Object.assign(document.createElement("legend"), { textContent: text }), list);
  return box;
}

const boxes = () => [...$("questions").children];
const chosen_in = (box) => box.querySelector("input:checked");
const question_to_answer = () => boxes().find((box) => !chosen_in(box)) ?? boxes()[0];

// ---------------------------------------------------------------- the clip and its answers

const note_key = `study ${base}`;

/** Seconds that this clip has been looked at. */
const elapsed = () => Math.min(note.seconds + (since === null ? 0 : (performance.now() - since) / 1000), most_seconds);

function keep_note() {
  if (!note) return;
  note.seconds = elapsed();
  if (since !== null) since = performance.now();
  remember(note_key, note);
}

function chose(event) {
  const box = event.target.closest(".question");
  note.chosen[box.dataset.question] = { option: Number(event.target.value), seconds: elapsed() };
  keep_note();
  update();
}

/** What can be done now. */
function update() {
  if (!note) return;
  const video = $("video"), playing = !video.paused && !video.ended;
  $("lock").disabled = !note.plays;
  $("replay").disabled = playing || !video.src;
  $("replay").firstChild.textContent = note.plays ? "Play again " : "Play ";
  $("next").disabled = !note.plays || !boxes().every(chosen_in);
}

async function show_clip() {
  const { test } = state, [clip] = test.clips;
  const kept = recall(note_key);
  note = kept?.clip === clip.id ? kept : { clip: clip.id, plays: 0, seconds: 0, chosen: {} };
  show("clip");
  $("stage").setAttribute("aria-label", `Clip ${test.position + 1} of ${test.position + test.clips.length}`);
  $("questions").replaceChildren(...test.questions.map((q) =>
    question(clip.id, { ...q, options: q.options.length ? q.options : clip.choices }, true)));
  for (const box of boxes()) {
    const answer = note.chosen[box.dataset.question];
    if (answer) box.querySelectorAll("input")[answer.option].checked = true;
  }
  const video = $("video");
  video.removeAttribute("src");
  update();
  $("stage").focus();
  say("Loading …");
  video.src = await load(clip.id);
  say("");
  since = performance.now();
  play();
}

async function next() {
  keep_note();
  const sent = { clip: note.clip, plays: note.plays, answers: note.chosen };
  note = since = null;
  remember(note_key, { sent });
  $("video").pause();
  $("lock").disabled = $("next").disabled = $("replay").disabled = true;
  await send(sent);
  URL.revokeObjectURL(await load(sent.clip));
  clips.delete(sent.clip);
}

/** Sends answers until the server has them. */
async function send(sent) {
  say("Saving …");
  const { ok, answer } = await post("answers", sent);
  remember(note_key, null);
  go(ok ? answer : await ask());
}

// ---------------------------------------------------------------- pages

function show(name) {
  for (const section of sections) $(section).hidden = section !== name;
  const { title, total, done } = state;
  document.title = $("title").textContent = title;
  $("way").hidden = total === undefined;
  if (total !== undefined) {
    $("progress").max = total;
    $("progress").value = done;
    $("progress-text").textContent = `${done} of ${total} clips answered`;
  }
  $("later").hidden = !["profile", "intro", "clip"].includes(name);
  $("link").href = $("link").textContent = location.href;
  $(name).querySelector("h2")?.focus();
  scrollTo(0, 0);
}

const pages = {
  consent() {
    paragraphs($("consent-text"), state.paragraphs);
    const earlier = recall(note_key)?.link;
    $("earlier").hidden = !earlier;
    if (earlier) $("earlier-link").href = earlier;
    show("consent");
  },
  profile() {
    $("profile-questions").replaceChildren(...state.questions.map((q) => question("profile", q, false)));
    show("profile");
  },
  test() {
    const { test } = state;
    preload(test);
    if (begun && test.position) return show_clip();
    $("part").textContent = `Part ${test.number} of ${test.tests}`;
    $("intro-title").textContent = test.title;
    paragraphs($("instructions"), test.instructions);
    $("begin").textContent = test.position ? "Go on" : "Begin";
    show("intro");
  },
  done() {
    paragraphs($("thanks"), state.paragraphs);
    show("done");
  },
  failed() {
    show("failed");
  },
};

function go(next_state) {
  state = next_state;
  pages[state.stage]();
}

async function agree() {
  $("agree").disabled = true;
  const { ok, answer } = await post("consent", {});
  $("agree").disabled = false;
  if (!ok) return say(answer.error, true);
  if (!answer.link) return go(answer);
  const link = new URL(`../${answer.link}`, location.href).href;
  remember(note_key, { link });
  location.replace(link);
}

async function give_profile(event) {
  event.preventDefault();
  const given = state.questions.map(({ id }) => [id, Number(new FormData(event.target).get(`profile-${id}`))]);
  const { ok, answer } = await post("profile", Object.fromEntries(given));
  go(ok ? answer : await ask());
}

// ---------------------------------------------------------------- the keyboard

function choose(digit) {
  const box = document.activeElement?.closest(".question") ?? question_to_answer();
  const input = box.querySelectorAll("input")[digit - 1];
  if (!input || input.disabled || $("lock").disabled) return;
  input.focus();
  input.click();
  const open = boxes().find((other) => !chosen_in(other));
  if (open) open.focus();
}

function press(event) {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const { key, target } = event, own = target.closest("button, a");
  if (!$("intro").hidden && key === "Enter" && !own && !event.repeat) return $("begin").click();
  if ($("clip").hidden) return;
  if (key >= "1" && key <= "9" && key.length === 1) {
    choose(Number(key));
  } else if (key === " " && !own && !(target.type === "radio" && !target.checked)) {
    event.preventDefault();
    if (!event.repeat) replay();
  } else if (key === "Enter" && !own) {
    event.preventDefault();
    if (!event.repeat) $("next").click();
  }
}

// ---------------------------------------------------------------- the beginning

function listen() {
  $("agree").addEventListener("click", agree);
  $("profile-form").addEventListener("submit", give_profile);
  $("begin").addEventListener("click", () => { begun = true; show_clip(); });
  $("clip-form").addEventListener("submit", (event) => { event.preventDefault(); next(); });
  $("questions").addEventListener("change", chose);
  $("replay").addEventListener("click", replay);
  const video = $("video");
  video.addEventListener("ended", ended);
  video.addEventListener("play", update);
  video.addEventListener("pause", update);
  video.addEventListener("ratechange", () => { video.playbackRate = 1; });
  video.addEventListener("error", () => { if (note && video.src) try_other_format(); });
  video.addEventListener("contextmenu", (event) => event.preventDefault());
  document.addEventListener("keydown", press);
  addEventListener("pagehide", keep_note);
}

async function start() {
  listen();
  const waits = recall(note_key)?.sent;
  if (waits) await send(waits);
  else go(await ask());
}

start();
