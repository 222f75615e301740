// SPDX-License-Identifier: MIT
// Turns SIPs into readings with their age, a pose that survives the robot's own wraps and resets, and the
// robot's state.
#include "knowledge/knowledge.h"

#include <string.h>

#include "knowledge/angle.h"
#include "knowledge/odometry.h"

#define REST_MM_S 5
#define ROTATING_MM_S 10 // wheel speed difference beyond which a reading is smeared by rotation
#define ARRAY ARCOS_TIMING_TRANSDUCERS_PER_ARRAY
#define LISTS_ALL_COUNT (ARRAY - 1) // in one SIP: the firing schedule lists at most 3 at its default pace
#define LISTS_ALL_WAIT_MS 460
#define FAR_MM 30000 // of a step: its components in another frame fit 32 bits
#define TURN_UNITS 4096
#define CDEG_PER_UNIT 20   // so much of a turn is like a unit of way
#define GAP_MS 500         // without a SIP for longer, it was the link that was silent, not the sonars
#define ARRAYS_ON_MS 6000u // so late the order that turns the arrays on may come
#define ARRAYS_ON (ARCOS_FLAG_SONAR1 | ARCOS_FLAG_SONAR2 | ARCOS_FLAG_SONAR3 | ARCOS_FLAG_SONAR4)

void argus_knowledge_init(argus_knowledge_t *const self) {
    memset(self, 0, sizeof *self);
    self->robot = argus_robot_default();
    self->sonars = (uint8_t)argus_robot_sonars(self->robot);
}

void argus_knowledge_reopen(argus_knowledge_t *const self, const uint32_t now_ms) {
    self->has_raw = false;
    self->origin_due = false;
    self->still_sips = 0;
    self->lists_all = false;
    self->fresh = 0;
    self->heard = 0;
    self->online_ms = now_ms;
    self->reopened_ms = now_ms;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        self->sonar[i].reported = false;
    }
}

void argus_knowledge_unhear(argus_knowledge_t *const self) {
    self->heard = 0;
}

// The raw position counts in 15 or 16 bits: the low 15 are right in both.
static int32_t raw_delta(const uint16_t now, const uint16_t before) {
    const int32_t delta = (int32_t)((uint32_t)(now - before) & 0x7FFFu);
    return delta > 0x3FFF ? delta - 0x8000 : delta;
}

static int32_t raw_heading_cdeg(const argus_sip_t *const sip) {
    return argus_angle_wrap((int32_t)sip->heading_raw * 36000 / TURN_UNITS);
}

int32_t argus_built_heading_cdeg(const argus_knowledge_t *const self) {
    return argus_angle_wrap(self->pose.heading_cdeg - argus_robot_facing_cdeg(self->robot));
}

int32_t argus_heading_offset_cdeg(const argus_knowledge_t *const self) {
    return argus_angle_wrap(self->heading_offset_cdeg + argus_robot_facing_cdeg(self->robot));
}

static void take_origin(argus_knowledge_t *const self, const argus_sip_t *const sip) {
    self->heading_offset_cdeg = argus_angle_wrap(argus_built_heading_cdeg(self) - raw_heading_cdeg(sip));
    self->has_raw = true;
}

static int32_t carry_mm(int32_t *const rest_um, const int32_t more_um) {
    const int32_t sum = *rest_um + more_um;
    const int32_t whole = sum / 1000;
    *rest_um = sum - whole * 1000;
    ARGUS_ASSERT(*rest_um > -1000 && *rest_um < 1000);
    return whole;
}

// Whole parts and the rest apart, so that 32 bits will do.
static int32_t rotated_um(const int32_t x_um, const int32_t c, const int32_t y_um, const int32_t s) {
    const int32_t one = ARGUS_TRIG_ONE;
    return x_um / one * c + y_um / one * s + (x_um % one * c + y_um % one * s) / one;
}

