// SPDX-License-Identifier: MIT
// Checks a ring, and works out of it what the manager wants to know of a robot.
#include "robot/make.h"

#include <string.h>

#include "arcos/arithmetic.h"
#include "robot/robot.h"

#define HALF_TURN_DEG 180
#define TURN_DEG 360
#define SPACING_MOST_DEG 60 // 1 / cos of it is 2
#define LAST_ASTERN_DEG 140 // who looks farther astern than this sees what the robot backs into head-on
#define ONE 30              // figures of sine and cosine have so many binary places
#define DEG_IN_RAD 18740330 // pi / 180
#define AHEAD_MOST_DEG 55   // a sector so far off ahead sees what the robot drives into
#define SERIES 6            // terms of a cosine: the next one is below the last place

_Static_assert(ARGUS_FORWARD_SONARS == ARGUS_FORWARD_MAX, "a ring has as many forward sonars as a plan");
_Static_assert(sizeof(argus_own_robot_t) <= sizeof(argus_robot_storage_t), "ARGUS_ROBOT_BYTES is too small");
_Static_assert(_Alignof(argus_own_robot_t) <= _Alignof(argus_robot_storage_t), "aligned too loosely");

typedef struct {
    int16_t least;
    int16_t most;
} bounds_t;

#define BUILT(key, section, def, min, max, meaning) [ROW_##key] = (def),
#define BOUNDS(key, section, def, min, max, meaning) [ROW_##key] = {(min), (max)},
#define ROW(key, section, def, min, max, meaning) ROW_##key,
enum { ARGUS_RING_TABLE(ROW) ROWS };
#undef ROW

static argus_ring_report_t report(const argus_ring_fault_t fault, const int key, const int sonar) {
    return (argus_ring_report_t){.fault = (int32_t)fault, .key = key, .sonar = sonar};
}

// The figures ----------------------------------------------------------------------------------------------

// Those of the ring, defaults filled in.
static void take_figures(const argus_ring_t *const ring, int32_t figures[ROWS]) {
    static const int32_t built[ROWS] = {ARGUS_RING_TABLE(BUILT)};
#define TAKE(key, section, def, min, max, meaning) figures[ROW_##key] = ring->key;
    ARGUS_RING_TABLE(TAKE)
#undef TAKE
    for (int i = 0; i < ROWS; i++) {
        figures[i] = figures[i] != 0 ? figures[i] : built[i];
    }
}

static argus_ring_report_t check_figures(const int32_t figures[ROWS]) {
    static const bounds_t bounds[ROWS] = {ARGUS_RING_TABLE(BOUNDS)};
    for (int i = 0; i < ROWS; i++) {
        if (figures[i] < bounds[i].least || figures[i] > bounds[i].most) {
            return report(ARGUS_RING_FIGURE, i, -1);
        }
    }
    return report(ARGUS_RING_OK, -1, -1);
}

// Of a corner of the rectangle, rounded up.
static int32_t corner_mm(const int32_t figures[ROWS]) {
    const int32_t end_mm = argus_max(figures[ROW_front_mm], figures[ROW_rear_mm]);
    const int32_t square4 = 4 * end_mm * end_mm + figures[ROW_width_mm] * figures[ROW_width_mm];
    int32_t radius_mm = end_mm;
    while (4 * radius_mm * radius_mm < square4) {
        radius_mm++;
    }
    return radius_mm;
}

static void work_out_figures(const argus_ring_t *const ring, int32_t figures[ROWS]) {
    int32_t face_mm = 1;
    for (int i = 0; i < ring->forward_count; i++) {
        face_mm = argus_max(face_mm, ring->mounts[ring->forward[i]].x_mm);
    }
    const int32_t found[][2] = {{ROW_swing_radius_mm, corner_mm(figures)},
                                {ROW_sonar_face_mm, face_mm},
                                {ROW_track_mm, figures[ROW_width_mm]}};
    for (size_t i = 0; i < sizeof found / sizeof found[0]; i++) {
        int32_t *const figure = &figures[found[i][0]];
        *figure = *figure != 0 ? *figure : found[i][1];
    }
    if (figures[ROW_tolerance_centre_mm] == 0) {
        figures[ROW_tolerance_centre_mm] = figures[ROW_sonar_face_mm];
    }
}

