// SPDX-License-Identifier: MIT
// The monitor of S1 to S8: reads both directions of the wire, keeps what the rules are about, and asks them.
#include "safety.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// Numbers of the protocol (SPEC.md), typed here a second time on purpose.
enum {
    PULSE,
    OPEN,
    CLOSE,
    POLLING,
    ENABLE,
    SETA,
    SETV,
    SETO,
    MOVE,
    ROTATE,
    SETRV,
    VEL,
    HEAD,
    DHEAD,
    CONFIG = 18,
    RVEL = 21,
    DCHEAD = 22,
    SETRA = 23,
    SONAR = 28,
    STOP = 29,
    VEL2 = 32,
    ADSEL = 35,
    SONAR_CYCLE = 48,
    E_STOP = 55,
    QSTOP = 57,
}; // clang-format off

#define NO_ECHO_MM 5000
#define PI 3.14159265358979323846
#define ROBOT_DECEL 300.0   // mm/s^2, the robot's own, on which S5 counts
#define TURN_DECEL 200.0    // deg/s^2
#define SLACK_MM 20.0       // rounding of readings and odometry
#define SPEED_STEP 26.0     // a speed is asked for in steps of 25 mm/s
#define SEEN_MS 6000u       // what others have seen holds for 5 s; one more for what is under way
#define LOOK_DEG 15.0       // half a cone
#define STEEP_DEG 35.0      // a sonar that looks farther aside sees nothing of the way that the body does not cover
#define BACKOFF_MM 300.0    // a step back is never longer: it has rules of its own
#define WATCHDOG_MS 2000u
#define NEW_ORIGIN_SIPS 5 // of the old one may be under way when it is told to count anew
#define NEW_ORIGIN_UNITS 80.0
#define NEW_ORIGIN_DEG 15.0
// clang-format on

static double radians(double deg) {
    return deg * PI / 180.0;
}

static double wrapped(double deg) {
    return deg - 360.0 * floor((deg + 180.0) / 360.0);
}

static int32_t signed16(const uint8_t *bytes) {
    return (int16_t)(uint16_t)(bytes[0] | bytes[1] << 8);
}

static uint32_t ring(const safety_t *self) {
    return (uint32_t)(8 * self->set.sonar_cycle_ms);
}

static bool is_late(uint32_t now, uint32_t since, uint32_t span) {
    return (int32_t)(now - since) > (int32_t)span;
}

// ---- what is found

static void report(safety_t *self, int32_t rule, uint32_t t_ms, const char *format, ...) {
    if (self->count < SAFETY_KEPT) {
        safety_violation_t *const kept = &self->kept[self->count];
        va_list list;
        kept->rule = rule;
        kept->t_ms = t_ms;
        va_start(list, format);
        vsnprintf(kept->reason, sizeof kept->reason, format, list);
        va_end(list);
    }
    self->count++;
    self->by_rule[rule]++;
}

static safety_debt_t *owe(safety_t *self, int32_t rule, const char *format, ...) {
    for (size_t i = 0; i < sizeof self->debt / sizeof self->debt[0]; i++) {
        safety_debt_t *const debt = &self->debt[i];
        if (debt->rule == rule) {
            return debt; // the older one is due first
        }
        if (debt->rule == 0) {
            va_list list;
            debt->rule = rule;
            debt->since_ms = self->now_ms;
            debt->limit_mm_s = debt->free_mm = 0;
            va_start(list, format);
            vsnprintf(debt->reason, sizeof debt->reason, format, list);
            va_end(list);
            return debt;
        }
    }
    return NULL;
}

static void settle(safety_t *self, bool is_e_stop, bool is_stop) {
    for (size_t i = 0; i < sizeof self->debt / sizeof self->debt[0]; i++) {
        const int32_t rule = self->debt[i].rule;
        if (rule == SAFETY_S2_BUMPER ? is_e_stop : is_e_stop || is_stop) {
            self->debt[i].rule = 0;
        }
    }
}

static double asked_mm_s(const safety_t *self) {
    if (!self->moves) {
        return 0;
    }
    return self->is_move ? copysign(self->setv_mm_s, self->speed_mm_s) : self->speed_mm_s;
}

static void collect(safety_t *self) {
    for (size_t i = 0; i < sizeof self->debt / sizeof self->debt[0]; i++) {
        safety_debt_t *const debt = &self->debt[i];
        if (debt->rule == 0 || !is_late(self->now_ms, debt->since_ms, (uint32_t)self->set.within_ms)) {
            continue;
        }
        const bool ends = self->is_move && is_late(debt->since_ms, self->moved_ms, 0) &&
                          fabs(self->rest_mm) < debt->free_mm;
        if (debt->limit_mm_s <= 0 || (!ends && fabs(asked_mm_s(self)) > debt->limit_mm_s + SPEED_STEP)) {
            report(self, debt->rule, debt->since_ms, "%s", debt->reason);
        }
        debt->rule = 0;
    }
}

// ---- time

static void check_silence(safety_t *self) {
    const uint32_t silent_ms = (uint32_t)(self->set.link_stall_ms + self->set.within_ms) + 100u;
    if (self->open && self->has_sip && (self->moves || self->turns) && !self->stopped_since_sip &&
        is_late(self->now_ms, self->sip_ms, silent_ms)) {
        report(self, SAFETY_S2_NO_SIP, self->now_ms, "no SIP for %u ms",
               (unsigned)(self->now_ms - self->sip_ms));
        self->stopped_since_sip = true; // once
    }
}