// Rotates a displacement of the robot's odometry frame into the course frame.
static void advance_pose(argus_knowledge_t *const self, const int32_t dx_um, const int32_t dy_um) {
    const int32_t c = argus_cos(self->heading_offset_cdeg);
    const int32_t s = argus_sin(self->heading_offset_cdeg);
    self->pose.x_mm += carry_mm(&self->x_um, rotated_um(dx_um, c, dy_um, -s));
    self->pose.y_mm += carry_mm(&self->y_um, rotated_um(dx_um, s, dy_um, c));
    const int32_t way_um = (int32_t)argus_hypot(dx_um / 16, dy_um / 16) * 16;
    self->odometer_mm += (uint32_t)carry_mm(&self->odometer_um, way_um);
}

// From the robot as it is built to the leading end, and back.
static argus_wheels_t faced(const argus_robot_t *const robot, const argus_wheels_t wheels) {
    const argus_wheels_t turned = {-wheels.right_mm_s, -wheels.left_mm_s};
    return robot->reversed ? turned : wheels;
}

static argus_wheels_t wheels_of(const argus_robot_t *const robot, const argus_sip_t *const sip) {
    return faced(robot, (argus_wheels_t){sip->vel_left_mm_s, sip->vel_right_mm_s});
}

argus_wheels_t argus_built_wheels(const argus_knowledge_t *const self) {
    return faced(self->robot, (argus_wheels_t){self->vel_left_mm_s, self->vel_right_mm_s});
}

uint16_t argus_built_bumpers(const argus_knowledge_t *const self) {
    const bool reversed = self->robot->reversed;
    const unsigned front = reversed ? self->bumpers_rear : self->bumpers_front;
    const unsigned rear = reversed ? self->bumpers_front : self->bumpers_rear;
    return (uint16_t)(front << 8 | rear);
}

int32_t argus_built_stalls(const argus_knowledge_t *const self) {
    const int32_t weight_left = self->robot->reversed ? 2 : 1;
    return (self->stall_left ? weight_left : 0) + (self->stall_right ? 3 - weight_left : 0);
}

static int32_t speed_or_none(const int32_t mm_s) {
    return argus_odometry_is_speed(mm_s) ? mm_s : 0;
}

// What no odometry and no wheel shows.
static bool is_odd(const argus_sip_t *const sip) {
    return argus_abs(sip->heading_raw) > TURN_UNITS || !argus_odometry_is_speed(sip->vel_left_mm_s) ||
           !argus_odometry_is_speed(sip->vel_right_mm_s);
}

// Since the last SIP, which is before this one's speeds are taken.
static argus_span_t span_to(const argus_knowledge_t *const self, const argus_sip_t *const sip,
                            const uint32_t now_ms) {
    const argus_wheels_t after = wheels_of(self->robot, sip);
    const argus_span_t span = {
        .before = {speed_or_none(self->vel_left_mm_s), speed_or_none(self->vel_right_mm_s)},
        .after = {speed_or_none(after.left_mm_s), speed_or_none(after.right_mm_s)},
        .track_mm = self->robot->track_mm,
        .elapsed_ms = now_ms - self->moved_ms,
        .late_ms = self->late_ms};
    return span;
}

// The robot moved as its wheels say, also where steps were wrong before but small; where it is now is the
// origin of its odometry.
static void leave_out(argus_knowledge_t *const self, const argus_sip_t *const sip,
                      const argus_span_t *const span) {
    const argus_way_turn_t moved = argus_odometry_by_wheels(span);
    const argus_pose_t half_way = {self->pose.x_mm, self->pose.y_mm,
                                   self->pose.heading_cdeg + moved.turn_cdeg / 2};
    const argus_point_t at =
        argus_to_course(&half_way, (argus_point_t){moved.way_mm - self->excess.out_mm, 0});
    self->pose.x_mm = at.x_mm;
    self->pose.y_mm = at.y_mm;
    self->odometer_mm += (uint32_t)argus_abs(moved.way_mm);
    self->pose.heading_cdeg =
        argus_angle_wrap(self->pose.heading_cdeg + moved.turn_cdeg - self->excess.out_cdeg);
    take_origin(self, sip);
    self->excess.out_mm = 0;
    self->excess.out_cdeg = 0;
}

