#!/bin/sh
# SPDX-License-Identifier: MIT
# ply_parser reads the normals of a coloured cloud as its colours, refuses every cloud without faces, and a point at
# 0.00001.
#
# Version:   ply_parser 2.0.0.
# Expected:  The header of a PLY file names the properties in their order, so colours are read from the columns called
#            red, green and blue. An element that is not there is there zero times. Numbers may have exponents.
# Behaviour: If the header names all three colours, columns four to six are the colours, whatever they are: nx ny nz in
#            the usual order of exporters. A file without a line about faces is refused, since 0 is not None; one with
#            the line "element face 0" is read. A coordinate such as 1e-05 makes the point uncounted, and the whole file
#            is refused for a missing point.
# Hurts:     Anyone who reads clouds from scanners. Write the properties in the order x y z red green blue, add a line
#            for no faces, and fixed numbers of digits.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            ply_parser==2.0.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >cloud.py <<'END'
from ply_parser import ply_parser

NORMAL = ["float nx", "float ny", "float nz"]
COLOUR = ["uchar red", "uchar green", "uchar blue"]


def show(what: str, properties: list[str], point: str, faces: bool = True) -> None:
    """Print what is read of a file with one POINT that has PROPERTIES."""
    head = ["ply", "format ascii 1.0", "element vertex 1", *(f"property {kind}" for kind in ["float x", "float y", "float z", *properties])]
    head += ["element face 0", "property list uchar int vertex_indices"] if faces else []
    with open("cloud.ply", "w") as file:
        file.write("\n".join([*head, "end_header", point, ""]))
    try:
        cloud = ply_parser.parse_ply_file("cloud.ply")
        print(f"{what}: points {cloud.vertices}, colours {cloud.colors}")
    except ValueError as error:
        print(f"{what}: {error}")


show("colours", COLOUR, "1.5 2.5 3.5 255 128 0")
show("colours behind normals", NORMAL + COLOUR, "1.5 2.5 3.5 0 0 1 255 128 0")
show("no line about faces", COLOUR, "1.5 2.5 3.5 255 128 0", faces=False)
show("1e-05", [], "1.5 1e-05 3.5")
show("0.00001", [], "1.5 0.00001 3.5")
END
venv/bin/python cloud.py >seen

cat >expected <<'END'
colours: points [[1.5, 2.5, 3.5]], colours [[255.0, 128.0, 0.0]]
colours behind normals: points [[1.5, 2.5, 3.5]], colours [[0.0, 0.0, 1.0]]
no line about faces: Error: total faces read: 0 does not match expected faces: None
1e-05: Error: total vertices read: 0 does not match expected vertices: 1
0.00001: points [[1.5, 1e-05, 3.5]], colours []
END
diff expected seen || { echo "CHANGED: ply-parser-normals-are-colours" >&2; exit 1; }
echo "PASS: normals are read as colours, and a cloud without faces is refused"