void safety_tick(safety_t *self, uint32_t t_ms) {
    self->now_ms = t_ms;
    collect(self);
    check_silence(self);
}

// ---- the robot's body

static bool leads_back(const safety_t *self) {
    return self->speed_mm_s < 0;
}

static uint32_t way_mask(const safety_t *self, bool back) {
    return back ? self->body->astern : self->body->ahead;
}

static double way_front(const safety_t *self, bool back) {
    return back ? self->body->rear_mm : self->body->front_mm;
}

static bool is_trusted(const safety_t *self, uint32_t k) {
    return k < (uint32_t)self->set.sonars && ((self->lost | self->doubted) >> k & 1u) == 0;
}

// Where the echo of a ray is in the frame of the body as it stands now; `*sure` is how well that is known.
static bool echo_place(const safety_t *self, const safety_ray_t *ray, double *x, double *y, double *sure) {
    if (ray->range_mm <= 0 || ray->range_mm >= NO_ECHO_MM ||
        is_late(self->now_ms, ray->t_ms, ring(self) + 150u)) {
        return false;
    }
    const safety_mount_t *const mount = &self->body->mount[ray->sonar];
    const double a = radians(mount->bearing_deg);
    const double ex = mount->x_mm + ray->range_mm * cos(a), ey = mount->y_mm + ray->range_mm * sin(a);
    const double c = cos(radians(ray->from.deg)), s = sin(radians(ray->from.deg));
    const double wx = ray->from.x + ex * c - ey * s - self->pose.x;
    const double wy = ray->from.y + ex * s + ey * c - self->pose.y;
    const double c2 = cos(radians(self->pose.deg)), s2 = sin(radians(self->pose.deg));
    *x = wx * c2 + wy * s2;
    *y = wy * c2 - wx * s2;
    // It fired up to one SIP period before, so that the robot was elsewhere by what it makes in that time.
    *sure = fabs(ray->v_mm_s) * 0.15 + radians(fabs(ray->w_deg_s)) * 0.15 * hypot(ex, ey);
    return true;
}

// The distance of a point from the rectangle of the body, 0 within.
static double body_gap(const safety_body_t *body, double x, double y) {
    const double dx = fmax(fmax(x - body->front_mm, -body->rear_mm - x), 0);
    const double dy = fmax(fabs(y) - body->half_mm, 0);
    return hypot(dx, dy);
}

// ---- S5 and S2: what is on the way

static double reaction_s(const safety_t *self) {
    const double wire = self->set.baud > 0 ? 64.0 * 10.0 / self->set.baud : 0;
    return (8.0 * self->set.sonar_cycle_ms + 100.0) / 1000.0 + wire;
}

static double stopping_speed(const safety_t *self, double free_mm) {
    const double at = ROBOT_DECEL * reaction_s(self);
    return free_mm <= 0 ? 0 : sqrt(at * at + 2 * ROBOT_DECEL * free_mm) - at;
}

static double sonar_face(const safety_t *self, bool back) {
    double face = 0;
    for (uint32_t k = 0; k < self->body->sonars; k++) {
        if ((way_mask(self, back) >> k & 1u) != 0) {
            face = fmax(face, back ? -self->body->mount[k].x_mm : self->body->mount[k].x_mm);
        }
    }
    return face;
}

// Those of an upper deck stand behind the foremost ones: so much less is left of what they read.
static double deck_behind(const safety_t *self, uint32_t k, bool back) {
    const double sign = back ? -1 : 1;
    double face = -1e9;
    for (uint32_t i = k / 8 * 8; i < k / 8 * 8 + 8 && i < self->body->sonars; i++) {
        if ((way_mask(self, back) >> i & 1u) != 0) {
            face = fmax(face, sign * self->body->mount[i].x_mm);
        }
    }
    return (sonar_face(self, back) - face) * fabs(cos(radians(self->body->mount[k].bearing_deg)));
}

// How far the leading end may go by what a sonar has read; -1: that is not on its way. A client's bounds
// count what is in the corridor of the body, the manager's own the reading itself.
static double way_to(const safety_t *self, uint32_t k, bool back) {
    double x = 0, y = 0, sure = 0;
    if (!echo_place(self, &self->last[k], &x, &y, &sure)) {
        return -1;
    }
    if (!self->set.guard) {
        const safety_pose_t *const from = &self->last[k].from;
        const double driven = hypot(self->pose.x - from->x, self->pose.y - from->y);
        return self->last[k].range_mm - driven - deck_behind(self, k, back) - way_front(self, back) +
               sonar_face(self, back);
    }
    const double ahead = (back ? -x : x) - way_front(self, back);
    return fabs(y) + sure <= self->body->half_mm ? ahead + sure : -1;
}

// The least of that of all trusted sonars of that end; -1: nothing.
static double seen_mm(const safety_t *self, bool back, uint32_t *which, int32_t *range) {
    double least = -1;
    for (uint32_t k = 0; k < self->body->sonars; k++) {
        if ((way_mask(self, back) >> k & 1u) == 0 || !is_trusted(self, k) || !self->reported[k]) {
            continue;
        }
        const double ahead = way_to(self, k, back);
        if (ahead > 0 && (least < 0 || ahead < least)) {
            least = ahead;
            *which = k;
            *range = self->last[k].range_mm;
        }
    }
    return least;
}

static bool is_backing_off(const safety_t *self) {
    const bool back = self->reversed ? self->speed_mm_s > 0 : self->speed_mm_s < 0;
    return self->is_move && back && fabs(self->rest_mm) <= BACKOFF_MM;
}

