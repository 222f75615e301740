// SPDX-License-Identifier: MIT
// The page: keeps what is known, draws it when it changes, and turns clicks and keys into orders.

import { Link } from "./link.js";
import { Events, SonarList, drawChosen, drawFigures, drawHead, drawPlan, legend, put } from "./panels.js";
import { Stage } from "./stage.js";
import { between } from "./geometry.js";
import { KINDS, SHOWS_AT_REST, exists, failureText, isNamed } from "./words.js";

const SAY_MS = 6000;
const TRAIL_KEPT = 3000;
const LATENCIES_KEPT = 200;
const THEMES = ["auto", "light", "dark"];
const $ = (id) => document.getElementById(id);

const known = { state: null, readings: null, evidence: null, robot: null, broken: {}, chosen: 3, link: { up: false, why: "connecting" },
  sim: false, canBreak: false, control: "none" };
const latencies = [];
const brokenAt = new Map();
let brokenKnown = false;
let sipAt = null;

const stage = new Stage({ floor: (x, y) => goTo(x, y), sonar: (k) => onSonar(k) });
const list = new SonarList(Object.assign((k) => choose(k), { by: (step) => chooseBy(step) }));
const events = new Events();
const link = new Link(take, (why) => take({ link: { up: false, why } }), askToken);

// ---- what is told

const TAKES = {
  about(about) {
    forget(); // a story follows, from its beginning
    brokenKnown = false;
    known.sim = about.sim;
    document.body.classList.toggle("sim", about.sim);
    stage.walls = about.walls ?? [];
    put($("world-name"), about.world ? `in ${about.world}` : "");
  },
  robot(robot) {
    known.robot = stage.robot = robot;
    list.build(robot);
  },
  link(up) {
    known.link = up;
    if (!up.up) known.control = "none";
    document.body.classList.toggle("stale", !up.up); // what is shown is of earlier
  },
  anew() {
    Object.assign(known, { state: null, readings: null, evidence: null });
    forget();
  },
  trail({ path, echoes }) {
    stage.path.push(...path);
    stage.echoes.push(...echoes);
    stage.path.splice(0, stage.path.length - TRAIL_KEPT);
    stage.echoes.splice(0, stage.echoes.length - TRAIL_KEPT);
  },
  goal(goal) {
    stage.goal = goal;
  },
  readings(readings) {
    known.readings = stage.readings = readings;
    if (known.state?.unix) sipAt = readings.t + known.state.unix - known.state.t;
  },
  evidence(evidence) {
    known.evidence = stage.evidence = evidence;
  },
  broken(broken) {
    // What was broken before this page came is not timed: nobody here knows since when.
    for (const k of Object.keys(broken)) if (brokenKnown && known.broken[k] !== broken[k]) brokenAt.set(Number(k), performance.now());
    for (const k of brokenAt.keys()) if (!(k in broken)) brokenAt.delete(k);
    known.broken = stage.broken = broken;
    brokenKnown = true;
  },
  viewers(count) {
    put($("viewers"), count === 1 ? "1 viewer" : `${count} viewers`);
  },
  control(control) {
    if (control === "lost") say("Somebody else has taken control.", "warn");
    known.control = control;
  },
};

function forget() {
  Object.assign(stage, { path: [], echoes: [], goal: null, state: null, readings: null, evidence: null });
  events.clear();
}

function take(message) {
  if (message.event === "STATUS") takeState(message);
  else if ("event" in message) takeEvent(message);
  else for (const [name, value] of Object.entries(message)) TAKES[name]?.(value);
  draw();
}

function takeState(state) {
  const before = known.state;
  known.state = state;
  const injected = Object.fromEntries((state.injected ?? []).flatMap((kind, k) => (kind ? [[k, kind]] : [])));
  if (!known.sim) TAKES.broken(injected);
  known.canBreak = known.sim || Boolean(state.inject);
  document.body.classList.toggle("armed", known.canBreak && !known.sim);
  stage.setState(state);
  if (before) tellFound(before, state);
}

/** Say how long a fault that was put in took to be found. */
function tellFound(before, state) {
  for (const [k, since] of brokenAt) {
    if (!isNamed(before, k) && isNamed(state, k)) {
      const after = ((performance.now() - since) / 1000).toFixed(1);
      say(`Found after ${after} s: sonar ${k}${state.kind[k] ? `, ${state.kind[k]}` : ""}.`, "good");
    }
  }
  if (before.state !== state.state) put($("failure"), failureText(state.state));
}

