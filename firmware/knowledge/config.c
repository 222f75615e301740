// SPDX-License-Identifier: MIT
// Defaults and ranges of the settings, and the two inequalities of S5.
#include "knowledge/config.h"

#include <stddef.h>
#include <string.h>

#include "arcos/gen_arcos.h"
#include "knowledge/angle.h"

#define SIP_READINGS 3 // the most of each array in one SIP
#define SIP_BARE (ARCOS_SIP_COUNT_BARE + ARCOS_FRAME_OVERHEAD)
#define COMMAND_BYTES 9
#define US_PER_S 1000000u

#define NOISE_SIGMAS 3
#define STEP_MARGIN_MM 20

// What ARGUS_AUTO stands for with a P3-DX; the ranges grow in whole parts.
#define AUTO_SPEED_MM_S 200
#define AUTO_SPEED_LEAST_MM_S 30 // what would be slower is refused
#define AUTO_OBJECT_MM 250
#define AUTO_CHECK_MM 350
#define AUTO_PART_MM 50

// A column of the table as it fits: few settings need more than 16 bits.
#define DEFAULT(key, def, min, max, unit, choices, meaning) (def),
#define MINIMUM(key, def, min, max, unit, choices, meaning) (min),
#define MAXIMUM(key, def, min, max, unit, choices, meaning) (max),
static const int16_t defaults[] = {ARGUS_CONFIG_TABLE(DEFAULT)};
static const int16_t minima[] = {ARGUS_CONFIG_TABLE(MINIMUM)};
static const int32_t maxima[] = {ARGUS_CONFIG_TABLE(MAXIMUM)};
#define ROWS (sizeof defaults / sizeof defaults[0])
_Static_assert(sizeof(argus_config_t) == ROWS * sizeof(int32_t), "the settings are one int32_t for each row");

void argus_config_default(argus_config_t *config) {
    for (size_t i = 0; i < ROWS; i++) {
        const int32_t value = defaults[i];
        memcpy((uint8_t *)config + i * sizeof value, &value, sizeof value);
    }
}

// The number of the first row out of range, or -1. A default is good, whatever the range (ARGUS_AUTO).
static int32_t row_out_of_range(const argus_config_t *config) {
    for (size_t i = 0; i < ROWS; i++) {
        int32_t value;
        memcpy(&value, (const uint8_t *)config + i * sizeof value, sizeof value);
        if (value != defaults[i] && (value < minima[i] || value > maxima[i])) {
            return (int32_t)i;
        }
    }
    return -1;
}

static uint32_t reaction_us(const argus_config_t *config, const argus_robot_t *robot) {
    ARGUS_ASSERT(robot->arrays > 0 && config->sonar_cycle_ms > 0);
    const uint32_t sip_bytes = SIP_BARE + (uint32_t)robot->arrays * SIP_READINGS * ARCOS_SIP_SONAR_BYTES;
    const uint32_t bits = (sip_bytes + COMMAND_BYTES) * ARCOS_TIMING_BITS_PER_BYTE;
    const uint32_t wire_us = config->baud > 0 ? bits * US_PER_S / (uint32_t)config->baud : 0;
    const uint32_t refresh_ms = ARCOS_TIMING_TRANSDUCERS_PER_ARRAY * (uint32_t)config->sonar_cycle_ms;
    return (refresh_ms + ARCOS_TIMING_SIP_CYCLE_MS) * 1000 + wire_us;
}

// What is asked beyond the robot's own setting is a gain, not a promise: the order may be lost on the wire.
static uint32_t sure_decel_mm_s2(const argus_config_t *config, const argus_robot_t *robot) {
    return (uint32_t)argus_min(config->decel_mm_s2, robot->decel_mm_s2);
}

// Rounded once, at the end: a sum of rounded parts would refuse speeds that are within the limit. The order
// of the multiplications keeps everything within 32 bits for any setting in range.
static void work_out_driving(argus_config_report_t *report, const argus_config_t *config,
                             const argus_robot_t *robot, int32_t late_ms) {
    const uint32_t v = (uint32_t)config->speed_mm_s;
    const uint32_t t_us = reaction_us(config, robot) + (uint32_t)late_ms * 1000;
    const uint32_t travel_um = v * (t_us / 1000) + v * (t_us % 1000) / 1000;
    const uint32_t brake_um = v * v * 1000 / (2 * sure_decel_mm_s2(config, robot));
    report->overhang_mm = robot->front_mm - robot->sonar_face_mm;
    report->reaction_ms = (int32_t)((t_us + 500) / 1000);
    report->travel_mm = (int32_t)(travel_um / 1000);
    report->driving_mm = report->overhang_mm + (int32_t)((travel_um + brake_um) / 1000);
    report->brake_mm = report->driving_mm - report->overhang_mm - report->travel_mm;
    ARGUS_ASSERT(report->travel_mm >= 0 && report->brake_mm >= 0);
}

