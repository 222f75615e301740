// SPDX-License-Identifier: MIT
// Floods the grid row by row: 64 cells are one word, so a step of the wave is a few shifts for each row.
#include "task/way.h"

#include <string.h>

#include "knowledge/angle.h"

#define CELLS ARGUS_GRID_CELLS
#define CELL_MM ARGUS_GRID_CELL_MM
#define WIDE_ROOM_MM 50 // beside the swing circle: room to turn anywhere (S7 wants 20 under `argus`)
#define NARROW_ROOM_MM \
    110            // beside the body: what a sonar at 50 degrees stops at, for an object range of 250 mm
#define OUT_MM 450 // about the robot and the waypoint less will do: it may have to get out of there
#define TIGHT_MM 200
#define PLANES 4
#define LABELS 15      // neighbours are at most seven steps of the wave apart
#define NARROW_STEPS 5 // that the wave takes to a cell where there is no room to turn; 1 to others
#define STEPS_MAX 1000
#define IDLE_STEPS (NARROW_STEPS + 1) // without a new cell: nothing is on its way any more
#define SAMPLE_MM 50
#define LEG_LEAST_MM 100 // a leg is done at 60
#define CUT_SAMPLES 4    // a straight leg may have so many more narrow samples than the way itself
#define AHEAD_MM 1000
#define AHEAD_OF_BODY_MM 100

static uint64_t bit(const int32_t x) {
    ARGUS_ASSERT(x >= 0 && x < CELLS);
    return (uint64_t)1 << x;
}

static bool is_within(const argus_cell_t cell) {
    return cell.x >= 0 && cell.x < CELLS && cell.y >= 0 && cell.y < CELLS;
}

static bool has(const uint64_t *const rows, const argus_cell_t cell) {
    return is_within(cell) && (rows[cell.y] & bit(cell.x)) != 0;
}

// In the window.
static argus_cell_t cell_in(const argus_grid_t *const grid, const argus_point_t at) {
    const argus_cell_t cell = argus_grid_cell(at);
    const argus_cell_t in = {cell.x - grid->low.x, cell.y - grid->low.y};
    return in;
}

static argus_point_t centre_of(const argus_grid_t *const grid, const argus_cell_t in) {
    const argus_cell_t cell = {in.x + grid->low.x, in.y + grid->low.y};
    return argus_grid_centre(cell);
}

static argus_point_t robot_at(const argus_ground_t *const ground) {
    const argus_point_t at = {ground->knowledge->pose.x_mm, ground->knowledge->pose.y_mm};
    return at;
}

static int32_t between_mm(const argus_point_t a, const argus_point_t b) {
    const int32_t most = 40000;
    return argus_hypot(argus_max(-most, argus_min(most, a.x_mm - b.x_mm)),
                       argus_max(-most, argus_min(most, a.y_mm - b.y_mm)));
}

// What is passable
// --------------------------------------------------------------------------------------------

// Cells to either side in a row `dy` rows off that are within the radius; -1: none.
static int reach(const int32_t radius_mm, const int dy) {
    ARGUS_ASSERT(radius_mm >= 0);
    ARGUS_ASSERT(radius_mm > 0);
    const int32_t most = radius_mm * radius_mm / (CELL_MM * CELL_MM) - dy * dy;
    int wide = -1;
    while ((wide + 1) * (wide + 1) <= most) {
        wide++;
    }
    return wide;
}

static uint64_t widened(const uint64_t row, const int by) {
    ARGUS_ASSERT(by >= 0 && by < CELLS);
    uint64_t wide = row;
    for (int i = 1; i <= by; i++) {
        wide |= row << i | row >> i;
    }
    return wide;
}

// What lies within the radius of what is set.
static void grow(const uint64_t *const from, uint64_t *const to, const int32_t radius_mm) {
    ARGUS_ASSERT(radius_mm > 0);
    const int most = radius_mm / CELL_MM;
    memset(to, 0, CELLS * sizeof *to);
    for (int dy = -most; dy <= most; dy++) {
        const int by = reach(radius_mm, dy);
        for (int y = argus_max(0, -dy); y < CELLS && y + dy < CELLS && by >= 0; y++) {
            to[y] |= widened(from[y + dy], by);
        }
    }
}

