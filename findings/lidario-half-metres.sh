#!/bin/sh
# SPDX-License-Identifier: MIT
# lidario writes PLY files with coordinates of 32 bits, so heights of a raster of 10 cm in UTM lie on a grid of half a
# metre.
#
# Version:   lidario 0.3.0, rasterio 1.4.3, plyfile 1.1, pandas 2.2.3, numpy 1.26.4.
# Expected:  The points of a PLY file are those of the other outputs, which are exact.
# Behaviour: Each coordinate is stored in 32 bits. Five million metres to the north they are half a metre apart, so rows
#            of a raster fall onto each other, while numpy and CSV have them apart. The file of CSV is called x.csv.csv
#            where x.csv is asked for.
# Hurts:     Anyone who hands a detailed height model to a mesh or a registration: it has stripes. Subtract an origin
#            first, by a translation of the raster.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            lidario==0.3.0 \
            rasterio==1.4.3 \
            plyfile==1.1 \
            pandas==2.2.3 \
            numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >ply.py <<'END'
import os

import lidario
import numpy as np
import rasterio
from plyfile import PlyData
from rasterio.transform import from_origin

profile = {"driver": "GTiff", "width": 1, "height": 20, "count": 1, "dtype": "float32"}
with rasterio.open("slope.tif", "w", transform=from_origin(500000, 5400002, 0.1, 0.1), **profile) as file:
    file.write(np.arange(20, dtype="float32").reshape(20, 1), 1)

points = lidario.Translator("geotiff", "numpy").translate("slope.tif")
print("numpy:", len(np.unique(points[:, 1].round(3))), "northings, first", points[0, 1].round(3))
lidario.Translator("geotiff", "ply").translate("slope.tif", out_file="slope")
north = PlyData.read("slope.ply").elements[0].data["y"]
print("ply:", len(np.unique(north)), "northings:", np.unique(north).tolist())
lidario.Translator("geotiff", "csv").translate("slope.tif", out_file="slope.csv")
print("csv:", [name for name in sorted(os.listdir()) if "csv" in name])
END
venv/bin/python ply.py >seen

cat >expected <<'END'
numpy: 20 northings, first 5400001.95
ply: 5 northings: [5400000.0, 5400000.5, 5400001.0, 5400001.5, 5400002.0]
csv: ['slope.csv.csv']
END
diff expected seen || { echo "CHANGED: lidario-half-metres" >&2; exit 1; }
echo "PASS: 20 rows of 10 cm are at 5 northings"
