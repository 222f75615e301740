// SPDX-License-Identifier: MIT
// VEL, MOVE, VEL2, RVEL and HEAD of a client under S1, S2, S5 and S7.
#include "guardian/hold.h"

#include <string.h>

#include "adjustment/motion.h"
#include "behaviour/state.h"
#include "knowledge/angle.h"

#define STEP_MM_S 25    // by so much at least a speed is raised again
#define DONE_MM 20      // of a MOVE: nothing is left
#define MORE_MM 100     // that a MOVE is lengthened by at least
#define LESS_MM 30      // ... and shortened: readings scatter
#define THERE_CDEG 50   // of a HEAD, whole degrees: no turn is left
#define LOOK_CDEG 6000  // a HEAD is looked at so far ahead
#define LEAST_CDEG 1000 // ... and any other turn at least so far: little ones follow each other
#define FREE_SIPS 10
#define UNHEARD_S 2   // a robot that hears nothing for so long stands by itself
#define SPARE_MM_S 40 // above what was given: how wheels keep a speed
#define FALLS_MM_S 10 // in each SIP where it obeys: a third of the weakest brake
#define SPARE_DEG_S 8
#define FALLS_DEG_S 3
#define SLANT_MM 80u   // driven, back or another way, it is another place
#define SLANT_CDEG 300 // turned, it is another way

void argus_hold_forget(argus_hold_client_t *const self) {
    const argus_given_t before = self->given;
    memset(&self->wish, 0, sizeof self->wish);
    memset(&self->given, 0, sizeof self->given);
    self->way_due = self->turn_due = false;
    self->given.bumpers = before.bumpers;
    self->given.stalls = before.stalls;
    self->given.slanted = before.slanted;
    self->given.slant_cdeg = before.slant_cdeg;
    self->given.slant_mm = before.slant_mm;
    self->given.setv_mm_s = before.setv_mm_s;
}

// Saying so ------------------------------------------------------------------------------------------------

static void say_once(const argus_grant_t *const grant, bool *const said, const argus_event_id_t event,
                     const int32_t value) {
    if (!*said) {
        *said = true;
        argus_emit(grant->events, event, value);
    }
}

// Closed again after it was open for a while is news.
static void tell_closed(const argus_grant_t *const grant, argus_given_t *const given,
                        const argus_bound_t *const bound) {
    if (bound->speed_mm_s == 0) {
        given->open_sips = 0;
        say_once(grant, &given->held_said, ARGUS_EV_GUARD_HELD, (int32_t)bound->why);
    } else if (given->held_said) {
        given->open_sips++;
        given->held_said = given->open_sips < FREE_SIPS;
    }
}

static void tell_way(const argus_grant_t *const grant, argus_given_t *const given,
                     const argus_bound_t *const bound, const int32_t wanted_mm_s) {
    tell_closed(grant, given, bound);
    if (bound->speed_mm_s >= argus_abs(wanted_mm_s)) {
        return;
    }
    given->free_sips = 0;
    if (bound->speed_mm_s > 0) {
        say_once(grant, &given->slowed_said, ARGUS_EV_GUARD_SLOWED, bound->speed_mm_s);
    }
}

// A bound that comes and goes is one.
static void tell_free(const argus_grant_t *const grant, argus_given_t *const given) {
    given->free_sips = (uint8_t)argus_min(given->free_sips + 1, FREE_SIPS);
    if ((given->held_said || given->slowed_said || given->turn_said) && given->free_sips >= FREE_SIPS) {
        given->held_said = given->slowed_said = given->turn_said = false;
        given->free_sips = 0;
        argus_emit(grant->events, ARGUS_EV_GUARD_FREE, 0);
    }
}

// The way --------------------------------------------------------------------------------------------------

static void set_speed(const argus_grant_t *const grant, argus_hold_client_t *const self, const int32_t mm_s) {
    ARGUS_ASSERT(mm_s > 0);
    if (mm_s != self->given.setv_mm_s && argus_outbox_int(grant->out, ARCOS_CMD_SETV, mm_s)) {
        self->given.setv_mm_s = mm_s;
    }
}

