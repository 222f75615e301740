// SPDX-License-Identifier: MIT
// Compares steps of the odometry with what wheels can do.
#include "knowledge/odometry.h"

#include "arcos/gen_arcos.h"
#include "argus/argus.h"
#include "knowledge/angle.h"

#define LATE_MS 150           // one that comes in time may follow one that came late
#define LATE_MOST_MS 350      // ... but by no more than this, of
#define FADES_MS 5            // ... which so much is over with each SIP
#define GAP_MS 500u           // without a SIP for longer it is not known what the wheels did
#define GAP_MAX_MS 4000u      // ... but the robot's watchdog has stopped them
#define FASTEST_MM_S 2000     // no robot of the tables drives as fast
#define DRIVES_MM_S 750       // the fastest that it is ever ordered
#define TURNS_CDEG_S 10000    // likewise
#define REST_MM_S 5           // encoders tremble
#define CREEP_MM_S 20         // ... and so far wheels are from turning it quite on the spot
#define BEND_CDEG 4500        // more than it turns on its way to a place, while nobody sees it
#define TURNING_CDEG_S 500    // ... which straight wheels do not look like
#define ACCEL_MM_S2 2000      // the hardest that wheels speed up or brake
#define ACCEL_CDEG_S2 30000   // likewise
#define ACCEL_MM 300          // in a gap they reach their speed
#define ACCEL_CDEG 3000       // likewise
#define SLACK_PERCENT 3       // speeds are rounded and averaged
#define TURN_SLACK_PERCENT 50 // ... and wheels that skid turn the body less than their track says
#define SLACK_MM 1            // in each SIP
#define SLACK_CDEG 30         // likewise
#define BENDS_CDEG 300        // ... and wheels that skid bend the way
#define ROOM_MM 20            // in one step, for what is not modelled,
#define ROOM_CDEG 200         // likewise
#define ROOM_MS 50            // ... and of the speed
#define BUILD_MM 80           // what may build up
#define BUILD_CDEG 3000       // likewise
#define ANEW_MM 100           // the way through a gap is not known better,
#define NEXT_MM 20            // ... and that from one SIP to the next not better than this
#define CDEG_PER_RADIAN 5730
#define PER_S_MAX 500000 // of what is multiplied by milliseconds: it fits 32 bits for 4 s

static int32_t turn_cdeg_s(const argus_wheels_t *const wheels, const int32_t track_mm) {
    ARGUS_ASSERT(track_mm > 0);
    const int32_t most = 2 * FASTEST_MM_S;
    const int32_t apart = wheels->right_mm_s - wheels->left_mm_s;
    return argus_within(most, apart) * CDEG_PER_RADIAN / track_mm;
}

// Of a speed, within a time up to some seconds.
static int32_t times_ms(const int32_t per_s, const int32_t ms) {
    ARGUS_ASSERT(ms >= 0 && ms <= (int32_t)GAP_MAX_MS + LATE_MS && argus_abs(per_s) <= PER_S_MAX);
    return per_s * ms / 1000;
}

static int32_t elapsed_ms(const argus_span_t *const span) {
    return (int32_t)(span->elapsed_ms < GAP_MAX_MS ? span->elapsed_ms : GAP_MAX_MS);
}

int32_t argus_odometry_speed_mm_s(const int32_t mm_s) {
    return argus_within(FASTEST_MM_S, mm_s);
}

bool argus_odometry_is_speed(const int32_t mm_s) {
    return argus_abs(mm_s) <= FASTEST_MM_S;
}

argus_way_turn_t argus_odometry_by_wheels(const argus_span_t *const span) {
    ARGUS_ASSERT(span->track_mm > 0);
    const int32_t ms = argus_min(elapsed_ms(span), ARCOS_TIMING_SIP_CYCLE_MS);
    const argus_wheels_t mean = {(span->before.left_mm_s + span->after.left_mm_s) / 2,
                                 (span->before.right_mm_s + span->after.right_mm_s) / 2};
    const int32_t speed = argus_within(FASTEST_MM_S, (mean.left_mm_s + mean.right_mm_s) / 2);
    const argus_way_turn_t moved = {times_ms(speed, ms), times_ms(turn_cdeg_s(&mean, span->track_mm), ms)};
    return moved;
}

// Within a step a speed lies between those of its ends, for a time between these; in a gap it may be any.
typedef struct {
    int32_t least;
    int32_t most;
    int32_t least_ms;
    int32_t most_ms;
} range_t;

static range_t range_of(const argus_span_t *const span, const int32_t credit_ms, const int32_t before,
                        const int32_t after, const int32_t gap) {
    const int32_t ms = elapsed_ms(span);
    ARGUS_ASSERT(gap >= 0 && credit_ms >= 0);
    const int32_t any = span->elapsed_ms > GAP_MS || credit_ms > (int32_t)GAP_MS ? gap : 0;
    return (range_t){.least = argus_min(argus_min(before, after), any > 0 ? -any : INT32_MAX),
                     .most = argus_max(argus_max(before, after), any > 0 ? any : INT32_MIN),
                     .least_ms = argus_min(ARCOS_TIMING_SIP_CYCLE_MS, ms),
                     .most_ms = argus_between(ms, GAP_MAX_MS, ARCOS_TIMING_SIP_CYCLE_MS + credit_ms)};
}