static void check_speed(safety_t *self) {
    uint32_t k = 0;
    int32_t range = 0;
    const bool back = leads_back(self);
    const double v = back ? -self->v_mm_s : self->v_mm_s;
    const double free_mm = seen_mm(self, back, &k, &range);
    if (!self->moves || self->set.paper || is_backing_off(self) || free_mm < 0) {
        return;
    }
    const double least = self->set.guard ? 25 : self->set.speed_mm_s;
    const double most = fmax(stopping_speed(self, free_mm + SLACK_MM), least);
    if (v > most + SPEED_STEP && fabs(asked_mm_s(self)) > most + SPEED_STEP) {
        safety_debt_t *const debt = owe(self, SAFETY_S5_SPEED, "%.0f mm/s, sonar %u reads %d: at most %.0f",
                                        v, (unsigned)k, (int)range, most);
        if (debt != NULL) {
            debt->limit_mm_s = most;
            debt->free_mm = free_mm;
        }
    }
}

static void check_no_echo(safety_t *self) {
    const double most = fmax(self->set.step_speed_mm_s, self->set.creep_mm_s);
    const bool back = leads_back(self);
    if (!self->moves || self->set.paper || is_backing_off(self) || fabs(self->v_mm_s) <= most + SPEED_STEP ||
        fabs(asked_mm_s(self)) <= most + SPEED_STEP) {
        return;
    }
    for (uint32_t k = 0; k < self->body->sonars; k++) {
        if ((way_mask(self, back) >> k & 1u) != 0 && self->heard[k]) {
            return;
        }
    }
    safety_debt_t *const debt =
        owe(self, SAFETY_S5_NO_ECHO, "%.0f mm/s, and no echo was heard there", self->v_mm_s);
    if (debt != NULL) {
        debt->limit_mm_s = most;
    }
}

static void check_object(safety_t *self, uint32_t k) {
    const bool back = leads_back(self);
    const int32_t range = self->last[k].range_mm;
    double x = 0, y = 0, sure = 0;
    if (!self->moves || is_backing_off(self) || range > self->set.object_range_mm || !is_trusted(self, k) ||
        (way_mask(self, back) >> k & 1u) == 0 || !echo_place(self, &self->last[k], &x, &y, &sure)) {
        return;
    }
    if (fabs(y) <= self->body->half_mm) {
        owe(self, SAFETY_S2_OBJECT, "sonar %u reads %d mm", (unsigned)k, (int)range);
    }
}

// ---- S2: silence of one sonar

static void check_silent(safety_t *self) {
    const uint32_t limit = (uint32_t)self->set.stale_ms + ring(self);
    for (uint32_t k = 0; k < self->body->sonars && k < (uint32_t)self->set.sonars; k++) {
        const uint32_t bit = (uint32_t)1 << k;
        if (!self->reported[k] || !is_late(self->sip_ms, self->reported_ms[k], limit)) {
            self->silent &= ~bit;
        } else if ((self->silent & bit) == 0) {
            self->silent |= bit;
            if (self->moves && !is_backing_off(self) && (way_mask(self, leads_back(self)) & bit) != 0 &&
                (self->lost & bit) == 0) {
                owe(self, SAFETY_S2_SILENT, "sonar %u has not reported for %u ms", (unsigned)k,
                    (unsigned)(self->sip_ms - self->reported_ms[k]));
            }
        }
    }
}

// ---- S1

static bool is_looked_at(const safety_t *self, uint32_t blind, bool back) {
    const double bearing = self->pose.deg + self->body->mount[blind].bearing_deg;
    const double way = radians(self->pose.deg + (back ? 180.0 : 0.0));
    const double front = way_front(self, back);
    const uint32_t held = self->ray_count < SAFETY_RAYS ? self->ray_count : SAFETY_RAYS;
    for (uint32_t i = 0; i < held; i++) {
        const safety_ray_t *const ray = &self->rays[i];
        const uint32_t k = (uint32_t)ray->sonar;
        const double looks = ray->from.deg + self->body->mount[k].bearing_deg;
        if (k == blind || (self->lost >> k & 1u) != 0 || is_late(self->sip_ms, ray->t_ms, SEEN_MS) ||
            fabs(wrapped(looks - bearing)) > LOOK_DEG + fabs(ray->w_deg_s) * 0.15) {
            continue;
        }
        const double end = (ray->from.x - self->pose.x) * cos(way) + (ray->from.y - self->pose.y) * sin(way) +
                           ray->range_mm + self->body->mount[k].x_mm;
        if (end > front) {
            return true;
        }
    }
    return false;
}

static uint32_t blind_mask(const safety_t *self, bool back) {
    return (self->lost | self->silent) & way_mask(self, back);
}

static bool is_none_left(const safety_t *self) {
    const uint32_t managed =
        self->body->sonars < (uint32_t)self->set.sonars ? self->body->sonars : (uint32_t)self->set.sonars;
    const uint32_t all = managed >= 32 ? UINT32_MAX : ((uint32_t)1 << managed) - 1u;
    return ((self->lost | self->silent) & all) == all;
}

static bool is_at_rest(const safety_t *self) {
    return fabs(self->v_mm_s) < 5;
}

static double stopping_mm(const safety_t *self, double v) {
    return fabs(v) * reaction_s(self) + v * v / (2 * ROBOT_DECEL);
}

