// SPDX-License-Identifier: MIT
// The scan of a laser as a whole: frozen, dark, cut, late, turned, scaled.
#include "awareness/laser.h"

#include <stddef.h>
#include <string.h>

#include "awareness/scan.h"
#include "knowledge/angle.h"

// Sectors follow each other from left to right.
typedef struct {
    const argus_knowledge_t *knowledge;
    int first;
    int count;
} sectors_t;

static uint16_t now_mm(const sectors_t *const sectors, const int k) {
    ARGUS_ASSERT(k >= 0 && k < sectors->count);
    return sectors->knowledge->sonar[sectors->first + k].reading_mm;
}

static bool is_return(const int32_t mm) {
    return mm < ARGUS_NO_ECHO_MM;
}

// `back`: 1 is the last one, self->count the first.
static const argus_scan_t *scan_at(const argus_laser_t *const self, const int back) {
    ARGUS_ASSERT(back >= 1 && back <= ARGUS_SCANS);
    return &self->scan[(self->next + 2 * ARGUS_SCANS - back) % ARGUS_SCANS];
}

// The scan of a time, to a slot; NULL: none.
static const argus_scan_t *scan_of(const argus_laser_t *const self, const uint32_t t_ms) {
    for (int back = 1; back <= self->count; back++) {
        const argus_scan_t *const scan = scan_at(self, back);
        const int32_t off_ms = (int32_t)(scan->t_ms - t_ms);
        if (argus_abs(off_ms) <= ARGUS_SCAN_SLOT_MS / 2) {
            return scan;
        }
    }
    return NULL;
}

static void find(argus_laser_t *const self, const argus_scan_fault_t fault) {
    if (self->fault == ARGUS_SCAN_SOUND) {
        self->fault = (uint8_t)fault;
        self->news = true;
    }
}

// What ends when it ends.
static void clear(argus_laser_t *const self, const argus_scan_fault_t fault) {
    if (self->fault == (uint8_t)fault) {
        self->fault = ARGUS_SCAN_SOUND;
    }
}

// Frozen and dark ------------------------------------------------------------------------------------------

static void take_same(argus_laser_t *const self, const sectors_t *const sectors,
                      const argus_scan_t *const before) {
    const argus_knowledge_t *const knowledge = sectors->knowledge;
    bool same = true;
    bool some = false;
    for (int k = 0; k < sectors->count; k++) {
        same = same && now_mm(sectors, k) == before->mm[k];
        some = some || is_return(now_mm(sectors, k));
    }
    if (!same || !some) {
        self->same_ms = knowledge->sip_ms;
        self->same_odometer_mm = knowledge->odometer_mm;
        self->same_cdeg = 0;
        clear(self, ARGUS_SCAN_FROZEN);
        return;
    }
    self->same_cdeg += argus_angle_abs_diff(knowledge->pose.heading_cdeg, before->heading_cdeg);
    const bool moved = (int32_t)(knowledge->odometer_mm - self->same_odometer_mm) >= ARGUS_SCAN_SAME_MM ||
                       self->same_cdeg >= ARGUS_SCAN_SAME_CDEG;
    if (moved && knowledge->sip_ms - self->same_ms >= ARGUS_SCAN_SAME_MS) {
        find(self, ARGUS_SCAN_FROZEN);
    }
}

static void take_dark(argus_laser_t *const self, const sectors_t *const sectors,
                      const argus_scan_t *const before) {
    int returns = 0;
    int near = 0;
    for (int k = 0; k < sectors->count; k++) {
        returns += is_return(now_mm(sectors, k));
        near += before->mm[k] <= ARGUS_LASTING_MM;
    }
    if (returns > 0) {
        self->dark = false;
        clear(self, ARGUS_SCAN_DARK);
    } else if (2 * near >= sectors->count) {
        self->dark = true;
        self->dark_ms = sectors->knowledge->sip_ms;
    }
    if (self->dark && sectors->knowledge->sip_ms - self->dark_ms >= ARGUS_SCAN_DARK_MS) {
        find(self, ARGUS_SCAN_DARK);
    }
}

// Range cut ------------------------------------------------------------------------------------------------

static void begin_cut(argus_laser_t *const self, const argus_knowledge_t *const knowledge) {
    self->cut_odometer_mm = knowledge->odometer_mm;
    self->most_mm = 0;
    self->edges = 0;
    self->inner = 0;
}