// What a change of speed may add that no SIP shows: half of the time faster, half slower.
static int32_t sped(const range_t *const range, const int32_t accel, const int32_t most) {
    const int32_t ms = argus_max(0, range->most_ms - ARCOS_TIMING_SIP_CYCLE_MS);
    return argus_min(most, times_ms(times_ms(accel, ms), ms) / 4);
}

// By how much a step is farther than the range allows, and by how much it falls short. Negative: it is
// within, and what has built up fades by as much.
typedef struct {
    int32_t over;
    int32_t under;
} beyond_t;

static int32_t slack_of(const int32_t value, const int32_t percent) {
    return argus_abs(value) * percent / 100;
}

static beyond_t beyond(const range_t *const range, const int32_t moved, const int32_t percent,
                       const int32_t slack) {
    const int32_t most = times_ms(range->most, range->most > 0 ? range->most_ms : range->least_ms);
    const int32_t least = times_ms(range->least, range->least > 0 ? range->least_ms : range->most_ms);
    ARGUS_ASSERT(slack >= 0);
    return (beyond_t){moved - most - slack_of(most, percent) - slack,
                      least - moved - slack_of(least, percent) - slack};
}

// A step by itself, and what builds up.
static bool takes(int32_t *const sum, const int32_t step, const int32_t room, const int32_t most) {
    ARGUS_ASSERT(*sum >= 0);
    *sum = argus_max(0, *sum + step);
    return step <= room && *sum <= most;
}

static int32_t fastest(const range_t *const range) {
    return argus_max(argus_abs(range->most), argus_abs(range->least));
}

static bool way_may_be(argus_excess_t *const self, const argus_span_t *const span,
                       const argus_moved_t *const moved) {
    const range_t range =
        range_of(span, self->credit_ms, (span->before.left_mm_s + span->before.right_mm_s) / 2,
                 (span->after.left_mm_s + span->after.right_mm_s) / 2, DRIVES_MM_S);
    const int32_t slack = SLACK_MM + sped(&range, ACCEL_MM_S2, ACCEL_MM);
    const int32_t near = times_ms(fastest(&range), ROOM_MS);
    // A turn bends the way, to a side by half of it at most; what else is aside of it is no way.
    const int32_t bend_cdeg = BENDS_CDEG + argus_abs(moved->turn_cdeg) / 2;
    const int32_t bend_mm = argus_abs(moved->ahead_mm) * bend_cdeg / CDEG_PER_RADIAN;
    const int32_t aside = argus_abs(moved->aside_mm) - bend_mm - slack;
    const beyond_t way = beyond(&range, moved->ahead_mm, SLACK_PERCENT, slack);
    return takes(&self->ahead_mm, way.over, ROOM_MM + near, BUILD_MM + near) &&
           takes(&self->back_mm, way.under, ROOM_MM + near, BUILD_MM + near) &&
           takes(&self->aside_mm, aside, ROOM_MM + near, BUILD_MM + near);
}

static bool turn_may_be(argus_excess_t *const self, const argus_span_t *const span,
                        const argus_moved_t *const moved) {
    const int32_t before = turn_cdeg_s(&span->before, span->track_mm);
    const int32_t after = turn_cdeg_s(&span->after, span->track_mm);
    // It begins no turn by itself, but it ends one.
    const int32_t gap = argus_abs(before) > TURNING_CDEG_S ? TURNS_CDEG_S : 0;
    const range_t range = range_of(span, self->credit_ms, before, after, gap);
    const int32_t slack = SLACK_CDEG + sped(&range, ACCEL_CDEG_S2, ACCEL_CDEG);
    const int32_t near = times_ms(fastest(&range), ROOM_MS);
    const beyond_t turn = beyond(&range, moved->turn_cdeg, TURN_SLACK_PERCENT, slack);
    return takes(&self->left_cdeg, turn.over, ROOM_CDEG + near, BUILD_CDEG + near) &&
           takes(&self->right_cdeg, turn.under, ROOM_CDEG + near, BUILD_CDEG + near);
}

static bool was_moving(const argus_wheels_t *const wheels) {
    return argus_abs(wheels->left_mm_s) > REST_MM_S || argus_abs(wheels->right_mm_s) > REST_MM_S;
}

bool argus_odometry_is_unseen(const argus_span_t *const span, const argus_order_t *const order) {
    return (order->under_way || was_moving(&span->before)) &&
           span->elapsed_ms > ARCOS_TIMING_SIP_CYCLE_MS + LATE_MS;
}

static int32_t faster_mm_s(const argus_wheels_t *const wheels) {
    return argus_max(argus_abs(wheels->left_mm_s), argus_abs(wheels->right_mm_s));
}

