// SPDX-License-Identifier: MIT
// The safety rules S1 to S7 (DESIGN.md) as questions: may it turn, how far may it go ahead or back? Nothing
// is changed.
#ifndef ARGUS_GUARD_H
#define ARGUS_GUARD_H

#include "argus/argus.h"
#include "knowledge/echoes.h"
#include "knowledge/knowledge.h"
#include "knowledge/profile.h"
#include "knowledge/rays.h"

#define ARGUS_LEAD_MM 4000u // without an echo: a sonar hears what stands in the way from farther off

// Half of what is driven straight along, ahead or back, without a turn: half the body, and something for its
// heading.
int32_t argus_guard_straight_half_mm(const argus_robot_t *robot);

// The last change of the leading end, or the beginning of the session.
typedef struct {
    uint32_t odometer_mm;
    bool done; // there was a change
} argus_reverse_t;

// What the answers rest on.
typedef struct {
    const argus_config_t *config;
    const argus_profile_t *profile;
    const argus_knowledge_t *knowledge;
    const argus_echoes_t *echoes;
    const argus_rays_t *rays;
    uint32_t now_ms;
    argus_reverse_t reverse;
    int32_t faster_mm_s; // than it is set, it has been seen to drive; 0: it keeps to that
    int32_t late_ms;     // the link, beyond what S5 counts on
    uint16_t bumpers;    // pressed, as far as they were answered
    uint8_t backed;      // back-offs in this place
    bool active;         // it may command motions: neither passive nor leaving
    bool linked;         // a session is open and SIPs come
    bool checked;        // a full health check has passed since then
    bool squeezes;       // it has waited for room to turn: what the body needs will do
    bool creeps;         // no sonar sees the way, and the operator lets it creep
} argus_guard_t;

// Ahead ----------------------------------------------------------------------------------------------------

// S1: it drives with every bearing ahead in use. Where the profile lets it, it drives as far as living sonars
// have seen the way of the body. It may step while the others cover for those that are out.
bool argus_guard_may_drive(const argus_guard_t *self, const argus_plan_t *plan);
bool argus_guard_may_step(const argus_plan_t *plan);

// Those ahead that have the name of a fault, and no neighbour that sees on the way what they may not.
argus_mask_t argus_guard_alone(const argus_guard_t *self);

// A sonar that looks ahead is out, or one of those; how far the way has been seen nonetheless, less some
// margin. INT32_MAX: none is, or the profile does not ask.
bool argus_guard_is_blind(const argus_guard_t *self);

// The most of those side by side: by so many halves of a pitch the heading must swing for others to see
// there.
int argus_guard_gap(const argus_guard_t *self);

int32_t argus_guard_seen_mm(const argus_guard_t *self);

// S2, S6: motors on, SIPs come, a full check has passed, no bumper is pressed.
bool argus_guard_may_translate(const argus_guard_t *self);

// The other end's turn to lead: on the last 4 m, on which this one led, none of its sonars in use that look
// ahead has heard an echo; on the first metre of a session where none was ever heard. So far the other one
// would have heard what stands ahead.
bool argus_guard_has_led(const argus_guard_t *self);

// S5: one of the sonars in use that look ahead has heard an echo in this session, and not so long ago, or the
// profile does not ask. Where none looks ahead, the whole ring counts. Where nothing is heard a free way and
// a dead ring look alike.
bool argus_guard_is_heard(const argus_guard_t *self);

// No sonar sees the way, and the operator lets it creep on its bumpers alone.
bool argus_guard_may_creep(const argus_guard_t *self);

// Where what lies ahead may be touched: the speed of creeping or, without leave for that, of a step.
int32_t argus_guard_unseen_mm_s(const argus_guard_t *self);

// S1, S5: the longest MOVE that normal driving may ask for now, never negative. It is the shortest front
// reading less the way driven since and less the object range, but no farther than `seen_mm`. That is of
// argus_guard_seen_mm(), which costs more than all the rest.
int32_t argus_guard_ahead_mm(const argus_guard_t *self, int32_t seen_mm);