int32_t argus_config_stop_mm(const argus_config_t *config, const argus_robot_t *robot, int32_t late_ms) {
    ARGUS_ASSERT(config->speed_mm_s > 0 && config->decel_mm_s2 > 0 && late_ms >= 0);
    argus_config_report_t report = {.fault = ARGUS_CONFIG_OK, .key = -1};
    work_out_driving(&report, config, robot, late_ms);
    return report.travel_mm + report.brake_mm;
}

// Of v t + v^2 / 2a = s the greater root, v = sqrt((a t)^2 + 2 a s) - a t. What is rounded makes it slower,
// and 1 mm is left, since the check wants less than the range.
int32_t argus_config_speed_mm_s(const argus_config_t *config, const argus_robot_t *robot, int32_t range_mm,
                                int32_t late_ms) {
    ARGUS_ASSERT(range_mm <= INT16_MAX && late_ms >= 0);
    const int32_t decel_mm_s2 = (int32_t)sure_decel_mm_s2(config, robot);
    const int32_t overhang_mm = robot->front_mm - robot->sonar_face_mm;
    const int32_t stop_mm = argus_max(0, range_mm - overhang_mm - 1);
    const int32_t t_ms = (int32_t)(reaction_us(config, robot) / 1000 + 1) + late_ms;
    const int32_t slower_mm_s = (decel_mm_s2 * t_ms + 999) / 1000;
    const uint32_t square = (uint32_t)(slower_mm_s * slower_mm_s + 2 * decel_mm_s2 * stop_mm);
    return (int32_t)argus_sqrt(square) - slower_mm_s;
}

static int32_t sqrt_up(int32_t value) {
    ARGUS_ASSERT(value >= 0);
    const uint32_t root = argus_sqrt((uint32_t)value);
    return (int32_t)(root + (root * root < (uint32_t)value));
}

// What one sonar hears of the line that the front of the body sweeps up to: from .. to across it. Half
// millimetres like everything here, because the body is an odd number wide.
typedef struct {
    int32_t ahead2; // of the transducer
    int32_t across2;
    int32_t from2;
    int32_t to2;
} view_t;

// Where a ray so far beside the axis meets the line, to half a millimetre.
static int32_t edge_of(int32_t ahead2, int32_t cdeg) {
    const int32_t c = argus_cos(cdeg);
    ARGUS_ASSERT(c > 0 && ahead2 > 0);
    return ahead2 * argus_sin(cdeg) / c;
}

static view_t view_of(const argus_robot_t *robot, int sonar, int32_t front2) {
    const argus_sonar_pose_t pose = argus_robot_pose(robot, sonar);
    const int32_t half_cdeg = argus_robot_cone_deg(robot, sonar) * 100 / 2;
    view_t view = {.ahead2 = front2 - 2 * pose.x_mm, .across2 = 2 * pose.y_mm};
    view.from2 = view.across2 + edge_of(view.ahead2, pose.heading_deg * 100 - half_cdeg);
    view.to2 = view.across2 + edge_of(view.ahead2, pose.heading_deg * 100 + half_cdeg);
    return view;
}

// Square of the reading of the place y2 on that line.
static int32_t reading_of(const view_t *views, int count, int32_t y2) {
    int32_t seen = INT32_MAX;
    int32_t nearest = INT32_MAX;
    for (int i = 0; i < count; i++) {
        const view_t *view = &views[i];
        const int32_t dy = y2 - view->across2;
        const int32_t square = view->ahead2 * view->ahead2 + dy * dy;
        nearest = argus_min(nearest, square);
        if (y2 >= view->from2 && y2 <= view->to2) {
            seen = argus_min(seen, square);
        }
    }
    return seen < INT32_MAX ? seen : nearest;
}

int32_t argus_config_reach_mm(const argus_robot_t *robot, int32_t step_mm) {
    ARGUS_ASSERT(step_mm > 0 && robot->width_mm > 0);
    view_t views[ARGUS_FORWARD_MAX];
    const int32_t front2 = 2 * (robot->front_mm + step_mm);
    const int32_t side2 = robot->width_mm;
    int32_t square = 0;
    for (int i = 0; i < robot->forward_count; i++) {
        views[i] = view_of(robot, robot->forward[i], front2);
    }
    for (int32_t y2 = -side2; y2 <= side2; y2++) {
        square = argus_max(square, reading_of(views, robot->forward_count, y2));
    }
    return (sqrt_up(square) + 1) / 2;
}

static int32_t stepping_mm(const argus_config_t *config, int32_t reach_mm) {
    return reach_mm + NOISE_SIGMAS * config->noise_mm + STEP_MARGIN_MM;
}

// Whole parts that are more than needed.
static int32_t parts_above(int32_t needed_mm) {
    ARGUS_ASSERT(needed_mm >= 0);
    return (needed_mm / AUTO_PART_MM + 1) * AUTO_PART_MM;
}