int32_t argus_odometry_unseen_mm(const argus_span_t *const span, const argus_order_t *const order) {
    const int32_t before = faster_mm_s(&span->before);
    const int32_t most = argus_max(order->speed_mm_s, argus_max(before, faster_mm_s(&span->after)));
    const int32_t ms = elapsed_ms(span);
    const int32_t driven_ms = argus_min(ms, order->watchdog_ms);
    const int32_t accel_ms = argus_min(driven_ms, (most - before) * 1000 / argus_max(1, order->accel_mm_s2));
    const int32_t gained = argus_min(most - before, times_ms(order->accel_mm_s2, accel_ms));
    const int32_t speed = before + gained;
    ARGUS_ASSERT(speed >= 0 && gained >= 0 && driven_ms >= 0);
    const int32_t braking = speed * speed / argus_max(1, 2 * order->decel_mm_s2);
    const int32_t way_mm = times_ms(speed, driven_ms) - times_ms(gained, accel_ms) / 2 +
                           argus_min(times_ms(speed, ms - driven_ms), braking);
    return order->way_mm > 0 ? argus_min(way_mm, order->way_mm) : way_mm;
}

// The way of so many SIPs: those before the one that came got lost, and its speeds tell less of them.
// Wheels that stand all at once show that more time went by than that.
static bool is_way_of(const argus_span_t *const span, const argus_moved_t *const step, const int32_t sips) {
    const argus_way_turn_t next = argus_odometry_by_wheels(span);
    const int32_t left_mm_s = argus_abs(span->after.left_mm_s - span->before.left_mm_s);
    const int32_t right_mm_s = argus_abs(span->after.right_mm_s - span->before.right_mm_s);
    return argus_max(left_mm_s, right_mm_s) <= times_ms(ACCEL_MM_S2, sips * ARCOS_TIMING_SIP_CYCLE_MS) &&
           argus_abs(step->ahead_mm - sips * next.way_mm) <= sips * NEXT_MM &&
           argus_abs(step->turn_cdeg - sips * next.turn_cdeg) <= sips * ROOM_CDEG;
}

static bool is_way_of_silence(const argus_span_t *const span, const argus_moved_t *const step,
                              const int32_t rolled_mm) {
    const int32_t turn_cdeg = argus_odometry_by_wheels(span).turn_cdeg;
    return argus_abs(step->turn_cdeg - turn_cdeg) <= ROOM_CDEG &&
           argus_abs(argus_abs(step->ahead_mm) - rolled_mm) <= ANEW_MM;
}

// What was held up comes in a bunch: its first is the next one, or, where the silence cut that, the one
// after.
static bool is_as_expected(const argus_span_t *const span, const argus_moved_t *const step,
                           const int32_t rolled_mm) {
    return is_way_of(span, step, 1) || is_way_of(span, step, 2) || is_way_of_silence(span, step, rolled_mm);
}

// One that turns on the spot makes no way, and one that drives to a place no great turn: counters that begin
// anew meanwhile stay near zero in that.
static bool may_be_from_zero(const argus_span_t *const span, const argus_order_t *const order,
                             const argus_way_turn_t *const from_zero) {
    const int32_t speed_mm_s = (span->before.left_mm_s + span->before.right_mm_s) / 2;
    if (order->way_mm > 0) {
        return argus_abs(from_zero->turn_cdeg) <= BEND_CDEG;
    }
    return argus_abs(speed_mm_s) > CREEP_MM_S || from_zero->way_mm <= NEXT_MM;
}

bool argus_odometry_may_be_anew(const argus_span_t *const span, const argus_order_t *const order,
                                const argus_moved_t *const step, const argus_way_turn_t *const from_zero) {
    ARGUS_ASSERT(from_zero->way_mm >= 0 && span->track_mm > 0);
    const int32_t rolled_mm = argus_odometry_unseen_mm(span, order);
    const int32_t turn_cdeg = argus_abs(from_zero->turn_cdeg);
    const int32_t wheel_mm = from_zero->way_mm + turn_cdeg * span->track_mm / (2 * CDEG_PER_RADIAN);
    return span->elapsed_ms > GAP_MS && wheel_mm <= rolled_mm + ANEW_MM &&
           may_be_from_zero(span, order, from_zero) && !is_as_expected(span, step, rolled_mm);
}

bool argus_odometry_may_be(argus_excess_t *const excess, const argus_span_t *const span,
                           const argus_moved_t *const moved) {
    ARGUS_ASSERT(span->track_mm > 0 && excess->credit_ms >= 0);
    const int32_t credit_ms = excess->credit_ms + elapsed_ms(span) - ARCOS_TIMING_SIP_CYCLE_MS - FADES_MS;
    const int32_t late_ms = (int32_t)(span->late_ms < GAP_MAX_MS ? span->late_ms : GAP_MAX_MS);
    excess->credit_ms = argus_between(0, argus_max(LATE_MOST_MS, late_ms), credit_ms);
    const argus_excess_t was = *excess;
    const bool way = way_may_be(excess, span, moved);
    const bool turn = turn_may_be(excess, span, moved);
    if (way && turn) {
        return true;
    }
    *excess = (argus_excess_t){.credit_ms = excess->credit_ms,
                               .out_mm = was.ahead_mm - was.back_mm,
                               .out_cdeg = was.left_cdeg - was.right_cdeg};
    return false;
}