static bool can_swing(const int32_t figures[ROWS]) {
    const int32_t end_mm = argus_max(figures[ROW_front_mm], figures[ROW_rear_mm]);
    const int32_t within_mm = argus_max(end_mm, (figures[ROW_width_mm] + 1) / 2);
    return figures[ROW_swing_radius_mm] >= within_mm &&
           figures[ROW_swing_radius_mm] < figures[ROW_no_echo_mm];
}

// The sonars -----------------------------------------------------------------------------------------------

static bool is_on_body(const argus_sonar_mount_t *const at, const int32_t figures[ROWS]) {
    return at->x_mm <= figures[ROW_front_mm] && at->x_mm >= -figures[ROW_rear_mm] &&
           2 * argus_abs(at->y_mm) <= figures[ROW_width_mm] + 1;
}

static bool is_alike(const argus_ring_t *const ring, const int sonar) {
    const argus_sonar_mount_t *const own = &ring->mounts[sonar];
    for (int i = 0; i < sonar; i++) {
        const argus_sonar_mount_t *const before = &ring->mounts[i];
        if (before->x_mm == own->x_mm && before->y_mm == own->y_mm &&
            before->heading_deg == own->heading_deg) {
            return true;
        }
    }
    return false;
}

static argus_ring_fault_t fault_of(const argus_ring_t *const ring, const int sonar,
                                   const int32_t figures[ROWS]) {
    const argus_sonar_mount_t *const mount = &ring->mounts[sonar];
    if (!is_on_body(mount, figures)) {
        return ARGUS_RING_BESIDE;
    }
    if (mount->heading_deg <= -HALF_TURN_DEG || mount->heading_deg > HALF_TURN_DEG) {
        return ARGUS_RING_BEARING;
    }
    if (mount->role > ARGUS_ROLE_ABEAM) {
        return ARGUS_RING_ROLE;
    }
    return sonar < ring->sonars - figures[ROW_sectors] && is_alike(ring, sonar) ? ARGUS_RING_ALIKE
                                                                                : ARGUS_RING_OK;
}

static argus_ring_report_t check_sonars(const argus_ring_t *const ring, const int32_t figures[ROWS]) {
    for (int i = 0; i < ring->sonars; i++) {
        const argus_ring_fault_t fault = fault_of(ring, i, figures);
        if (fault != ARGUS_RING_OK) {
            const bool laser = i >= ring->sonars - figures[ROW_sectors];
            return laser ? report(fault, ROW_ahead_mm, -1) : report(fault, -1, i);
        }
    }
    return report(ARGUS_RING_OK, -1, -1);
}

// Sectors of a laser's scan --------------------------------------------------------------------------------

static bool is_managed(const int32_t sonars, const int32_t sectors) {
    return sonars + sectors > 0 && sonars + sectors <= ARGUS_SONARS && (sectors == 0 || ARGUS_LASER);
}

// Sonars fill whole arrays of eight before them: no array has both.
static argus_ring_report_t check_sectors(const argus_ring_t *const ring, const int32_t figures[ROWS]) {
    const int32_t sectors = figures[ROW_sectors];
    if (!is_managed(ring->sonars, sectors)) {
        return report(ARGUS_RING_SONARS, sectors > 0 ? ROW_sectors : -1, -1);
    }
    if (sectors > 0 && ring->sonars % ARCOS_TIMING_TRANSDUCERS_PER_ARRAY != 0) {
        return report(ARGUS_RING_SECTORS, ROW_sectors, -1);
    }
    const bool whole = sectors == 0 || figures[ROW_field_deg] % sectors == 0;
    return report(whole ? ARGUS_RING_OK : ARGUS_RING_SECTORS, whole ? -1 : ROW_field_deg, -1);
}