static void take_cut(argus_laser_t *const self, const sectors_t *const sectors,
                     const argus_scan_t *const before) {
    for (int k = 0; k < sectors->count; k++) {
        const int32_t mm = now_mm(sectors, k);
        const int32_t least = argus_min(mm, before->mm[k]);
        self->most_mm = (uint16_t)(is_return(mm) ? argus_max(self->most_mm, mm) : self->most_mm);
        if (is_return(mm) != is_return(before->mm[k])) {
            const bool edge = least * 100 >= self->most_mm * ARGUS_SCAN_CUT_PERCENT;
            self->edges = edge ? argus_one_more(self->edges) : self->edges;
            self->inner = edge ? self->inner : argus_one_more(self->inner);
        }
    }
    if (sectors->knowledge->odometer_mm - self->cut_odometer_mm >= ARGUS_SCAN_CUT_WAY_MM) {
        if (self->edges >= ARGUS_SCAN_CUT_EDGES && self->edges >= ARGUS_SCAN_CUT_TIMES * self->inner &&
            self->most_mm < ARGUS_SCAN_CUT_MOST_MM) {
            find(self, ARGUS_SCAN_CUT);
        }
        begin_cut(self, sectors->knowledge);
    }
}

// Turned and scaled ----------------------------------------------------------------------------------------

static void keep(int32_t *const sum, const int32_t more) {
    *sum = *sum / 16 * ARGUS_SCAN_KEEPS_SIXTEENTHS + more;
}

static void add_measure(argus_slopes_t *const slopes, const int32_t y, const int32_t c, const int32_t t) {
    keep(&slopes->cc, c * c);
    keep(&slopes->ct, c * t);
    keep(&slopes->tt, t * t);
    keep(&slopes->yc, y * c);
    keep(&slopes->yt, y * t);
}

static int32_t permille(const int64_t part, const int64_t whole) {
    return (int32_t)(part / (whole / 1000 + 1));
}

// Of both, as far as the walls about tell them apart.
static void judge_both(argus_laser_t *const self, const int64_t det, const int64_t wanted) {
    const argus_slopes_t *const s = &self->slopes;
    const int32_t sine = permille((int64_t)s->yt * s->cc - (int64_t)s->yc * s->ct, det);
    const int32_t scale = permille((int64_t)s->yc * s->tt - (int64_t)s->yt * s->ct, det);
    if (argus_abs(sine) >= ARGUS_SCAN_TURNED_PERMILLE) {
        find(self, ARGUS_SCAN_TURNED);
    } else if (det / s->tt >= wanted && argus_abs(scale - 1000) >= ARGUS_SCAN_SCALED_PERMILLE) {
        find(self, ARGUS_SCAN_SCALED);
    }
}

// Where walls lie ahead only, an axis that is turned can hardly be told from the scale: then the axis is
// taken to be right, and more is wanted.
static void judge_slopes(argus_laser_t *const self) {
    const argus_slopes_t *const s = &self->slopes;
    const int64_t wanted = (int64_t)ARGUS_SCAN_MEASURES * ARGUS_SCAN_STRETCH_MM * ARGUS_SCAN_STRETCH_MM;
    const int64_t det = (int64_t)s->cc * s->tt - (int64_t)s->ct * s->ct;
    if (s->cc > 0 && det / s->cc >= wanted) {
        judge_both(self, det, wanted);
    } else if (s->cc >= 4 * wanted &&
               argus_abs(permille(s->yc, s->cc) - 1000) >= ARGUS_SCAN_SCALED_PERMILLE * 4 / 3) {
        find(self, ARGUS_SCAN_SCALED);
    }
}

// Where the laser is, course frame, with the heading of the robot.
static argus_pose_t laser_at(const sectors_t *const sectors) {
    const argus_knowledge_t *const knowledge = sectors->knowledge;
    const argus_sonar_pose_t mount = argus_robot_pose(knowledge->robot, sectors->first);
    const argus_point_t at = argus_to_course(&knowledge->pose, (argus_point_t){mount.x_mm, mount.y_mm});
    return (argus_pose_t){at.x_mm, at.y_mm, knowledge->pose.heading_cdeg};
}

