// SPDX-License-Identifier: MIT
// Floods the grid row by row: 64 cells are one word, so a step of the wave is a few shifts for each row.
#include "task/wave.h"

#include <string.h>

#include "knowledge/angle.h"

#define CELLS ARGUS_GRID_CELLS
#define CELL_MM ARGUS_GRID_CELL_MM
#define LABELS ARGUS_WAVE_LABELS
#define PLANES ARGUS_WAVE_PLANES
#define MEMORY ARGUS_WAVE_MEMORY
#define WIDE_ROOM_MM 50 // beside the swing circle: room to turn anywhere (S7 wants 20 under `argus`)
#define NARROW_ROOM_MM \
    110 // beside the body: what a sonar at 50 degrees stops at, for an object range of 250 mm
#define TIGHT_MM 200
#define NARROW_STEPS 5 // that the wave takes to a cell where there is no room to turn; 1 to others
#define RIPE_STEPS (NARROW_STEPS + 1)
#define NO_ROW (-2)
#define STEPS_MAX 1000
#define ROW_WORK 1   // a row that is not at rest,
#define SLOW_WORK 5  // ... and one where it is narrow,
#define FRESH_WORK 1 // ... and new cells in it, beside it,
#define STEP_WORK 10 // ... and whatever the rows
#define FAR_MOST 40000
#define AHEAD_OF_BODY_MM 100

_Static_assert(MEMORY > RIPE_STEPS + 1, "what is at rest has nothing on its way any more");

static uint64_t bit(const int32_t x) {
    ARGUS_ASSERT(x >= 0 && x < CELLS);
    return (uint64_t)1 << x;
}

bool argus_wave_is_within(const argus_cell_t cell) {
    return cell.x >= 0 && cell.x < CELLS && cell.y >= 0 && cell.y < CELLS;
}

static bool has(const uint64_t *const rows, const argus_cell_t cell) {
    return argus_wave_is_within(cell) && (rows[cell.y] & bit(cell.x)) != 0;
}

static argus_cell_t cell_in(const argus_wave_t *const self, const argus_point_t at) {
    const argus_cell_t cell = argus_grid_cell(at);
    return (argus_cell_t){cell.x - self->low.x, cell.y - self->low.y};
}

// What is passable
// --------------------------------------------------------------------------------------------

int argus_wave_reach(const int32_t radius_mm, const int dy) {
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
        const int by = argus_wave_reach(radius_mm, dy);
        ARGUS_ASSERT(by >= 0); // a row that is within the radius
        for (int y = argus_max(0, -dy); y < CELLS && y + dy < CELLS; y++) {
            to[y] |= from[y + dy] != 0 ? widened(from[y + dy], by) : 0;
        }
    }
}

static void invert(uint64_t *const rows) {
    for (int y = 0; y < CELLS; y++) {
        rows[y] = ~rows[y];
    }
}

// About a place the robot may be nearer to things.
static void let_out(argus_wave_t *const self, const argus_cell_t about, const uint64_t *const tight) {
    const int most = ARGUS_WAVE_OUT_MM / CELL_MM;
    for (int dy = -most; dy <= most; dy++) {
        const int by = argus_wave_reach(ARGUS_WAVE_OUT_MM, dy);
        for (int dx = -by; dx <= by; dx++) {
            const argus_cell_t cell = {about.x + dx, about.y + dy};
            if (argus_wave_is_within(cell) && !has(tight, cell)) {
                self->narrow[cell.y] |= bit(cell.x);
            }
        }
    }
    if (argus_wave_is_within(about)) {
        self->narrow[about.y] |= bit(about.x);
    }
}

int32_t argus_wave_narrow_mm(const argus_knowledge_t *const knowledge) {
    return argus_robot_half_width_mm(knowledge->robot) + NARROW_ROOM_MM;
}

int32_t argus_wave_wide_mm(const argus_knowledge_t *const knowledge) {
    return knowledge->robot->swing_radius_mm + WIDE_ROOM_MM;
}

// The planes of the labels are free for it until the wave begins.
static void survey(argus_wave_t *const self, const argus_ground_t *const ground) {
    uint64_t *const occupied = self->label[0];
    uint64_t *const tight = self->label[1];
    for (int y = 0; y < CELLS; y++) {
        occupied[y] = argus_grid_row(ground->grid, y);
    }
    if (ground->stopped) {
        const argus_point_t ahead = {ground->knowledge->robot->front_mm + AHEAD_OF_BODY_MM, 0};
        const argus_cell_t cell = cell_in(self, argus_to_course(&ground->knowledge->pose, ahead));
        if (argus_wave_is_within(cell)) {
            occupied[cell.y] |= bit(cell.x);
        }
    }
    grow(occupied, self->wide, argus_wave_wide_mm(ground->knowledge));
    grow(occupied, self->narrow, argus_wave_narrow_mm(ground->knowledge));
    grow(occupied, tight, TIGHT_MM);
    invert(self->wide);
    invert(self->narrow);
    let_out(self, self->to, tight);
    let_out(self, self->from, tight);
    memset(self->label, 0, sizeof self->label);
    memset(self->reached, 0, sizeof self->reached);
    memset(self->moved, 0, sizeof self->moved);
}