// No sonar is left, and an operator lets it go on by its bumpers: check_alone() bounds that.
static bool may_creep(const safety_t *self) {
    return is_none_left(self) && self->set.creep_mm_s > 0;
}

static void check_blind(safety_t *self, double way_mm) {
    const bool back = way_mm < 0;
    const uint32_t blind = blind_mask(self, back);
    for (uint32_t k = 0; k < self->body->sonars; k++) {
        const double off = fabs(wrapped(self->body->mount[k].bearing_deg - (back ? 180.0 : 0.0)));
        if ((blind >> k & 1u) == 0 || off > STEEP_DEG || is_backing_off(self) || may_creep(self)) {
            self->unseen_mm[k] = 0;
            self->allowed_mm[k] = self->set.step_mm;
            continue;
        }
        if ((self->blind >> k & 1u) == 0) {
            self->allowed_mm[k] = self->set.step_mm + stopping_mm(self, self->v_mm_s);
        }
        if (is_at_rest(self) || is_looked_at(self, k, back)) {
            self->unseen_mm[k] = 0;
            self->allowed_mm[k] = is_at_rest(self) ? self->set.step_mm
                                                   : fmax(self->set.step_mm, stopping_mm(self, self->v_mm_s));
            continue;
        }
        self->unseen_mm[k] += fabs(way_mm);
        if (self->unseen_mm[k] > self->allowed_mm[k] + 2 * SLACK_MM) {
            report(self, SAFETY_S1_UNSEEN, self->now_ms,
                   "%.0f mm, the bearing of sonar %u is blind, none looked", self->unseen_mm[k], (unsigned)k);
            self->unseen_mm[k] = 0;
        }
    }
    self->blind = blind;
}

static void check_alone(safety_t *self, double way_mm) {
    if (!is_none_left(self) || is_at_rest(self) || is_backing_off(self)) {
        self->alone_mm = is_none_left(self) ? 0 : -stopping_mm(self, self->v_mm_s);
        return;
    }
    const double creep = self->set.creep_mm_s;
    self->alone_mm += fabs(way_mm);
    if (self->alone_mm > SLACK_MM && (creep <= 0 || fabs(self->v_mm_s) > creep + SPEED_STEP)) {
        report(self, SAFETY_S1_NO_SONAR, self->now_ms, "%.0f mm/s with no sonar left", self->v_mm_s);
        self->alone_mm = -1000;
    }
}

// ---- from the robot: a SIP

// It was told to count from here, and does so since this SIP: no way was driven, and the pose stays.
static bool begins_anew(safety_t *self, int32_t x, int32_t y, int32_t turn) {
    const double near = NEW_ORIGIN_UNITS, at = hypot(x, y), from = hypot(self->raw_x, self->raw_y);
    const double by = fabs(wrapped((turn - self->raw_deg) * 360.0 / 4096.0));
    const bool fits = at <= near && fabs(wrapped(turn * 360.0 / 4096.0)) <= NEW_ORIGIN_DEG;
    const bool anew = self->origin_sips > 0 && fits && (from > near || by > NEW_ORIGIN_DEG);
    self->origin_sips = anew ? 0 : self->origin_sips - (self->origin_sips > 0);
    return anew;
}

static double step_pose(safety_t *self, const uint8_t *data) {
    const int32_t x = signed16(data + 1), y = signed16(data + 3), turn = signed16(data + 5);
    double way = 0;
    if (self->has_pose && begins_anew(self, x, y, turn)) {
        way = 0;
    } else if (self->has_pose) {
        // Only 15 bits of a position are sure.
        const int32_t dx = (((x - self->raw_x) & 0x7fff) ^ 0x4000) - 0x4000;
        const int32_t dy = (((y - self->raw_y) & 0x7fff) ^ 0x4000) - 0x4000;
        const double mx = dx * self->body->mm_per_unit, my = dy * self->body->mm_per_unit;
        self->pose.x += mx;
        self->pose.y += my;
        self->pose.deg += wrapped((turn - self->raw_deg) * 360.0 / 4096.0);
        way = mx * cos(radians(self->pose.deg)) + my * sin(radians(self->pose.deg));
        if (hypot(mx, my) > 400) { // no robot: what was seen is elsewhere now
            memset(self->last, 0, sizeof self->last);
            self->ray_count = 0;
            way = 0;
        }
    } else {
        self->pose = (safety_pose_t){0, 0, turn * 360.0 / 4096.0};
        self->has_pose = true;
    }
    self->raw_x = x;
    self->raw_y = y;
    self->raw_deg = turn;
    return way;
}

static void take_bumpers(safety_t *self, uint8_t rear, uint8_t front) {
    const uint32_t bumpers = (uint32_t)(front & 0x3e) << 8 | (rear & 0x3e);
    const uint32_t stalls = (uint32_t)(rear & 1) | (uint32_t)(front & 1) << 1;
    const uint32_t pressed = bumpers & ~self->bumpers;
    const bool away =
        !self->turns && self->moves &&
        ((self->speed_mm_s < 0 && (pressed & 0xff) == 0) || (self->speed_mm_s > 0 && (pressed >> 8) == 0));
    if (self->bumpers == 0 && bumpers != 0) {
        self->bumper_deg = self->pose.deg;
    }
    if (pressed != 0 && (self->moves || self->turns) && !away) {
        owe(self, SAFETY_S2_BUMPER, "bumpers %04x pressed", (unsigned)pressed);
    }
    if ((stalls & ~self->stalls) != 0 && (self->moves || self->turns)) {
        owe(self, SAFETY_S2_STALL, "stall %u", (unsigned)stalls);
    }
    self->bumpers = bumpers;
    self->stalls = stalls;
}

