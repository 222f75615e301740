# SPDX-License-Identifier: MIT
"""Rule: the rules of Nav2 that these tests hold the guard against are those of its sources.

NAV2_SOURCES names a clone of ros-navigation/navigation2. Of it the functions of the range layer, of the collision
monitor's Range source and of its check of messages are compiled as they are, between stand-ins for the rest of ROS.
"""

from __future__ import annotations

import math
import os
import random
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from argus_ros import messages
from argus_tools.rings.intake import Limits
from builtin_interfaces.msg import Time
from nav2_rules import CollisionMonitor, RangeLayer, Seat, is_well_formed

LAYER = "nav2_costmap_2d/plugins/range_sensor_layer.cpp"
SOURCE = "nav2_collision_monitor/src/range.cpp"
CHECK = "nav2_ros_common/include/nav2_ros_common/validate_messages.hpp"
SIZE_M, CELL_M = 6.0, 0.05
STAND_INS = r"""
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>
#define RCLCPP_DEBUG(...)
#define RCLCPP_INFO(...)
#define RCLCPP_ERROR(...)
namespace builtin_interfaces::msg { struct Time { int sec = 0; unsigned nanosec = 0; }; }
namespace std_msgs::msg { struct Header { builtin_interfaces::msg::Time stamp; std::string frame_id; }; }
namespace sensor_msgs::msg { struct Range { std_msgs::msg::Header header; float field_of_view, min_range,
max_range, range; }; }
namespace geometry_msgs::msg { struct Point { double x = 0, y = 0, z = 0; };
struct PointStamped { std_msgs::msg::Header header; Point point; }; }
namespace angles { double normalize_angle(double a) { return std::remainder(a, 2 * M_PI); } }
namespace tf2_ros { template <class T> int fromMsg(const T &) { return 0; } template <class T> int
fromRclcpp(const T &) { return 0; } }
namespace tf2 { struct Vector3 { double a, b, c; Vector3(double x, double y, double z) : a(x), b(y), c(z) {}
double x() { return a; } double y() { return b; } double z() { return c; } };
struct Transform { double x = 0, y = 0, yaw = 0; Vector3 operator*(const Vector3 & v) const {
return {x + std::cos(yaw) * v.a - std::sin(yaw) * v.b, y + std::sin(yaw) * v.a + std::cos(yaw) * v.b, v.c}; } }; }
namespace rclcpp { struct Time {}; }
static tf2::Transform seat;
struct Buffer { bool canTransform(...) { return true; }
void transform(geometry_msgs::msg::PointStamped & in, geometry_msgs::msg::PointStamped & out, std::string, int) {
tf2::Vector3 v = seat * tf2::Vector3(in.point.x, in.point.y, 0); out.point.x = v.a; out.point.y = v.b; } };
struct Clock { int now() { return 0; } };
using namespace std;
struct RangeSensorLayer {
Buffer buffer, * tf_ = &buffer; Clock clock, * clock_ = &clock;
std::string global_frame_; int transform_tolerance_ = 0, buffered_readings_ = 0, last_reading_time_ = 0, logger_ = 0;
double max_angle_ = 0, phi_v_ = 1.2, inflate_cone_ = 1.0, resolution_ = CELL, origin_ = -SIZE / 2;
double min_x_ = 0, min_y_ = 0, max_x_ = 0, max_y_ = 0; bool clear_on_max_reading_ = false;
unsigned size_x_ = CELLS, size_y_ = CELLS; unsigned char map[CELLS][CELLS];
void worldToMapNoBounds(double x, double y, int & i, int & j) { i = int((x - origin_) / resolution_); j =
int((y - origin_) / resolution_); }
bool worldToMap(double x, double y, unsigned & i, unsigned & j) { if (x < origin_ || y < origin_) return false;
i = unsigned((x - origin_) / resolution_); j = unsigned((y - origin_) / resolution_); return i < size_x_ && j <
size_y_; }
void mapToWorld(unsigned i, unsigned j, double & x, double & y) { x = origin_ + (i + 0.5) * resolution_; y =
origin_ + (j + 0.5) * resolution_; }
void touch(...) {}
void setCost(unsigned i, unsigned j, unsigned char c) { map[i][j] = c; }
unsigned char getCost(unsigned i, unsigned j) { return map[i][j]; }
double to_prob(unsigned char c) { return double(c) / 254; }
unsigned char to_cost(double p) { return (unsigned char)(p * 254); }
float area(int, int, int, int, int, int) { return 0; }
int orient2d(int, int, int, int, int, int) { return 0; }
double gamma(double), delta(double), sensor_model(double, double, double);
void processVariableRangeMsg(sensor_msgs::msg::Range &), updateCostmap(sensor_msgs::msg::Range &, bool);
void update_cell(double, double, double, double, double, double, bool); };
struct Point { double x, y, z; std::string source; };
constexpr size_t MAX_RANGE_DATA_POINTS = 1e4;
struct Range { sensor_msgs::msg::Range * data_ = nullptr; std::string source_name_ = "s"; int logger_ = 0;
double obstacles_angle_ = M_PI / 180;
bool sourceValid(const builtin_interfaces::msg::Time &, const rclcpp::Time &) { return true; }
bool getTransform(const rclcpp::Time &, const std_msgs::msg::Header &, tf2::Transform & t) { t = seat; return true; }
bool getSourceData(const rclcpp::Time &, std::vector<Point> &); };
const double MAX_RANGE_FIELD_OF_VIEW = M_PI;
"""
MAIN = r"""
int main(int, char ** argv) {
  RangeSensorLayer layer; layer.clear_on_max_reading_ = argv[1][0] == '1';
  for (auto & row : layer.map) for (auto & cell : row) cell = 127;
  double x, y, yaw; float r, low, high, view; unsigned ns; int framed;
  while (scanf("%lf %lf %lf %f %f %f %f %u %d", &x, &y, &yaw, &r, &low, &high, &view, &ns, &framed) == 9) {
    sensor_msgs::msg::Range m; m.field_of_view = view; m.min_range = low; m.max_range = high; m.range = r;
    m.header.stamp.nanosec = ns; if (framed) m.header.frame_id = "s";
    seat.x = x; seat.y = y; seat.yaw = yaw;
    Range source; source.data_ = &m; std::vector<Point> points;
    const bool valid = validateMsg(m), has = valid && source.getSourceData({}, points);
    double sum = 0; for (auto & p : points) sum += p.x + 2 * p.y;
    printf("%d %d %zu %.6f\n", valid, has, points.size(), sum);
    if (r == r) { auto copy = m; layer.processVariableRangeMsg(copy); }
  }
  for (auto & row : layer.map) for (auto & cell : row) printf("%d ", cell);
}
"""