// The wave
// ----------------------------------------------------------------------------------------------------

static unsigned label_at(const int32_t step) {
    return 1u + (unsigned)step % LABELS;
}

static void come_to(argus_wave_t *const self, const int y, const uint64_t cells) {
    ARGUS_ASSERT(y >= 0 && y < CELLS);
    self->reached[y] |= cells;
    self->moved[self->step % MEMORY] |= bit(y);
    uint64_t *row = &self->label[0][y];
    for (unsigned rest = label_at(self->step); rest != 0; rest >>= 1) {
        *row |= (rest & 1u) != 0 ? cells : 0;
        row += CELLS;
    }
}

unsigned argus_wave_label(const argus_wave_t *const self, const argus_cell_t cell) {
    unsigned label = 0;
    for (unsigned i = 0; i < PLANES && argus_wave_is_within(cell); i++) {
        label |= (unsigned)(self->label[i][cell.y] >> cell.x & 1u) << i;
    }
    return label;
}

// The cells beside those of a row, and of the rows above and below it. Corners count in every other step, so
// the front of the wave is an octagon.
static uint64_t beside(const uint64_t row, const uint64_t others, const bool corners) {
    const uint64_t across = corners ? row | others : row;
    return others | row | across << 1 | across >> 1;
}

// The rows that a step brought new cells, so many steps ago.
static uint64_t moved(const argus_wave_t *const self, const int ago) {
    ARGUS_ASSERT(ago >= 0 && ago < MEMORY);
    return self->moved[(self->step + MEMORY - ago) % MEMORY];
}

static uint64_t labelled(const argus_wave_t *const self, const int y, const unsigned label) {
    ARGUS_ASSERT(y >= 0 && y < CELLS);
    uint64_t row = ~(uint64_t)0;
    for (unsigned i = 0; i < PLANES; i++) {
        row &= (label >> i & 1u) != 0 ? self->label[i][y] : ~self->label[i][y];
    }
    return row;
}

// Of a row the cells from which the wave gets on now where it is narrow. Those before them have got on. As
// corners count in every other step only, a cell brings the last ones a step after the first.
static uint64_t ripe(const argus_wave_t *const self, const int y) {
    uint64_t cells = 0;
    for (int ago = NARROW_STEPS; ago <= RIPE_STEPS && y >= 0 && y < CELLS; ago++) {
        const bool any = (moved(self, ago) & bit(y)) != 0;
        cells |= any ? labelled(self, y, label_at(self->step + LABELS - ago)) : 0;
    }
    return cells;
}

// What one step does to the rows, from the first to the last.
typedef struct {
    uint64_t ripe_rows;   // with, or beside one with, cells from which the wave gets on where it is narrow
    uint64_t fresh_below; // the new cells of the row before
    uint64_t ripe[3];     // of the rows about one: up to three rows ask for each
    int row[3];
} sweep_t;

static uint64_t ripe_in(sweep_t *const sweep, const argus_wave_t *const self, const int y) {
    const int slot = (y + 3) % 3;
    if (sweep->row[slot] != y) {
        sweep->row[slot] = y;
        sweep->ripe[slot] = ripe(self, y);
    }
    return sweep->ripe[slot];
}

// The cells of a row where it is narrow that the wave comes to, of those next to what it has reached.
static uint64_t come_slowly(const argus_wave_t *const self, sweep_t *const sweep, const int y,
                            const uint64_t slow) {
    ARGUS_ASSERT(y >= 0 && y < CELLS);
    ARGUS_ASSERT((slow & (self->reached[y] | self->wide[y])) == 0);
    const uint64_t others = ripe_in(sweep, self, y - 1) | ripe_in(sweep, self, y + 1);
    return beside(ripe_in(sweep, self, y), others, self->step % 2 == 0) & slow;
}

static uint64_t alive(const argus_wave_t *const self) {
    uint64_t rows = 0;
    for (int i = 0; i < MEMORY; i++) {
        rows |= self->moved[i];
    }
    return rows;
}

// The new cells of a row. Of the row before counts what was there before this step.
static uint64_t come_beside(const argus_wave_t *const self, sweep_t *const sweep, const int y,
                            int32_t *const work) {
    ARGUS_ASSERT(y >= 0 && y < CELLS);
    const uint64_t here = self->reached[y];
    const uint64_t below = y > 0 ? self->reached[y - 1] & ~sweep->fresh_below : 0;
    const uint64_t others = below | (y + 1 < CELLS ? self->reached[y + 1] : 0);
    const uint64_t next = beside(here, others, self->step % 2 == 0) & ~here & self->narrow[y];
    const uint64_t slow = next & ~self->wide[y];
    *work += slow != 0 ? SLOW_WORK : ROW_WORK;
    const bool gets_on = slow != 0 && (sweep->ripe_rows & 1u) != 0;
    return (next & self->wide[y]) | (gets_on ? come_slowly(self, sweep, y, slow) : 0);
}

