// SPDX-License-Identifier: MIT
// Bounds a client's motion by S1, S2, S5 and S7, for the end of the robot that would lead.
#include "guardian/bounds.h"

#include "adjustment/grazing.h"
#include "behaviour/state.h"
#include "knowledge/angle.h"
#include "knowledge/config.h"

#define BESIDE_MM 30     // from the body: readings scatter, and the heading does
#define CONE_PLACES 2    // of a cone on either side of its axis
#define TRUST_MM 2000    // a thin thing beyond may give no echo
#define SEEN_LEFT_MM 100 // what argus_guard_seen_mm() takes off for itself
#define LEAST_MM_S 30    // slower than this it stands
#define CURVE_MOST_CDEG 9000
#define DEVIATION_MOST_MM 400
#define FASTEST_MM_S 1500 // no robot is faster
#define CURVE_STEP_MM_S 25
#define TURN_NEAR_MM 250    // beyond the circle that the body sweeps
#define TURN_LEAST_DEG_S 10 // slower is steering
#define TURN_MOST_DEG_S 500 // no robot turns faster; times the way until it stands it fits in 31 bits

static argus_bound_t closed(const argus_bound_why_t why) {
    return (argus_bound_t){.speed_mm_s = 0, .way_mm = 0, .why = why};
}

// Which end goes, and within what on either side of its axis.
typedef struct {
    bool rear;
    int32_t half_mm;
} corridor_t;

int32_t argus_turn_deg_s(const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->robot->track_mm > 0);
    const int32_t across_mm_s = knowledge->vel_right_mm_s - knowledge->vel_left_mm_s;
    const int32_t by_wheels = across_mm_s * ARGUS_DEG_PER_RAD / knowledge->robot->track_mm;
    return argus_abs(knowledge->turn_deg_s) > argus_abs(by_wheels) ? knowledge->turn_deg_s : by_wheels;
}

static int32_t turn_deg_s(const argus_t *const self) {
    return argus_min(argus_abs(argus_turn_deg_s(&self->knowledge)), TURN_MOST_DEG_S);
}

static int32_t speed_mm_s(const argus_t *const self) {
    const argus_knowledge_t *const knowledge = &self->knowledge;
    return argus_abs(knowledge->vel_right_mm_s + knowledge->vel_left_mm_s) / 2;
}

// Until it stands.
static int32_t rest_mm(const argus_t *const self, const int32_t mm_s) {
    ARGUS_ASSERT(self->knowledge.robot->decel_mm_s2 > 0);
    return mm_s * ARGUS_CLIENT_REACTION_MS / 1000 + mm_s * mm_s / (2 * self->knowledge.robot->decel_mm_s2);
}

// In a curve the robot leaves its axis by s^2 w / 2 v until it stands.
static int32_t deviation_mm(const argus_t *const self, const int32_t mm_s) {
    const int32_t way_mm = rest_mm(self, mm_s);
    const int32_t turn_cdeg = mm_s > 0 ? way_mm * turn_deg_s(self) * 100 / mm_s : 0;
    return way_mm * argus_min(turn_cdeg, CURVE_MOST_CDEG) / (2 * 100 * ARGUS_DEG_PER_RAD);
}

static corridor_t corridor(const argus_t *const self, const bool rear) {
    return (corridor_t){.rear = rear,
                        .half_mm = argus_robot_half_width_mm(self->knowledge.robot) + BESIDE_MM +
                                   argus_min(deviation_mm(self, speed_mm_s(self)), DEVIATION_MOST_MM)};
}

// How far the leading end may go until it touches the nearest place at which the echo may lie; INT32_MAX: it
// lies beside the way.
static int32_t on_way_mm(const argus_robot_t *const robot, const int sonar, const int32_t reading_mm,
                         const corridor_t *const way) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(reading_mm >= 0);
    const argus_sonar_pose_t pose = argus_robot_pose(robot, sonar);
    int32_t nearest_mm = INT32_MAX;
    for (int k = -CONE_PLACES; k <= CONE_PLACES; k++) {
        const int32_t bearing =
            pose.heading_deg * 100 + argus_robot_cone_deg(robot, sonar) * 100 * k / (2 * CONE_PLACES);
        const int32_t x_mm = pose.x_mm + reading_mm * argus_cos(bearing) / ARGUS_TRIG_ONE;
        const int32_t y_mm = pose.y_mm + reading_mm * argus_sin(bearing) / ARGUS_TRIG_ONE;
        const int32_t free_mm = way->rear ? -x_mm - robot->rear_mm : x_mm - robot->front_mm;
        if (argus_abs(y_mm) <= way->half_mm) {
            nearest_mm = argus_min(nearest_mm, argus_max(free_mm, 0));
        }
    }
    return nearest_mm;
}