static void measure(argus_laser_t *const self, const argus_wall_t *const wall,
                    const argus_pose_t *const now) {
    const int32_t dx = now->x_mm - wall->at.x_mm;
    const int32_t dy = now->y_mm - wall->at.y_mm;
    const int32_t bearing = wall->bearing_cdeg + wall->aside_cdeg / wall->scans;
    const int32_t cos = argus_cos(bearing);
    const int32_t sin = argus_sin(bearing);
    const int32_t c = -(dx * cos + dy * sin) / ARGUS_TRIG_ONE;
    const int32_t t = (dx * sin - dy * cos) / ARGUS_TRIG_ONE;
    const int32_t y = wall->last_mm - wall->from_mm;
    if (argus_abs(y - c) * 100 <= ARGUS_SCAN_DROPPED_PERCENT * argus_hypot(dx, dy)) {
        add_measure(&self->slopes, y, c, t);
        judge_slopes(self);
    }
}

// The one that is followed at this bearing and range; else a place for another, NULL: none is left.
static argus_wall_t *wall_at(argus_laser_t *const self, const int32_t bearing_cdeg, const int32_t mm) {
    argus_wall_t *spare = NULL;
    for (int i = 0; i < ARGUS_SCAN_WALLS; i++) {
        argus_wall_t *const wall = &self->wall[i];
        if (wall->scans == 0) {
            spare = wall;
        } else if (argus_abs(mm - wall->last_mm) <= ARGUS_SCAN_WALL_LEAP_MM &&
                   argus_angle_abs_diff(bearing_cdeg, wall->bearing_cdeg) <= ARGUS_SCAN_BENT_CDEG) {
            return wall;
        }
    }
    return spare;
}

static void follow(argus_laser_t *const self, const argus_pose_t *const now, const int32_t bearing_cdeg,
                   const int32_t mm) {
    argus_wall_t *const wall = wall_at(self, bearing_cdeg, mm);
    if (wall == NULL) {
        return;
    }
    if (wall->scans == 0) {
        *wall = (argus_wall_t){
            .at = {now->x_mm, now->y_mm}, .bearing_cdeg = bearing_cdeg, .from_mm = (uint16_t)mm};
    }
    wall->last_mm = (uint16_t)mm;
    wall->aside_cdeg += argus_angle_wrap(bearing_cdeg - wall->bearing_cdeg);
    wall->missed = 0;
    const bool whole =
        argus_hypot(now->x_mm - wall->at.x_mm, now->y_mm - wall->at.y_mm) >= ARGUS_SCAN_STRETCH_MM;
    wall->scans = argus_one_more(wall->scans);
    if (whole) {
        measure(self, wall, now);
    }
    if (whole || wall->scans == UINT8_MAX) {
        wall->scans = 0;
    }
}

static void take_walls(argus_laser_t *const self, const sectors_t *const sectors) {
    const argus_robot_t *const robot = sectors->knowledge->robot;
    const argus_pose_t now = laser_at(sectors);
    for (int i = 0; i < ARGUS_SCAN_WALLS; i++) {
        self->wall[i].missed = argus_one_more(self->wall[i].missed);
    }
    for (int k = 1; k + 1 < sectors->count; k++) {
        int32_t aside_cdeg = 0;
        if (now_mm(sectors, k) >= ARGUS_SCAN_WALL_LEAST_MM &&
            argus_scan_shape(sectors->knowledge, sectors->first + k, &aside_cdeg) == ARGUS_SHAPE_WALL) {
            const int32_t mount_cdeg = argus_robot_pose(robot, sectors->first + k).heading_deg * 100;
            follow(self, &now, argus_angle_wrap(now.heading_cdeg + mount_cdeg + aside_cdeg),
                   now_mm(sectors, k));
        }
    }
    for (int i = 0; i < ARGUS_SCAN_WALLS; i++) {
        argus_wall_t *const wall = &self->wall[i];
        wall->scans = wall->missed > ARGUS_SCAN_WALL_MISSED ? (uint8_t)0 : wall->scans;
    }
}

// Late -----------------------------------------------------------------------------------------------------

// As mean of the sectors: what is seen now, and what was seen then, with the robot turned by so much since.
static int32_t misfit_mm(const sectors_t *const sectors, const argus_scan_t *const then, const int shift) {
    int32_t sum_mm = 0;
    int32_t count = 0;
    for (int k = 0; k < sectors->count; k++) {
        const int from = k - shift;
        if (from >= 0 && from < sectors->count) {
            sum_mm += argus_min(argus_abs(now_mm(sectors, k) - then->mm[from]), ARGUS_SCAN_MISFIT_MM);
            count++;
        }
    }
    return count * 2 >= sectors->count ? sum_mm / count : -1;
}