static void invert(uint64_t *const rows) {
    for (int y = 0; y < CELLS; y++) {
        rows[y] = ~rows[y];
    }
}

// About a place the robot may be nearer to things.
static void let_out(argus_wave_t *const wave, const argus_cell_t about, const uint64_t *const tight) {
    const int most = OUT_MM / CELL_MM;
    for (int dy = -most; dy <= most; dy++) {
        const int by = reach(OUT_MM, dy);
        for (int dx = -by; dx <= by; dx++) {
            const argus_cell_t cell = {about.x + dx, about.y + dy};
            if (is_within(cell) && !has(tight, cell)) {
                wave->narrow[cell.y] |= bit(cell.x);
            }
        }
    }
    if (is_within(about)) {
        wave->narrow[about.y] |= bit(about.x);
    }
}

static int32_t narrow_mm(const argus_knowledge_t *const knowledge) {
    return argus_robot_half_width_mm(knowledge->robot) + NARROW_ROOM_MM;
}

static int32_t wide_mm(const argus_knowledge_t *const knowledge) {
    return knowledge->robot->swing_radius_mm + WIDE_ROOM_MM;
}

// The planes of the labels are free for it until the wave begins.
static void survey(argus_wave_t *const wave, const argus_ground_t *const ground,
                   const argus_point_t waypoint) {
    uint64_t *const occupied = wave->label[0];
    uint64_t *const tight = wave->label[1];
    for (int y = 0; y < CELLS; y++) {
        occupied[y] = argus_grid_row(ground->grid, y);
    }
    if (ground->stopped) {
        const argus_point_t ahead = {ground->knowledge->robot->front_mm + AHEAD_OF_BODY_MM, 0};
        const argus_cell_t cell = cell_in(ground->grid, argus_to_course(&ground->knowledge->pose, ahead));
        occupied[cell.y] |= is_within(cell) ? bit(cell.x) : 0;
    }
    grow(occupied, wave->wide, wide_mm(ground->knowledge));
    grow(occupied, wave->narrow, narrow_mm(ground->knowledge));
    grow(occupied, tight, TIGHT_MM);
    invert(wave->wide);
    invert(wave->narrow);
    let_out(wave, cell_in(ground->grid, robot_at(ground)), tight);
    let_out(wave, cell_in(ground->grid, waypoint), tight);
    memset(wave->label, 0, sizeof wave->label);
    memset(wave->reached, 0, sizeof wave->reached);
}

// The wave
// ----------------------------------------------------------------------------------------------------

static uint64_t labelled(const argus_wave_t *const wave, const int y, const unsigned label) {
    ARGUS_ASSERT(y >= 0 && y < CELLS);
    uint64_t row = ~(uint64_t)0;
    for (unsigned i = 0; i < PLANES; i++) {
        row &= wave->label[i][y] ^ ((uint64_t)(label >> i & 1u) - 1u); // the plane, or what is not in it
    }
    return row;
}

static void put_label(argus_wave_t *const wave, const int y, const uint64_t cells, const unsigned label) {
    ARGUS_ASSERT(label >= 1 && label <= LABELS);
    ARGUS_ASSERT(y >= 0 && y < CELLS);
    wave->reached[y] |= cells;
    uint64_t *row = &wave->label[0][y];
    for (unsigned rest = label; rest != 0; rest >>= 1) {
        *row |= (rest & 1u) != 0 ? cells : 0;
        row += CELLS;
    }
}

static unsigned label_of(const argus_wave_t *const wave, const argus_cell_t cell) {
    unsigned label = 0;
    for (unsigned i = 0; i < PLANES; i++) {
        label |= has(wave->label[i], cell) ? 1u << i : 0u;
    }
    return label;
}

static unsigned label_at(const int step) {
    return 1u + (unsigned)step % LABELS;
}

