// SPDX-License-Identifier: MIT
// Raises cells where echoes lie and lowers those that beams passed.
#include "knowledge/grid.h"

#include <string.h>

#include "knowledge/angle.h"

#define CELLS ARGUS_GRID_CELLS
#define CELL_MM ARGUS_GRID_CELL_MM
#define MASK (CELLS - 1)
#define SLACK_CELLS 4 // the robot may be so far from the middle before the window follows
#define LEVEL_MAX 15  // touched: no beam takes that back
#define HEARD_MOST 14
#define OCCUPIED 4 // two near echoes: one may be crosstalk
#define MARKED 6   // three beams take it back
#define FAR_MM 1600
#define NEAR_RISE 3
#define FAR_RISE 1
#define FAR_MOST 3     // far echoes alone occupy nothing: they tell their place badly
#define SHORT_MM 150   // a beam passes nothing so close to its echo
#define PASSED_MM 1500 // ... nor beyond this, since it grows wide
#define SILENT_MM 800  // ... nor beyond this, if nothing comes back: a smooth wall may have turned it away
#define REST_SIPS 10   // at rest the beams of a check count,
#define REST_EVERY 40  // ... and then of a quarter of the SIPs: they tell nothing new
#define BODY_CELLS 1   // about its centre, where the robot stands

#define BESIDE_MM 600     // of a flank's echoes the nearer ones tell of a wall along the way,
#define APART_LEAST_MM 80 // ... two of them at such a distance,
#define APART_MOST_MM 300
#define ALONG_CDEG 3000 // ... within this of the heading
#define GOES_ON_MM 600

_Static_assert((CELLS & MASK) == 0 && CELLS == 64,
               "cells wrap around by a mask, and rows are words of 64 bits");

void argus_grid_init(argus_grid_t *const self) {
    memset(self, 0, sizeof *self);
}

void argus_grid_clear(argus_grid_t *const self) {
    memset(self->level, 0, sizeof self->level);
}

static int32_t cell_of(const int32_t mm) {
    return mm >= 0 ? mm / CELL_MM : -((CELL_MM - 1 - mm) / CELL_MM);
}

argus_cell_t argus_grid_cell(const argus_point_t at) {
    const argus_cell_t cell = {cell_of(at.x_mm), cell_of(at.y_mm)};
    return cell;
}

argus_point_t argus_grid_centre(const argus_cell_t cell) {
    const argus_point_t at = {cell.x * CELL_MM + CELL_MM / 2, cell.y * CELL_MM + CELL_MM / 2};
    return at;
}

bool argus_grid_is_inside(const argus_grid_t *const self, const argus_cell_t cell) {
    const int32_t x = cell.x - self->low.x;
    const int32_t y = cell.y - self->low.y;
    return x >= 0 && x < CELLS && y >= 0 && y < CELLS;
}

// A cell keeps its place while the window moves on: places wrap around.
static unsigned place_of(const argus_cell_t cell) {
    return ((unsigned)cell.y & MASK) * CELLS + ((unsigned)cell.x & MASK);
}

static unsigned level_at(const argus_grid_t *const self, const unsigned place) {
    return self->level[place / 2] >> (place % 2 * 4) & LEVEL_MAX;
}

static void put(argus_grid_t *const self, const argus_cell_t cell, const unsigned level) {
    ARGUS_ASSERT(level <= LEVEL_MAX);
    const unsigned place = place_of(cell);
    const unsigned shift = place % 2 * 4;
    const unsigned others = self->level[place / 2] & ~((unsigned)LEVEL_MAX << shift);
    ARGUS_ASSERT(place / 2 < sizeof self->level);
    self->level[place / 2] = (uint8_t)(others | level << shift);
}

static void rise(argus_grid_t *const self, const argus_cell_t cell, const unsigned by, const unsigned most) {
    if (!argus_grid_is_inside(self, cell)) {
        return;
    }
    const unsigned level = level_at(self, place_of(cell));
    if (level < most) {
        put(self, cell, level + by < most ? level + by : most);
    }
}

static void lower(argus_grid_t *const self, const argus_cell_t cell) {
    const unsigned level = argus_grid_is_inside(self, cell) ? level_at(self, place_of(cell)) : 0;
    if (level > 0 && level < LEVEL_MAX) {
        put(self, cell, level - 1);
    }
}

void argus_grid_mark(argus_grid_t *const self, const argus_point_t at, const bool sure) {
    const unsigned level = sure ? LEVEL_MAX : MARKED;
    rise(self, argus_grid_cell(at), level, level);
}

void argus_grid_fade(argus_grid_t *const self) {
    for (unsigned i = 0; i < sizeof self->level; i++) {
        self->level[i] = (uint8_t)(self->level[i] >> 1 & 0x77u);
    }
}

