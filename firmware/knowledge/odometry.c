// SPDX-License-Identifier: MIT
// Compares steps of the odometry with what wheels can do.
#include "knowledge/odometry.h"

#include "argus/argus.h"
#include "knowledge/angle.h"

#define SIP_MS 100          // SIPs that come in a bunch were made so long apart
#define LATE_MS 150         // ... and one that comes in time may follow one that came late
#define GAP_MS 500u         // without a SIP for longer it is not known what the wheels did
#define GAP_MAX_MS 4000u    // ... but the robot's watchdog has stopped them
#define FASTEST_MM_S 2000   // no robot of the tables drives as fast
#define DRIVES_MM_S 750     // the fastest that it is ever ordered
#define TURNS_CDEG_S 10000  // likewise
#define REST_MM_S 5         // encoders tremble
#define TURNING_CDEG_S 500  // ... which straight wheels do not look like
#define ACCEL_MM_S2 2000    // the hardest that wheels speed up or brake
#define ACCEL_CDEG_S2 30000 // likewise
#define ACCEL_MM 300        // in a gap they reach their speed
#define ACCEL_CDEG 3000     // likewise
#define ROOM_MM 100         // for what is not modelled
#define ROOM_CDEG 400       // likewise
#define EXCESS_MM 250       // what may build up
#define EXCESS_CDEG 3000    // likewise
#define LOST_MS 300         // ... and of SIPs that were lost in a bunch
#define SLACK_PERCENT 110   // speeds are rounded and averaged
#define SLACK_MM 2          // in each SIP
#define SLACK_CDEG 30       // likewise
#define SURE_PERCENT 70     // of what the wheels say is made for sure
#define SHORT_MM 500        // what may be missing of it
#define SHORT_CDEG 4500     // likewise
#define CDEG_PER_RADIAN 5730
#define PER_S_MAX 500000 // of what is multiplied by milliseconds: it fits 32 bits for 4 s

static int32_t fastest_mm_s(const argus_span_t *const span) {
    const int32_t before = argus_max(argus_abs(span->before.left_mm_s), argus_abs(span->before.right_mm_s));
    const int32_t after = argus_max(argus_abs(span->after.left_mm_s), argus_abs(span->after.right_mm_s));
    const int32_t gap = span->elapsed_ms > GAP_MS ? DRIVES_MM_S : 0;
    ARGUS_ASSERT(before >= 0 && after >= 0);
    return argus_min(FASTEST_MM_S, argus_max(gap, argus_max(before, after)));
}

static int32_t turn_cdeg_s(const argus_wheels_t *const wheels, const int32_t track_mm) {
    ARGUS_ASSERT(track_mm > 0);
    const int32_t most = 2 * FASTEST_MM_S;
    const int32_t apart = wheels->right_mm_s - wheels->left_mm_s;
    return argus_max(-most, argus_min(most, apart)) * CDEG_PER_RADIAN / track_mm;
}

static int32_t fastest_cdeg_s(const argus_span_t *const span) {
    const int32_t before = argus_abs(turn_cdeg_s(&span->before, span->track_mm));
    const int32_t after = argus_abs(turn_cdeg_s(&span->after, span->track_mm));
    // It begins no turn by itself, but it ends one.
    const int32_t gap = span->elapsed_ms > GAP_MS && before > TURNING_CDEG_S ? TURNS_CDEG_S : 0;
    return argus_max(gap, argus_max(before, after));
}

// Of a speed, within a time up to some seconds.
static int32_t times_ms(const int32_t per_s, const int32_t ms) {
    ARGUS_ASSERT(ms >= 0 && ms <= (int32_t)GAP_MAX_MS + LATE_MS && argus_abs(per_s) <= PER_S_MAX);
    return per_s * ms / 1000;
}

static int32_t elapsed_ms(const argus_span_t *const span) {
    return (int32_t)(span->elapsed_ms < GAP_MAX_MS ? span->elapsed_ms : GAP_MAX_MS);
}

bool argus_odometry_is_speed(const int32_t mm_s) {
    return argus_abs(mm_s) <= FASTEST_MM_S;
}