def function(text: str, head: str) -> str:
    """A function as it stands in a source, to the brace that ends it."""
    found = re.search(rf"^[\w ]*{head}.*?^}}", text, re.S | re.M)
    assert found is not None, f"{head} is not there any more"
    return found[0]


@pytest.fixture(scope="module")
def nav2(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Nav2's own functions as a program."""
    given = os.environ.get("NAV2_SOURCES")
    if not given:
        pytest.skip(
            "NAV2_SOURCES names no clone of ros-navigation/navigation2: its documents are what counts"
        )
    layer, source, check = ((Path(given) / name).read_text() for name in (LAYER, SOURCE, CHECK))
    parts = [
        "const int NSEC_PER_SEC = 1e9;",
        *(
            function(check, rf"bool validateMsg\(const {kind} &")
            for kind in (
                "double",
                "builtin_interfaces::msg::Time",
                "std_msgs::msg::Header",
                "sensor_msgs::msg::Range",
            )
        ),
        *(
            function(layer, rf"RangeSensorLayer::{name}")
            for name in ("gamma", "delta", "sensor_model", "processVariableRangeMsg")
        ),
        function(layer, r"RangeSensorLayer::updateCostmap\(\n"),
        function(layer, "RangeSensorLayer::update_cell"),
        function(source, "Range::getSourceData"),
    ]
    folder = tmp_path_factory.mktemp("nav2")
    code = folder / "nav2.cpp"
    code.write_text("\n".join((STAND_INS, *parts, MAIN)))
    sizes = (f"-DCELL={CELL_M}", f"-DSIZE={SIZE_M}", f"-DCELLS={round(SIZE_M / CELL_M)}")
    subprocess.run(["g++", "-std=c++17", "-O1", "-w", *sizes, code, "-o", folder / "nav2"], check=True)
    return folder / "nav2"


def random_reading(chance: random.Random, odd: float) -> Any:
    values = [chance.choice([0.4, 1.0, 4.99, 5.0, 5.01, 0.1, 0.09, chance.uniform(0, 5)]), 0.1, 5.0, 0.5236]
    if chance.random() < odd:
        values[chance.randrange(4)] = chance.choice(
            [math.nan, math.inf, -math.inf, 0.0, -1.0, 3.2, 7.0, 450.0]
        )
    reading, least, greatest, view = values
    framed, nanosec = chance.random() > odd / 9, 5 if chance.random() > odd / 9 else 1_000_000_000
    at = Time(sec=3, nanosec=nanosec)
    return messages.range_message(at, "s" if framed else "", reading, Limits(least, greatest), view)


def line_of(reading: Any, seat: Seat) -> str:
    values = (
        seat.x,
        seat.y,
        seat.yaw,
        reading.range,
        reading.min_range,
        reading.max_range,
        reading.field_of_view,
    )
    return (
        " ".join(map(repr, map(float, values)))
        + f" {reading.header.stamp.nanosec} {int(reading.header.frame_id != '')}"
    )


def said(nav2: Path, clears: bool, given: list[tuple[Any, Seat]]) -> tuple[list[list[str]], Any]:
    lines = "\n".join(line_of(*one) for one in given)
    done = subprocess.run([nav2, str(int(clears))], input=lines, capture_output=True, text=True, check=True)
    *rows, grid = done.stdout.splitlines()
    assert len(rows) == len(given)
    return [row.split() for row in rows], np.array(grid.split(), dtype=int)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_its_source_takes_the_same_messages_and_makes_the_same_points(nav2: Path, seed: int) -> None:
    chance = random.Random(seed)
    given = [
        (random_reading(chance, 0.5), Seat(*(chance.uniform(-2, 2) for _ in range(3)))) for _ in range(3000)
    ]
    rows, _ = said(nav2, False, given)
    for (reading, seat), (valid, has, count, total) in zip(given, rows, strict=True):
        assert is_well_formed(reading) == (valid == "1"), reading
        monitor = CollisionMonitor((-9, 9, -9, 9), source_timeout=0.0)
        monitor.add("s", seat)
        monitor.take_range("s", reading)
        points = monitor._points(monitor.sources["s"], 3.0)
        assert (points is not None) == (has == "1"), reading
        if points is not None:
            found = list(points)
            # Angles are added up as float there, so that there may be one point more or less at the end.
            assert abs(len(found) - int(count)) <= 1
            if len(found) == int(count):
                assert sum(x + 2 * y for x, y in found) == pytest.approx(float(total), abs=0.02)


@pytest.mark.parametrize("clears", [False, True])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_its_range_layer_marks_and_clears_the_same_cells(nav2: Path, seed: int, clears: bool) -> None:
    chance = random.Random(seed)
    given = [
        (random_reading(chance, 0.0), Seat(*(chance.uniform(-1, 1) for _ in range(3)))) for _ in range(60)
    ]
    _, grid = said(nav2, clears, given)
    layer = RangeLayer(SIZE_M, clears)
    for reading, seat in given:
        layer.take(reading, seat)
    differ = np.abs(layer.costs.astype(int).ravel() - grid) > 2
    assert np.count_nonzero(grid != 127) > 1000
    # A cell on the edge of a box or of a cone falls to either side by the last bit of a float.
    assert np.count_nonzero(differ) < 0.01 * grid.size, np.count_nonzero(differ)
