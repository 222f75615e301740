#!/bin/sh
# SPDX-License-Identifier: MIT
# The left neighbour of sonar 0 is sonar_-1 in xacro-parser and sonar_15 in xacro, and sonar 07 is sonar_07 in one and
# sonar_7 in the other.
#
# Version:   xacro-parser 0.3.11 (Node), jsdom 22.1.0, xacro 2.1.1 (Python).
# Expected:  A macro gives the same names in the browser as on the robot.
# Behaviour: The remainder has the sign of its left side in xacro-parser, that of its right side in xacro. A property 07
#           stays 07 and is 7 in xacro. Two texts of digits are added as numbers, 3 > 2 > 1 is false, an and of two
#           numbers is true, and a quotient is 2 where xacro has 2.0. No error is raised in any of them; //, ** and
#           int() do raise.
# Hurts:     Anyone who shows a robot in a page and names frames by a formula: a ring of sonars loses its first
#           neighbour, and transforms of 07 are looked up as 7.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit --ignore-scripts \
        xacro-parser@0.3.11 \
        jsdom@22.1.0 || return 1
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            xacro==2.1.1 \
            PyYAML==6.0.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >compare.mjs <<'END'
import { spawnSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { JSDOM } from "jsdom";

const { DOMParser, XMLSerializer, Node } = new JSDOM().window;
Object.assign(globalThis, { DOMParser, XMLSerializer, Node });
const { XacroParser } = await import("xacro-parser");

const HEAD = `<robot name="ring" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:property name="i" value="0"/><xacro:property name="id" value="07"/>`;
for (const expression of ["(i - 1) % 16", "id", "'1' + '2'", "3 > 2 > 1", "5 and 3", "10 / 5", "7 // 2", "2 ** 3", "int(7.9)"]) {
  const text = `${HEAD}<link name="sonar_\${${expression.replaceAll(">", "&gt;")}}"/></robot>`;
  writeFileSync("ring.xacro", text);
  const python = spawnSync("venv/bin/xacro", ["ring.xacro"], { encoding: "utf8" }).stdout;
  let node = "raises";
  try {
    node = (await new XacroParser().parse(text)).querySelector("link").getAttribute("name");
  } catch {}
  console.log(`${expression}: xacro-parser ${node}, xacro ${/link name="([^"]*)"/.exec(python)[1]}`);
}
END
node compare.mjs >seen

cat >expected <<'END'
(i - 1) % 16: xacro-parser sonar_-1, xacro sonar_15
id: xacro-parser sonar_07, xacro sonar_7
'1' + '2': xacro-parser sonar_3, xacro sonar_12
3 > 2 > 1: xacro-parser sonar_false, xacro sonar_True
5 and 3: xacro-parser sonar_true, xacro sonar_3
10 / 5: xacro-parser sonar_2, xacro sonar_2.0
7 // 2: xacro-parser raises, xacro sonar_3
2 ** 3: xacro-parser raises, xacro sonar_8
int(7.9): xacro-parser raises, xacro sonar_7
END
diff expected seen || { echo "CHANGED: xacro-parser-minus-one" >&2; exit 1; }
echo "PASS: 0 - 1 modulo 16 is -1 and 15"