static uint8_t role_of(const int32_t heading_deg) {
    if (argus_abs(heading_deg) <= AHEAD_MOST_DEG) {
        return ARGUS_ROLE_AHEAD;
    }
    return argus_abs(heading_deg) >= HALF_TURN_DEG - AHEAD_MOST_DEG ? ARGUS_ROLE_ASTERN : ARGUS_ROLE_ABEAM;
}

// All sensors: the sonars, then the sectors, left to right.
static void take_mounts(argus_sonar_mount_t mounts[ARGUS_SONARS], const argus_ring_t *const ring,
                        const int32_t figures[ROWS]) {
    ARGUS_ASSERT(ring->sonars + figures[ROW_sectors] <= ARGUS_SONARS);
    for (int i = 0; i < ring->sonars; i++) {
        mounts[i] = ring->mounts[i];
    }
    const bool guards = figures[ROW_guards] != 0 || ring->sonars == 0;
    for (int k = 0; k < figures[ROW_sectors]; k++) {
        const int32_t width = figures[ROW_field_deg] / figures[ROW_sectors];
        const int32_t turned = figures[ROW_facing_deg] + (figures[ROW_field_deg] - width) / 2 - k * width;
        const int32_t heading = (turned + TURN_DEG + HALF_TURN_DEG - 1) % TURN_DEG - HALF_TURN_DEG + 1;
        mounts[ring->sonars + k] =
            (argus_sonar_mount_t){(int16_t)figures[ROW_ahead_mm], (int16_t)figures[ROW_aside_mm],
                                  (int16_t)heading, guards ? role_of(heading) : ARGUS_ROLE_NONE};
    }
}

// Those that face forward ----------------------------------------------------------------------------------

static int32_t bearing_of(const argus_ring_t *const ring, const int rank) {
    return ring->mounts[ring->forward[rank]].heading_deg;
}

// Turns that put any sonar onto the bearing of one that faces forward.
static int turns_of(const argus_ring_t *const ring, const int32_t sectors) {
    uint32_t seen[(TURN_DEG + 31) / 32] = {0};
    int count = 0;
    for (int i = 0; i < ring->forward_count * ring->sonars; i++) {
        const int32_t by = bearing_of(ring, i / ring->sonars) - ring->mounts[i % ring->sonars].heading_deg;
        const int32_t turn = (by + TURN_DEG) % TURN_DEG;
        const uint32_t bit = UINT32_C(1) << turn % 32;
        if (i % ring->sonars >= ring->sonars - sectors &&
            ring->mounts[i % ring->sonars].role == ARGUS_ROLE_NONE) {
            continue; // it covers for none
        }
        count += turn != 0 && (seen[turn / 32] & bit) == 0;
        seen[turn / 32] |= bit;
    }
    return count;
}

static argus_ring_report_t check_forward(const argus_ring_t *const ring, const int32_t sectors) {
    if (ring->forward_count < 2 || ring->forward_count > ARGUS_FORWARD_MAX) {
        return report(ARGUS_RING_FORWARD, -1, -1);
    }
    for (int i = 0; i < ring->forward_count; i++) {
        const int sonar = ring->forward[i];
        if (sonar >= ring->sonars || ring->mounts[sonar].role != ARGUS_ROLE_AHEAD) {
            return report(ARGUS_RING_FORWARD, -1, sonar);
        }
        const int32_t spacing = i > 0 ? bearing_of(ring, i - 1) - bearing_of(ring, i) : 1;
        if (spacing <= 0 || spacing >= SPACING_MOST_DEG) {
            return report(ARGUS_RING_ORDER, -1, sonar);
        }
    }
    return report(turns_of(ring, sectors) > ARGUS_TURNS_MAX ? ARGUS_RING_TURNS : ARGUS_RING_OK, -1, -1);
}