static void take_reading(safety_t *self, uint32_t k, int32_t range) {
    if (k >= self->body->sonars || k >= (uint32_t)self->set.sonars) {
        return;
    }
    safety_ray_t *const ray = &self->last[k];
    *ray = (safety_ray_t){self->now_ms, (int32_t)k,   range < NO_ECHO_MM ? range : NO_ECHO_MM,
                          self->pose,   self->v_mm_s, self->w_deg_s};
    self->rays[self->ray_count++ % SAFETY_RAYS] = *ray;
    self->reported[k] = true;
    self->reported_ms[k] = self->now_ms;
    self->heard[k] = self->heard[k] || range < NO_ECHO_MM;
    check_object(self, k);
}

static void run_out(safety_t *self, double way_mm) {
    if (!self->moves || !self->is_move) {
        return;
    }
    self->rest_mm -= way_mm;
    if (self->rest_mm * self->speed_mm_s <= 0 || (fabs(self->rest_mm) < 20 && is_at_rest(self))) {
        self->moves = false;
    }
}

static void take_gap(safety_t *self) {
    const uint32_t gap = self->now_ms - self->sip_ms;
    if (self->has_sip && gap > (uint32_t)self->set.link_stall_ms + 50u) {
        self->resumes = true;
        self->vel_cancelled = self->rvel_cancelled = false;
        self->checked_ms = self->now_ms;
        memset(self->reported, 0, sizeof self->reported);
    }
}

static void take_sip(safety_t *self, const uint8_t *data, size_t length) {
    if (!self->open || self->body == NULL || length < 21) {
        return;
    }
    take_gap(self);
    self->sip_ms = self->now_ms;
    self->has_sip = true;
    self->stopped_since_sip = false;
    const double before_deg = self->pose.deg;
    const bool had = self->has_pose;
    const double way = step_pose(self, data);
    self->v_mm_s = (signed16(data + 7) + signed16(data + 9)) / 2.0;
    self->w_deg_s = had ? (self->pose.deg - before_deg) * 10.0 : 0;
    run_out(self, way);
    take_bumpers(self, data[12], data[13]);
    const size_t count = data[19];
    for (size_t i = 0; i < count && 23 + 3 * i <= length; i++) {
        take_reading(self, data[20 + 3 * i], (int32_t)(data[21 + 3 * i] | data[22 + 3 * i] << 8));
    }
    check_silent(self);
    check_blind(self, way);
    check_alone(self, way);
    check_speed(self);
    check_no_echo(self);
}

// ---- from the robot: the rest

static void forget_session(safety_t *self) {
    self->open = self->has_sip = self->has_pose = self->moves = self->turns = self->resumes = false;
    self->bumpers = self->stalls = self->silent = self->blind = 0;
    self->ray_count = 0;
    memset(self->reported, 0, sizeof self->reported);
    memset(self->heard, 0, sizeof self->heard);
    memset(self->last, 0, sizeof self->last);
    memset(self->debt, 0, sizeof self->debt);
}

int32_t safety_body_row(const char *subclass) {
    for (unsigned i = 0; i < safety_body_count; i++) {
        const char *own = safety_bodies[i].subclass, *it = subclass;
        while (*own != 0 && (*it == *own || (*it >= 'A' && *it <= 'Z' && *it - 'A' + 'a' == *own))) {
            own++;
            it++;
        }
        if (*own == 0 && *it == 0) {
            return (int32_t)i;
        }
    }
    return strcmp(subclass, "p3dx") == 0 ? safety_body_row("p3dx-sh") : -1;
}

static void take_name(safety_t *self, const uint8_t *data, size_t length) {
    char text[3 * 64] = {0};
    const char *word[3] = {text, "", ""};
    const size_t kept = length - 1 < sizeof text - 1 ? length - 1 : sizeof text - 1;
    memcpy(text, data + 1, kept);
    for (size_t i = 0, n = 0; i < kept && n < 2; i++) {
        if (text[i] == 0) {
            word[++n] = text + i + 1;
        }
    }
    const int32_t row = self->set.body >= 0 ? self->set.body : safety_body_row(word[2]);
    self->body = row >= 0 && (unsigned)row < safety_body_count ? &safety_bodies[row] : NULL;
}

static void from_robot(safety_t *self, const uint8_t *data, size_t length) {
    if (data[0] == 0x32 || data[0] == 0x33) {
        take_sip(self, data, length);
    } else if (data[0] == 2 && length > 1) {
        take_name(self, data, length);
        forget_session(self);
        self->answered = true;
    } else if (data[0] == 0 || data[0] == 0xfe || data[0] == 0xff) {
        forget_session(self);
        self->answered = false;
    }
}

// ---- to the robot

// The least gap of the body to an echo while it turns by `turn_deg`, if that is nearer than it is now.
static bool meets(const safety_t *self, double turn_deg, double x, double y, double sure) {
    const double now = body_gap(self->body, x, y);
    const double sign = turn_deg < 0 ? -1 : 1;
    for (double at = 1; at <= fabs(turn_deg) + 0.5; at += 1) {
        const double a = radians(fmin(at, fabs(turn_deg)) * sign);
        const double gap = body_gap(self->body, x * cos(a) + y * sin(a), y * cos(a) - x * sin(a));
        if (gap + sure < 10 && gap + sure < now - 5) {
            return true;
        }
    }
    return false;
}