// The shortest of these, less the way driven since.
static int32_t clear_mm(const argus_knowledge_t *const knowledge, const unsigned looks,
                        const corridor_t *const way) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    int32_t shortest_mm = TRUST_MM;
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((looks >> i & 1u) != 0 && argus_usable(knowledge, i)) {
            const int32_t since_mm = (int32_t)(knowledge->odometer_mm - knowledge->sonar[i].odometer_mm);
            const int32_t free_mm =
                on_way_mm(knowledge->robot, i, knowledge->sonar[i].reading_mm, way) - since_mm;
            shortest_mm = argus_min(shortest_mm, argus_max(free_mm, 0));
        }
    }
    return shortest_mm;
}

// What was heard twice a moment ago and has left the cones is still there.
static int32_t remembered_mm(const argus_t *const self, const corridor_t *const way) {
    const argus_robot_t *const robot = self->knowledge.robot;
    const argus_view_t from = argus_view(&self->knowledge);
    int32_t nearest_mm = TRUST_MM;
    for (int i = 0; i < self->echoes.count; i++) {
        argus_point_t at;
        if (argus_echoes_near(&self->echoes, &from, i, &at) && argus_abs(at.y_mm) <= way->half_mm) {
            const int32_t free_mm = way->rear ? -at.x_mm - robot->rear_mm : at.x_mm - robot->front_mm;
            nearest_mm = free_mm >= 0 ? argus_min(nearest_mm, free_mm) : nearest_mm;
        }
    }
    return nearest_mm;
}

static int32_t free_mm_of(const argus_t *const self, const unsigned looks, const bool rear) {
    const corridor_t way = corridor(self, rear);
    const int32_t heard_mm = clear_mm(&self->knowledge, looks, &way);
    return argus_rules(self)->remembers ? argus_min(heard_mm, remembered_mm(self, &way)) : heard_mm;
}

static int32_t face_overhang_mm(const argus_robot_t *const robot) {
    return robot->front_mm - robot->sonar_face_mm;
}

// The object range counts from the sonars' faces; `free_mm` from the body.
static argus_bound_t by_clearance(const argus_guard_t *const guard, const int32_t free_mm,
                                  const int32_t overhang_mm) {
    const argus_robot_t *const robot = guard->knowledge->robot;
    const int32_t way_mm = free_mm + overhang_mm - guard->config->object_range_mm;
    if (way_mm <= 0) {
        return closed(ARGUS_BOUND_OBJECT);
    }
    const int32_t speed_mm_s =
        argus_config_speed_mm_s(guard->config, robot, free_mm + face_overhang_mm(robot), guard->late_ms);
    if (speed_mm_s < LEAST_MM_S) {
        return closed(ARGUS_BOUND_OBJECT);
    }
    return (argus_bound_t){.speed_mm_s = speed_mm_s, .way_mm = way_mm, .why = ARGUS_BOUND_FREE};
}

static bool slants(const argus_t *const self) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    const unsigned flank = argus_robot_flank(self->knowledge.robot) & ~(unsigned)argus_out(&self->knowledge);
    const int32_t stop_mm = argus_config_stop_mm(&self->config, self->knowledge.robot, self->latency.late_ms);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if ((flank >> i & 1u) != 0 &&
            argus_grazing_wall(&self->evidence.pings[i], self->knowledge.robot, i, stop_mm)) {
            return true;
        }
    }
    return false;
}

// Beside a wall, and where one ahead is named.
static bool is_careful(const argus_t *const self) {
    const unsigned ahead = argus_robot_ahead(self->knowledge.robot);
    return argus_flank_mm(&self->knowledge, 0) <= ARGUS_FLANK_NEAR_MM ||
           (argus_named(&self->knowledge) & ahead) != 0;
}

// The way ahead is seen, or may be.
static bool may_see(const argus_t *const self, const argus_guard_t *const guard) {
    const bool blind = argus_guard_is_blind(guard) && !guard->profile->drives_seen;
    return !argus_is_shown_blind(self, guard) && !blind && argus_guard_sees_ahead(guard);
}

// As fast as is careful beside a wall, where one ahead is named, and until one has heard an echo.
static int32_t careful_mm_s(const argus_t *const self, const argus_guard_t *const guard) {
    if (!argus_guard_is_heard(guard)) {
        return argus_guard_unseen_mm_s(guard);
    }
    return is_careful(self) ? self->config.speed_mm_s : INT32_MAX;
}