// The cells beside those of a row, and of the rows above and below it; every other step of the wave corners
// count: its front is an octagon.
static uint64_t beside(const uint64_t row, const uint64_t others, const bool corners) {
    return widened(row, 1) | (corners ? widened(others, 1) : others);
}

// What the wave reached long enough ago to get on where it is narrow, of the rows about one: each is asked
// for by up to three.
typedef struct {
    uint64_t cells[3];
    uint64_t fresh_below;
    int row[3];
} ripe_t;

static uint64_t ripened(ripe_t *const ripe, const argus_wave_t *const wave, const int y, const int step) {
    ARGUS_ASSERT(step >= 1);
    ARGUS_ASSERT(y >= -1 && y <= CELLS);
    if (y < 0 || y >= CELLS) {
        return 0;
    }
    const int slot = y % 3;
    if (ripe->row[slot] != y) {
        uint64_t young = 0;
        for (int ago = 1; ago < NARROW_STEPS; ago++) {
            young |= labelled(wave, y, label_at(step + LABELS - ago));
        }
        ripe->row[slot] = y;
        ripe->cells[slot] = wave->reached[y] & ~young;
    }
    return ripe->cells[slot];
}

// The cells of a row that the wave comes to, of those next to what it has reached. Of the row below counts
// what was there before this step.
static uint64_t come_on(argus_wave_t *const wave, ripe_t *const ripe, const int y, const uint64_t next,
                        const int step) {
    ARGUS_ASSERT(next != 0 && (next & wave->reached[y]) == 0);
    ARGUS_ASSERT(step >= 1);
    ARGUS_ASSERT(y >= 0 && y < CELLS);
    const uint64_t slow = next & ~wave->wide[y];
    uint64_t fresh = next & wave->wide[y];
    if (slow != 0) {
        const uint64_t others =
            (ripened(ripe, wave, y - 1, step) & ~ripe->fresh_below) | ripened(ripe, wave, y + 1, step);
        fresh |= beside(ripened(ripe, wave, y, step), others, step % 2 == 0) & slow;
    }
    put_label(wave, y, fresh, label_at(step));
    return fresh;
}

// True: the wave has come to new cells.
static bool advance(argus_wave_t *const wave, const int step) {
    ARGUS_ASSERT(step >= 1);
    ripe_t ripe = {.row = {-1, -1, -1}};
    uint64_t below = 0;
    bool any = false;
    for (int y = 0; y < CELLS; y++) {
        const uint64_t here = wave->reached[y];
        const uint64_t others = below | (y + 1 < CELLS ? wave->reached[y + 1] : 0);
        const uint64_t next = beside(here, others, step % 2 == 0) & ~here & wave->narrow[y];
        ripe.fresh_below = next != 0 ? come_on(wave, &ripe, y, next, step) : 0;
        any = any || ripe.fresh_below != 0;
        below = here;
    }
    return any;
}

static int32_t outside(const int32_t at) {
    return at < 0 ? -at : argus_max(0, at - (CELLS - 1));
}

// In cells, how far the waypoint is outside the window.
static int32_t beyond(const argus_cell_t waypoint) {
    return argus_hypot(argus_min(outside(waypoint.x), 40000), argus_min(outside(waypoint.y), 40000));
}

static int32_t square(const int32_t mm) {
    return mm * mm;
}

static void come_to(argus_wave_t *const wave, const argus_cell_t cell, const int step) {
    ARGUS_ASSERT(step >= 1);
    if (has(wave->narrow, cell) && !has(wave->reached, cell)) {
        put_label(wave, (int)cell.y, bit(cell.x), label_at(step));
    }
}

// A side of the window that is `apart` from the waypoint, whose foot on it is at `foot`.
typedef struct {
    int32_t apart;
    int32_t foot;
    int32_t at;
    bool upright;
} side_t;