// A step of the odometry in the frame of the leading end, which looks half way between both headings.
static argus_moved_t moved_of(const argus_knowledge_t *const self, const argus_sip_t *const sip,
                              const argus_point_t step_mm, const int32_t heading_cdeg) {
    const int32_t turn_cdeg = argus_angle_wrap(heading_cdeg - self->pose.heading_cdeg);
    const argus_point_t step = {argus_within(FAR_MM, step_mm.x_mm), argus_within(FAR_MM, step_mm.y_mm)};
    const int32_t facing_cdeg = raw_heading_cdeg(sip) + argus_robot_facing_cdeg(self->robot) - turn_cdeg / 2;
    const argus_point_t moved = argus_in_frame(step, facing_cdeg);
    return (argus_moved_t){moved.x_mm, moved.y_mm, turn_cdeg};
}

// In a silence: this may be the way since the counters were zero, not since the last SIP.
static bool may_count_anew(const argus_knowledge_t *const self, const argus_sip_t *const sip,
                           const int32_t distance_um, const argus_span_t *const span,
                           const argus_moved_t *const moved) {
    const int32_t units = argus_hypot(raw_delta(sip->x_raw, 0), raw_delta(sip->y_raw, 0));
    const argus_way_turn_t from_zero = {units * distance_um / 1000, raw_heading_cdeg(sip)};
    return argus_odometry_may_be_anew(span, &self->order, moved, &from_zero);
}

// Those that come in a bunch are a cycle apart nonetheless.
static int32_t turn_deg_s(const argus_span_t *const span, const int32_t turn_cdeg) {
    const int32_t cycle_ms = ARCOS_TIMING_SIP_CYCLE_MS;
    const int32_t ms = span->elapsed_ms > (uint32_t)INT16_MAX ? INT16_MAX : (int32_t)span->elapsed_ms;
    return turn_cdeg * 10 / argus_max(ms, cycle_ms);
}

// True: the robot can have moved so, and is known to.
static bool move(argus_knowledge_t *const self, const argus_sip_t *const sip, const int32_t distance_um,
                 const argus_span_t *const span) {
    ARGUS_ASSERT(distance_um > 0);
    const int32_t dx_um = raw_delta(sip->x_raw, self->x_raw) * distance_um;
    const int32_t dy_um = raw_delta(sip->y_raw, self->y_raw) * distance_um;
    const int32_t heading = argus_angle_wrap(raw_heading_cdeg(sip) + argus_heading_offset_cdeg(self));
    const argus_moved_t moved = moved_of(self, sip, (argus_point_t){dx_um / 1000, dy_um / 1000}, heading);
    if (is_odd(sip) || !argus_odometry_may_be(&self->excess, span, &moved) ||
        (argus_odometry_is_unseen(span, &self->order) &&
         may_count_anew(self, sip, distance_um, span, &moved))) {
        const argus_way_turn_t said = argus_odometry_by_wheels(span);
        self->leap_mm = argus_hypot(moved.ahead_mm - said.way_mm, moved.aside_mm);
        self->leap_cdeg = argus_abs(moved.turn_cdeg - said.turn_cdeg);
        return false;
    }
    advance_pose(self, dx_um, dy_um);
    self->pose.heading_cdeg = heading;
    self->turn_deg_s = turn_deg_s(span, moved.turn_cdeg);
    return true;
}

void argus_knowledge_origin_due(argus_knowledge_t *const self) {
    self->origin_due = true;
}

// From the last SIP, or from zero, in one figure.
static int32_t off(const argus_knowledge_t *const self, const argus_sip_t *const sip, const bool zero) {
    const int32_t dx = raw_delta(sip->x_raw, zero ? 0 : self->x_raw);
    const int32_t dy = raw_delta(sip->y_raw, zero ? 0 : self->y_raw);
    const int32_t heading = zero ? 0 : argus_angle_wrap(self->pose.heading_cdeg - self->heading_offset_cdeg);
    return argus_hypot(dx, dy) + argus_angle_abs_diff(raw_heading_cdeg(sip), heading) / CDEG_PER_UNIT;
}

// True: it counts from zero now.
static bool take_zero(argus_knowledge_t *const self, const argus_sip_t *const sip) {
    if (!self->origin_due || off(self, sip, true) >= off(self, sip, false)) {
        return false;
    }
    self->x_raw = 0;
    self->y_raw = 0;
    self->heading_offset_cdeg = self->pose.heading_cdeg;
    return true;
}

