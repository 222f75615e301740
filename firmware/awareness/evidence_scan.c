// SPDX-License-Identifier: MIT
// What the whole ring saw all round from where the robot stands or turns: a turn shows every bearing to many
// sonars.
#include <string.h>

#include "awareness/evidence_internal.h"
#include "knowledge/angle.h"

#define BIN_CDEG (36000 / ARGUS_SCAN_BINS)
#define PLACE_MM 120      // farther from where it began, the picture is of another place
#define SCAN_AGE_MS 6000u // what moves about the robot makes an old picture wrong
#define LAG_MS 70         // a SIP lists pings 0 to 140 ms old
#define WITNESSES 2
#define BOTH_SIDES 5u
#define FARTHEST_MM 3600
#define TOLERANCE_MM 120
#define TOLERANCE_PERCENT 8

// Hundredths of a nat; see DESIGN.md, Evidence.
#define SCAN_MISSES 260
#define SCAN_DIFFERS 220
#define SCAN_AGREES (-40)

void argus_scan_restart(argus_scan_t *const self) {
    memset(self, 0, sizeof *self);
}

// The range that the robot's centre would read along the sonar's axis.
static int32_t from_centre_mm(const int sonar, const int32_t reading_mm) {
    const argus_sonar_pose_t *const m = &argus_sonar_pose[sonar];
    const int32_t heading = m->heading_deg * 100;
    return reading_mm + (m->x_mm * argus_cos(heading) + m->y_mm * argus_sin(heading)) / ARGUS_TRIG_ONE;
}

static int32_t turn_rate_cdeg_s(const argus_knowledge_t *const knowledge) {
    const int32_t difference = knowledge->vel_right_mm_s - knowledge->vel_left_mm_s;
    return difference * 5730 / ARGUS_P3DX_MOTION_TRACK_MM;
}

static int bin_of(const argus_knowledge_t *const knowledge, const int sonar) {
    const int32_t late = turn_rate_cdeg_s(knowledge) * LAG_MS / 1000;
    const int32_t bearing = argus_angle_wrap(argus_built_heading_cdeg(knowledge) - late +
                                             argus_sonar_pose[sonar].heading_deg * 100);
    return (int)((bearing + 36000) / BIN_CDEG % ARGUS_SCAN_BINS);
}

typedef struct {
    int32_t least_mm;
    int32_t most_mm;
    uint32_t echo_sonars;
    unsigned sides; // echoes in the bin before, in its own, in the one after
    bool none;
    bool agrees;
} picture_t;

static int32_t tolerance_of(const int32_t range_mm) {
    return TOLERANCE_MM + range_mm * TOLERANCE_PERCENT / 100;
}

static void look_at(picture_t *const picture, const argus_scan_entry_t *const entry, const int32_t range_mm) {
    if (entry->range_mm >= ARGUS_NO_ECHO_MM) {
        picture->none = true;
        return;
    }
    picture->echo_sonars |= 1u << entry->sonar;
    picture->least_mm = argus_min(picture->least_mm, entry->range_mm);
    picture->most_mm = argus_max(picture->most_mm, entry->range_mm);
    picture->agrees = picture->agrees || argus_abs(entry->range_mm - range_mm) <= tolerance_of(range_mm);
}

static picture_t gather(const argus_scan_t *const self, const argus_knowledge_t *const knowledge,
                        const int sonar, const int bin, const int32_t range_mm) {
    picture_t picture = {INT32_MAX, 0, 0, 0, false, false};
    for (int k = bin - 1; k <= bin + 1; k++) {
        const argus_scan_bin_t *const b = &self->bin[(k + ARGUS_SCAN_BINS) % ARGUS_SCAN_BINS];
        for (int i = 0; i < ARGUS_SCAN_DEPTH; i++) {
            const argus_scan_entry_t *const e = &b->entry[i];
            const bool fresh = e->used && knowledge->sip_ms - e->t_ms < SCAN_AGE_MS;
            if (fresh && e->sonar != sonar && !argus_is_out(knowledge, e->sonar)) {
                look_at(&picture, e, range_mm);
                picture.sides |= e->range_mm < ARGUS_NO_ECHO_MM ? 1u << (k - bin + 1) : 0u;
            }
        }
    }
    return picture;
}

static argus_scan_verdict_t judge(const picture_t *const picture, const bool echo, const int32_t range_mm) {
    if (echo && picture->agrees) {
        return ARGUS_SCAN_AGREES;
    }
    // At the edge of what is heard of a wall, one side hears and the other does not.
    const bool between = (picture->sides & BOTH_SIDES) == BOTH_SIDES;
    if (picture->none || !between || argus_count_bits(picture->echo_sonars) < WITNESSES ||
        picture->most_mm > FARTHEST_MM) {
        return ARGUS_SCAN_NOTHING;
    }
    if (!echo) {
        return ARGUS_SCAN_MISSES;
    }
    const bool shorter = range_mm < picture->least_mm - tolerance_of(range_mm);
    const bool longer = range_mm > picture->most_mm + tolerance_of(picture->most_mm);
    return shorter || longer ? ARGUS_SCAN_DIFFERS : ARGUS_SCAN_NOTHING;
}

static void remember(argus_scan_bin_t *const bin, const int sonar, const int32_t range_mm,
                     const uint32_t now_ms) {
    argus_scan_entry_t *const e = &bin->entry[bin->next];
    bin->next = (uint8_t)((bin->next + 1) % ARGUS_SCAN_DEPTH);
    e->used = true;
    e->sonar = (uint8_t)sonar;
    e->range_mm = (uint16_t)range_mm;
    e->t_ms = now_ms;
}

argus_scan_verdict_t argus_scan_take(argus_scan_t *const self, const argus_knowledge_t *const knowledge,
                                     const int sonar) {
    const int32_t away = argus_hypot(argus_max(-30000, argus_min(30000, knowledge->pose.x_mm - self->x_mm)),
                                     argus_max(-30000, argus_min(30000, knowledge->pose.y_mm - self->y_mm)));
    if (away > PLACE_MM) {
        argus_scan_restart(self);
        self->x_mm = knowledge->pose.x_mm;
        self->y_mm = knowledge->pose.y_mm;
    }
    const bool echo = knowledge->sonar[sonar].reading_mm < ARGUS_NO_ECHO_MM;
    const int32_t range =
        echo ? argus_min(from_centre_mm(sonar, knowledge->sonar[sonar].reading_mm), ARGUS_NO_ECHO_MM - 1)
             : ARGUS_NO_ECHO_MM;
    const int bin = bin_of(knowledge, sonar);
    const picture_t picture = gather(self, knowledge, sonar, bin, range);
    remember(&self->bin[bin], sonar, range, knowledge->sip_ms);
    return judge(&picture, echo, range);
}

int32_t argus_scan_weight(const argus_scan_verdict_t verdict) {
    static const int16_t weight[] = {0, SCAN_AGREES, SCAN_DIFFERS, SCAN_MISSES};
    return weight[verdict];
}