static void stand(const argus_grant_t *const grant, argus_hold_client_t *const self, const bool anyway) {
    argus_given_t *const given = &self->given;
    if (!given->rolls && !anyway) {
        return;
    }
    if (argus_outbox_int(grant->out, ARCOS_CMD_VEL, 0)) {
        given->rolls = given->moves = false;
        given->mm_s = given->move_mm = given->right = given->left = 0;
    }
}

// As much of the speed as the bound lets, in steps; what is given stays while it may.
static int32_t bounded(const argus_bound_t *const bound, const int32_t wanted_mm_s,
                       const int32_t given_mm_s) {
    const int32_t most_mm_s = bound->speed_mm_s;
    const int32_t wanted = argus_abs(wanted_mm_s);
    const bool same_way = (wanted_mm_s < 0) == (given_mm_s < 0);
    const int32_t given = same_way ? argus_abs(given_mm_s) : 0;
    int32_t speed = argus_min(wanted, most_mm_s);
    if (speed < wanted) {
        speed = argus_max(speed / STEP_MM_S * STEP_MM_S, argus_min(speed, STEP_MM_S));
        speed = given <= most_mm_s && given > speed ? given : speed;
    }
    return wanted_mm_s < 0 ? -speed : speed;
}

static int32_t in_units(const int32_t mm_s) {
    return argus_within(127, mm_s / ARGUS_VEL2_UNIT_MM_S);
}

// Of the right and the left wheel, in its units.
static bool send_pair(const argus_grant_t *const grant, const int32_t right, const int32_t left) {
    const uint8_t data[] = {ARCOS_CMD_VEL2, ARCOS_ARG_POSITIVE, (uint8_t)right, (uint8_t)left};
    return argus_outbox_packet(grant->out, data, sizeof data);
}

// What the robot turns on until it stands, were its turn ended with the next command. It turns no faster than
// the SETRV that passes.
static int32_t until_rest_cdeg(const int32_t deg_s) {
    const int32_t speed = argus_within(ARGUS_CLIENT_TURN_DEG_S, deg_s);
    const int32_t ahead_cdeg = argus_abs(speed) * ARGUS_CLIENT_REACTION_MS / 10 +
                               speed * speed * 100 / (2 * ARGUS_CLIENT_TURN_DECEL);
    return speed < 0 ? -ahead_cdeg : ahead_cdeg;
}

static argus_permit_t ask_turn(const argus_t *const core, const int32_t by_cdeg) {
    return argus_permit(core, (argus_ask_t){ARGUS_MOVER_CLIENT, ARGUS_WANTS_TURN, by_cdeg});
}

// At least so far.
static int32_t widened(const int32_t by_cdeg, const int32_t least_cdeg) {
    return by_cdeg < 0 ? argus_min(by_cdeg, -least_cdeg) : argus_max(by_cdeg, least_cdeg);
}

static argus_permit_t ask_speed(const argus_t *const core, const int32_t deg_s) {
    return deg_s == 0 ? ARGUS_PERMIT_GIVEN : ask_turn(core, widened(until_rest_cdeg(deg_s), LEAST_CDEG));
}

static void tell_turn(const argus_grant_t *const grant, argus_given_t *const given,
                      const argus_permit_t permit, const int32_t value) {
    given->free_sips = 0;
    if (permit == ARGUS_PERMIT_SWING) {
        say_once(grant, &given->turn_said, ARGUS_EV_GUARD_TURN_HELD, value);
    } else {
        given->open_sips = 0;
        say_once(grant, &given->held_said, ARGUS_EV_GUARD_HELD, (int32_t)argus_bound_why(permit));
    }
}

