// SPDX-License-Identifier: MIT
// The picture: floor, walls, way and echoes on a canvas; robot, beams, ring and plan as SVG above it, one frame for both.

import { RAD, between, coverage, onFloor, ringAngles, runs } from "./geometry.js";
import { LOOKS, exists, lookOf, metres, signed, usable } from "./words.js";

const SVG = "http://www.w3.org/2000/svg";
const NO_ECHO_MM = 5000;
const BEAM_DEG = 8;
const RING_PART = 0.215; // of half the picture: where the eyes sit
const RING_MIN = 68; // pixels: eyes 20 degrees apart are then far enough from one another for a finger
const SPANS_MM = [1500, 2000, 2600, 3300, 4200, 5400, 7000, 10000];
const SCALE_DEG = -70; // where the range circles have their figures
const PLAN_OUT = 20; // pixels from the plan's arc to its figure
const LABEL_OUT = [16, 32, 48]; // pixels beyond the echo
const [LABEL_WIDE, LABEL_HIGH] = [36, 15]; // pixels that a figure keeps to itself
const GLIDE_MS = 110;
const GLIDE_FRAME_MS = 30;

export function make(name, attributes = {}, parent = null) {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  parent?.append(node);
  return node;
}

/** An eye of the ring: the form says the same as the colour. */
export function eye(form, r) {
  const cross = `M${-r * 0.5} ${-r * 0.5}L${r * 0.5} ${r * 0.5}M${r * 0.5} ${-r * 0.5}L${-r * 0.5} ${r * 0.5}`;
  const forms = {
    eye: [["circle", { r, class: "lid" }], ["circle", { r: r * 0.42, class: "pupil" }]],
    triangle: [["path", { d: `M0 ${-r * 1.1}L${r * 1.05} ${r * 0.85}H${-r * 1.05}Z`, class: "lid" }],
      ["path", { d: `M0 ${-r * 0.35}V${r * 0.22}M0 ${r * 0.52}V${r * 0.56}`, class: "mark" }]],
    cross: [["rect", { x: -r, y: -r, width: 2 * r, height: 2 * r, rx: r * 0.2, class: "lid full" }],
      ["path", { d: cross, class: "mark" }]],
    diamond: [["path", { d: `M0 ${-r * 1.2}L${r * 1.2} 0L0 ${r * 1.2}L${-r * 1.2} 0Z`, class: "lid" }],
      ["circle", { r: r * 0.2, class: "pupil" }]],
    hollow: [["circle", { r, class: "lid dashed" }]],
  };
  return forms[form].map(([name, attributes]) => make(name, attributes));
}

const polar = (r, deg) => [-r * Math.sin(deg * RAD), -r * Math.cos(deg * RAD)];

function arc(r, from, to) {
  const [x1, y1] = polar(r, from), [x2, y2] = polar(r, to);
  return `M${x1} ${y1}A${r} ${r} 0 ${to - from > 180 ? 1 : 0} 0 ${x2} ${y2}`;
}

/** Those of the floor, by name; the robot's are in the style sheet. */
function colours(box) {
  const style = getComputedStyle(box);
  return Object.fromEntries(["muted", "floor", "grid", "wall", "way", "echo", "doubted", "goal"].map((name) => [name, style.getPropertyValue(`--${name}`)]));
}

export class Stage {
  /** act: { floor(x_mm, y_mm), sonar(k) } hear of clicks. */
  constructor(act) {
    this.box = document.querySelector("#stage");
    this.canvas = document.querySelector("#ground");
    this.svg = document.querySelector("#robot");
    this.act = act;
    this.span = 2;
    this.robot = null;
    this.state = null;
    this.readings = null;
    this.evidence = null;
    this.broken = {};
    this.chosen = 3;
    this.path = [];
    this.echoes = [];
    this.walls = [];
    this.goal = null;
    this.pose = { x: 0, y: 0, deg: 0 };
    this.glide = null;
    this.eyes = new Map();
    this.over = undefined;
    this.base = 0;
    this.waiting = false;
    this.stale = true; // the robot is to be drawn anew, not only to be moved
    this.last = 0;
    this.colours = null;
    this.drawn = () => {};
    this.still = matchMedia("(prefers-reduced-motion: reduce)");
    new ResizeObserver(() => this.redraw()).observe(this.box);
    this.box.addEventListener("click", (event) => this.#click(event));
    this.box.addEventListener("pointermove", (event) => this.#hover(this.#eyeAt(...this.#place(event))));
    this.box.addEventListener("pointerleave", () => this.#hover(undefined));
    this.box.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.sign(event.deltaY));
    }, { passive: false });
  }