// The row --------------------------------------------------------------------------------------------------

static int64_t cosine(const int32_t deg) {
    const int64_t x = (int64_t)deg * DEG_IN_RAD;
    const int64_t square = x * x >> ONE;
    int64_t term = INT64_C(1) << ONE;
    int64_t sum = term;
    for (int i = 1; i <= SERIES; i++) {
        term = -(term * square >> ONE) / ((2 * i - 1) * 2 * i);
        sum += term;
    }
    return sum;
}

// 1 / cos, less 1, in 2^-32.
static uint32_t excess_of(const int32_t deg) {
    ARGUS_ASSERT(deg > 0 && deg < SPACING_MOST_DEG);
    return (uint32_t)((UINT64_C(1) << 62) / (uint64_t)cosine(deg) - (UINT64_C(1) << 32));
}

static void take_masks(argus_robot_t *const row, const argus_ring_t *const ring) {
    ARGUS_ASSERT(ring->sonars <= ARGUS_SONARS && ring->forward_count <= ARGUS_FORWARD_MAX);
    for (int i = 0; i < ring->sonars; i++) {
        const argus_sonar_mount_t *const mount = &ring->mounts[i];
        argus_mask_t *const side = mount->x_mm > 0 ? &row->flank_mask : &row->rear_flank_mask;
        argus_mask_t *const ahead = mount->role == ARGUS_ROLE_AHEAD ? &row->ahead_mask : &row->astern_mask;
        if (mount->role != ARGUS_ROLE_NONE) {
            argus_mask_t *const mask = mount->role == ARGUS_ROLE_ABEAM ? side : ahead;
            *mask = (argus_mask_t)(*mask | 1u << i);
        }
    }
    for (int i = 0; i < ring->forward_count; i++) {
        row->forward[i] = ring->forward[i];
        row->forward_mask = (argus_mask_t)(row->forward_mask | 1u << ring->forward[i]);
    }
}

static void take_spacing(argus_robot_t *const row, const argus_ring_t *const ring) {
    ARGUS_ASSERT(ring->forward_count > 1);
    const int32_t gaps = ring->forward_count - 1;
    const int32_t all_deg = bearing_of(ring, 0) - bearing_of(ring, gaps);
    int32_t widest = 0;
    for (int i = 0; i < gaps; i++) {
        widest = argus_max(widest, bearing_of(ring, i) - bearing_of(ring, i + 1));
    }
    row->pitch_deg = (int16_t)((2 * all_deg + gaps) / (2 * gaps));
    row->tolerance_excess = excess_of(widest);
}

static int16_t rear_overhang_mm(const argus_ring_t *const ring, const int32_t rear_mm) {
    int32_t last_mm = INT16_MIN;
    for (int i = 0; i < ring->sonars; i++) {
        if (argus_abs(ring->mounts[i].heading_deg) >= LAST_ASTERN_DEG) {
            last_mm = argus_max(last_mm, ring->mounts[i].x_mm);
        }
    }
    return (int16_t)(rear_mm + (last_mm == INT16_MIN ? 0 : last_mm));
}

// Of an upper deck: its foremost faces are so far behind those that face forward.
static int16_t deck_behind_mm(const argus_robot_t *const row, const argus_ring_t *const ring) {
    const unsigned beside = (unsigned)row->ahead_mask & ~(unsigned)row->forward_mask;
    int32_t face_mm = INT16_MIN;
    for (int i = 0; i < ring->sonars; i++) {
        if ((beside >> i & 1u) != 0) {
            face_mm = argus_max(face_mm, row->reversed ? -ring->mounts[i].x_mm : ring->mounts[i].x_mm);
        }
    }
    return (int16_t)(face_mm == INT16_MIN ? 0 : argus_max(row->sonar_face_mm - face_mm, 0));
}