// Both wheels slowed alike: the curve stays. A turn on the spot is a turn, and so is what the units of VEL2
// make of a curve.
static void give_pair(const argus_grant_t *const grant, argus_hold_client_t *const self,
                      const argus_bound_t *const bound, const bool anyway) {
    const argus_wish_t *const wish = &self->wish;
    argus_given_t *const given = &self->given;
    const int32_t mm_s = bounded(bound, wish->mm_s, given->mm_s);
    const int32_t half_mm_s =
        wish->mm_s != 0 ? wish->half_mm_s * argus_abs(mm_s) / argus_abs(wish->mm_s) : wish->half_mm_s;
    int32_t right = in_units(mm_s + half_mm_s);
    int32_t left = in_units(mm_s - half_mm_s);
    const int32_t deg_s = (right - left) * ARGUS_VEL2_UNIT_MM_S * ARGUS_DEG_PER_RAD /
                          argus_max(1, grant->core->knowledge.robot->track_mm);
    const argus_permit_t permit = ask_speed(grant->core, deg_s);
    if (permit != ARGUS_PERMIT_GIVEN) {
        tell_turn(grant, given, permit, deg_s);
        right = left = in_units(mm_s);
    }
    if ((anyway || right != given->right || left != given->left) && send_pair(grant, right, left)) {
        given->mm_s = mm_s;
        given->right = (int8_t)right;
        given->left = (int8_t)left;
        given->rolls = right != 0 || left != 0;
        given->moves = false;
    }
}

static int32_t left_of(const argus_t *const core, const int32_t mm, const uint32_t odometer_mm) {
    const int32_t driven_mm = (int32_t)(core->knowledge.odometer_mm - odometer_mm);
    return mm < 0 ? argus_min(0, mm + driven_mm) : argus_max(0, mm - driven_mm);
}

static void send_move(const argus_grant_t *const grant, argus_hold_client_t *const self, const int32_t mm,
                      const int32_t mm_s) {
    argus_given_t *const given = &self->given;
    set_speed(grant, self, mm_s);
    if (argus_outbox_int(grant->out, ARCOS_CMD_MOVE, mm)) {
        given->rolls = given->moves = true;
        given->move_mm = mm;
        given->odometer_mm = grant->core->knowledge.odometer_mm;
        given->move_ms = grant->core->now_ms;
    }
}

// Whether the MOVE that the robot has is not the one that it may have now.
static bool is_other(const argus_t *const core, const argus_hold_client_t *const self, const int32_t left_mm,
                     const int32_t mm, const int32_t mm_s) {
    const argus_given_t *const given = &self->given;
    const int32_t has_mm = argus_abs(left_of(core, given->move_mm, given->odometer_mm));
    const bool longer = has_mm + DONE_MM < argus_abs(left_mm) && mm > has_mm + MORE_MM;
    return !given->moves || longer || mm + LESS_MM < has_mm || mm_s < given->setv_mm_s;
}

static bool is_on(const argus_t *const core) {
    return (core->knowledge.flags & ARCOS_FLAG_MOTORS) != 0;
}

// A robot that stands for longer than it would wait for us has lost the order.
static bool is_lost(const argus_t *const core, const argus_given_t *const given) {
    const argus_knowledge_t *const knowledge = &core->knowledge;
    const bool rests = knowledge->vel_left_mm_s == 0 && knowledge->vel_right_mm_s == 0;
    return rests && core->now_ms - given->move_ms > UNHEARD_S * 1000u + (uint32_t)core->latency.late_ms;
}

// What it was given of a way in this direction, and has not driven. An order without motors is none.
static int32_t has_mm_of(const argus_t *const core, const argus_given_t *const given, const int32_t mm_s) {
    const bool same_way = given->moves && (given->move_mm < 0) == (mm_s < 0);
    return same_way && is_on(core) && !is_lost(core, given)
               ? argus_abs(left_of(core, given->move_mm, given->odometer_mm))
               : 0;
}

// How long a MOVE is to go out, 0: none. What goes out on a link that has become late acts so much later, and
// counts from there: what the robot may drive until then is taken off.
static int32_t more_mm(const int32_t way_mm, const int32_t has_mm, const int32_t mm_s) {
    if (way_mm + LESS_MM < has_mm) {
        return way_mm;
    }
    const int32_t mm = way_mm - argus_min(has_mm, mm_s * UNHEARD_S);
    const int32_t least_mm = has_mm > DONE_MM ? has_mm + MORE_MM : DONE_MM;
    return mm > least_mm ? mm : 0;
}