function takeEvent(event) {
  events.add(event);
  if (event.event === "GOAL_REACHED") say("The goal is reached.", "good");
}

// ---- drawing

let panelsWaiting = false;

function draw() {
  stage.chosen = known.chosen;
  stage.redraw();
  if (!panelsWaiting) {
    panelsWaiting = true;
    requestAnimationFrame(drawPanels);
  }
}

function drawPanels() {
  panelsWaiting = false;
  drawHead(known);
  list.draw(known);
  drawChosen(known);
  const { state } = known;
  const plan = state?.plan_deg ?? [];
  drawPlan(state, state?.mode === "SWEEPING" ? stage.nearest(plan, between(stage.base, stage.pose.deg)) : -1);
  drawFigures(state, latencies.length ? latencies.at(-1) : null);
  const mine = known.control === "mine";
  const control = $("control");
  control.setAttribute("aria-pressed", String(mine));
  put(control, mine ? "In control" : state?.controlled ? "Take over" : "Take control");
}

/** After each drawn frame: how old is the newest reading now that it is on the screen? */
stage.drawn = () => {
  if (sipAt === null) return;
  const at = sipAt;
  sipAt = null;
  const channel = new MessageChannel(); // its turn comes when the frame has been painted
  channel.port1.onmessage = () => {
    const now = link.now();
    if (Number.isNaN(now)) return;
    latencies.push(now - at * 1000);
    if (latencies.length > LATENCIES_KEPT) latencies.shift();
  };
  channel.port2.postMessage(0);
};

// ---- saying

let sayTimer = 0;

function say(text, tone = "") {
  const box = $("say");
  box.dataset.tone = tone;
  put(box, text);
  box.classList.add("shown");
  clearTimeout(sayTimer);
  sayTimer = setTimeout(() => box.classList.remove("shown"), SAY_MS);
}

function askToken() {
  const dialog = $("ask");
  if (!dialog.open) dialog.showModal();
}

// ---- orders

/** The answer; null, and a word on the page, where it is refused. */
async function ask(request) {
  let answer = await link.ask(request);
  if (answer.why === "not_in_control" || answer.why === "stale_grant") {
    const taken = await link.ask({ do: "take" });
    answer = taken.ok ? await link.ask(request) : taken;
  }
  if (!answer.ok) say(answer.why === "taken" ? "Somebody else is in control. Take over first." : answer.say || "It was refused.", "warn");
  return answer.ok ? answer : null;
}

const order = (name, members = {}) => ask({ do: "order", order: name, ...members });
const chosenOrder = (name) => order(name, { sonar: known.chosen });

async function stop() {
  if (await order("stop")) say("Stopped. Go on continues the course.");
}

async function goTo(x, y) {
  const answer = await order("goto", { x_mm: x, y_mm: y });
  if (!answer) return;
  const note = answer.say ? ` Note: ${answer.say}.` : "";
  say(known.state?.active ? `On its way.${note}` : "The robot is passive: it drives when you make it active.");
}

async function breakOrMend(k) {
  if (known.broken[k]) {
    if (await ask({ do: "mend", sonar: k })) say(`Sonar ${k} is mended.`);
    return;
  }
  const kind = $("fault").value;
  const rests = known.state?.mode === "IDLE" && kind !== SHOWS_AT_REST;
  const hint = rests ? "This shows while it drives: give it a goal." : "Will Argus see it?";
  if (await ask({ do: "break", sonar: k, kind })) say(`Sonar ${k} is broken: it ${KINDS[kind]}. ${hint}`);
}

function onSonar(k) {
  choose(k);
  if (known.sim) breakOrMend(k);
}

function choose(k) {
  known.chosen = k;
  draw();
}

function chooseBy(step) {
  const count = known.robot?.sonars.length ?? 16;
  let k = known.chosen;
  do k = (k + step + count) % count;
  while (known.state && !exists(known.state, k) && k !== known.chosen);
  choose(k);
  return k;
}