static void check_turn(safety_t *self, double turn_deg, bool is_whole) {
    if (self->bumpers != 0 &&
        (fabs(turn_deg) > 1 || fabs(self->pose.deg + turn_deg - self->bumper_deg) > 3) &&
        fabs(turn_deg) > 0.6) {
        report(self, SAFETY_S7_BUMPER, self->now_ms, "%.1f degrees, bumpers %04x", turn_deg,
               (unsigned)self->bumpers);
    }
    for (uint32_t k = 0; k < self->body->sonars; k++) {
        double x = 0, y = 0, sure = 0;
        if (!is_trusted(self, k) || !self->reported[k] || !echo_place(self, &self->last[k], &x, &y, &sure)) {
            continue;
        }
        if (meets(self, turn_deg, x, y, sure)) {
            report(self, SAFETY_S7_ECHO, self->now_ms, "%.1f degrees, sonar %u hears %.0f, %.0f mm", turn_deg,
                   (unsigned)k, x, y);
            return;
        }
        const double swing = hypot(fmax(self->body->front_mm, self->body->rear_mm), self->body->half_mm);
        if (is_whole && !self->set.guard && !self->turns && is_at_rest(self) && fabs(turn_deg) > 21 &&
            hypot(x, y) + sure < swing - 10) {
            report(self, SAFETY_S7_CIRCLE, self->now_ms,
                   "%.1f degrees, sonar %u hears %.0f mm from the centre", turn_deg, (unsigned)k,
                   hypot(x, y));
            return;
        }
    }
}

static bool may_move(safety_t *self, const char *what) {
    if (!self->open) {
        report(self, SAFETY_S8_COMMAND, self->now_ms, "%s with no session", what);
        return false;
    }
    if (self->body == NULL) {
        report(self, SAFETY_S5_BODY, self->now_ms, "%s", what);
        return false;
    }
    if (self->held) {
        report(self, SAFETY_STANDS, self->now_ms, "%s", what);
    }
    if (self->resumes && !(self->vel_cancelled && self->rvel_cancelled)) {
        report(self, SAFETY_S2_RESUME, self->now_ms, "%s", what);
        self->resumes = false;
    }
    for (size_t i = 0; i < sizeof self->debt / sizeof self->debt[0]; i++) {
        safety_debt_t *const debt = &self->debt[i];
        if (self->set.within_ms == 0 && debt->rule / 10 == 2) {
            report(self, debt->rule, self->now_ms, "%s before STOP: %.60s", what, debt->reason);
            debt->rule = 0;
        }
    }
    return true;
}

static void note_heading(safety_t *self, double to_deg) {
    if (self->stand_count == 0) {
        self->stand_deg[self->stand_count++] = self->pose.deg;
    }
    if (self->stand_count < SAFETY_HEADINGS) {
        self->stand_deg[self->stand_count++] = to_deg;
    }
}

static void order_turn(safety_t *self, double turn_deg, double asked_deg, bool is_heading, const char *what) {
    const double held_deg = is_heading && fabs(turn_deg) <= 0.6 ? 0 : turn_deg;
    if (!may_move(self, what)) {
        return;
    }
    if (self->has_pose && held_deg != 0) {
        note_heading(self, self->pose.deg + turn_deg);
        check_turn(self, asked_deg, is_heading);
    }
    self->turns = held_deg != 0;
    self->target_deg = self->pose.deg + turn_deg;
}

static void order_heading(safety_t *self, double to_deg) {
    const double turn = wrapped(to_deg - self->pose.deg);
    const double most = self->set.guard ? 45 : 180;
    order_turn(self, turn, copysign(fmin(fabs(turn), most), turn), true, "HEAD");
}

static void order_rate(safety_t *self, double rate) {
    if (rate == 0) {
        self->turns = false;
        self->rvel_cancelled = true;
        return;
    }
    const double way = copysign(fmin(fabs(rate) * 0.4, 45), rate);
    order_turn(self, way, way, false, "RVEL");
}

static void check_heard(safety_t *self, bool back) {
    const uint32_t mask = way_mask(self, back);
    for (uint32_t k = 0; k < self->body->sonars && k < (uint32_t)self->set.sonars; k++) {
        if ((mask >> k & 1u) != 0 && !self->reported[k] && (self->lost >> k & 1u) == 0 &&
            !is_late(self->now_ms, self->checked_ms, (uint32_t)self->set.stale_ms)) {
            report(self, SAFETY_S6_UNHEARD, self->now_ms, "sonar %u has not reported yet", (unsigned)k);
            return;
        }
    }
}

// After a sweep it drives on the heading at which it stood before: not on one that the sweep alone came to.
static void check_heading(safety_t *self) {
    bool known = self->stand_count < 2 || self->stand_count >= SAFETY_HEADINGS;
    for (uint32_t i = 0; i + 1 < self->stand_count; i++) {
        known = known || fabs(wrapped(self->pose.deg - self->stand_deg[i])) <= 5;
    }
    if (self->swept && !self->spoiled && !known) {
        report(self, SAFETY_S4_HEADING, self->now_ms, "%.1f degrees beside that before the sweep",
               wrapped(self->pose.deg - self->stand_deg[0]));
    }
    self->stand_count = 0;
    self->swept = self->spoiled = false;
}

static void order_way(safety_t *self, double speed, double length, const char *what) {
    if (!may_move(self, what)) {
        return;
    }
    self->is_move = length != 0;
    self->moves = true;
    self->moved_ms = self->now_ms;
    self->speed_mm_s = speed;
    self->rest_mm = length;
    if (!is_backing_off(self)) {
        check_heard(self, speed < 0);
    }
    if (length > 0) {
        check_heading(self);
    }
}