static void copy_name(argus_robot_t *const row, const char *const name) {
    for (size_t i = 0; i + 1 < sizeof row->name && name[i] != '\0'; i++) {
        row->name[i] = name[i];
    }
}

static void make_built(argus_own_robot_t *const own, const argus_ring_t *const ring,
                       const int32_t figures[ROWS]) {
    argus_robot_t *const row = &own->rows[0];
    copy_name(row, ring->name);
    row->poses = (int16_t)((const char *)own->poses - (const char *)row);
    row->sonars = ring->sonars;
    row->arrays = (uint8_t)((ring->sonars + ARCOS_TIMING_TRANSDUCERS_PER_ARRAY - 1) /
                            ARCOS_TIMING_TRANSDUCERS_PER_ARRAY);
    row->forward_count = ring->forward_count;
    row->front_bumpers = (uint8_t)figures[ROW_front_bumpers];
    row->rear_bumpers = (uint8_t)figures[ROW_rear_bumpers];
    row->front_mm = (int16_t)figures[ROW_front_mm];
    row->rear_mm = (int16_t)figures[ROW_rear_mm];
    row->width_mm = (int16_t)figures[ROW_width_mm];
    row->swing_radius_mm = (int16_t)figures[ROW_swing_radius_mm];
    row->sonar_face_mm = (int16_t)figures[ROW_sonar_face_mm];
    row->tolerance_centre_mm = (int16_t)figures[ROW_tolerance_centre_mm];
    row->decel_mm_s2 = (int16_t)figures[ROW_decel_mm_s2];
    row->track_mm = (int16_t)figures[ROW_track_mm];
    row->dist_conv_um = (int16_t)figures[ROW_dist_conv_um];
    row->min_mm = (int16_t)figures[ROW_min_mm];
    row->no_echo_mm = (int16_t)figures[ROW_no_echo_mm];
    row->cone_deg = (int16_t)figures[ROW_cone_deg];
    row->cycle_ms = (int16_t)figures[ROW_cycle_ms];
    row->sector_deg = (int16_t)(figures[ROW_sectors] > 0 ? figures[ROW_field_deg] / figures[ROW_sectors] : 0);
    for (int i = ring->sonars - figures[ROW_sectors]; i < ring->sonars; i++) {
        row->sector_mask = (argus_mask_t)(row->sector_mask | 1u << i);
    }
    take_masks(row, ring);
    take_spacing(row, ring);
    row->rear_overhang_mm = rear_overhang_mm(ring, row->rear_mm);
    row->deck_behind_mm = deck_behind_mm(row, ring);
}

// The one that looks astern on the bearing of a forward one, with the rear leading; -1: none.
static int opposite(const argus_ring_t *const ring, const int32_t bearing_deg) {
    for (int i = 0; i < ring->sonars; i++) {
        const int32_t turned = ring->mounts[i].heading_deg - bearing_deg;
        if (ring->mounts[i].role == ARGUS_ROLE_ASTERN && argus_abs(turned) == HALF_TURN_DEG) {
            return i;
        }
    }
    return -1;
}