// The wave comes as a circle, in each step to what the step before left. False: it has come to all of the
// side.
static bool come_to_side(argus_wave_t *const wave, const side_t *const side, const int32_t radius,
                         const int step) {
    ARGUS_ASSERT(radius >= 0 && step >= 1);
    ARGUS_ASSERT(step >= 1);
    const int32_t now = square(radius) - square(side->apart);
    const int32_t before = step > 1 ? square(radius - 1) - square(side->apart) : -1;
    bool more = false;
    if (now < 0 || before >= argus_max(square(side->foot), square(CELLS - 1 - side->foot))) {
        return now < 0; // not yet, or all of it before
    }
    for (int32_t i = 0; i < CELLS; i++) {
        const int32_t off = square(i - side->foot);
        if (off > now) {
            more = true;
        } else if (off > before) {
            come_to(wave, side->upright ? (argus_cell_t){side->at, i} : (argus_cell_t){i, side->at}, step);
        }
    }
    return more;
}

// A wave from a waypoint outside comes to the border by and by. False: it has come to all of it.
static bool come_in(argus_wave_t *const wave, const argus_cell_t waypoint, const int step) {
    ARGUS_ASSERT(step >= 1);
    const int32_t radius = beyond(waypoint) + step;
    const int32_t end = CELLS - 1;
    const side_t sides[] = {{waypoint.y, waypoint.x, 0, false},
                            {end - waypoint.y, waypoint.x, end, false},
                            {waypoint.x, waypoint.y, 0, true},
                            {end - waypoint.x, waypoint.y, end, true}};
    bool more = false;
    for (int i = 0; i < 4; i++) {
        more = come_to_side(wave, &sides[i], radius, step) || more;
    }
    return more;
}

// Steps that the wave takes from the waypoint to the robot; -1: it does not come.
static int flood(argus_wave_t *const wave, const argus_cell_t from, const argus_cell_t to) {
    ARGUS_ASSERT(is_within(to));
    const bool far = !is_within(from);
    int idle = 0;
    if (!far) {
        put_label(wave, (int)from.y, bit(from.x), label_at(0));
    }
    for (int step = 1; step < STEPS_MAX && idle < IDLE_STEPS; step++) {
        if (label_of(wave, to) != 0) {
            return step - 1;
        }
        const bool more = far && come_in(wave, from, step);
        idle = advance(wave, step) || more ? 0 : idle + 1;
    }
    return -1;
}

// Back to the robot's first leg
// ---------------------------------------------------------------------------------