// The lowest cell of the window that the robot is in the middle of, but for the slack.
static int32_t lowest(const int32_t low, const int32_t robot) {
    const int32_t middle = low + CELLS / 2;
    const int32_t off = robot - middle;
    return argus_abs(off) <= SLACK_CELLS ? low : low + off - (off > 0 ? SLACK_CELLS : -SLACK_CELLS);
}

static void enter_column(argus_grid_t *const self, const int32_t x) {
    ARGUS_ASSERT(x >= self->low.x - 1 && x < self->low.x + CELLS);
    for (int32_t y = 0; y < CELLS; y++) {
        const argus_cell_t cell = {x, y};
        put(self, cell, 0);
    }
}

static void enter_row(argus_grid_t *const self, const int32_t y) {
    memset(&self->level[((unsigned)y & MASK) * CELLS / 2], 0, CELLS / 2);
}

static void follow(argus_grid_t *const self, const argus_cell_t robot) {
    const argus_cell_t low = {lowest(self->low.x, robot.x), lowest(self->low.y, robot.y)};
    if (argus_abs(low.x - self->low.x) >= CELLS || argus_abs(low.y - self->low.y) >= CELLS) {
        argus_grid_clear(self);
        self->low = low;
    }
    while (self->low.x != low.x) {
        const bool up = self->low.x < low.x;
        enter_column(self, up ? self->low.x : self->low.x - 1); // the one that leaves makes its place free
        self->low.x += up ? 1 : -1;
    }
    while (self->low.y != low.y) {
        const bool up = self->low.y < low.y;
        enter_row(self, up ? self->low.y : self->low.y - 1);
        self->low.y += up ? 1 : -1;
    }
    ARGUS_ASSERT(argus_grid_is_inside(self, robot));
}

static void clear_body(argus_grid_t *const self, const argus_cell_t robot) {
    for (int32_t y = -BODY_CELLS; y <= BODY_CELLS; y++) {
        for (int32_t x = -BODY_CELLS; x <= BODY_CELLS; x++) {
            const argus_cell_t cell = {robot.x + x, robot.y + y};
            put(self, cell, 0);
        }
    }
}

static argus_point_t along(const argus_pose_t *const ray, const int32_t way_mm) {
    return argus_to_course(ray, (argus_point_t){way_mm, 0});
}

static void pass(argus_grid_t *const self, const argus_pose_t *const ray, const int32_t way_mm) {
    for (int32_t mm = CELL_MM / 2; mm < way_mm; mm += CELL_MM) {
        lower(self, argus_grid_cell(along(ray, mm)));
    }
}

// A wall that the robot drives along is heard abeam only. It is taken to go on as between its last two
// echoes; a beam that passes there says otherwise.
static void extend(argus_grid_t *const self, const argus_knowledge_t *const knowledge,
                   const argus_point_t echo, argus_point_t *const last) {
    const int32_t dx = echo.x_mm - last->x_mm;
    const int32_t dy = echo.y_mm - last->y_mm;
    const bool near = argus_abs(dx) <= APART_MOST_MM && argus_abs(dy) <= APART_MOST_MM;
    const int32_t apart_mm = near ? argus_hypot(dx, dy) : INT32_MAX;
    if (apart_mm < APART_LEAST_MM) {
        return;
    }
    *last = echo;
    if (apart_mm > APART_MOST_MM ||
        argus_angle_abs_diff(argus_atan2(dy, dx), knowledge->pose.heading_cdeg) > ALONG_CDEG) {
        return;
    }
    for (int32_t mm = CELL_MM; mm <= GOES_ON_MM; mm += CELL_MM) {
        const argus_point_t on = {echo.x_mm + dx * mm / apart_mm, echo.y_mm + dy * mm / apart_mm};
        rise(self, argus_grid_cell(on), OCCUPIED, OCCUPIED);
    }
}

static bool tells(const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return (knowledge->fresh >> sonar & 1u) != 0 && !argus_is_out(knowledge, sonar) &&
           knowledge->sonar[sonar].health != ARGUS_SUSPECT;
}

static bool is_passing(const argus_knowledge_t *const knowledge) {
    return knowledge->still_sips <= REST_SIPS || knowledge->still_sips % REST_EVERY < REST_SIPS;
}