// How far before the sonars' faces the body would meet what it has touched before; INT32_MAX: not straight
// ahead. Whatever the sonars hear, it stands there.
int32_t argus_guard_touched_mm(const argus_guard_t *self);

// What it drives on at its present speed while the link is late: until a MOVE takes effect.
int32_t argus_guard_unseen_way_mm(const argus_guard_t *self);

// S2, S5: how far before the sonars' faces what was heard a moment ago stands in the way of the body, though
// none hears it now: a smooth wall turns echoes away, and the end of one gives hardly any.
int32_t argus_guard_heard_mm(const argus_guard_t *self);

// S5: the speed for the way ahead, `speed_mm_s`. Where the profile adapts it and nothing is close beside, it
// is what the shortest front reading allows, and what was heard in the way, up to `speed_max_mm_s`. Where a
// sonar is doubted, what others have seen limits it, too.
int32_t argus_guard_speed_mm_s(const argus_guard_t *self, int32_t seen_mm);
// ... and were nothing doubted.
int32_t argus_guard_free_speed_mm_s(const argus_guard_t *self, int32_t seen_mm);

// S2: every sonar in use that looks ahead has been refreshed within two rounds of its array.
bool argus_guard_sees_ahead(const argus_guard_t *self);

// In which each sonar of an array has been listed twice.
uint32_t argus_guard_two_rounds_ms(const argus_config_t *config);

// Turning --------------------------------------------------------------------------------------------------

// S4: near enough to the heading that a sweep or a verification began on.
bool argus_guard_is_home(const argus_guard_t *self, int32_t base_cdeg);

// S7: no bumper pressed, nothing within the circle that the body sweeps.
bool argus_guard_may_turn(const argus_guard_t *self);
bool argus_guard_swing_is_blocked(const argus_guard_t *self);

// S7, where the profile lets it: a turn of at most 20 degrees from here. In it the body keeps 40 mm from all
// that is seen or was seen a moment ago. Cost: six places of the body for each echo.
bool argus_guard_may_nudge(const argus_guard_t *self, int32_t by_cdeg);

// The distance of what would be nearest to the robot's centre, were it `back_mm` farther back. It counts what
// is seen and, where the profile says so, what was seen a moment ago. INT32_MAX: nothing.
int32_t argus_guard_nearest_mm(const argus_guard_t *self, int32_t back_mm);

// The echo that this sonar hears now forbids to turn. What is remembered does.
bool argus_guard_echo_blocks(const argus_guard_t *self, int sonar);
// One of those whose echo does, or ARGUS_NO_SONAR.
int argus_guard_barring(const argus_guard_t *self);
bool argus_guard_memory_blocks(const argus_guard_t *self);

// In a turn: the echo of this sonar, just heard, lies within the circle, for the first time or again. `at`:
// where, course frame; `left`: on which side.
typedef enum { ARGUS_TOUCH_NONE, ARGUS_TOUCH_FIRST, ARGUS_TOUCH_AGAIN } argus_touch_t;
argus_touch_t argus_guard_touch(const argus_guard_t *self, int sonar, argus_point_t *at, bool *left);

// Back -----------------------------------------------------------------------------------------------------

// S7: all sonars of the rear report, none of them is out or has the name of a fault; and all of them read
// clear.
bool argus_guard_rear_is_watched(const argus_guard_t *self);
bool argus_guard_rear_is_clear(const argus_guard_t *self);

// The rear is clear; or, while it creeps and the rear is not watched, no bumper there is pressed.
bool argus_guard_may_back(const argus_guard_t *self);

// S7: it may back away to make room for a turn; how far, and how fast S5 allows it with the rear's overhang.
bool argus_guard_may_back_off(const argus_guard_t *self);
int32_t argus_guard_back_mm(const argus_guard_t *self);
int32_t argus_guard_back_speed_mm_s(const argus_guard_t *self);

#endif