// The neighbour that the wave reached soonest; false at its source.
static bool descend(const argus_wave_t *const wave, argus_cell_t *const at, int *const steps) {
    static const int8_t around[8][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    const unsigned here = label_of(wave, *at);
    unsigned most = 0;
    argus_cell_t next = *at;
    for (int i = 0; i < 8; i++) {
        const argus_cell_t cell = {at->x + around[i][0], at->y + around[i][1]};
        const unsigned label = label_of(wave, cell);
        const unsigned sooner = (here + LABELS - label) % LABELS;
        if (label != 0 && sooner <= LABELS / 2 && sooner > most) {
            most = sooner;
            next = cell;
        }
    }
    *at = next;
    *steps -= (int)most;
    return most > 0;
}

// Samples of the straight line that are not wide; INT32_MAX: it is not free.
static int32_t narrow_samples(const argus_wave_t *const wave, const argus_ground_t *const ground,
                              const argus_point_t to) {
    const argus_point_t from = robot_at(ground);
    const int32_t way_mm = argus_max(1, argus_min(between_mm(from, to), CELLS * CELL_MM));
    const int32_t dx = argus_max(-40000, argus_min(40000, to.x_mm - from.x_mm));
    const int32_t dy = argus_max(-40000, argus_min(40000, to.y_mm - from.y_mm));
    const int32_t length_mm = argus_max(1, argus_hypot(dx, dy));
    int32_t narrow = 0;
    for (int32_t mm = 0; mm <= way_mm; mm += SAMPLE_MM) {
        const argus_point_t on = {from.x_mm + dx * mm / length_mm, from.y_mm + dy * mm / length_mm};
        const argus_cell_t cell = cell_in(ground->grid, on);
        if (is_within(cell) && !has(wave->narrow, cell)) {
            return INT32_MAX;
        }
        narrow += is_within(cell) && !has(wave->wide, cell) ? 1 : 0;
    }
    return narrow;
}

static bool is_better(const bool straight, const bool wide, const bool wide_end) {
    return straight && (wide || !wide_end);
}

static void end_leg_at(argus_leg_t *const leg, const argus_point_t to, const int steps) {
    ARGUS_ASSERT(steps >= 0);
    leg->to = to;
    leg->to_go_mm = steps * CELL_MM;
}

// The farthest cell of the way that can be driven straight to, best one on which the robot can turn.
static void pull(const argus_wave_t *const wave, const argus_ground_t *const ground,
                 const argus_point_t waypoint, int steps, argus_leg_t *const leg) {
    argus_cell_t at = cell_in(ground->grid, robot_at(ground));
    int32_t narrow = CUT_SAMPLES;
    bool wide_end = false;
    bool straight = true;
    bool first = true; // a leg so short would be done at once
    leg->to = robot_at(ground);
    while ((straight || first) && descend(wave, &at, &steps)) {
        const argus_point_t centre = centre_of(ground->grid, at);
        const bool wide = has(wave->wide, at);
        narrow += wide ? 0 : CELL_MM / SAMPLE_MM;
        straight = narrow_samples(wave, ground, centre) <= narrow;
        if (first || is_better(straight, wide, wide_end)) {
            end_leg_at(leg, centre, steps);
            wide_end = wide;
        }
        first = between_mm(robot_at(ground), leg->to) < LEG_LEAST_MM;
    }
    leg->direct = straight && narrow_samples(wave, ground, waypoint) <= narrow;
    if (leg->direct) {
        end_leg_at(leg, waypoint, 0);
    }
}

bool argus_way_find(argus_wave_t *const wave, const argus_ground_t *const ground,
                    const argus_point_t waypoint, argus_leg_t *const leg) {
    const argus_cell_t robot = cell_in(ground->grid, robot_at(ground));
    const argus_cell_t goal = cell_in(ground->grid, waypoint);
    if (!is_within(robot)) {
        return false; // no SIP has come yet
    }
    survey(wave, ground, waypoint);
    const int steps = flood(wave, goal, robot);
    if (steps < 0) {
        return false;
    }
    pull(wave, ground, waypoint, steps, leg);
    leg->to_go_mm += leg->direct ? 0 : beyond(goal) * CELL_MM;
    leg->narrow = narrow_samples(wave, ground, leg->to) > 0;
    return true;
}

static bool is_clear(const argus_ground_t *const ground, const argus_cell_t about, const int32_t radius_mm) {
    ARGUS_ASSERT(radius_mm > 0);
    const int most = (int)(radius_mm / CELL_MM);
    for (int dy = -most; dy <= most; dy++) {
        const int by = reach(radius_mm, dy);
        for (int dx = -by; dx <= by; dx++) {
            const argus_cell_t cell = {about.x + dx, about.y + dy};
            if (argus_grid_is_occupied(ground->grid, cell)) {
                return false;
            }
        }
    }
    return true;
}

bool argus_way_is_free(const argus_ground_t *const ground, const argus_leg_t *const leg) {
    const argus_point_t to = leg->to;
    const int32_t radius_mm = leg->narrow ? narrow_mm(ground->knowledge) : wide_mm(ground->knowledge);
    const argus_point_t from = robot_at(ground);
    const int32_t dx = argus_max(-40000, argus_min(40000, to.x_mm - from.x_mm));
    const int32_t dy = argus_max(-40000, argus_min(40000, to.y_mm - from.y_mm));
    const int32_t length_mm = argus_max(1, argus_hypot(dx, dy));
    const int32_t end_mm = argus_min(AHEAD_MM, length_mm - OUT_MM);
    for (int32_t mm = OUT_MM + SAMPLE_MM; mm <= end_mm; mm += SAMPLE_MM) {
        const argus_point_t on = {from.x_mm + dx * mm / length_mm, from.y_mm + dy * mm / length_mm};
        if (!is_clear(ground, argus_grid_cell(on), radius_mm)) {
            return false;
        }
    }
    return true;
}
