// SPDX-License-Identifier: MIT
// Works out how far the heading drifts between two orders.
#include "adjustment/trim.h"

#include "knowledge/angle.h"

#define CDEG_PER_RADIAN 5730
#define LATE_MS 150      // a SIP and an order on the wire, and half of the time between two
#define AGAIN_MM 3000u   // so often it is measured again,
#define MEASURE_MM 2500u // ... if within so much no piece of way was straight enough to tell, later

bool argus_trim_is_due(const argus_wheel_t *const wheel, const argus_knowledge_t *const knowledge) {
    const uint32_t since_mm = knowledge->odometer_mm - wheel->odometer_mm;
    return wheel->short_pm != 0 && since_mm % (AGAIN_MM + MEASURE_MM) < AGAIN_MM;
}

int32_t argus_trim_cdeg(const argus_wheel_t *const wheel, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->robot->track_mm > 0);
    const int32_t left_pm = knowledge->robot->reversed ? -wheel->short_pm : wheel->short_pm;
    const int32_t speed_mm_s = (knowledge->vel_left_mm_s + knowledge->vel_right_mm_s) / 2;
    const int32_t um = argus_between(0, 1000, speed_mm_s) * LATE_MS * left_pm / 1000; // apart by then
    return -(um * (CDEG_PER_RADIAN / 10) / knowledge->robot->track_mm / 100);
}