static void order_stop(safety_t *self, bool is_e_stop) {
    self->moves = self->turns = false;
    self->stopped_since_sip = true;
    settle(self, is_e_stop, true);
}

static void order_velocity(safety_t *self, double speed) {
    if (speed != 0) {
        order_way(self, speed, 0, "VEL");
        return;
    }
    self->moves = false;
    self->vel_cancelled = true;
    for (size_t i = 0; i < sizeof self->debt / sizeof self->debt[0]; i++) {
        const int32_t rule = self->debt[i].rule;
        if (self->set.guard && (rule == SAFETY_S2_OBJECT || rule == SAFETY_S2_SILENT)) {
            self->debt[i].rule = 0;
        }
    }
}

static void order_wheels(safety_t *self, const uint8_t *data) {
    const double left = (int8_t)data[2] * 20.0, right = (int8_t)data[3] * 20.0;
    const double rate = (right - left) * 0.0056 / 2 * 180 / PI;
    if (left + right != 0) {
        order_way(self, (left + right) / 2, 0, "VEL2");
    } else {
        order_velocity(self, 0);
    }
    order_rate(self, rate);
}

static bool is_sent(uint8_t command, int32_t value) {
    switch (command) {
    case PULSE:
    case OPEN:
    case CLOSE:
    case POLLING:
    case ENABLE:
    case SETA:
    case SETRA:
    case SETO:
    case CONFIG:
    case SONAR:
    case STOP:
    case E_STOP:
    case SONAR_CYCLE:
    case ADSEL:
        return true;
    case SETV:
    case SETRV:
        return value >= 0;
    case MOVE:
        return true;
    case HEAD:
        return value >= -360 && value <= 360;
    case VEL:
    case RVEL:
        return value == 0;
    default:
        return false;
    }
}

static void order(safety_t *self, uint8_t command, int32_t value, const uint8_t *data) {
    switch (command) {
    case STOP:
        order_stop(self, false);
        break;
    case E_STOP:
    case QSTOP:
        order_stop(self, true);
        break;
    case MOVE:
        if (value != 0) {
            order_way(self, value < 0 ? -1 : 1, value, "MOVE");
        }
        break;
    case VEL:
        order_velocity(self, value);
        break;
    case VEL2:
        order_wheels(self, data);
        break;
    case RVEL:
        order_rate(self, value);
        break;
    case HEAD:
        order_heading(self, value);
        break;
    case DHEAD:
    case ROTATE:
    case DCHEAD:
        order_turn(self, value, value, true, "a turn");
        break;
    case ENABLE:
        if (value != 0 && self->body == NULL) {
            report(self, SAFETY_S5_BODY, self->now_ms, "ENABLE");
        }
        break;
    case SETV:
        self->setv_mm_s = value;
        if (!self->set.guard &&
            value > (self->set.speed_max_mm_s > self->set.speed_mm_s ? self->set.speed_max_mm_s
                                                                     : self->set.speed_mm_s)) {
            report(self, SAFETY_S5_CEILING, self->now_ms, "SETV %d", (int)value);
        }
        break;
    case SETO:
        self->origin_sips = NEW_ORIGIN_SIPS;
        break;
    case CLOSE:
        forget_session(self);
        break;
    default:
        break;
    }
}

static void to_robot(safety_t *self, const uint8_t *data, size_t length) {
    const uint8_t command = data[0];
    int32_t value = 0;
    if (command == OPEN && self->answered && !self->open) {
        self->answered = false;
        self->open = true;
        self->opened_ms = self->checked_ms = self->now_ms;
        return;
    }
    if (length >= 4 && (data[1] == 0x3b || data[1] == 0x1b)) {
        value = data[2] | data[3] << 8;
        value = data[1] == 0x1b ? -value : value;
    }
    if (!self->set.guard && !is_sent(command, value)) {
        report(self, SAFETY_S8_COMMAND, self->now_ms, "command %u with %d", (unsigned)command, (int)value);
    }
    if (length < 4 && (command == VEL2 || command == MOVE || command == HEAD)) {
        report(self, SAFETY_S8_COMMAND, self->now_ms, "command %u without an argument", (unsigned)command);
        return;
    }
    order(self, command, value, data);
}

// ---- framing

static uint16_t checksum(const uint8_t *data, size_t length) {
    uint16_t sum = 0;
    size_t i = 0;
    for (; i + 1 < length; i += 2) {
        sum = (uint16_t)(sum + (uint16_t)(data[i] << 8 | data[i + 1]));
    }
    return i < length ? (uint16_t)(sum ^ data[i]) : sum;
}

// The length of the packet at the start; 0: it is not whole yet, -1: there is none.
static int packet_length(const uint8_t *bytes, size_t held) {
    if (bytes[0] != 0xfa || (held > 1 && bytes[1] != 0xfb) || (held > 2 && bytes[2] < 3)) {
        return -1;
    }
    if (held < 3 || held < (size_t)bytes[2] + 3) {
        return 0;
    }
    const size_t data = (size_t)bytes[2] - 2;
    const uint16_t sum = (uint16_t)(bytes[3 + data] << 8 | bytes[4 + data]);
    return checksum(bytes + 3, data) == sum ? (int)bytes[2] + 3 : -1;
}