// A VEL goes on until the next order, however late that comes. So a robot that is told to go on is given the
// way that is seen, and more of it as more is seen.
static void give_speed(const argus_grant_t *const grant, argus_hold_client_t *const self,
                       const argus_bound_t *const bound, const bool anyway) {
    argus_given_t *const given = &self->given;
    const int32_t mm_s = bounded(bound, self->wish.mm_s, given->mm_s);
    const int32_t most_mm_s = argus_min(argus_abs(mm_s), self->setv_mm_s);
    if (most_mm_s == 0) {
        stand(grant, self, anyway);
        return;
    }
    if (anyway) { // a SETV that was lost, too
        given->setv_mm_s = 0;
    }
    const int32_t mm = more_mm(bound->way_mm, has_mm_of(grant->core, given, mm_s), most_mm_s);
    if (mm > 0 && (anyway || is_on(grant->core))) {
        send_move(grant, self, mm_s < 0 ? -mm : mm, most_mm_s);
    } else {
        set_speed(grant, self, most_mm_s);
    }
    given->mm_s = mm_s;
    given->moves = given->moves && is_on(grant->core);
}

// A MOVE ends where it should without us, and is lengthened as more is seen.
static void give_move(const argus_grant_t *const grant, argus_hold_client_t *const self,
                      const argus_bound_t *const bound, const bool anyway) {
    const int32_t left_mm = left_of(grant->core, self->wish.left_mm, self->wish.odometer_mm);
    const int32_t mm = argus_min(argus_abs(left_mm), bound->way_mm);
    const int32_t mm_s = argus_min(self->setv_mm_s, bound->speed_mm_s / STEP_MM_S * STEP_MM_S);
    if (!anyway && argus_abs(left_mm) <= DONE_MM) {
        self->wish.way = ARGUS_WISH_REST;
    } else if (mm_s <= 0 || mm <= 0) {
        stand(grant, self, anyway);
    } else if (anyway || is_other(grant->core, self, left_mm, mm, mm_s)) {
        send_move(grant, self, left_mm < 0 ? -mm : mm, mm_s);
        self->given.mm_s = 0;
    }
}

static bool wants_ahead(const argus_t *const core, const argus_wish_t *const wish) {
    return wish->way == ARGUS_WISH_MOVE ? left_of(core, wish->left_mm, wish->odometer_mm) > 0
                                        : wish->mm_s > 0;
}

static bool is_where_it_slanted(const argus_t *const core, const argus_given_t *const given) {
    const argus_knowledge_t *const knowledge = &core->knowledge;
    return given->slanted && knowledge->odometer_mm - given->slant_mm < SLANT_MM &&
           argus_angle_abs_diff(knowledge->pose.heading_cdeg, given->slant_cdeg) <= SLANT_CDEG;
}

// A wall that only driving along it shows is forgotten by a robot that stands before it, but has not gone.
static argus_bound_t way_of(const argus_t *const core, argus_given_t *const given, const bool ahead) {
    argus_bound_t bound = argus_bound_way(core, ahead);
    if (ahead == core->knowledge.robot->reversed) { // only the end that leads sees such a wall
        return bound;
    }
    if (bound.slants) {
        given->slant_cdeg = core->knowledge.pose.heading_cdeg;
        given->slant_mm = core->knowledge.odometer_mm;
    } else if (bound.speed_mm_s > 0 && is_where_it_slanted(core, given)) {
        bound = (argus_bound_t){.speed_mm_s = 0, .why = ARGUS_BOUND_OBJECT};
    }
    given->slanted = bound.slants || is_where_it_slanted(core, given);
    return bound;
}

// Of what has no end: where no way is left it is closed. VEL2 has no length, so a speed bounds it.
static void bound_open(argus_bound_t *const bound, const bool paired) {
    if (bound->speed_mm_s > 0 && bound->way_mm <= DONE_MM) {
        *bound = (argus_bound_t){.speed_mm_s = 0, .why = ARGUS_BOUND_OBJECT};
    } else if (paired) {
        bound->speed_mm_s = argus_min(bound->speed_mm_s, argus_max(bound->way_mm / UNHEARD_S, STEP_MM_S));
    }
}