static argus_bound_t leading(const argus_t *const self, const argus_guard_t *const guard) {
    const argus_knowledge_t *const knowledge = &self->knowledge;
    if (!may_see(self, guard)) {
        return closed(ARGUS_BOUND_UNSEEN);
    }
    const unsigned looks = argus_robot_ahead(knowledge->robot) | argus_robot_forward(knowledge->robot);
    const int32_t overhang_mm = face_overhang_mm(knowledge->robot);
    argus_bound_t bound = by_clearance(guard, free_mm_of(self, looks, false), overhang_mm);
    if (bound.speed_mm_s == 0) {
        return bound;
    }
    const int32_t seen_mm = argus_min(argus_guard_seen_mm(guard), TRUST_MM);
    const int32_t seen_mm_s =
        argus_config_speed_mm_s(guard->config, knowledge->robot, seen_mm + SEEN_LEFT_MM, guard->late_ms);
    if (seen_mm == 0 || seen_mm_s < LEAST_MM_S) {
        return closed(ARGUS_BOUND_UNSEEN);
    }
    if (slants(self)) {
        bound = closed(ARGUS_BOUND_OBJECT);
        bound.slants = true;
        return bound;
    }
    bound.speed_mm_s = argus_min(bound.speed_mm_s, argus_min(seen_mm_s, careful_mm_s(self, guard)));
    bound.way_mm = argus_min(bound.way_mm, seen_mm);
    return bound;
}

// Each of those that look astern is trusted, and has reported within two rounds.
static bool sees_astern(const argus_t *const self) {
    const argus_knowledge_t *const knowledge = &self->knowledge;
    const uint32_t limit_ms = argus_guard_two_rounds_ms(&self->config);
    const unsigned looks = argus_robot_astern(knowledge->robot);
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((looks >> i & 1u) != 0 &&
            (!argus_trusted(knowledge, i) || argus_age_ms(knowledge, i, self->now_ms) > limit_ms)) {
            return false;
        }
    }
    return looks != 0;
}

static argus_bound_t trailing(const argus_t *const self, const argus_guard_t *const guard) {
    const argus_knowledge_t *const knowledge = &self->knowledge;
    if (!sees_astern(self)) {
        return closed(ARGUS_BOUND_UNSEEN);
    }
    const unsigned looks = argus_robot_astern(knowledge->robot);
    argus_bound_t bound =
        by_clearance(guard, free_mm_of(self, looks, true), knowledge->robot->rear_overhang_mm);
    // The manager itself backs no faster: beside the rear no sonar hears a wall that slants in.
    const bool heard = !guard->profile->asks_echo || (knowledge->heard & looks) != 0;
    const int32_t most_mm_s = heard ? self->config.speed_mm_s : argus_guard_unseen_mm_s(guard);
    bound.speed_mm_s = argus_min(bound.speed_mm_s, most_mm_s);
    return bound;
}

// A curve may be left on any tangent. Where that leads beyond what is looked at, the robot stands before the
// nearest thing, wherever that is.
static int32_t in_curve_mm_s(const argus_t *const self, const int32_t room_mm) {
    int32_t mm_s = FASTEST_MM_S;
    while (mm_s > self->config.step_speed_mm_s && deviation_mm(self, mm_s) > DEVIATION_MOST_MM &&
           rest_mm(self, mm_s) > room_mm) {
        mm_s -= CURVE_STEP_MM_S;
    }
    return mm_s;
}

// Between the sonars abeam and those of the ends a corner may hide, which a turn would sweep.
static argus_bound_t in_turn(const argus_t *const self, const argus_guard_t *const guard,
                             argus_bound_t bound) {
    const int32_t room_mm = argus_guard_nearest_mm(guard, 0) - self->knowledge.robot->swing_radius_mm;
    if (room_mm <= TURN_NEAR_MM && turn_deg_s(self) > TURN_LEAST_DEG_S) {
        bound.speed_mm_s = argus_min(bound.speed_mm_s, self->config.step_speed_mm_s);
    }
    bound.speed_mm_s = argus_min(bound.speed_mm_s, in_curve_mm_s(self, room_mm));
    return bound;
}

argus_bound_why_t argus_bound_why(const argus_permit_t permit) {
    switch (permit) {
    case ARGUS_PERMIT_GIVEN:
        return ARGUS_BOUND_FREE;
    case ARGUS_PERMIT_BUMPER:
        return ARGUS_BOUND_BUMPER;
    case ARGUS_PERMIT_SWING:
        return ARGUS_BOUND_OBJECT;
    default:
        return ARGUS_BOUND_HALTED;
    }
}

argus_bound_t argus_bound_way(const argus_t *const self, const bool ahead) {
    const argus_guard_t guard = argus_guard(self);
    const bool leads = ahead != self->knowledge.robot->reversed;
    const argus_ask_t order = {.mover = ARGUS_MOVER_CLIENT,
                               .wants = leads ? ARGUS_WANTS_AHEAD : ARGUS_WANTS_BACK};
    const argus_permit_t permit = argus_permit(self, order);
    if (permit != ARGUS_PERMIT_GIVEN) {
        return closed(argus_bound_why(permit));
    }
    return in_turn(self, &guard, leads ? leading(self, &guard) : trailing(self, &guard));
}