async function control() {
  if (known.control === "mine") {
    await link.ask({ do: "release" });
    return;
  }
  const answer = await link.ask({ do: "take", force: Boolean(known.state?.controlled) });
  if (!answer.ok) say(answer.say, "warn");
}

const toggleActive = () => order(known.state?.active ? "passive" : "active");

// ---- keys and clicks

const KEYS = {
  ArrowUp: () => order("step", { way: "ahead" }), w: () => order("step", { way: "ahead" }),
  ArrowDown: () => order("step", { way: "back" }), s: () => order("step", { way: "back" }),
  ArrowLeft: () => order("turn", { deg: 20 }), a: () => order("turn", { deg: 20 }),
  ArrowRight: () => order("turn", { deg: -20 }), d: () => order("turn", { deg: -20 }),
  g: () => order("go"), r: () => order("recheck"), p: toggleActive, n: () => chooseBy(1), b: () => chooseBy(-1),
  t: () => chosenOrder("retest"), k: () => chosenOrder("pin"), x: () => chosenOrder("out"),
  f: () => (known.canBreak ? breakOrMend(known.chosen) : undefined), "+": () => stage.zoom(-1), "-": () => stage.zoom(1),
};

/** Space and Escape stop wherever they mean nothing else; the other keys only while the picture has the focus. */
function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing || $("ask").open) return;
  const inField = event.target.closest?.("input, select, textarea");
  const onControl = event.target.closest?.("button, a, [role=radio]");
  if (event.key === "Escape" || (event.key === " " && !inField && !onControl)) {
    event.preventDefault();
    stop();
    return;
  }
  const does = event.target.closest?.("#stage") ? KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key] : undefined;
  if (does && !event.repeat) does();
  if (does) event.preventDefault();
}

function setTheme(theme) {
  localStorage.setItem("argus-monitor-theme", theme);
  document.documentElement.dataset.theme = theme;
  put($("theme"), `Theme: ${theme}`);
  stage.recolour();
}

function wire() {
  document.addEventListener("keydown", onKey);
  for (const button of document.querySelectorAll("[data-order]")) {
    const { order: name, deg, way } = button.dataset;
    button.addEventListener("click", () => (name === "stop" ? stop() : order(name, { ...(deg && { deg: Number(deg) }), ...(way && { way }) })));
  }
  for (const button of document.querySelectorAll("[data-sonar-order]")) {
    button.addEventListener("click", () => chosenOrder(button.dataset.sonarOrder));
  }
  $("more").addEventListener("click", (event) => {
    const open = document.querySelector(".orders").classList.toggle("unfolded");
    event.currentTarget.setAttribute("aria-expanded", String(open));
  });
  $("active").addEventListener("click", toggleActive);
  $("control").addEventListener("click", control);
  $("zoom-in").addEventListener("click", () => stage.zoom(-1));
  $("zoom-out").addEventListener("click", () => stage.zoom(1));
  $("break").addEventListener("click", () => known.broken[known.chosen] || breakOrMend(known.chosen));
  $("mend").addEventListener("click", () => known.broken[known.chosen] && breakOrMend(known.chosen));
  $("theme").addEventListener("click", () => setTheme(THEMES[(THEMES.indexOf(document.documentElement.dataset.theme) + 1) % THEMES.length]));
  $("ask-form").addEventListener("submit", () => link.use($("token").value));
  $("goto").addEventListener("submit", (event) => {
    event.preventDefault();
    const [x, y] = ["x", "y"].map((name) => Number(event.target.elements[name].value.replace(",", ".") || NaN));
    if (Number.isFinite(x) && Number.isFinite(y)) goTo(Math.round(x * 1000), Math.round(y * 1000));
    else say("Give x (ahead of the start) and y (left of it) in metres.", "warn");
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => stage.recolour());
}

$("fault").replaceChildren(...Object.keys(KINDS).map((kind) => new Option(kind, kind)));
$("fault").value = SHOWS_AT_REST; // what a first click breaks is found within seconds
legend();
wire();
setTheme(THEMES.includes(localStorage.getItem("argus-monitor-theme")) ? localStorage.getItem("argus-monitor-theme") : "auto");
draw();
link.open();
window.argusMonitor = { known, latencies, stage, stop, mend: (sonar) => ask({ do: "mend", sonar }) }; // for tests