// Its counters restarted. If it was in motion then, and some SIPs are missing, how far it got before is
// unknown.
static bool loses_way(argus_knowledge_t *const self, const argus_span_t *const span) {
    const bool lost = argus_odometry_is_unseen(span, &self->order);
    if (lost) {
        self->leap_mm = argus_odometry_unseen_mm(span, &self->order);
        self->leap_cdeg = 0;
    }
    return lost;
}

static void take_motion(argus_knowledge_t *const self, const argus_sip_t *const sip) {
    const argus_wheels_t wheels = wheels_of(self->robot, sip);
    const int32_t left = argus_odometry_speed_mm_s(wheels.left_mm_s); // a SIP may state any
    const int32_t right = argus_odometry_speed_mm_s(wheels.right_mm_s);
    self->vel_left_mm_s = (int16_t)left;
    self->vel_right_mm_s = (int16_t)right;
    self->rotating = argus_abs(left - right) > ROTATING_MM_S;
    if (argus_abs(left) > REST_MM_S || argus_abs(right) > REST_MM_S) {
        self->still_sips = 0;
    } else if (self->still_sips < UINT16_MAX) {
        self->still_sips++;
    }
}

void argus_knowledge_odometry(argus_knowledge_t *const self, const argus_sip_t *const sip,
                              const int32_t distance_um, const uint32_t now_ms) {
    ARGUS_ASSERT(distance_um > 0);
    const argus_span_t span = span_to(self, sip, now_ms);
    self->turn_deg_s = 0;
    if (!self->has_raw) {
        self->leapt = loses_way(self, &span);
        take_origin(self, sip);
        self->excess = (argus_excess_t){0};
    } else {
        self->leapt =
            (take_zero(self, sip) && loses_way(self, &span)) || !move(self, sip, distance_um, &span);
    }
    if (self->leapt) {
        leave_out(self, sip, &span);
        self->leaps++;
        self->leaps_unseen += argus_odometry_is_unseen(&span, &self->order) ? 1u : 0u;
    }
    self->moved_ms = now_ms;
    self->x_raw = sip->x_raw;
    self->y_raw = sip->y_raw;
    self->order.under_way = false;
    take_motion(self, sip);
}

void argus_knowledge_turn_about(argus_knowledge_t *const self, const argus_robot_t *const robot) {
    ARGUS_ASSERT(robot == argus_robot_other_end(self->robot));
    const int16_t left = self->vel_left_mm_s;
    const uint8_t front = self->bumpers_front;
    const bool stall_left = self->stall_left;
    self->robot = robot;
    self->pose.heading_cdeg = argus_angle_wrap(self->pose.heading_cdeg + 18000);
    self->vel_left_mm_s = (int16_t)-self->vel_right_mm_s;
    self->vel_right_mm_s = (int16_t)-left;
    self->bumpers_front = self->bumpers_rear;
    self->bumpers_rear = front;
    self->stall_left = self->stall_right;
    self->stall_right = stall_left;
}

void argus_knowledge_set_back(argus_knowledge_t *const self, const argus_pose_t *const to) {
    self->pose.x_mm = to->x_mm;
    self->pose.y_mm = to->y_mm;
    self->x_um = 0;
    self->y_um = 0;
}

static void take_state(argus_knowledge_t *const self, const argus_sip_t *const sip) {
    self->flags = sip->flags;
    const bool reversed = self->robot->reversed; // bit 1 is leftmost in front and rightmost in the rear
    self->bumpers_front = reversed ? sip->bumpers_rear : sip->bumpers_front;
    self->bumpers_rear = reversed ? sip->bumpers_front : sip->bumpers_rear;
    self->stall_left = reversed ? sip->stall_right : sip->stall_left;
    self->stall_right = reversed ? sip->stall_left : sip->stall_right;
    const bool finer = sip->has_battery_x10 && sip->battery_x10_dv != 0; // not every server fills it in
    self->battery_dv = finer ? sip->battery_x10_dv : sip->battery_dv;
}