static void give_way(const argus_grant_t *const grant, argus_hold_client_t *const self, const bool anyway) {
    const argus_wish_t *const wish = &self->wish;
    const bool moves = wish->way == ARGUS_WISH_MOVE;
    if (wish->way == ARGUS_WISH_REST) { // the last of a MOVE the robot drives by itself
        if (anyway) {
            stand(grant, self, true);
        }
        return;
    }
    argus_bound_t bound = way_of(grant->core, &self->given, wants_ahead(grant->core, wish));
    if (!moves) {
        bound_open(&bound, wish->paired);
    }
    if (moves || wish->mm_s != 0) {
        tell_way(grant, &self->given, &bound, moves ? self->setv_mm_s : wish->mm_s);
    }
    if (moves) {
        give_move(grant, self, &bound, anyway);
    } else if (wish->paired) {
        give_pair(grant, self, &bound, anyway);
    } else {
        give_speed(grant, self, &bound, anyway);
    }
}

// The turn -------------------------------------------------------------------------------------------------

static int32_t raw_cdeg(const argus_t *const core) {
    return argus_angle_wrap(core->knowledge.pose.heading_cdeg - argus_heading_offset_cdeg(&core->knowledge));
}

static int32_t left_cdeg(const argus_t *const core, const argus_wish_t *const wish) {
    return argus_angle_wrap(wish->heading_deg * 100 - raw_cdeg(core));
}

// No farther than the heading that the robot was let turn to.
static bool is_let(const argus_t *const core, const argus_given_t *const given, const int32_t left) {
    const int32_t let_cdeg = argus_angle_wrap(given->head_cdeg - raw_cdeg(core));
    return given->has_head && (let_cdeg < 0) == (left < 0) && argus_abs(left) <= argus_abs(let_cdeg);
}

// How far a HEAD is asked: to its end, but no farther than it is looked at, or than the robot needs to stand.
// One that goes on from the one before is asked as any other turn. Or a client would turn in steps as far as
// none of them is closed.
static int32_t head_look_cdeg(const argus_t *const core, const argus_given_t *const given,
                              const int32_t left) {
    const int32_t rest_cdeg = until_rest_cdeg(argus_turn_deg_s(&core->knowledge));
    const bool same_way = (rest_cdeg < 0) == (left < 0);
    const int32_t most_cdeg = same_way ? argus_max(LOOK_CDEG, argus_abs(rest_cdeg)) : LOOK_CDEG;
    return widened(argus_within(most_cdeg, left), is_let(core, given, left) ? 0 : LEAST_CDEG);
}

static argus_permit_t ask_wish(const argus_t *const core, const argus_hold_client_t *const self) {
    const argus_wish_t *const wish = &self->wish;
    if (wish->turn == ARGUS_WISH_STRAIGHT) {
        return ARGUS_PERMIT_GIVEN;
    }
    if (wish->turn == ARGUS_WISH_RVEL) {
        return ask_speed(core, wish->deg_s);
    }
    const int32_t left = left_cdeg(core, wish);
    const bool there = argus_abs(left) <= THERE_CDEG;
    const bool either = argus_abs(left) > ARGUS_TURN_EITHER_CDEG;
    return ask_turn(core, there ? 0 : either ? left : head_look_cdeg(core, &self->given, left));
}

static int32_t wanted_deg(const argus_t *const core, const argus_wish_t *const wish) {
    return wish->turn == ARGUS_WISH_RVEL ? wish->deg_s : left_cdeg(core, wish) / 100;
}

static void send_turn(const argus_grant_t *const grant, argus_hold_client_t *const self, const bool closed) {
    const argus_wish_t *const wish = &self->wish;
    argus_given_t *const given = &self->given;
    given->has_head = !closed && wish->turn == ARGUS_WISH_HEAD;
    if (given->has_head) {
        given->head_cdeg = wish->heading_deg * 100;
        argus_outbox_int(grant->out, ARCOS_CMD_HEAD, wish->heading_deg);
    } else {
        const bool turns = !closed && wish->turn == ARGUS_WISH_RVEL;
        argus_outbox_int(grant->out, ARCOS_CMD_RVEL, turns ? wish->deg_s : 0);
    }
}

