// SPDX-License-Identifier: MIT
// What argusd's names mean to people, and the forms in which a sonar's health is drawn.

/** Looks of a sonar: each has a colour (in the style sheet), a form and a word, so that none says it alone. */
export const LOOKS = {
  good: { word: "healthy", form: "eye" },
  doubt: { word: "suspect", form: "triangle" },
  bad: { word: "failed", form: "cross" },
  trial: { word: "on probation", form: "diamond" },
  quiet: { word: "not heard", form: "hollow" },
};

const OF_HEALTH = {
  HEALTHY: "good", UNKNOWN: "quiet", SUSPECT: "doubt", DISABLED: "bad", PROBATION: "trial", STALE: "quiet", ABSENT: "quiet",
};

export const KINDS = {
  off: "hears no echo", silent: "says nothing", stuck: "repeats itself", wrong: "reads wrong", garbage: "reads at random",
  slow: "lags behind", intermittent: "drops echoes",
};

/** The fault that a robot which stands still finds, too: a sonar that reports is only contradicted in motion. */
export const SHOWS_AT_REST = "silent";

const FAILURES = {
  IsNormal: "All sonars ahead work", IsMinor: "Minor failure", IsMajor: "Major failure", IsCatastrophic: "Blind ahead",
};

const MODES = {
  OFFLINE: "Offline", CHECKING: "Checking its sonars", VERIFYING: "Verifying a suspect", IDLE: "Idle", DRIVING: "Driving",
  SWEEPING: "Sweeping", STEPPING: "One step ahead", BACKING: "Backing away", WAITING: "Waiting", CLOSING: "Closing", CLOSED: "Closed",
  CREEPING: "Creeping on its bumpers",
};

/** The key in LOOKS of a sonar of a state. */
export function lookOf(state, k) {
  return OF_HEALTH[state?.health?.[k]] ?? "quiet";
}

/** Whether argusd has given its fault a name. */
export const isNamed = (state, k) => (state?.kind?.[k] ?? "") in KINDS;

/** Whether its readings are used: what the coverage ring counts on. */
export const usable = (state, k) => state?.kind?.[k] === "" && ["HEALTHY", "SUSPECT"].includes(state?.health?.[k]);

export const exists = (state, k) => state?.health?.[k] !== "ABSENT";

/** Health and fault of a sonar in words. */
export function conditionOf(state, k) {
  const health = state?.health?.[k];
  if (health === undefined) return "not known yet";
  if (health === "ABSENT") return "not fitted";
  const kind = state.kind[k];
  const word = health === "DISABLED" ? "failed" : health.toLowerCase();
  if (kind && kind in KINDS) return `${word}: ${kind}`;
  return kind === "out" ? "taken out" : word;
}

export const failureText = (state) => FAILURES[state] ?? "Not connected";
export const modeText = (mode) => MODES[mode] ?? String(mode ?? "Offline").toLowerCase();
export const metres = (mm) => (mm / 1000).toFixed(2);
export const signed = (deg) => `${deg > 0 ? "+" : deg < 0 ? "−" : ""}${Math.abs(deg)}°`;

/** An event as a line for people. */
export function eventText(event) {
  const what = event.event.toLowerCase().replaceAll("_", " ");
  const sonar = /^sonar\/\w+\/(\d+)$/.exec(event.name);
  const about = sonar ? `sonar ${Number(sonar[1])}` : event.name;
  return { about, what: (sonar ? what.replace(/^sonar /, "") : what) + (event.shown ?? "") };
}