// Sectors by which the robot turned in the step that ended so long ago; false: not known.
static bool shift_of(const argus_laser_t *const self, const sectors_t *const sectors, const uint32_t ago_ms,
                     int *const shift) {
    const uint32_t end_ms = sectors->knowledge->sip_ms - ago_ms;
    const argus_scan_t *const to = scan_of(self, end_ms);
    const argus_scan_t *const from = scan_of(self, end_ms - ARGUS_SCAN_LATE_STEP_MS);
    if (to == NULL || from == NULL) {
        return false;
    }
    const int32_t width_cdeg = sectors->knowledge->robot->sector_deg * 100;
    const int32_t turned = argus_angle_wrap(to->heading_cdeg - from->heading_cdeg);
    *shift = (int)((turned + (turned > 0 ? width_cdeg / 2 : -width_cdeg / 2)) / width_cdeg);
    return true;
}

static void take_lag(argus_laser_t *const self, const sectors_t *const sectors, const int lag,
                     const int prompt, const int late) {
    const argus_scan_t *const then =
        scan_of(self, sectors->knowledge->sip_ms - (uint32_t)ARGUS_SCAN_LATE_STEP_MS);
    argus_misfit_t *const misfit = &self->misfit[lag];
    ARGUS_ASSERT(then != NULL); // the robot's turn since then is known
    const int32_t prompt_mm = misfit_mm(sectors, then, prompt);
    const int32_t late_mm = misfit_mm(sectors, then, late);
    if (prompt_mm < 0 || late_mm < 0) {
        return;
    }
    keep(&misfit->prompt_mm, prompt_mm * 16);
    keep(&misfit->late_mm, late_mm * 16);
    misfit->scans = argus_one_more(misfit->scans);
    if (misfit->scans >= ARGUS_SCAN_LATE_SCANS &&
        (int64_t)misfit->prompt_mm * 100 > (int64_t)misfit->late_mm * ARGUS_SCAN_LATE_PERCENT) {
        find(self, ARGUS_SCAN_LATE);
    }
}

static void take_lags(argus_laser_t *const self, const sectors_t *const sectors) {
    int prompt = 0;
    if (!shift_of(self, sectors, 0, &prompt)) {
        return;
    }
    for (int lag = 0; lag < ARGUS_SCAN_LAGS; lag++) {
        int late = 0;
        const uint32_t ago_ms = (uint32_t)((lag + 1) * ARGUS_SCAN_LATE_STEP_MS);
        if (shift_of(self, sectors, ago_ms, &late) && late != prompt) {
            take_lag(self, sectors, lag, prompt, late);
        }
    }
}

// All ------------------------------------------------------------------------------------------------------

static void note(argus_laser_t *const self, const sectors_t *const sectors) {
    argus_scan_t *const scan = &self->scan[self->next];
    scan->t_ms = sectors->knowledge->sip_ms;
    scan->heading_cdeg = sectors->knowledge->pose.heading_cdeg;
    for (int k = 0; k < sectors->count; k++) {
        scan->mm[k] = now_mm(sectors, k);
    }
    self->next = (uint8_t)((self->next + 1) % ARGUS_SCANS);
    self->count = (uint8_t)argus_min(self->count + 1, ARGUS_SCANS);
}

void argus_laser_sip(argus_laser_t *const self, const argus_knowledge_t *const knowledge) {
    const argus_mask_t mask = argus_robot_sectors(knowledge->robot);
    self->news = false;
    if (mask == 0 || (knowledge->fresh & mask) != mask) {
        return;
    }
    self->sectors = mask;
    const int count = argus_count_bits(mask);
    const sectors_t sectors = {knowledge, knowledge->sonars - count, count};
    const argus_scan_t *const before = self->count > 0 ? scan_at(self, 1) : NULL;
    if (before == NULL) {
        self->same_ms = knowledge->sip_ms;
        begin_cut(self, knowledge);
    } else {
        take_same(self, &sectors, before);
        take_dark(self, &sectors, before);
        take_cut(self, &sectors, before);
        take_walls(self, &sectors);
    }
    note(self, &sectors);
    take_lags(self, &sectors);
}

argus_fault_kind_t argus_laser_kind(const argus_laser_t *const self) {
    static const uint8_t kinds[] = {ARGUS_KIND_NONE, ARGUS_KIND_STUCK, ARGUS_KIND_OFF,  ARGUS_KIND_WRONG,
                                    ARGUS_KIND_SLOW, ARGUS_KIND_WRONG, ARGUS_KIND_WRONG};
    ARGUS_ASSERT(self->fault < sizeof kinds);
    return (argus_fault_kind_t)kinds[self->fault];
}
