// SPDX-License-Identifier: MIT
// Where a silent sonar would look along what another one lately heard.
#include "analysis/aim.h"

#include "awareness/names.h"
#include "awareness/numbers.h"
#include "knowledge/angle.h"

#define AIM_NEAREST_MM 250
#define AIM_TURN_CDEG 10000

// It has lately looked there itself.
static bool has_looked(const argus_pings_t *const pings, const argus_ping_t *const there,
                       const uint32_t now_ms) {
    ARGUS_ASSERT(pings->count <= ARGUS_PINGS && pings->next < ARGUS_PINGS);
    for (int back = 1; back <= pings->count; back++) {
        const argus_ping_t *const then = argus_pings_at(pings, back);
        if (argus_ping_age_ms(then, now_ms) <= ARGUS_BESIDE_MS &&
            argus_ping_is_within(there, then, ARGUS_PLACE_MM) &&
            argus_ping_turned_cdeg(there, then) <= ARGUS_SAME_CDEG) {
            return true;
        }
    }
    return false;
}

// An echo that another lately heard at a range that tells, on a bearing that takes a turn to look along.
static bool is_worth_a_turn(const argus_ping_t *const then, const int32_t turn_cdeg, const uint32_t now_ms) {
    return then->reading_mm >= AIM_NEAREST_MM &&
           then->reading_mm <= ARGUS_FARTHEST_MM - ARGUS_SAME_ALONG_MM && turn_cdeg >= ARGUS_SAME_CDEG &&
           turn_cdeg <= AIM_TURN_CDEG && argus_ping_age_ms(then, now_ms) <= ARGUS_BESIDE_MS;
}

// What it costs to look along the bearing of a ping of another, in hundredths of a degree of turn; INT32_MAX:
// it is no use.
static int32_t cost_of_aim(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                           const int sonar, const argus_ping_t *const then) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_pose_t mount = argus_robot_pose(knowledge->robot, sonar);
    argus_pose_t turned = knowledge->pose;
    turned.heading_cdeg = argus_angle_wrap(then->bearing_cdeg - mount.heading_deg * 100);
    const int32_t turn = argus_angle_abs_diff(turned.heading_cdeg, knowledge->pose.heading_cdeg);
    if (!is_worth_a_turn(then, turn, knowledge->sip_ms)) {
        return INT32_MAX;
    }
    const argus_ping_t there = argus_ping_from(knowledge->robot, sonar, &turned);
    const bool telling = argus_ping_is_within(&there, then, ARGUS_SAME_ALONG_MM) &&
                         argus_ping_shift(&there, then).lateral_mm <= ARGUS_SAME_LATERAL_MM &&
                         !has_looked(&self->pings[sonar], &there, knowledge->sip_ms);
    return telling ? turn + then->reading_mm : INT32_MAX;
}

bool argus_aim(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
               int32_t *const heading_cdeg) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    int32_t least = INT32_MAX;
    for (int other = 0; other < knowledge->sonars; other++) {
        if (other == sonar || argus_is_out(knowledge, other) || argus_names_suspects(self, other)) {
            continue;
        }
        for (int back = 1; back <= self->pings[other].count; back++) {
            const argus_ping_t *const then = argus_pings_at(&self->pings[other], back);
            const int32_t cost = cost_of_aim(self, knowledge, sonar, then);
            if (cost < least) {
                least = cost;
                const int32_t mount_cdeg = argus_robot_pose(knowledge->robot, sonar).heading_deg * 100;
                *heading_cdeg = argus_angle_wrap(then->bearing_cdeg - mount_cdeg);
            }
        }
    }
    return least < INT32_MAX;
}