static void take_reading(argus_knowledge_t *const self, const argus_sip_sonar_t *const from) {
    ARGUS_ASSERT(from->number < self->sonars);
    argus_sonar_t *const sonar = &self->sonar[from->number];
    const bool silent = from->range_mm >= self->robot->no_echo_mm;
    sonar->reading_mm = silent && from->range_mm < ARGUS_NO_ECHO_MM ? ARGUS_NO_ECHO_MM : from->range_mm;
    sonar->reported = true;
    sonar->steady = !self->rotating;
    sonar->sip = self->sips;
    sonar->heard_ms = self->sip_ms;
    sonar->odometer_mm = self->odometer_mm;
    sonar->readings++;
    self->fresh |= (argus_mask_t)(1u << from->number);
    self->listed |= self->fresh;
    if (!silent) {
        self->heard |= (argus_mask_t)(1u << from->number);
        sonar->echo_mm = self->odometer_mm;
    }
}

static void take_readings(argus_knowledge_t *const self, const argus_sip_t *const sip) {
    int first = 0; // of the first array
    bool strange = false;
    self->fresh = 0;
    for (int i = 0; i < sip->sonar_count; i++) {
        strange = strange || sip->sonar[i].number >= self->robot->sonars;
        if (sip->sonar[i].number < self->sonars) {
            take_reading(self, &sip->sonar[i]);
            first += sip->sonar[i].number < ARRAY;
        }
    }
    self->strange_sips = strange ? argus_one_more(self->strange_sips) : 0;
    if (first > 0) {
        self->lists_all = first >= LISTS_ALL_COUNT;
    }
}

// The arrays of a new session are not on yet: that they are silent is not the sonars' fault.
static bool is_still_off(const argus_knowledge_t *const self, const argus_sip_t *const sip) {
    bool reported = sip->sonar_count > 0;
    for (int i = 0; i < self->sonars; i++) {
        reported = reported || self->sonar[i].reported;
    }
    return !reported && ((unsigned)sip->flags & ARRAYS_ON) == 0;
}

void argus_knowledge_sip(argus_knowledge_t *const self, const argus_sip_t *const sip,
                         const int32_t distance_um, const uint32_t now_ms) {
    ARGUS_ASSERT(self->robot != NULL && distance_um > 0);
    const bool after_gap = self->sips > 0 && now_ms - self->sip_ms > GAP_MS;
    if (after_gap || (is_still_off(self, sip) && now_ms - self->reopened_ms < ARRAYS_ON_MS)) {
        self->online_ms = now_ms;
    }
    self->sips++;
    self->sip_ms = now_ms;
    argus_knowledge_odometry(self, sip, distance_um, now_ms);
    take_state(self, sip);
    take_readings(self, sip);
}

argus_mask_t argus_with_health(const argus_knowledge_t *const self, const argus_health_t health) {
    ARGUS_ASSERT(self->sonars <= ARGUS_SONARS);
    ARGUS_ASSERT(health <= ARGUS_ABSENT);
    unsigned mask = 0;
    for (int i = 0; i < self->sonars; i++) {
        mask |= self->sonar[i].health == health ? 1u << i : 0u;
    }
    return (argus_mask_t)mask;
}

argus_mask_t argus_disabled(const argus_knowledge_t *const self) {
    return argus_with_health(self, ARGUS_DISABLED);
}

argus_mask_t argus_out(const argus_knowledge_t *const self) {
    return argus_disabled(self) | argus_with_health(self, ARGUS_PROBATION) |
           argus_with_health(self, ARGUS_ABSENT);
}

argus_mask_t argus_named(const argus_knowledge_t *const self) {
    ARGUS_ASSERT(self->sonars <= ARGUS_SONARS);
    unsigned mask = 0;
    for (int i = 0; i < self->sonars; i++) {
        const argus_sonar_t *const s = &self->sonar[i];
        mask |= s->health == ARGUS_SUSPECT && s->kind != ARGUS_KIND_NONE ? 1u << i : 0u;
    }
    return (argus_mask_t)mask;
}

