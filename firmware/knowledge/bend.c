// SPDX-License-Identifier: MIT
// Compares the heading with the order to go straight ahead, piece of way by piece of way.
#include "knowledge/bend.h"

#include "knowledge/angle.h"

#define BENT_CDEG 60 // seven steps of what the robot reports; two pieces before it is steered back
#define LONG_MM 1000
#define LEAST_MM 40    // on less way a bend may be a push
#define DRIVES_MM_S 50 // slower, what is reported is too coarse
#define ORDER_MS 500u  // until an order to turn by a degree shows and is done
#define THERE_CDEG 100 // one by more is done when the robot has come so near

void argus_bend_ordered(argus_bend_t *const self, const int32_t heading_cdeg, const uint32_t now_ms) {
    self->ordered_cdeg = heading_cdeg;
    self->ordered_ms = now_ms;
    self->turning = true;
    self->begun = false;
}

// An order to turn is under way: what the robot turns now it was ordered to.
static bool is_turning(argus_bend_t *const self, const argus_knowledge_t *const knowledge) {
    const bool there = argus_angle_abs_diff(knowledge->pose.heading_cdeg, self->ordered_cdeg) <= THERE_CDEG;
    self->turning = self->turning && !there;
    return self->turning || knowledge->sip_ms - self->ordered_ms < ORDER_MS;
}

static bool is_sound(const argus_knowledge_t *const knowledge) {
    return !knowledge->leapt && knowledge->bumpers_front == 0 && knowledge->bumpers_rear == 0 &&
           knowledge->vel_left_mm_s >= DRIVES_MM_S && knowledge->vel_right_mm_s >= DRIVES_MM_S;
}

static bool is_done(const argus_way_turn_t *const piece) {
    const bool bent = argus_abs(piece->turn_cdeg) >= BENT_CDEG && piece->way_mm >= LEAST_MM;
    return bent || piece->way_mm >= LONG_MM;
}

bool argus_bend_sip(argus_bend_t *const self, const argus_knowledge_t *const knowledge, const bool straight,
                    argus_way_turn_t *const piece) {
    const bool turning = is_turning(self, knowledge);
    const bool goes_on = straight && !turning && is_sound(knowledge);
    const bool counts = goes_on && self->begun;
    if (counts) {
        self->piece.way_mm += (int32_t)(knowledge->odometer_mm - self->odometer_mm);
        self->piece.turn_cdeg += argus_angle_wrap(knowledge->pose.heading_cdeg - self->heading_cdeg);
    } else {
        self->piece = (argus_way_turn_t){0, 0};
    }
    self->begun = goes_on;
    self->odometer_mm = knowledge->odometer_mm;
    self->heading_cdeg = knowledge->pose.heading_cdeg;
    if (!counts || !is_done(&self->piece)) {
        return false;
    }
    *piece = self->piece;
    self->piece = (argus_way_turn_t){0, 0};
    return true;
}