static void give_turn(const argus_grant_t *const grant, argus_hold_client_t *const self, const bool anyway) {
    argus_given_t *const given = &self->given;
    const argus_permit_t permit = ask_wish(grant->core, self);
    const bool closed = permit != ARGUS_PERMIT_GIVEN;
    if (closed && (anyway || wanted_deg(grant->core, &self->wish) != 0)) {
        tell_turn(grant, given, permit, wanted_deg(grant->core, &self->wish));
    }
    if (anyway || closed != given->turn_held) {
        send_turn(grant, self, closed);
    }
    given->turn_held = closed;
}

// Weaving --------------------------------------------------------------------------------------------------

// It goes ahead with a bearing ahead blind, and nothing is said of a turn. What no sonar sees is never free,
// so the heading swings, as when the manager drives itself.
static bool should_weave(const argus_t *const core, const argus_wish_t *const wish) {
    const argus_guard_t guard = argus_guard(core);
    return wish->way != ARGUS_WISH_REST && wish->turn == ARGUS_WISH_STRAIGHT && !wish->paired &&
           guard.profile->drives_seen && argus_guard_is_blind(&guard) && argus_wanted_sonars(core) != 0 &&
           wants_ahead(core, wish) != core->knowledge.robot->reversed;
}

static int gap_of(const argus_t *const core) {
    const argus_guard_t guard = argus_guard(core);
    return argus_guard_gap(&guard);
}

static void begin_weaving(const argus_grant_t *const grant, argus_given_t *const given) {
    given->weave = (argus_weave_t){.side = 1};
    given->base_cdeg = grant->core->knowledge.pose.heading_cdeg;
    argus_emit(grant->events, ARGUS_EV_GUARD_LOOKS, argus_weave_swing_cdeg(gap_of(grant->core)) / 100);
}

// A look that may not be made is ended where the heading is.
static void steer(const argus_grant_t *const grant, argus_given_t *const given, const int32_t to_cdeg) {
    const int32_t by_cdeg = argus_angle_wrap(to_cdeg - grant->core->knowledge.pose.heading_cdeg);
    if (ask_turn(grant->core, by_cdeg) == ARGUS_PERMIT_GIVEN) {
        argus_motion_steer(grant->out, &grant->core->knowledge, to_cdeg);
        given->turn_held = false;
    } else if (!given->turn_held) {
        given->turn_held = argus_outbox_int(grant->out, ARCOS_CMD_RVEL, 0);
    }
}

static void weave(const argus_grant_t *const grant, argus_given_t *const given) {
    if (given->weave.side == 0) {
        begin_weaving(grant, given);
    }
    const int32_t to_cdeg = argus_weave_cdeg(&given->weave, gap_of(grant->core),
                                             grant->core->knowledge.pose.heading_cdeg, given->base_cdeg);
    steer(grant, given, to_cdeg);
}

static void end_weaving(const argus_grant_t *const grant, argus_hold_client_t *const self) {
    if (self->given.weave.side != 0 && self->wish.turn == ARGUS_WISH_STRAIGHT && !self->wish.paired) {
        steer(grant, &self->given, self->given.base_cdeg);
    }
    self->given.weave.side = 0;
}

// ----------------------------------------------------------------------------------------------------------

// What the outbox had no room for is given with the next SIP.
static void give(const argus_grant_t *const grant, argus_hold_client_t *const self, const bool way,
                 const bool anyway) {
    const uint32_t refused = grant->out->refused;
    bool *const due = way ? &self->way_due : &self->turn_due;
    if (way) {
        give_way(grant, self, anyway || *due);
    } else {
        give_turn(grant, self, anyway || *due);
    }
    *due = grant->out->refused != refused;
}

void argus_hold_way(const argus_grant_t *const grant, argus_hold_client_t *const self) {
    give(grant, self, true, true);
}

void argus_hold_tell(const argus_grant_t *const grant, argus_hold_client_t *const self,
                     const argus_permit_t permit) {
    tell_turn(grant, &self->given, permit, 0);
}

// RVEL 0, repeated, must not end the looks.
void argus_hold_turn(const argus_grant_t *const grant, argus_hold_client_t *const self) {
    if (self->given.weave.side == 0 || self->wish.turn != ARGUS_WISH_STRAIGHT) {
        give(grant, self, false, true);
    }
}

