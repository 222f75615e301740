// SPDX-License-Identifier: MIT
// Frames and bearings: the floor has x up and y left, mm, as argusd's pose; degrees are counter-clockwise positive.

export const RAD = Math.PI / 180;
export const CONE_DEG = 30;

/** A point of the robot's frame on the floor. */
export function onFloor(pose, x, y) {
  const c = Math.cos(pose.deg * RAD), s = Math.sin(pose.deg * RAD);
  return [pose.x + x * c - y * s, pose.y + x * s + y * c];
}

/** The smaller way from one angle to another, -180 to 180. */
export const between = (from, to) => ((((to - from) % 360) + 540) % 360) - 180;

/** Sonars that look the same way stand side by side on the ring: the angle there of each. */
export function ringAngles(sonars) {
  return sonars.map((one, k) => {
    const twin = sonars.findIndex((other, n) => n !== k && Math.abs(between(one.deg, other.deg)) < 5);
    if (twin < 0) return one.deg;
    const ahead = one.x_mm >= sonars[twin].x_mm;
    return one.deg + (ahead ? -1 : 1) * 9 * Math.sign(one.deg || 1);
  });
}

/** For each whole degree from -180: "seen" by a sonar in use, "turned" to by a rotation of the plan, "blind" where a
 *  sonar that looks there is out of use, or "gap" where none looks. */
export function coverage(sonars, fitted, inUse, plan) {
  const axesOf = (keep) => sonars.filter((_, k) => keep(k)).map((one) => one.deg);
  const used = axesOf(inUse);
  const all = axesOf(fitted);
  const near = (axes, deg, turn) => axes.some((axis) => Math.abs(between(axis + turn, deg)) <= CONE_DEG / 2);
  return Array.from({ length: 360 }, (_, k) => {
    const deg = k - 180;
    if (near(used, deg, 0)) return "seen";
    if (!near(all, deg, 0)) return "gap";
    return plan.some((turn) => near(used, deg, turn)) ? "turned" : "blind";
  });
}

/** Runs of equal values in a circle of 360 degrees: [value, from, to]. */
export function runs(circle) {
  const found = [];
  let from = 0;
  for (let k = 1; k <= circle.length; k++) {
    if (k === circle.length || circle[k] !== circle[from]) {
      found.push([circle[from], from - 180, k - 180]);
      from = k;
    }
  }
  if (found.length > 1 && found[0][0] === found.at(-1)[0]) {
    const first = found.shift();
    found.at(-1)[2] = first[2] + 360;
  }
  return found;
}