  zoom(by) {
    this.span = Math.max(0, Math.min(SPANS_MM.length - 1, this.span + by));
    this.redraw();
  }

  setState(state) {
    const to = { x: state.x_mm, y: state.y_mm, deg: state.heading_cdeg / 100 };
    const leap = Math.hypot(to.x - this.pose.x, to.y - this.pose.y) > 500;
    const from = leap || this.still.matches || !this.state ? to : this.pose;
    this.glide = from.x === to.x && from.y === to.y && from.deg === to.deg ? null : { from, to, since: performance.now() };
    if (!this.glide) this.pose = to;
    if (state.mode !== "SWEEPING" || this.state?.mode !== "SWEEPING") this.base = to.deg;
    this.state = state;
    this.redraw();
  }

  redraw() {
    this.stale = true;
    this.#ask();
  }

  /** After a change of the theme. */
  recolour() {
    this.colours = null;
    this.redraw();
  }

  #ask() {
    if (!this.waiting) {
      this.waiting = true;
      requestAnimationFrame((now) => this.#frame(now));
    }
  }

  #frame(now) {
    this.waiting = false;
    if (!this.stale && now - this.last < GLIDE_FRAME_MS) { // between two states; what is new is drawn at once
      this.#ask();
      return;
    }
    this.last = now;
    const { deg } = this.pose;
    if (this.glide) {
      const part = Math.min(1, (now - this.glide.since) / GLIDE_MS);
      const { from, to } = this.glide;
      this.pose = {
        x: from.x + (to.x - from.x) * part,
        y: from.y + (to.y - from.y) * part,
        deg: from.deg + between(from.deg, to.deg) * part,
      };
      if (part === 1) this.glide = null;
      else this.#ask();
    }
    const { clientWidth: width, clientHeight: height } = this.box;
    if (!width || !height) return;
    this.half = Math.min(width, height) / 2;
    this.scale = this.half / SPANS_MM[this.span];
    this.#size();
    this.#ground(width, height);
    // While it glides straight on the robot looks as before: to build it anew sixty times a second costs what the
    // next reading then waits for.
    if (this.stale || this.pose.deg !== deg) this.#figure(width, height);
    this.stale = false;
    this.drawn();
  }

  /** Pixels from the middle, for a point on the floor. */
  #at(x, y) {
    return [-(y - this.pose.y) * this.scale, -(x - this.pose.x) * this.scale];
  }

  // ---- floor

  #ground(width, height) {
    const ratio = devicePixelRatio || 1;
    if (this.canvas.width !== Math.round(width * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
    }
    const pen = this.canvas.getContext("2d");
    this.colours ??= colours(this.box);
    const colour = (name) => this.colours[name];
    pen.setTransform(ratio, 0, 0, ratio, (width * ratio) / 2, (height * ratio) / 2);
    pen.clearRect(-width / 2, -height / 2, width, height);
    this.#grid(pen, width, height, colour("grid"));
    this.#lines(pen, colour("wall"));
    this.#scale(pen, colour("muted"), colour("floor"));
    this.#way(pen, colour("way"));
    this.#dots(pen, colour("echo"), colour("doubted"));
    if (this.goal) this.#flag(pen, colour("goal"));
  }

  #grid(pen, width, height, colour) {
    const step = 1000 * this.scale;
    pen.fillStyle = colour;
    const left = ((this.pose.y * this.scale) % step) - Math.ceil(width / step) * step;
    const top = ((this.pose.x * this.scale) % step) - Math.ceil(height / step) * step;
    for (let x = left; x < width / 2; x += step) {
      for (let y = top; y < height / 2; y += step) pen.fillRect(x - 1, y - 1, 2, 2);
    }
    pen.strokeStyle = colour;
    pen.lineWidth = 1;
    for (let r = 1000; r <= NO_ECHO_MM; r += 1000) {
      pen.beginPath();
      pen.arc(0, 0, r * this.scale, 0, 2 * Math.PI);
      pen.stroke();
    }
  }

  #scale(pen, ink, paper) {
    pen.font = "12px ui-monospace, monospace";
    pen.textAlign = "center";
    pen.fillStyle = ink;
    pen.strokeStyle = paper; // a rim, so that beams and circles do not cross the figures
    pen.lineWidth = 4;
    for (const [m, x, y] of this.#scaleLabels()) {
      pen.strokeText(`${m} m`, x, y + 4);
      pen.fillText(`${m} m`, x, y + 4);
    }
  }

  #lines(pen, colour) {
    pen.strokeStyle = colour;
    pen.lineWidth = Math.max(2, 45 * this.scale);
    pen.lineCap = "round";
    pen.beginPath();
    for (const [x1, y1, x2, y2] of this.walls) {
      pen.moveTo(...this.#at(x1, y1));
      pen.lineTo(...this.#at(x2, y2));
    }
    pen.stroke();
  }

  #way(pen, colour) {
    if (!this.path.length) return;
    pen.strokeStyle = colour;
    pen.lineWidth = 2.5;
    pen.lineJoin = "round";
    pen.beginPath();
    this.path.forEach(([x, y], k) => (k ? pen.lineTo(...this.#at(x, y)) : pen.moveTo(...this.#at(x, y))));
    pen.lineTo(0, 0);
    pen.stroke();
  }

  #dots(pen, trusted, doubted) {
    pen.fillStyle = trusted;
    for (const [x, y, good] of this.echoes) {
      if (!good) continue;
      const [px, py] = this.#at(x, y);
      pen.fillRect(px - 1.5, py - 1.5, 3, 3);
    }
    pen.strokeStyle = doubted;
    pen.lineWidth = 1.4;
    pen.beginPath();
    for (const [x, y, good] of this.echoes) {
      if (good) continue;
      const [px, py] = this.#at(x, y);
      pen.moveTo(px - 3, py - 3);
      pen.lineTo(px + 3, py + 3);
      pen.moveTo(px + 3, py - 3);
      pen.lineTo(px - 3, py + 3);
    }
    pen.stroke();
  }

  #flag(pen, colour) {
    const [x, y] = this.#at(...this.goal);
    pen.strokeStyle = pen.fillStyle = colour;
    pen.lineWidth = 2;
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(x, y - 26);
    pen.stroke();
    pen.beginPath();
    pen.moveTo(x, y - 26);
    pen.lineTo(x + 16, y - 20);
    pen.lineTo(x, y - 14);
    pen.fill();
    pen.beginPath();
    pen.arc(x, y, 4, 0, 2 * Math.PI);
    pen.fill();
  }

  // ---- robot

  /** How large the ring of eyes is, and each eye. */
  #size() {
    this.ring = Math.max(RING_PART * this.half, RING_MIN, ((this.robot?.swing_mm ?? 0) + 90) * this.scale);
    this.r = Math.max(8.5, Math.min(13, this.half * 0.03));
  }

  /** Where figures begin: what lies further in would be under the ring, or what is drawn around it. */
  get #clear() {
    return this.ring + 2.6 * this.r + 14;
  }

  #figure(width, height) {
    this.svg.setAttribute("viewBox", `${-width / 2} ${-height / 2} ${width} ${height}`);
    if (!this.robot) return;
    const turned = make("g", { transform: `rotate(${-this.pose.deg})` });
    const upright = make("g");
    const angles = ringAngles(this.robot.sonars);
    if (this.state) {
      this.#beams(turned, upright);
      this.#coverage(turned);
      this.#plan(upright);
    }
    this.#body(turned);
    this.eyes.clear();
    this.robot.sonars.forEach((_, k) => this.#eye(upright, k, angles[k]));
    this.svg.replaceChildren(turned, upright);
  }

  #mm(k) {
    return this.readings?.mm[k] ?? this.state.reading_mm[k];
  }

  #beams(turned, upright) {
    const labels = [];
    for (const [k, one] of this.robot.sonars.entries()) {
      const age = this.readings?.age_ms[k] ?? this.state.age_ms[k];
      if (!exists(this.state, k) || age < 0) continue;
      const look = lookOf(this.state, k);
      const mm = Math.min(this.#mm(k), NO_ECHO_MM);
      const [x, y] = [-one.y_mm * this.scale, -one.x_mm * this.scale];
      const r = mm * this.scale;
      const [x1, y1] = polar(r, one.deg - BEAM_DEG), [x2, y2] = polar(r, one.deg + BEAM_DEG);
      const group = make("g", { class: `beam ${look}${mm >= NO_ECHO_MM ? " open" : ""}`, transform: `translate(${x} ${y})` }, turned);
      make("path", { d: `M0 0L${x1} ${y1}A${r} ${r} 0 0 0 ${x2} ${y2}Z`, class: "cone" }, group);
      if (mm < NO_ECHO_MM) {
        make("path", { d: `M${x1} ${y1}A${r} ${r} 0 0 0 ${x2} ${y2}`, class: "echo" }, group);
        labels.push({ one, mm, look, first: k === this.chosen ? 0 : look === "good" ? 2 : 1 });
      }
    }
    const taken = [...this.#scaleLabels().map(([, x, y]) => [x, y]), ...this.#planLabels()];
    for (const label of labels.sort((a, b) => a.first - b.first)) this.#label(upright, taken, label);
  }

  /** The metres of the range circles that have a figure, and where it stands. */
  #scaleLabels() {
    return [1, 2, 3, 4, 5]
      .filter((m) => m * 1000 * this.scale >= this.#clear)
      .map((m) => [m, ...polar(m * 1000 * this.scale, SCALE_DEG)]);
  }

  /** The range at its echo, farther out where another figure stands, nowhere if there is no room: the list has it. */
  #label(upright, taken, { one, mm, look }) {
    const [fx, fy] = onFloor({ x: 0, y: 0, deg: this.pose.deg }, one.x_mm, one.y_mm);
    const { clientWidth: width, clientHeight: height } = this.box;
    for (const out of LABEL_OUT) {
      const [px, py] = polar(mm * this.scale + out, one.deg + this.pose.deg);
      const [x, y] = [px - fy * this.scale, py - fx * this.scale];
      if (Math.hypot(x, y) < this.#clear) continue;
      if (Math.abs(x) > width / 2 - LABEL_WIDE / 2 || Math.abs(y) > height / 2 - LABEL_HIGH) continue;
      if (taken.some(([ox, oy]) => Math.abs(x - ox) < LABEL_WIDE && Math.abs(y - oy) < LABEL_HIGH)) continue;
      taken.push([x, y]);
      make("text", { x, y: y + 4, class: `reading ${look}` }, upright).textContent = metres(mm);
      return;
    }
  }

  #coverage(turned) {
    const circle = coverage(this.robot.sonars, (k) => exists(this.state, k), (k) => usable(this.state, k), this.state.plan_deg ?? []);
    for (const [what, from, to] of runs(circle)) {
      if (what === "gap") continue;
      make("path", { d: arc(this.ring + 2.1 * this.r, from, Math.min(to, from + 359.9)), class: `cover ${what}` }, turned);
      if (what === "blind") {
        for (let deg = from + 2; deg < to; deg += 4) {
          const [x1, y1] = polar(this.ring + 1.75 * this.r, deg), [x2, y2] = polar(this.ring + 2.45 * this.r, deg);
          make("path", { d: `M${x1} ${y1}L${x2} ${y2}`, class: "tick" }, turned);
        }
      }
    }
  }

  #planRadius() {
    return this.ring + 3.6 * this.r;
  }

  /** Where the plan has its figures and their marks. */
  #planLabels() {
    return (this.state.plan_deg ?? []).flatMap((deg) => [PLAN_OUT, 0].map((out) => polar(this.#planRadius() + out, this.base + deg)));
  }

  #plan(upright) {
    const plan = this.state.plan_deg ?? [];
    const sweeping = this.state.mode === "SWEEPING";
    const turn = between(this.base, this.pose.deg);
    const now = sweeping ? this.nearest(plan, turn) : -1;
    const r = this.#planRadius();
    plan.forEach((deg, k) => {
      const group = make("g", { class: k === now ? "turn now" : "turn" }, upright);
      make("path", { d: arc(r, this.base + Math.min(0, deg), this.base + Math.max(0, deg)), class: "sweep" }, group);
      const [x1, y1] = polar(r - 5, this.base + deg), [x2, y2] = polar(r + 7, this.base + deg);
      make("path", { d: `M${x1} ${y1}L${x2} ${y2}`, class: "stopmark" }, group);
      const [x, y] = polar(r + PLAN_OUT, this.base + deg);
      make("text", { x, y: y + 4, class: "deg" }, group).textContent = signed(deg);
    });
    if (plan.length) {
      const [x1, y1] = polar(r - 4, this.pose.deg);
      make("circle", { cx: x1, cy: y1, r: 4, class: "needle" }, upright);
    }
  }

  nearest(plan, turn) {
    let best = -1;
    plan.forEach((deg, k) => {
      if (best < 0 || Math.abs(between(deg, turn)) < Math.abs(between(plan[best], turn))) best = k;
    });
    return best;
  }

  #body(turned) {
    const { front_mm: front, rear_mm: rear, half_mm: half } = this.robot;
    const s = this.scale, [f, b, h] = [front * s, rear * s, half * s];
    const group = make("g", { class: "body" }, turned);
    const wheel = { width: h * 0.34, height: h * 0.95, rx: h * 0.1, class: "wheel" };
    make("rect", { x: -h, y: -h * 0.48, ...wheel }, group);
    make("rect", { x: h * 0.66, y: -h * 0.48, ...wheel }, group);
    const n = h * 0.78;
    make("path", {
      d: `M${-n} ${-f * 0.45}Q${-n * 0.86} ${-f} 0 ${-f}Q${n * 0.86} ${-f} ${n} ${-f * 0.45}V${b * 0.55}Q${n * 0.86} ${b} 0 ${b}Q${-n * 0.86} ${b} ${-n} ${b * 0.55}Z`,
      class: "hull",
    }, group);
    make("path", { d: `M0 ${-f * 0.78}L${n * 0.3} ${-f * 0.3}L0 ${-f * 0.42}L${-n * 0.3} ${-f * 0.3}Z`, class: "nose" }, group);
    make("circle", { r: n * 0.42, cy: b * 0.22, class: "hub" }, group);
    if (this.state?.bumpers_front) make("path", { d: `M${-n} ${-f * 0.6}Q0 ${-f * 1.35} ${n} ${-f * 0.6}`, class: "pressed" }, group);
    if (this.state?.bumpers_rear) make("path", { d: `M${-n} ${b * 0.7}Q0 ${b * 1.3} ${n} ${b * 0.7}`, class: "pressed" }, group);
  }

  #eye(upright, k, angle) {
    if (this.state && !exists(this.state, k)) return;
    const look = lookOf(this.state, k);
    const [x, y] = polar(this.ring, angle + this.pose.deg);
    this.eyes.set(k, [x, y]);
    const marks = `${k === this.chosen ? " chosen" : ""}${k === this.over ? " over" : ""}`;
    const group = make("g", { class: `sonar ${look}${marks}`, transform: `translate(${x} ${y})`, "data-sonar": k }, upright);
    make("circle", { r: Math.max(12, this.r * 1.35), class: "target" }, group);
    const level = this.evidence?.level?.[k] ?? 0;
    if (level > 0) make("path", { d: arc(this.r * 1.5, -180 + 0.01, -180 + Math.min(359.9, 3.6 * level)), class: "gauge" }, group);
    group.append(...eye(LOOKS[look].form, this.r * 0.95));
    if (this.broken[k]) make("path", { d: `M${this.r * 0.5} ${-this.r * 2.1}l${-this.r * 0.6} ${this.r * 0.9}h${this.r * 0.6}l${-this.r * 0.5} ${this.r * 0.9}`, class: "bolt" }, group);
    const [nx, ny] = polar(-1.95 * this.r, angle + this.pose.deg);
    make("text", { x: nx, y: ny + 4, class: "number" }, group).textContent = k;
  }

  #hover(sonar) {
    if (this.over === sonar) return;
    this.over = sonar;
    this.box.style.cursor = sonar === undefined ? "" : "pointer";
    this.redraw();
  }

  #place(event) {
    const box = this.box.getBoundingClientRect();
    return [event.clientX - box.left - box.width / 2, event.clientY - box.top - box.height / 2];
  }

  /** The sonar whose eye is there. By place, not by element: those are made anew while a button is held. */
  #eyeAt(x, y) {
    const near = [...this.eyes.entries()].map(([k, [ex, ey]]) => [Math.hypot(x - ex, y - ey), k]).sort((a, b) => a[0] - b[0]);
    return near.length && near[0][0] <= Math.max(13, 1.4 * this.r) ? near[0][1] : undefined;
  }

  #click(event) {
    const [across, down] = this.#place(event);
    const sonar = this.#eyeAt(across, down);
    if (sonar !== undefined) {
      this.act.sonar(sonar);
      return;
    }
    if (Math.hypot(across, down) < this.ring + 2.5 * this.r) return; // the robot stands there
    this.act.floor(Math.round(this.pose.x - down / this.scale), Math.round(this.pose.y - across / this.scale));
  }
}