// For one end, as far as the ranges before fall short: what an end of the robot asks of the settings as they
// are built, so that a range does not depend on what else is set.
static void widen(argus_config_t *config, const argus_robot_t *robot) {
    argus_config_t built;
    argus_config_report_t report = {.fault = ARGUS_CONFIG_OK, .key = -1};
    argus_config_default(&built);
    built.speed_mm_s = AUTO_SPEED_MM_S;
    built.sonar_cycle_ms = robot->cycle_ms;
    work_out_driving(&report, &built, robot, 0);
    const int32_t step_mm = stepping_mm(&built, argus_config_reach_mm(robot, built.step_mm));
    config->object_range_mm = argus_max(config->object_range_mm, parts_above(report.driving_mm));
    config->check_range_mm = argus_max(config->check_range_mm, parts_above(step_mm));
}

static argus_config_t auto_ranges(const argus_robot_t *robot) {
    const argus_robot_t *const other = argus_robot_other_end(robot);
    argus_config_t ranges = {.object_range_mm = AUTO_OBJECT_MM, .check_range_mm = AUTO_CHECK_MM};
    if (argus_robot_is_known(robot)) {
        widen(&ranges, robot);
    }
    if (other != NULL) {
        widen(&ranges, other);
    }
    return ranges;
}

static int32_t auto_speed_mm_s(const argus_config_t *config, const argus_robot_t *robot) {
    const argus_robot_t *const other = argus_robot_other_end(robot);
    const int32_t here_mm_s = argus_config_speed_mm_s(config, robot, config->object_range_mm, 0);
    const int32_t there_mm_s =
        other != NULL ? argus_config_speed_mm_s(config, other, config->object_range_mm, 0) : here_mm_s;
    const int32_t safe_mm_s = argus_min(here_mm_s, there_mm_s);
    return argus_max(AUTO_SPEED_LEAST_MM_S, argus_min(AUTO_SPEED_MM_S, safe_mm_s));
}

argus_follows_t argus_config_follows(const argus_config_t *config) {
    return (argus_follows_t){.sonar_cycle = config->sonar_cycle_ms == ARGUS_AUTO,
                             .speed = config->speed_mm_s == ARGUS_AUTO,
                             .object_range = config->object_range_mm == ARGUS_AUTO,
                             .check_range = config->check_range_mm == ARGUS_AUTO};
}

static void follow_body(argus_config_t *config, argus_follows_t follows, const argus_robot_t *robot) {
    const argus_config_t ranges = auto_ranges(robot); // costs as much as the check
    if (follows.object_range) {
        config->object_range_mm = ranges.object_range_mm;
    }
    if (follows.check_range) {
        config->check_range_mm = ranges.check_range_mm;
    }
}

void argus_config_follow(argus_config_t *config, argus_follows_t follows, const argus_robot_t *robot) {
    const bool is_known = argus_robot_is_known(robot);
    const bool is_sound = is_known && row_out_of_range(config) < 0;
    if (follows.sonar_cycle) {
        config->sonar_cycle_ms = (is_known ? robot : argus_robot_default())->cycle_ms;
    }
    if (follows.object_range || follows.check_range) {
        follow_body(config, follows, robot);
    }
    if (follows.speed) {
        config->speed_mm_s = is_sound ? auto_speed_mm_s(config, robot) : AUTO_SPEED_MM_S;
    }
}

void argus_config_mend(argus_config_t *config) {
    argus_config_t built;
    argus_config_default(&built);
    for (int32_t row = row_out_of_range(config); row >= 0; row = row_out_of_range(config)) {
        const size_t at = (size_t)row * sizeof(int32_t);
        memcpy((uint8_t *)config + at, (const uint8_t *)&built + at, sizeof(int32_t));
    }
}

argus_config_report_t argus_config_check(const argus_config_t *config) {
    const argus_robot_t *chosen = argus_robot_chosen(config->robot);
    return argus_config_check_for(config, chosen != NULL ? chosen : argus_robot_default());
}

static void take_in_force(argus_config_report_t *report, const argus_config_t *config) {
    report->speed_mm_s = config->speed_mm_s;
    report->object_range_mm = config->object_range_mm;
    report->check_range_mm = config->check_range_mm;
}

argus_config_report_t argus_config_check_for(const argus_config_t *asked, const argus_robot_t *robot) {
    argus_config_report_t report = {.fault = ARGUS_CONFIG_OK, .key = row_out_of_range(asked)};
    if (report.key >= 0) {
        report.fault = ARGUS_CONFIG_RANGE;
        return report; // the arithmetic below relies on the ranges
    }
    argus_config_t config = *asked;
    argus_config_follow(&config, argus_config_follows(asked), robot);
    take_in_force(&report, &config);
    work_out_driving(&report, &config, robot, 0);
    report.reach_mm = argus_config_reach_mm(robot, config.step_mm);
    report.stepping_mm = stepping_mm(&config, report.reach_mm);
    if (report.driving_mm >= config.object_range_mm) {
        report.fault = ARGUS_CONFIG_DRIVING;
    } else if (report.stepping_mm >= config.check_range_mm) {
        report.fault = ARGUS_CONFIG_STEP;
    }
    return report;
}
