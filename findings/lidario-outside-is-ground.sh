#!/bin/sh
# SPDX-License-Identifier: MIT
# lidario makes points of what a mask has cut away: outside of the polygon the ground is flat at 0, and cells without
# data that are NaN are points, too.
#
# Version:   lidario 0.3.0, rasterio 1.4.3, plyfile 1.1, pandas 2.2.3, numpy 1.26.4.
# Expected:  Of a raster that rasterio.mask cut to a polygon, only the cells inside are points, and no_data is looked
#            up.
# Behaviour: A mask has no note of its value for no data, and lidario takes -9999, while rasterio fills with 0 or with
#            what the file has. A file whose value is NaN keeps all its cells, since NaN differs from NaN.
# Hurts:     Anyone who cuts a floor or a field out of a height model: most points are a plane that is not there, at the
#            height of the sea. no_data=0 helps for the mask; NaN has to be replaced before.
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

cat >cut.py <<'END'
import warnings

warnings.simplefilter("ignore")
import lidario
import numpy as np
import rasterio
import rasterio.mask
from rasterio.transform import from_origin

HEIGHTS = np.full((4, 4), 7.5, dtype="float32")
MIDDLE = {"type": "Polygon", "coordinates": [[(1, 1), (3, 1), (3, 3), (1, 3), (1, 1)]]}


def write(name, heights, nodata):
    profile = {"driver": "GTiff", "width": 4, "height": 4, "count": 1, "dtype": "float32"}
    with rasterio.open(name, "w", transform=from_origin(0, 4, 1, 1), nodata=nodata, **profile) as file:
        file.write(heights, 1)


def told(name, points):
    heights, counts = np.unique(points[:, 2], return_counts=True)
    print(f"{name}: {len(points)} points, heights", dict(zip(heights.tolist(), counts.tolist(), strict=True)))


write("plain.tif", HEIGHTS, None)
with rasterio.open("plain.tif") as file:
    cut = rasterio.mask.mask(file, [MIDDLE])
mask = lidario.Translator("mask", "numpy")
told("mask", mask.translate(cut))
told("mask, no_data=0", mask.translate(cut, no_data=0))

holes = HEIGHTS.copy()
holes[0] = np.nan
for nodata in (np.nan, -1.0):
    write("holes.tif", np.where(np.isnan(holes), nodata, holes).astype("float32"), nodata)
    told(f"file, no data is {nodata}", lidario.Translator("geotiff", "numpy").translate("holes.tif"))
END
venv/bin/python cut.py >seen

cat >expected <<'END'
mask: 16 points, heights {0.0: 12, 7.5: 4}
mask, no_data=0: 4 points, heights {7.5: 4}
file, no data is nan: 16 points, heights {7.5: 12, nan: 4}
file, no data is -1.0: 12 points, heights {7.5: 12}
END
diff expected seen || { echo "CHANGED: lidario-outside-is-ground" >&2; exit 1; }
echo "PASS: of 16 cells, 4 inside, 16 are points"