void argus_hold_still(const argus_grant_t *const grant, argus_hold_client_t *const self) {
    argus_given_t *const given = &self->given;
    argus_outbox_urgent(grant->out, ARCOS_CMD_STOP);
    given->rolls = given->moves = given->has_head = false;
    given->mm_s = given->move_mm = given->right = given->left = 0;
    given->weave.side = 0;
    given->turn_held = true;
}

// S2: once for each contact; what the client wanted is over.
static bool is_hit(const argus_t *const core, argus_given_t *const given) {
    const uint16_t pressed = argus_built_bumpers(&core->knowledge);
    const bool fresh = (pressed & ~(unsigned)given->bumpers) != 0;
    given->bumpers = pressed;
    return fresh;
}

// S2, likewise; the event is the manager's own.
static bool is_stalled(const argus_t *const core, argus_given_t *const given) {
    const uint8_t stalls = (uint8_t)argus_built_stalls(&core->knowledge);
    const bool fresh = (stalls & ~(unsigned)given->stalls) != 0;
    given->stalls = stalls;
    return fresh;
}

static int32_t given_mm_s(const argus_given_t *const given, const int32_t setv_mm_s) {
    if (!given->rolls) {
        return 0;
    }
    const bool by_move = given->moves && given->mm_s == 0;
    return by_move ? argus_max(setv_mm_s, given->setv_mm_s) : argus_abs(given->mm_s);
}

// A HEAD turns as fast as SETRV lets it.
static int32_t given_deg_s(const argus_t *const core, const argus_hold_client_t *const self) {
    const argus_given_t *const given = &self->given;
    const int32_t units = self->wish.paired ? given->right - given->left : 0;
    if (given->has_head || given->weave.side != 0) {
        return ARGUS_CLIENT_TURN_DEG_S;
    }
    if (units != 0) {
        return argus_abs(units) * ARGUS_VEL2_UNIT_MM_S * ARGUS_DEG_PER_RAD /
               argus_max(1, core->knowledge.robot->track_mm);
    }
    const bool turns = self->wish.turn == ARGUS_WISH_RVEL && !given->turn_held;
    return turns ? argus_within(ARGUS_CLIENT_TURN_DEG_S, argus_abs(self->wish.deg_s)) : 0;
}

// What is lost on its way to the robot is given again: a stop, too, of which nothing is wanted any more.
static void heed(const argus_t *const core, argus_hold_client_t *const self) {
    const argus_knowledge_t *const knowledge = &core->knowledge;
    const int32_t mm_s = argus_abs(knowledge->vel_left_mm_s + knowledge->vel_right_mm_s) / 2;
    const int32_t late_ms = core->latency.late_ms;
    self->way_due = argus_heed_sip(&self->way_heed, given_mm_s(&self->given, self->setv_mm_s), mm_s,
                                   SPARE_MM_S, FALLS_MM_S, late_ms) ||
                    self->way_due;
    self->turn_due =
        argus_heed_sip(&self->turn_heed, given_deg_s(core, self),
                       argus_abs(argus_turn_deg_s(&core->knowledge)), SPARE_DEG_S, FALLS_DEG_S, late_ms) ||
        self->turn_due;
}

void argus_hold_watch(const argus_grant_t *const grant, argus_hold_client_t *const self) {
    const bool stalled = is_stalled(grant->core, &self->given);
    if (is_hit(grant->core, &self->given)) {
        argus_outbox_urgent(grant->out, ARCOS_CMD_E_STOP);
        argus_hold_forget(self);
        argus_emit(grant->events, ARGUS_EV_GUARD_HELD, (int32_t)ARGUS_BOUND_BUMPER);
        return;
    }
    if (stalled) {
        argus_outbox_urgent(grant->out, ARCOS_CMD_STOP);
        argus_hold_forget(self);
        return;
    }
    tell_free(grant, &self->given);
    heed(grant->core, self);
    give(grant, self, true, false);
    if (should_weave(grant->core, &self->wish)) {
        weave(grant, &self->given);
    } else {
        end_weaving(grant, self);
        if (!self->wish.paired) {
            give(grant, self, false, false);
        }
    }
}