argus_way_turn_t argus_odometry_by_wheels(const argus_span_t *const span) {
    ARGUS_ASSERT(span->track_mm > 0);
    const int32_t ms = argus_min(elapsed_ms(span), SIP_MS);
    const argus_wheels_t mean = {(span->before.left_mm_s + span->after.left_mm_s) / 2,
                                 (span->before.right_mm_s + span->after.right_mm_s) / 2};
    const int32_t speed =
        argus_max(-FASTEST_MM_S, argus_min(FASTEST_MM_S, (mean.left_mm_s + mean.right_mm_s) / 2));
    const argus_way_turn_t moved = {times_ms(speed, ms), times_ms(turn_cdeg_s(&mean, span->track_mm), ms)};
    return moved;
}

static bool may_be_alone(const argus_span_t *const span, const argus_way_turn_t *const moved) {
    const int32_t ms = elapsed_ms(span) + LATE_MS;
    const int32_t sped_mm = argus_min(ACCEL_MM, times_ms(times_ms(ACCEL_MM_S2, ms), ms) / 2);
    const int32_t sped_cdeg = argus_min(ACCEL_CDEG, times_ms(times_ms(ACCEL_CDEG_S2, ms), ms) / 2);
    return moved->way_mm <= times_ms(fastest_mm_s(span), ms) + sped_mm + ROOM_MM &&
           moved->turn_cdeg <= times_ms(fastest_cdeg_s(span), ms) + sped_cdeg + ROOM_CDEG;
}

static int32_t build_up(const int32_t excess, const int32_t moved, const int32_t by_wheels,
                        const int32_t slack) {
    ARGUS_ASSERT(excess >= 0 && slack >= 0);
    return argus_max(0, excess + moved - by_wheels * SLACK_PERCENT / 100 - slack);
}

// Of what the wheels say the odometry shows nothing: a value that is frozen.
static bool falls_short(argus_excess_t *const self, const argus_span_t *const span,
                        const argus_way_turn_t *const moved) {
    const argus_way_turn_t said = argus_odometry_by_wheels(span);
    self->short_mm =
        build_up(self->short_mm, argus_abs(said.way_mm) * SURE_PERCENT / 100, moved->way_mm, SLACK_MM);
    self->short_cdeg = build_up(self->short_cdeg, argus_abs(said.turn_cdeg) * SURE_PERCENT / 100,
                                moved->turn_cdeg, SLACK_CDEG);
    return self->short_mm > SHORT_MM || self->short_cdeg > SHORT_CDEG;
}

static bool builds_up(argus_excess_t *const self, const argus_span_t *const span,
                      const argus_way_turn_t *const moved) {
    const int32_t ms = argus_max(SIP_MS, elapsed_ms(span));
    const int32_t mm_s = fastest_mm_s(span);
    const int32_t cdeg_s = fastest_cdeg_s(span);
    self->way_mm = build_up(self->way_mm, moved->way_mm, times_ms(mm_s, ms), SLACK_MM);
    self->turn_cdeg = build_up(self->turn_cdeg, moved->turn_cdeg, times_ms(cdeg_s, ms), SLACK_CDEG);
    return self->way_mm > EXCESS_MM + times_ms(mm_s, LOST_MS) ||
           self->turn_cdeg > EXCESS_CDEG + times_ms(cdeg_s, LOST_MS);
}

static bool was_moving(const argus_wheels_t *const wheels) {
    return argus_abs(wheels->left_mm_s) > REST_MM_S || argus_abs(wheels->right_mm_s) > REST_MM_S;
}

bool argus_odometry_is_unseen(const argus_span_t *const span, const bool under_way) {
    return (under_way || was_moving(&span->before)) && span->elapsed_ms > SIP_MS + LATE_MS;
}

int32_t argus_odometry_unseen_mm(const argus_span_t *const span) {
    ARGUS_ASSERT(span->track_mm > 0);
    return times_ms(fastest_mm_s(span), elapsed_ms(span));
}

bool argus_odometry_may_be(argus_excess_t *const excess, const argus_span_t *const span,
                           const argus_way_turn_t *const moved) {
    ARGUS_ASSERT(moved->way_mm >= 0 && moved->turn_cdeg >= 0);
    const bool far = builds_up(excess, span, moved);
    const bool frozen = falls_short(excess, span, moved);
    if (!far && !frozen && may_be_alone(span, moved)) {
        return true;
    }
    *excess = (argus_excess_t){0};
    return false;
}