// Doubt without a name is not enough to look away from what it says.
bool argus_trusted(const argus_knowledge_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_t *const s = &self->sonar[sonar];
    return s->health == ARGUS_HEALTHY || (s->health == ARGUS_SUSPECT && s->kind == ARGUS_KIND_NONE);
}

bool argus_usable(const argus_knowledge_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_t *const s = &self->sonar[sonar];
    return s->reported && !argus_is_out(self, sonar) && s->reading_mm < self->robot->no_echo_mm;
}

int32_t argus_reading_ahead_mm(const argus_knowledge_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < self->sonars);
    const int32_t reading_mm = self->sonar[sonar].reading_mm;
    const argus_robot_t *const robot = self->robot;
    const bool beside = argus_robot_looks_ahead(robot, sonar) && !argus_robot_faces_forward(robot, sonar);
    if (robot->deck_behind_mm == 0 || !beside || reading_mm >= robot->no_echo_mm) {
        return reading_mm;
    }
    const int32_t bearing_cdeg = argus_robot_pose(robot, sonar).heading_deg * 100;
    return argus_max(0, reading_mm - robot->deck_behind_mm * argus_cos(bearing_cdeg) / ARGUS_TRIG_ONE);
}

bool argus_counts_ahead(const argus_knowledge_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_robot_looks_ahead(self->robot, sonar) &&
           (argus_robot_faces_forward(self->robot, sonar) || self->sonar[sonar].health != ARGUS_STALE);
}

uint32_t argus_unheard_mm(const argus_knowledge_t *const self, const argus_mask_t sonars) {
    ARGUS_ASSERT(self->sonars <= ARGUS_SONARS);
    const unsigned heard = sonars & self->heard;
    uint32_t least_mm = UINT32_MAX;
    for (int i = 0; i < self->sonars; i++) {
        const uint32_t since_mm = self->odometer_mm - self->sonar[i].echo_mm;
        least_mm = (heard >> i & 1u) != 0 && since_mm < least_mm ? since_mm : least_mm;
    }
    return least_mm;
}

int32_t argus_flank_mm(const argus_knowledge_t *const self, const argus_mask_t except) {
    ARGUS_ASSERT(self->sonars <= ARGUS_SONARS);
    const unsigned flank = argus_robot_flank(self->robot) & ~(unsigned)except;
    int32_t nearest = INT32_MAX;
    for (int i = 0; i < self->sonars; i++) {
        if ((flank >> i & 1u) != 0 && argus_usable(self, i)) {
            nearest = argus_min(nearest, self->sonar[i].reading_mm);
        }
    }
    return nearest;
}

argus_mark_t argus_mark_now(const argus_knowledge_t *const self) {
    const argus_mark_t mark = {.sip = self->sips, .from_ms = self->sip_ms + LISTS_ALL_WAIT_MS};
    return mark;
}

bool argus_fresh_since(const argus_knowledge_t *const self, const int sonar, const argus_mark_t *const mark) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_t *const s = &self->sonar[sonar];
    const bool later = s->reported && (int32_t)(s->sip - mark->sip) > 0;
    return later && (!self->lists_all || (int32_t)(s->heard_ms - mark->from_ms) >= 0);
}

bool argus_all_fresh_since(const argus_knowledge_t *const self, const argus_mask_t sonars,
                           const argus_mark_t *const mark) {
    ARGUS_ASSERT(self->sonars <= ARGUS_SONARS);
    for (int i = 0; i < self->sonars; i++) {
        if ((sonars >> i & 1u) != 0 && !argus_fresh_since(self, i, mark)) {
            return false;
        }
    }
    return true;
}

uint32_t argus_silent_ms(const argus_knowledge_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_t *const s = &self->sonar[sonar];
    const uint32_t since_online = self->sip_ms - self->online_ms;
    const uint32_t since_heard = self->sip_ms - s->heard_ms;
    return s->reported && since_heard < since_online ? since_heard : since_online;
}

uint32_t argus_age_ms(const argus_knowledge_t *const self, const int sonar, const uint32_t now_ms) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return self->sonar[sonar].reported ? now_ms - self->sonar[sonar].heard_ms : UINT32_MAX;
}

bool argus_at_rest(const argus_knowledge_t *const self) {
    return self->still_sips >= 2;
}

