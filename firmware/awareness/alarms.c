// SPDX-License-Identifier: MIT
// Looks at every SIP for what calls for a STOP.
#include "awareness/alarms.h"

#include "awareness/numbers.h"
#include "knowledge/profile.h"

static bool looks_along_motion(const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t speed = (knowledge->vel_left_mm_s + knowledge->vel_right_mm_s) / 2;
    const unsigned ahead = speed > ARGUS_MOVING_MM_S ? argus_robot_ahead(knowledge->robot) : 0u;
    const unsigned behind = speed < -ARGUS_MOVING_MM_S ? argus_robot_astern(knowledge->robot) : 0u;
    return ((ahead | behind) >> sonar & 1u) != 0;
}

static void see_object(argus_alarm_t *const alarm, const int sonar, const int32_t reading_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    alarm->object |= (argus_mask_t)(1u << sonar);
    if (alarm->object_sonar == -1 || reading_mm < alarm->object_mm) {
        alarm->object_sonar = (int8_t)sonar;
        alarm->object_mm = (uint16_t)reading_mm;
    }
}

static void judge_fresh(argus_alarm_t *const alarm, const argus_knowledge_t *const knowledge,
                        const argus_config_t *const config, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_t *const s = &knowledge->sonar[sonar];
    const bool forward = argus_robot_faces_forward(knowledge->robot, sonar);
    if (argus_is_out(knowledge, sonar)) {
        return;
    }
    const bool dead = s->reading_mm >= knowledge->robot->no_echo_mm;
    if (forward && dead && argus_profile(config)->dead_reading) {
        alarm->dead |= (argus_mask_t)(1u << sonar);
    }
    const int32_t range_mm = argus_reading_ahead_mm(knowledge, sonar);
    if (range_mm <= config->object_range_mm && looks_along_motion(knowledge, sonar)) {
        see_object(alarm, sonar, range_mm);
    }
}

static bool is_silent(const argus_knowledge_t *const knowledge, const argus_config_t *const config,
                      const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return !argus_is_out(knowledge, sonar) && argus_silent_ms(knowledge, sonar) > (uint32_t)config->stale_ms;
}

argus_alarm_t argus_alarms(const argus_knowledge_t *const knowledge, const argus_config_t *const config) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    argus_alarm_t alarm = {.object_sonar = -1};
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((knowledge->fresh >> i & 1u) != 0) {
            judge_fresh(&alarm, knowledge, config, i);
        }
        if (argus_robot_faces_forward(knowledge->robot, i) && is_silent(knowledge, config, i)) {
            alarm.silent |= (argus_mask_t)(1u << i);
        }
    }
    alarm.bumper = (knowledge->bumpers_front | knowledge->bumpers_rear) != 0;
    alarm.stall = knowledge->stall_left || knowledge->stall_right;
    return alarm;
}
