#!/bin/sh
# SPDX-License-Identifier: MIT
# A red point of a PCD file is blue in @loaders.gl/pcd, dark blue if its colour is an integer, and the intensity is
# not there.
#
# Version:   @loaders.gl/pcd 4.4.2, @loaders.gl/core 4.4.2 (Node).
# Expected:  rgb is 0x00RRGGBB in the bits of a float, or in an integer if its type is U. Further fields of the file are
#           attributes, as those of a PLY file are with the same library.
# Behaviour: The lowest byte is taken for red, in text and in binary files. An integer in a text is taken for the value
#           of a float, and the bits of that float for the colour: 16711680, which is red, becomes 0 0 127. The
#           intensity is dropped. A flat scan without z has NaN for it.
# Hurts:     Anyone who shows clouds by colours of a class or a range: near and far are swapped. Swap the first and the
#           third colour, and write the colour as a float.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit --ignore-scripts \
        @loaders.gl/pcd@4.4.2 \
        @loaders.gl/core@4.4.2 \
        @math.gl/types@4.1.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >colours.mjs <<'END'
import { parse } from "@loaders.gl/core";
import { PCDLoader } from "@loaders.gl/pcd";

const header = (fields, types, data) => `# .PCD v0.7
VERSION 0.7
FIELDS ${fields}
SIZE ${types.replace(/\w/g, "4")}
TYPE ${types}
COUNT ${types.replace(/\w/g, "1")}
WIDTH 1
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS 1
DATA ${data}
`;
const RED = 0xff0000;
const float = Buffer.alloc(4);
float.writeUInt32LE(RED);
const point = Buffer.alloc(12);
point.writeFloatLE(1.5);

const show = async (name, content) => {
  const bytes = new Uint8Array(content);
  const { attributes } = await parse(bytes.buffer, PCDLoader, { worker: false });
  const text = Object.entries(attributes).map(([key, { value }]) => `${key} ${[...value].join(" ")}`);
  console.log(`${name}: ${text.join(", ")}`);
};
await show("text, red as a float", Buffer.from(header("x y z rgb", "F F F F", "ascii") + `1.5 0 0 ${float.readFloatLE()}\n`));
await show("text, red as an integer", Buffer.from(header("x y z rgb", "F F F U", "ascii") + `1.5 0 0 ${RED}\n`));
await show("binary, red", Buffer.concat([Buffer.from(header("x y z rgb", "F F F U", "binary")), point, float]));
await show("text, intensity", Buffer.from(header("x y z intensity", "F F F F", "ascii") + "1.5 0 0 10\n"));
await show("text, without z", Buffer.from(header("x y", "F F", "ascii") + "1.5 0\n"));
END
node colours.mjs >seen

cat >expected <<'END'
text, red as a float: POSITION 1.5 0 0, COLOR_0 0 0 255
text, red as an integer: POSITION 1.5 0 0, COLOR_0 0 0 127
binary, red: POSITION 1.5 0 0, COLOR_0 0 0 255
text, intensity: POSITION 1.5 0 0
text, without z: POSITION 1.5 0 NaN
END
diff expected seen || { echo "CHANGED: loaders-gl-pcd-red-is-blue" >&2; exit 1; }
echo "PASS: red is blue"
