// SPDX-License-Identifier: MIT
// Algorithm 2 as a state machine (paper: Table III, in the convention and with the corrections named below).
#include "analysis/verify.h"

#include <string.h>

#include "knowledge/angle.h"
#include "paper/disparity.h"

#define LEFT 0u
#define RIGHT 1u

void argus_verify_init(argus_verify_t *const self) {
    memset(self, 0, sizeof *self);
}

void argus_verify_begin(argus_verify_t *const self, const argus_robot_t *const robot, const int sonar,
                        const int32_t base_cdeg) {
    ARGUS_ASSERT(sonar >= 0 && sonar < argus_robot_sonars(robot));
    const argus_sonar_pose_t pose = argus_robot_pose(robot, sonar);
    ARGUS_ASSERT(argus_robot_faces_forward(robot, sonar));
    argus_verify_init(self);
    self->phase = ARGUS_VERIFY_RECHECK;
    self->sonar = (int8_t)sonar;
    self->base_cdeg = base_cdeg;
    self->by[LEFT] = (int8_t)argus_robot_beside(robot, sonar, true);
    self->by[RIGHT] = (int8_t)argus_robot_beside(robot, sonar, false);
    for (unsigned side = LEFT; side <= RIGHT; side++) {
        const int by = self->by[side];
        const int32_t bearing_deg = by >= 0 ? argus_robot_pose(robot, by).heading_deg : pose.heading_deg;
        self->turn_deg[side] = (int16_t)(pose.heading_deg - bearing_deg);
    }
}

// paper: the listing turns the edge sonars by Table I's sign and never turns back. Here a turn to the right
// (-20) puts the left neighbour on the bearing, one to the left (+20) the right neighbour. RETURN ends on the
// base heading.
int32_t argus_verify_heading_cdeg(const argus_verify_t *const self) {
    switch (self->phase) {
    case ARGUS_VERIFY_LEFT:
        return argus_angle_wrap(self->base_cdeg + self->turn_deg[LEFT] * 100);
    case ARGUS_VERIFY_RIGHT:
        return argus_angle_wrap(self->base_cdeg + self->turn_deg[RIGHT] * 100);
    case ARGUS_VERIFY_IDLE:
    case ARGUS_VERIFY_RECHECK:
    case ARGUS_VERIFY_RETURN:
    case ARGUS_VERIFY_DONE:
    default:
        return self->base_cdeg;
    }
}

static bool may_testify(const argus_knowledge_t *const knowledge, const int sonar) {
    return sonar >= 0 && argus_usable(knowledge, sonar);
}

static argus_verify_phase_t first_turn(const argus_verify_t *const self) {
    return (self->witnesses & 1u << LEFT) != 0 ? ARGUS_VERIFY_LEFT : ARGUS_VERIFY_RIGHT;
}

static void conclude(argus_verify_t *const self, const argus_result_t result) {
    ARGUS_ASSERT(result != ARGUS_RESULT_NONE && self->result == ARGUS_RESULT_NONE);
    self->result = result;
    self->phase = ARGUS_VERIFY_RETURN;
}

// v is read again at rest, with its neighbours; a suspicion that does not hold there is dropped without a
// turn.
static bool recheck(argus_verify_t *const self, const argus_knowledge_t *const knowledge,
                    const argus_mark_t *const mark) {
    ARGUS_ASSERT(self->phase == ARGUS_VERIFY_RECHECK && self->sonar >= 0);
    unsigned wanted = 1u << self->sonar;
    self->witnesses = 0;
    for (unsigned side = LEFT; side <= RIGHT; side++) {
        if (may_testify(knowledge, self->by[side])) {
            self->witnesses |= (uint8_t)(1u << side);
            wanted |= 1u << self->by[side];
        }
    }
    if (!argus_all_fresh_since(knowledge, (argus_mask_t)wanted, mark)) {
        return false;
    }
    self->reading_mm = knowledge->sonar[self->sonar].reading_mm;
    const argus_verdict_t verdict = argus_disparity(knowledge, self->sonar, &self->difference_mm);
    if (verdict != ARGUS_DISPARATE) {
        self->result = self->witnesses == 0 ? ARGUS_RESULT_UNPROVEN : ARGUS_RESULT_DROPPED;
        self->phase = ARGUS_VERIFY_DONE;
    } else {
        self->phase = first_turn(self);
    }
    return true;
}

// paper: line 19 adds before dividing and line 22 lacks the absolute value; here the mean is meant, and |mean
// - v| > tr.
static void judge(argus_verify_t *const self, const argus_robot_t *const robot) {
    ARGUS_ASSERT((self->heard & ~self->witnesses & 3) == 0);
    int32_t sum = 0;
    int32_t count = 0;
    for (unsigned side = LEFT; side <= RIGHT; side++) {
        if ((self->heard & 1u << side) != 0) {
            sum += self->witness_mm[side];
            count++;
        }
    }
    if (count == 0) {
        conclude(self, ARGUS_RESULT_UNPROVEN);
        return;
    }
    // Twice the difference, so that the mean of two is not rounded before it is judged.
    const int32_t off = argus_abs(sum * 2 / count - 2 * (int32_t)self->reading_mm);
    self->mean_mm = sum / count;
    const int32_t limit = 2 * argus_tolerance_mm(robot, self->reading_mm);
    conclude(self, off > limit ? ARGUS_RESULT_CONVICTED : ARGUS_RESULT_CLEARED);
}

static bool hear(argus_verify_t *const self, const argus_knowledge_t *const knowledge,
                 const argus_mark_t *const mark, const unsigned side) {
    const int sonar = self->by[side];
    ARGUS_ASSERT(sonar >= 0);
    const bool gone = argus_is_out(knowledge, sonar); // it failed on the way: it cannot testify
    if (!gone && !argus_fresh_since(knowledge, sonar, mark)) {
        return false;
    }
    if (may_testify(knowledge, sonar)) {
        self->heard |= (uint8_t)(1u << side);
        self->witness_mm[side] = knowledge->sonar[sonar].reading_mm;
    }
    if (side == LEFT && (self->witnesses & 1u << RIGHT) != 0) {
        self->phase = ARGUS_VERIFY_RIGHT;
    } else {
        judge(self, knowledge->robot);
    }
    return true;
}

bool argus_verify_step(argus_verify_t *const self, const argus_knowledge_t *const knowledge,
                       const argus_mark_t *const mark) {
    ARGUS_ASSERT(self->phase <= ARGUS_VERIFY_DONE);
    switch (self->phase) {
    case ARGUS_VERIFY_RECHECK:
        return recheck(self, knowledge, mark);
    case ARGUS_VERIFY_LEFT:
        return hear(self, knowledge, mark, LEFT);
    case ARGUS_VERIFY_RIGHT:
        return hear(self, knowledge, mark, RIGHT);
    case ARGUS_VERIFY_RETURN:
        self->phase = ARGUS_VERIFY_DONE;
        return true;
    case ARGUS_VERIFY_IDLE:
    case ARGUS_VERIFY_DONE:
    default:
        return false;
    }
}