static void take_stream(safety_t *self, safety_stream_t *stream, safety_way_t way) {
    size_t at = 0;
    while (at < stream->length) {
        const int length = packet_length(stream->bytes + at, stream->length - at);
        if (length == 0) {
            break;
        }
        if (length < 0) {
            if (way == SAFETY_TO_ROBOT) {
                report(self, SAFETY_S8_FRAME, self->now_ms, "byte %02x", stream->bytes[at]);
            }
            at++;
            continue;
        }
        const uint8_t *const data = stream->bytes + at + 3;
        if (way == SAFETY_FROM_ROBOT) {
            from_robot(self, data, (size_t)length - 5);
        } else {
            if (length > 200) {
                report(self, SAFETY_S8_FRAME, self->now_ms, "%d bytes", length);
            }
            to_robot(self, data, (size_t)length - 5);
        }
        at += (size_t)length;
    }
    memmove(stream->bytes, stream->bytes + at, stream->length - at);
    stream->length -= at;
}

void safety_feed(safety_t *self, uint32_t t_ms, safety_way_t way, const uint8_t *bytes, size_t length) {
    safety_stream_t *const stream = way == SAFETY_TO_ROBOT ? &self->to : &self->from;
    safety_tick(self, t_ms);
    if (way == SAFETY_TO_ROBOT && length > 0) {
        self->spoke_ms = t_ms;
        self->has_spoken = true;
        self->silence = false;
    }
    while (length > 0) {
        const size_t room = SAFETY_BUFFER - stream->length;
        const size_t part = length < room ? length : room;
        memcpy(stream->bytes + stream->length, bytes, part);
        stream->length += part;
        bytes += part;
        length -= part;
        take_stream(self, stream, way);
    }
}

// ---- what else is known

void safety_truth(safety_t *self, uint32_t t_ms, double v_mm_s, double w_deg_s, double gap_mm, bool contact) {
    safety_tick(self, t_ms);
    const bool moves = fabs(v_mm_s) > 10 || fabs(w_deg_s) > 3;
    const bool creeps = self->body != NULL && is_none_left(self);
    if (contact && !self->touching && moves && self->set.contact && !creeps) {
        const bool turn = radians(fabs(w_deg_s)) * 300 > fabs(v_mm_s);
        report(self, turn ? SAFETY_S7_CONTACT : SAFETY_S5_CONTACT, t_ms, "%.0f mm/s, %.0f deg/s, gap %.0f mm",
               v_mm_s, w_deg_s, gap_mm);
    }
    self->touching = contact;
    if (self->has_spoken && is_late(t_ms, self->spoke_ms, WATCHDOG_MS + 100u)) {
        const uint32_t silent = t_ms - self->spoke_ms - WATCHDOG_MS;
        if (!self->silence) {
            self->silence = true;
            self->silence_mm_s = fabs(v_mm_s);
        } else if (moves && silent > 500 + self->silence_mm_s / ROBOT_DECEL * 1000 + fabs(w_deg_s) * 10) {
            report(self, SAFETY_S3_WATCHDOG, t_ms, "%.0f mm/s, %.0f deg/s, %u ms after the last byte", v_mm_s,
                   w_deg_s, (unsigned)(t_ms - self->spoke_ms));
            self->has_spoken = false;
        }
    }
}

void safety_health(safety_t *self, uint32_t out, uint32_t doubted) {
    self->lost = out;
    self->doubted = doubted;
}

void safety_event(safety_t *self, uint32_t t_ms, int32_t id, int32_t value) {
    safety_tick(self, t_ms);
    self->reversed = id == 73 ? value != 0 : self->reversed;
    switch (id) {
    case 33:
    case 55: // a look begins, a sweep is done
        self->swept = true;
        break;
    case 52:
    case 53:
    case 57:
    case 58:
    case 60:
    case 61:
    case 63:
    case 64:
    case 67:
    case 70:
    case 73:
        self->spoiled = true; // another way, so another heading
        break;
    default:
        break;
    }
}

void safety_hold(safety_t *self, uint32_t t_ms, bool holds) {
    safety_tick(self, t_ms);
    self->held = holds;
}

// ---- beginning and end

safety_settings_t safety_defaults(void) {
    return (safety_settings_t){
        .object_range_mm = 250,
        .step_mm = 200,
        .step_speed_mm_s = 100,
        .speed_mm_s = 200,
        .speed_max_mm_s = 500,
        .stale_ms = 1500,
        .link_stall_ms = 600,
        .sonar_cycle_ms = 40,
        .baud = 9600,
        .sonars = 16,
        .body = -1,
        .contact = 1,
    };
}

void safety_init(safety_t *self, const safety_settings_t *settings) {
    memset(self, 0, sizeof *self);
    self->set = *settings;
}

const char *safety_meaning(int32_t rule) {
    switch (rule) {
#define MEANING(number, name, meaning) \
    case number:                       \
        return #name ": " meaning;
        SAFETY_RULES(MEANING)
#undef MEANING
    default:
        return "";
    }
}

size_t safety_size(void) {
    return sizeof(safety_t);
}

size_t safety_settings_size(void) {
    return sizeof(safety_settings_t);
}

uint32_t safety_count(const safety_t *self) {
    return self->count;
}

uint32_t safety_count_of(const safety_t *self, int32_t rule) {
    return rule > 0 && rule < 100 ? self->by_rule[rule] : 0;
}

const safety_violation_t *safety_kept(const safety_t *self, uint32_t index) {
    return index < self->count && index < SAFETY_KEPT ? &self->kept[index] : NULL;
}