// An echo may come from anywhere on the arc of the cone. What is known to stand at an end of the arc explains
// it, where nothing is known on the axis: so the edge of a door is not heard in the door.
static bool is_explained(const argus_grid_t *const self, const argus_pose_t *const axis,
                         const int32_t reading_mm, const int32_t half_cdeg) {
    bool known = false;
    for (int32_t side = -1; side <= 1; side += 2) {
        const argus_pose_t ray = {axis->x_mm, axis->y_mm, axis->heading_cdeg + side * half_cdeg};
        known = known || argus_grid_is_occupied(self, argus_grid_cell(along(&ray, reading_mm)));
    }
    return known;
}

// The axis of its cone, course frame; its heading may be past half a turn.
static argus_pose_t axis_of(const argus_knowledge_t *const knowledge, const int sonar) {
    const argus_sonar_pose_t at = argus_robot_pose(knowledge->robot, sonar);
    const argus_point_t from = argus_to_course(&knowledge->pose, (argus_point_t){at.x_mm, at.y_mm});
    return (argus_pose_t){from.x_mm, from.y_mm, knowledge->pose.heading_cdeg + at.heading_deg * 100};
}

static void hear(argus_grid_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                 const argus_pose_t *const axis) {
    ARGUS_ASSERT((unsigned)sonar < ARGUS_SONARS);
    const int32_t reading_mm = knowledge->sonar[sonar].reading_mm;
    const bool near = reading_mm <= ARGUS_PLACED_MM;
    const argus_point_t echo = along(axis, reading_mm);
    const argus_cell_t cell = argus_grid_cell(echo);
    if (argus_grid_is_occupied(self, cell) ||
        !is_explained(self, axis, reading_mm, argus_robot_cone_deg(knowledge->robot, sonar) * 50)) {
        rise(self, cell, near ? NEAR_RISE : FAR_RISE, near ? HEARD_MOST : FAR_MOST);
    }
    if ((argus_robot_flank(knowledge->robot) >> sonar & 1u) != 0 && reading_mm <= BESIDE_MM) {
        const bool left = argus_robot_pose(knowledge->robot, sonar).y_mm > 0;
        extend(self, knowledge, echo, &self->abeam[left ? 1 : 0]);
    }
}

static void take(argus_grid_t *const self, const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT((unsigned)sonar < ARGUS_SONARS);
    const int32_t reading_mm = knowledge->sonar[sonar].reading_mm;
    const bool silent = reading_mm >= knowledge->robot->no_echo_mm;
    const argus_pose_t axis = axis_of(knowledge, sonar);
    if (is_passing(knowledge)) {
        pass(self, &axis, silent ? SILENT_MM : argus_min(reading_mm - SHORT_MM, PASSED_MM));
    }
    if (reading_mm <= FAR_MM) {
        hear(self, knowledge, sonar, &axis);
    }
}

void argus_grid_see(argus_grid_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const argus_point_t centre = {knowledge->pose.x_mm, knowledge->pose.y_mm};
    const argus_cell_t robot = argus_grid_cell(centre);
    follow(self, robot);
    clear_body(self, robot);
    for (int i = 0; i < knowledge->sonars && !knowledge->rotating; i++) {
        if (tells(knowledge, i)) {
            take(self, knowledge, i);
        }
    }
}

bool argus_grid_is_occupied(const argus_grid_t *const self, const argus_cell_t cell) {
    return argus_grid_is_inside(self, cell) && level_at(self, place_of(cell)) >= OCCUPIED;
}

// Eight cells of a row, two to a byte, to a bit each: bits 2 and 3 of a level say OCCUPIED.
static uint32_t occupied_in(const uint8_t *const pairs) {
    const uint32_t levels =
        (uint32_t)pairs[0] | (uint32_t)pairs[1] << 8 | (uint32_t)pairs[2] << 16 | (uint32_t)pairs[3] << 24;
    uint32_t bits = (levels >> 2 | levels >> 3) & 0x11111111u;
    bits = (bits | bits >> 3) & 0x03030303u; // cells draw together: by two, ...
    bits = (bits | bits >> 6) & 0x000F000Fu;
    return (bits | bits >> 12) & 0xFFu;
}

_Static_assert(OCCUPIED == 4 && LEVEL_MAX == 15, "what bits 2 and 3 of a level say");

// Places in a row wrap around: what is in front of the window's first cell follows its last.
uint64_t argus_grid_row(const argus_grid_t *const self, const int row) {
    ARGUS_ASSERT(row >= 0 && row < CELLS);
    const uint8_t *const pairs = &self->level[((unsigned)(self->low.y + row) & MASK) * CELLS / 2];
    const unsigned first = (unsigned)self->low.x & MASK;
    uint64_t bits = 0;
    for (int i = CELLS / 2 - 4; i >= 0; i -= 4) {
        bits = bits << 8 | occupied_in(&pairs[i]);
    }
    return bits >> first | bits << (CELLS - first) % CELLS;
}