// The robot turned by 180 degrees, where its rear has as many sonars as lead in front.
static bool make_turned(argus_own_robot_t *const own, const argus_ring_t *const ring) {
    argus_robot_t *const row = &own->rows[1];
    const argus_robot_t *const built = &own->rows[0];
    *row = *built;
    row->forward_mask = 0;
    row->sonar_face_mm = INT16_MIN;
    for (int i = 0; i < ring->forward_count; i++) {
        const int sonar = opposite(ring, bearing_of(ring, i));
        if (sonar < 0) {
            return false;
        }
        row->forward[i] = (uint8_t)sonar;
        row->forward_mask = (argus_mask_t)(row->forward_mask | 1u << sonar);
        row->sonar_face_mm = (int16_t)argus_max(row->sonar_face_mm, -ring->mounts[sonar].x_mm);
    }
    row->other = -1;
    row->reversed = true;
    row->poses = (int16_t)(built->poses - (int)sizeof *row);
    row->tolerance_centre_mm = row->sonar_face_mm;
    row->front_mm = built->rear_mm;
    row->rear_mm = built->front_mm;
    row->front_bumpers = built->rear_bumpers;
    row->rear_bumpers = built->front_bumpers;
    row->ahead_mask = built->astern_mask;
    row->astern_mask = built->ahead_mask;
    row->flank_mask = built->rear_flank_mask;
    row->rear_flank_mask = built->flank_mask;
    row->deck_behind_mm = deck_behind_mm(row, ring);
    return true;
}

static void turn_overhang(argus_own_robot_t *const own, const argus_ring_t *const ring) {
    int32_t last_mm = INT16_MIN;
    for (int i = 0; i < ring->sonars; i++) {
        if (argus_abs(ring->mounts[i].heading_deg) <= HALF_TURN_DEG - LAST_ASTERN_DEG) {
            last_mm = argus_max(last_mm, -ring->mounts[i].x_mm);
        }
    }
    own->rows[1].rear_overhang_mm = (int16_t)(own->rows[1].rear_mm + (last_mm == INT16_MIN ? 0 : last_mm));
}

static bool is_name(const char *const name) {
    size_t length = 0;
    while (name != NULL && length < ARGUS_ROBOT_NAME_MAX && name[length] != '\0') {
        length++;
    }
    return length > 0 && length < ARGUS_ROBOT_NAME_MAX;
}

static argus_ring_report_t check(const argus_ring_t *const ring, const int32_t figures[ROWS]) {
    argus_ring_report_t found = check_sonars(ring, figures);
    if (found.fault == ARGUS_RING_OK) {
        found = check_forward(ring, figures[ROW_sectors]);
    }
    return found;
}

// `whole`: the ring with the sectors of its laser, whose mounts are in `mounts`.
static argus_ring_report_t make_whole(argus_ring_t *const whole, argus_sonar_mount_t mounts[ARGUS_SONARS],
                                      const argus_ring_t *const ring, int32_t figures[ROWS]) {
    take_figures(ring, figures);
    if (!is_name(ring->name)) {
        return report(ARGUS_RING_NAME, -1, -1);
    }
    argus_ring_report_t found = check_figures(figures);
    if (found.fault == ARGUS_RING_OK) {
        found = check_sectors(ring, figures);
    }
    if (found.fault == ARGUS_RING_OK) {
        take_mounts(mounts, ring, figures);
        *whole = *ring;
        whole->mounts = mounts;
        whole->sonars = (uint8_t)(ring->sonars + figures[ROW_sectors]);
        found = check(whole, figures);
    }
    return found;
}

argus_ring_report_t argus_robot_make(argus_own_robot_t *const own, const argus_ring_t *const ring) {
    int32_t figures[ROWS];
    argus_sonar_mount_t mounts[ARGUS_SONARS];
    argus_ring_t whole;
    const argus_ring_report_t found = make_whole(&whole, mounts, ring, figures);
    if (found.fault != ARGUS_RING_OK) {
        return found;
    }
    work_out_figures(&whole, figures);
    if (!can_swing(figures)) {
        return report(ARGUS_RING_SWING, ROW_swing_radius_mm, -1);
    }
    memset(own, 0, sizeof *own);
    make_built(own, &whole, figures);
    for (int i = 0; i < whole.sonars; i++) {
        own->poses[i] = (argus_sonar_pose_t){mounts[i].x_mm, mounts[i].y_mm, mounts[i].heading_deg};
    }
    if (make_turned(own, &whole)) {
        own->rows[0].other = 1;
        turn_overhang(own, &whole);
    }
    return found;
}