argus_point_t argus_echo_robot(const argus_knowledge_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < self->sonars);
    const argus_sonar_pose_t at = argus_robot_pose(self->robot, sonar);
    const int32_t range = self->sonar[sonar].reading_mm;
    const argus_pose_t mount = {at.x_mm, at.y_mm, at.heading_deg * 100};
    return argus_to_course(&mount, (argus_point_t){range, 0});
}

argus_point_t argus_from_sonar(const argus_knowledge_t *const self, const int sonar, const argus_point_t at) {
    ARGUS_ASSERT(sonar >= 0 && sonar < self->sonars);
    const argus_sonar_pose_t from = argus_robot_pose(self->robot, sonar);
    return argus_in_frame((argus_point_t){at.x_mm - from.x_mm, at.y_mm - from.y_mm}, from.heading_deg * 100);
}

argus_frame_t argus_frame_at(const argus_pose_t *const pose) {
    return (argus_frame_t){
        {pose->x_mm, pose->y_mm}, argus_cos(pose->heading_cdeg), argus_sin(pose->heading_cdeg)};
}

argus_point_t argus_from_frame(const argus_frame_t *const frame, const argus_point_t point) {
    const int32_t x = point.x_mm * frame->cos - point.y_mm * frame->sin;
    const int32_t y = point.x_mm * frame->sin + point.y_mm * frame->cos;
    return (argus_point_t){frame->at.x_mm + x / ARGUS_TRIG_ONE, frame->at.y_mm + y / ARGUS_TRIG_ONE};
}

argus_point_t argus_into_frame(const argus_frame_t *const frame, const argus_point_t point) {
    const argus_point_t off = {point.x_mm - frame->at.x_mm, point.y_mm - frame->at.y_mm};
    return (argus_point_t){(off.x_mm * frame->cos + off.y_mm * frame->sin) / ARGUS_TRIG_ONE,
                           (off.y_mm * frame->cos - off.x_mm * frame->sin) / ARGUS_TRIG_ONE};
}

argus_point_t argus_to_course(const argus_pose_t *const pose, const argus_point_t robot) {
    const argus_frame_t frame = argus_frame_at(pose);
    return argus_from_frame(&frame, robot);
}

int32_t argus_echo_to_centre_mm(const argus_knowledge_t *const self, const int sonar, const int32_t back_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(back_mm >= 0);
    const argus_point_t echo = argus_echo_robot(self, sonar);
    return argus_usable(self, sonar) ? argus_hypot(echo.x_mm + back_mm, echo.y_mm) : INT32_MAX;
}

int32_t argus_nearest_to_centre_mm(const argus_knowledge_t *const self, const int32_t back_mm) {
    ARGUS_ASSERT(self->sonars <= ARGUS_SONARS);
    ARGUS_ASSERT(back_mm >= 0);
    int32_t nearest = INT32_MAX;
    for (int i = 0; i < self->sonars; i++) {
        nearest = argus_min(nearest, argus_echo_to_centre_mm(self, i, back_mm));
    }
    return nearest;
}

argus_mask_t argus_living(const argus_knowledge_t *const self, const uint32_t stale_ms,
                          const uint32_t now_ms) {
    unsigned trusted = 0;
    unsigned named = 0;
    for (int i = 0; i < self->sonars; i++) {
        const bool late = argus_age_ms(self, i, now_ms) > stale_ms;
        const bool heard = !late && self->sonar[i].health != ARGUS_STALE && !argus_is_out(self, i);
        trusted |= heard && argus_trusted(self, i) ? 1u << i : 0u;
        named |= heard && !argus_trusted(self, i) ? 1u << i : 0u;
    }
    return (argus_mask_t)(trusted != 0 ? trusted : named);
}

int argus_nearest_ahead(const argus_knowledge_t *const self) {
    int nearest = -1;
    for (int i = 0; i < self->sonars; i++) {
        if (argus_counts_ahead(self, i) && self->sonar[i].reported && !argus_is_out(self, i) &&
            (nearest < 0 || argus_reading_ahead_mm(self, i) < argus_reading_ahead_mm(self, nearest))) {
            nearest = i;
        }
    }
    return nearest;
}
