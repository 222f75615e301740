// SPDX-License-Identifier: MIT
// The panels beside the picture: list of sonars, the chosen one, plan, events, figures of robot and link.

import { eye, make } from "./stage.js";
import { KINDS, LOOKS, conditionOf, eventText, exists, failureText, isNamed, lookOf, metres, modeText, signed, usable } from "./words.js";

const TOLD_PERCENT = 20; // less is what any sonar has now and then
const EVENTS_SHOWN = 120;
const LEVELS = ["ok", "warn", "error", "stale"];
const $ = (id) => document.getElementById(id);

function element(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

/** Sets text only where it changed, so that nothing is laid out or read out anew for nothing. */
export function put(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

function glyph(look) {
  const svg = make("svg", { viewBox: "-12 -12 24 24", class: `glyph ${look}`, "aria-hidden": "true" });
  svg.append(...eye(LOOKS[look].form, 8));
  return svg;
}

export function legend() {
  const items = Object.entries(LOOKS).map(([look, { word }]) => element("li", {}, glyph(look), word));
  const arcs = [["seen", "seen"], ["turned", "seen by turning"], ["blind", "blind"]].map(([what, word]) => {
    const svg = make("svg", { viewBox: "-12 -12 24 24", class: "glyph", "aria-hidden": "true" });
    make("path", { d: "M-10 0H10", class: `cover ${what}` }, svg);
    if (what === "blind") make("path", { d: "M-8 -4V4M-3 -4V4M2 -4V4M7 -4V4", class: "tick" }, svg);
    return element("li", {}, svg, word);
  });
  $("legend").replaceChildren(...items, ...arcs);
}

export class SonarList {
  constructor(choose) {
    this.box = $("sonars");
    this.choose = choose;
    this.rows = [];
    this.box.addEventListener("keydown", (event) => {
      const by = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[event.key];
      if (by) {
        event.preventDefault();
        this.rows[this.choose.by(by)]?.row.focus();
      }
    });
  }

  build(robot) {
    this.rows = robot.sonars.map((one, k) => {
      const parts = { glyph: element("span", { class: "g" }), mm: element("span", { class: "mm" }), bar: element("i"),
        what: element("span", { class: "what" }), level: element("i") };
      const row = element("button", { type: "button", role: "radio", class: "sonar-row", title: "Choose this sonar (N and B)", "data-k": k, "aria-checked": "false", tabindex: "-1" },
        parts.glyph, element("span", { class: "n" }, String(k)), element("span", { class: "deg" }, signed(one.deg)), parts.mm,
        element("span", { class: "range" }, parts.bar), parts.what, element("span", { class: "proof" }, parts.level));
      row.addEventListener("click", () => this.choose(k));
      return { row, ...parts, look: "" };
    });
    this.box.replaceChildren(...this.rows.map(({ row }) => row));
  }

  draw({ state, readings, evidence, chosen, broken }) {
    this.rows.forEach((one, k) => {
      const there = !state || exists(state, k);
      one.row.hidden = !there;
      const mm = readings?.mm[k] ?? state?.reading_mm[k];
      const look = lookOf(state, k);
      if (one.look !== look) {
        one.look = look;
        one.row.dataset.look = look;
        one.glyph.replaceChildren(glyph(look));
      }
      const heard = mm !== undefined && (readings?.age_ms[k] ?? state?.age_ms[k]) >= 0;
      put(one.mm, !heard ? "–" : mm >= 5000 ? "no echo" : `${metres(mm)} m`);
      one.bar.style.width = heard ? `${Math.min(100, mm / 50)}%` : "0";
      const level = evidence?.level?.[k] ?? 0;
      put(one.what, told({ state, evidence, broken }, k));
      one.level.style.width = `${Math.min(100, level)}%`;
      one.row.setAttribute("aria-checked", String(k === chosen));
      one.row.tabIndex = k === chosen ? 0 : -1;
    });
    if (state) {
      const fitted = state.health.filter((_, k) => exists(state, k) && k < this.rows.length).length;
      const used = state.health.filter((_, k) => usable(state, k) && k < this.rows.length).length;
      put($("sonars-count"), `${used} of ${fitted} in use`);
    }
  }
}

/** A row's words: short, since what matters most must fit. */
function told({ state, evidence, broken }, k) {
  const level = evidence?.level?.[k] ?? 0;
  const mark = broken[k] ? "↯ " : "";
  if (isNamed(state, k)) return mark + conditionOf(state, k);
  if (broken[k]) return `${mark}${broken[k]}, not found`;
  if (level >= TOLD_PERCENT && evidence.kind[k] && !state?.kind?.[k]) return `${evidence.kind[k]}? ${level} %`;
  return conditionOf(state, k);
}

export function drawChosen({ state, evidence, chosen, broken, robot, canBreak }) {
  put($("chosen-title"), `Sonar ${chosen}`);
  if (!state || !robot) return;
  const kind = state.kind[chosen], deg = robot.sonars[chosen]?.deg ?? 0;
  const parts = [`Looks ${signed(deg)}: ${conditionOf(state, chosen)}${kind in KINDS ? `, it ${KINDS[kind]}` : ""}.`];
  const level = evidence?.level?.[chosen] ?? 0;
  if (level >= TOLD_PERCENT && evidence.kind[chosen]) parts.push(`The evidence for ${evidence.kind[chosen]} is ${level} % of what a verdict takes.`);
  const by = evidence?.seen_by?.[chosen];
  if (Array.isArray(by) && by.length) parts.push(`Contradicted by ${by.length > 1 ? "sonars" : "sonar"} ${by.join(", ")}.`);
  if (broken[chosen]) parts.push(`Broken on purpose: ${broken[chosen]}.`);
  put($("chosen-text"), parts.join(" "));
  $("mend").disabled = !canBreak || !broken[chosen];
  $("break").disabled = !canBreak;
}

export function drawHead({ state, link }) {
  const up = link.up && state;
  put($("robot-name"), up && state.robot ? state.robot : "no robot");
  const failure = $("failure");
  failure.dataset.state = up ? state.state : "";
  put(failure, up ? failureText(state.state) : "Not connected");
  const chip = $("link");
  chip.dataset.up = String(Boolean(up && state.link_up && state.online));
  put(chip, !link.up ? link.why || "connecting" : !state ? "waiting for argusd" : !state.link_up ? "robot link lost" : state.online ? "live" : "no session");
  put($("mode"), up ? `${modeText(state.mode)}${state.paused ? ", paused" : ""}${state.reversed ? ", rear leads" : ""}` : "Offline");
  const active = $("active");
  active.setAttribute("aria-checked", String(Boolean(state?.active)));
  put(active, state?.active ? "Active" : "Passive");
  put($("stage-text"), !link.up && state ? "Nothing comes any more: this is of earlier." : sentence(state));
}

function sentence(state) {
  if (!state) return "Nothing is known of the robot yet.";
  const bad = state.health.flatMap((_, k) => (exists(state, k) && (isNamed(state, k) || lookOf(state, k) === "bad") ? [`${k}${state.kind[k] ? ` ${state.kind[k]}` : ""}`] : []));
  if (!bad.length) return "All eyes open.";
  const plan = state.plan_deg ?? [];
  const looks = plan.length ? ` Looks there by turning ${plan.map(signed).join(", ")}.` : "";
  return `${bad.length === 1 ? "Sonar" : "Sonars"} ${bad.join(", ")}.${looks}`;
}

export function drawPlan(state, now) {
  const plan = state?.plan_deg ?? [];
  const box = $("plan");
  const key = JSON.stringify([plan, now, state?.plan_complete]);
  if (box.dataset.key === key) return;
  box.dataset.key = key;
  if (!plan.length) {
    const lost = state && state.state !== "IsNormal" && !state.plan_complete;
    box.replaceChildren(lost ? "No rotation covers the blind bearings." : "No rotation is needed: every bearing ahead is seen.");
    return;
  }
  const chips = plan.map((deg, k) => element("span", k === now ? { class: "turn now", "aria-current": "step" } : { class: "turn" }, signed(deg)));
  const end = state.plan_complete ? "covers all blind bearings" : "leaves some bearings blind";
  box.replaceChildren(...chips.flatMap((chip) => [chip, " "]), element("span", { class: "end" }, end));
}

export class Events {
  constructor() {
    this.box = $("events");
    this.last = null;
  }

  clear() {
    this.box.replaceChildren();
    this.last = null;
  }

  add(event) {
    const { about, what } = eventText(event);
    const key = `${event.event} ${event.name}`;
    if (this.last?.key === key) {
      this.last.count += 1;
      put(this.last.words, what);
      this.last.times.textContent = ` ×${this.last.count}`;
      return;
    }
    const times = element("span", { class: "times" });
    const words = element("span", {}, what);
    const line = element("li", { class: LEVELS[event.level] ?? "ok" }, element("time", {}, event.t.toFixed(1)), element("b", {}, about), element("span", {}, words, times));
    this.last = { key, count: 1, times, words };
    this.box.prepend(line);
    while (this.box.childElementCount > EVENTS_SHOWN) this.box.lastElementChild.remove();
  }
}

export function drawFigures(state, latency) {
  if (!state) return;
  const pairs = [
    ["Battery", `${(state.battery_dv / 10).toFixed(1)} V`],
    ["Speed", `${Math.round((state.vel_left_mm_s + state.vel_right_mm_s) / 2)} mm/s`],
    ["Place", `${metres(state.x_mm)}, ${metres(state.y_mm)} m`],
    ["Heading", `${(state.heading_cdeg / 100).toFixed(1)}°`],
    ["Goal", state.mission === "none" || !state.waypoints ? "none" : `${metres(state.goal_mm)} m away`],
    ["Stops", String(state.stops)],
    ["SIPs", String(state.sips)],
    ["Bad sums", String(state.bad_checksums)],
    ["Skipped", `${state.skipped_bytes} B`],
    ["Bytes in", String(state.bytes_in)],
    ["Reopened", String(state.reopened)],
    ["SIP to screen", latency === null ? "–" : `${latency.toFixed(0)} ms`],
    ["Link", state.link],
  ];
  const box = $("figures");
  if (box.childElementCount !== pairs.length) box.replaceChildren(...pairs.map(([name]) => element("div", {}, element("dt", {}, name), element("dd"))));
  pairs.forEach(([, value], k) => put(box.children[k].lastChild, value));
}
