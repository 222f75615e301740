// SPDX-License-Identifier: MIT
// How far a robot leaves its axis until it stands is worked out without overflow, whatever its SIPs state.
// Bounds: wheels of -2,000 to 2,000 mm/s, to which SIPs are held; any brake and track that a ring may have
// Sources: firmware/knowledge/odometry.c
// Unwind: 3
// Ci: no
// Mutant: firmware/guardian/bounds.c | argus_min(argus_abs(argus_turn_deg_s(&self->knowledge)), TURN_MOST_DEG_S) | argus_abs(argus_turn_deg_s(&self->knowledge))
// Mutant: firmware/knowledge/odometry.c | return argus_within(FASTEST_MM_S, mm_s); | return mm_s;
#include "proof.h"

#include "guardian/bounds.c"

#include "knowledge/odometry.h"

void proof(void) {
    argus_robot_t robot;
    robot.decel_mm_s2 = (int16_t)any_between(50, 5000);
    robot.track_mm = (int16_t)any_between(1, 3000);
    argus_t self;
    self.knowledge.robot = &robot;
    self.knowledge.vel_left_mm_s = (int16_t)argus_odometry_speed_mm_s(any_between(INT16_MIN, INT16_MAX));
    self.knowledge.vel_right_mm_s = (int16_t)argus_odometry_speed_mm_s(any_between(INT16_MIN, INT16_MAX));
    const int32_t mm = deviation_mm(&self, speed_mm_s(&self));
    PROVE(mm >= 0, "to one side");
    PROVE(argus_turn_deg_s(&self.knowledge) != 0 || mm == 0, "straight on there is none");
}