// A row gets new cells only where it, or one beside it, got some a few steps ago.
static void advance(argus_wave_t *const self, int32_t *const work) {
    ARGUS_ASSERT(self->step >= 1);
    sweep_t sweep = {.ripe_rows = widened(moved(self, NARROW_STEPS) | moved(self, RIPE_STEPS), 1),
                     .row = {NO_ROW, NO_ROW, NO_ROW}};
    int y = 0;
    for (uint64_t rows = widened(alive(self), 1); rows != 0; rows >>= 1, sweep.ripe_rows >>= 1, y++) {
        sweep.fresh_below = (rows & 1u) != 0 ? come_beside(self, &sweep, y, work) : 0;
        if (sweep.fresh_below != 0) {
            come_to(self, y, sweep.fresh_below);
            *work += FRESH_WORK;
        }
    }
}

// From outside
// ------------------------------------------------------------------------------------------------------

static int32_t outside(const int32_t at) {
    return at < 0 ? -at : argus_max(0, at - (CELLS - 1));
}

static int32_t square(const int32_t cells) {
    return cells * cells;
}

// Comes to a cell of the window's border.
static void come_in_at(argus_wave_t *const self, const int32_t x, const int32_t y) {
    const argus_cell_t cell = {x, y};
    if (has(self->narrow, cell) && !has(self->reached, cell)) {
        come_to(self, (int)y, bit(x));
    }
}

// A side of the window that is `apart` from the waypoint, whose foot on it is at `foot`.
typedef struct {
    int32_t apart;
    int32_t foot;
    int32_t at;
    bool upright;
} side_t;

// The wave comes as a circle, to either side of the foot.
static bool come_to_side(argus_wave_t *const self, const side_t *const side, int32_t *const spread) {
    const int32_t now = square(self->beyond + self->step) - square(side->apart);
    const int32_t end = argus_max(side->foot, CELLS - 1 - side->foot);
    for (; *spread <= end && square(*spread) <= now; ++*spread) {
        for (int32_t i = side->foot - *spread; i <= side->foot + *spread; i += argus_max(1, 2 * *spread)) {
            come_in_at(self, side->upright ? side->at : i, side->upright ? i : side->at);
        }
    }
    return *spread <= end;
}

// A wave from a waypoint outside comes to the border by and by. False: it has come to all of it.
static bool come_in(argus_wave_t *const self) {
    const argus_cell_t from = self->from;
    const int32_t end = CELLS - 1;
    const side_t sides[] = {{from.y, from.x, 0, false},
                            {end - from.y, from.x, end, false},
                            {from.x, from.y, 0, true},
                            {end - from.x, from.y, end, true}};
    bool more = false;
    for (int i = 0; i < 4; i++) {
        more = come_to_side(self, &sides[i], &self->spread[i]) || more;
    }
    return more;
}

static void begin_spread(argus_wave_t *const self) {
    const int32_t beside_x = outside(self->from.x);
    const int32_t beside_y = outside(self->from.y);
    self->beyond = argus_hypot(argus_min(beside_x, FAR_MOST), argus_min(beside_y, FAR_MOST));
    self->spread[0] = self->spread[1] = beside_x;
    self->spread[2] = self->spread[3] = beside_y;
}

// -----------------------------------------------------------------------------------------------------------

void argus_wave_begin(argus_wave_t *const self, const argus_ground_t *const ground,
                      const argus_point_t waypoint) {
    const argus_pose_t *const pose = &ground->knowledge->pose;
    self->low = ground->grid->low;
    self->from = cell_in(self, waypoint);
    self->to = cell_in(self, (argus_point_t){pose->x_mm, pose->y_mm});
    ARGUS_ASSERT(argus_wave_is_within(self->to));
    survey(self, ground);
    self->step = 0;
    if (argus_wave_is_within(self->from)) {
        self->beyond = 0;
        come_to(self, (int)self->from.y, bit(self->from.x));
    } else {
        begin_spread(self);
    }
    self->step = 1;
}

argus_wave_news_t argus_wave_spread(argus_wave_t *const self, int32_t *const work) {
    ARGUS_ASSERT(self->step >= 1 && self->step <= STEPS_MAX);
    if (argus_wave_label(self, self->to) != 0) {
        return ARGUS_WAVE_THERE;
    }
    self->moved[self->step % MEMORY] = 0;
    const bool more = !argus_wave_is_within(self->from) && come_in(self);
    if (self->step == STEPS_MAX || (!more && alive(self) == 0)) {
        return ARGUS_WAVE_DEAD;
    }
    advance(self, work);
    self->step++;
    *work += STEP_WORK;
    return ARGUS_WAVE_SPREADS;
}
