// SPDX-License-Identifier: MIT
// What a robot without ARCOS says of itself, as a SIP.
#include "knowledge/observe.h"

#include <string.h>

#include "knowledge/angle.h"

#define TURN_UNITS 4096
#define BATTERY_DV 125      // nothing is known of it
#define CDEG_IN_RADIAN 5730 // rounded
#define FASTEST_MM_S 30000  // so that nothing overflows; the odometry finds what no robot drives
#define FASTEST_CDEG_S 200000

// In units of the robot's position: what is beyond 16 bits wraps, as on the wire.
static uint16_t raw_of(const int32_t mm, const argus_robot_t *const robot) {
    return (uint16_t)((int64_t)mm * 1000 / robot->dist_conv_um & 0xFFFF);
}

static void take_speeds(argus_sip_t *const sip, const argus_observation_t *const from,
                        const int32_t track_mm) {
    const int32_t ahead_mm_s = argus_within(FASTEST_MM_S / 2, from->speed_mm_s);
    const int32_t turn_cdeg_s = argus_within(FASTEST_CDEG_S, from->turn_cdeg_s);
    const int32_t apart_mm_s = (int32_t)((int64_t)turn_cdeg_s * track_mm / CDEG_IN_RADIAN);
    const int32_t half_mm_s = argus_within(FASTEST_MM_S / 2, apart_mm_s / 2);
    sip->vel_left_mm_s = (int16_t)(ahead_mm_s - half_mm_s);
    sip->vel_right_mm_s = (int16_t)(ahead_mm_s + half_mm_s);
    sip->moving = sip->vel_left_mm_s != 0 || sip->vel_right_mm_s != 0;
}

static void take_ranges(argus_sip_t *const sip, const argus_observation_t *const from) {
    ARGUS_ASSERT(from->ranges != NULL || from->count == 0);
    for (int i = 0; i < from->count && sip->sonar_count < ARGUS_SIP_SONARS_MAX; i++) {
        const argus_range_t *const range = &from->ranges[i];
        if (range->age_ms <= ARGUS_RANGE_OLD_MS) {
            sip->sonar[sip->sonar_count++] = (argus_sip_sonar_t){range->sonar, range->range_mm};
        }
    }
}

void argus_sip_of(argus_sip_t *const sip, const argus_observation_t *const observation,
                  const argus_robot_t *const robot) {
    ARGUS_ASSERT(robot->dist_conv_um > 0);
    const int32_t heading_cdeg = argus_angle_wrap(observation->pose.heading_cdeg);
    memset(sip, 0, sizeof *sip);
    sip->battery_dv = BATTERY_DV;
    sip->flags =
        ARCOS_FLAG_MOTORS | ARCOS_FLAG_SONAR1 | ARCOS_FLAG_SONAR2 | ARCOS_FLAG_SONAR3 | ARCOS_FLAG_SONAR4;
    sip->x_raw = raw_of(observation->pose.x_mm, robot);
    sip->y_raw = raw_of(observation->pose.y_mm, robot);
    sip->heading_raw = (int16_t)(heading_cdeg * TURN_UNITS / ARGUS_TURN_CDEG);
    take_speeds(sip, observation, robot->track_mm);
    take_ranges(sip, observation);
}
