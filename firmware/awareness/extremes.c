// SPDX-License-Identifier: MIT
// Judges the extremes of a reading by way and time.
#include "awareness/extremes.h"

#include <string.h>

#include "awareness/numbers.h"
#include "knowledge/angle.h"

void argus_extremes_init(argus_extremes_t *const self) {
    memset(self, 0, sizeof *self);
}

void argus_extremes_forget(argus_extremes_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    memset(&self->of[sonar], 0, sizeof self->of[sonar]);
}

void argus_extremes_restart(argus_extremes_t *const self) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        self->of[i].running = false;
        self->of[i].before_mm = 0;
    }
}

static bool is_shortest(const argus_knowledge_t *const knowledge, const int32_t reading_mm) {
    ARGUS_ASSERT(reading_mm >= 0);
    return reading_mm <= knowledge->robot->min_mm + ARGUS_SHORTEST_NOISE_MM;
}

static void begin_run(argus_extreme_t *const self, const argus_pose_t *const pose, const int32_t reading_mm) {
    self->run_mm = (uint16_t)reading_mm;
    self->at = (argus_point_t){pose->x_mm, pose->y_mm};
    self->from = self->at;
    self->from_cdeg = pose->heading_cdeg;
    self->away_mm = 0;
    self->running = true;
}

// Another sonar on the same side hears the wall that this one claims to be beside, or something farther off.
// 1: farther, 0: it cannot tell, -1: the wall.
static int mate_says(const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const argus_robot_t *const robot = knowledge->robot;
    const unsigned abeam = argus_robot_flank(robot) | argus_robot_rear_flank(robot);
    const argus_sonar_pose_t mine = argus_robot_pose(robot, sonar);
    for (int i = 0; i < knowledge->sonars; i++) {
        const bool mate = i != sonar && (abeam >> i & 1u) != 0 &&
                          argus_robot_pose(robot, i).heading_deg == mine.heading_deg;
        if (mate && argus_usable(knowledge, i)) {
            return knowledge->sonar[i].reading_mm > robot->min_mm + ARGUS_SHORTEST_CLEAR_MM ? 1 : -1;
        }
    }
    return 0;
}

// One that looks about the same way hears something as near, not at its own least: there is something, as a
// person beside the robot, who comes and goes as he likes. Nothing that near is so small that one alone hears
// it.
static bool has_company(const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const argus_robot_t *const robot = knowledge->robot;
    const int32_t bearing = argus_robot_pose(robot, sonar).heading_deg * 100;
    for (int i = 0; i < knowledge->sonars; i++) {
        const int32_t reading_mm = knowledge->sonar[i].reading_mm;
        if (i != sonar && !is_shortest(knowledge, reading_mm) &&
            reading_mm <= robot->min_mm + ARGUS_SHORTEST_CLEAR_MM && argus_usable(knowledge, i) &&
            argus_angle_abs_diff(argus_robot_pose(robot, i).heading_deg * 100, bearing) <=
                ARGUS_SHORTEST_BESIDE_CDEG) {
            return true;
        }
    }
    return false;
}

// Beside a wall a range stays on the way, too; but no robot drives so near one that it reads its shortest.
static bool tells_alone(const argus_extreme_t *const self, const argus_knowledge_t *const knowledge,
                        const int sonar) {
    const int32_t bearing = argus_robot_pose(knowledge->robot, sonar).heading_deg * 100;
    return is_shortest(knowledge, self->run_mm) ||
           argus_abs(argus_cos(bearing)) > ARGUS_TRIG_ONE * ARGUS_SHORTEST_ALONG_PERCENT / 100;
}

// What stands still is as far off as the robot went away from it, at least.
static void go_on(argus_extreme_t *const self, const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_pose_t *const pose = &knowledge->pose;
    const int32_t axis = pose->heading_cdeg + argus_robot_pose(knowledge->robot, sonar).heading_deg * 100;
    const argus_point_t step = {pose->x_mm - self->at.x_mm, pose->y_mm - self->at.y_mm};
    const int says = mate_says(knowledge, sonar);
    self->at = (argus_point_t){pose->x_mm, pose->y_mm};
    self->away_mm = argus_max(0, self->away_mm - argus_in_frame(step, axis).x_mm);
    const bool company = has_company(knowledge, sonar);
    if (says < 0 || company) {
        self->from = self->at;
        self->away_mm = company ? 0 : self->away_mm;
    }
    const int32_t past_mm = argus_hypot(self->at.x_mm - self->from.x_mm, self->at.y_mm - self->from.y_mm);
    const bool alone = tells_alone(self, knowledge, sonar);
    self->proved = self->proved || (says > 0 && past_mm >= ARGUS_SHORTEST_ABEAM_MM) ||
                   (alone && (self->away_mm >= ARGUS_SHORTEST_AWAY_MM || past_mm >= ARGUS_SHORTEST_ALONE_MM));
}

static void take_near(argus_extreme_t *const self, const argus_knowledge_t *const knowledge,
                      const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t turned = argus_angle_abs_diff(knowledge->pose.heading_cdeg, self->from_cdeg);
    const unsigned abeam = argus_robot_flank(knowledge->robot) | argus_robot_rear_flank(knowledge->robot);
    const int32_t most =
        (abeam >> sonar & 1u) != 0 ? ARGUS_SHORTEST_TURNED_ABEAM_CDEG : ARGUS_SHORTEST_TURNED_CDEG;
    const int32_t reading_mm = knowledge->sonar[sonar].reading_mm;
    const bool alike = self->running && argus_abs(reading_mm - self->run_mm) <= ARGUS_SHORTEST_NOISE_MM;
    self->proved = self->proved && alike;
    if (!alike || turned > most) {
        begin_run(self, &knowledge->pose, reading_mm);
        return;
    }
    go_on(self, knowledge, sonar);
}

// How little a reading can be true after those before it; 0: it may well be.
static int doubt(const argus_extreme_t *const self, const argus_knowledge_t *const knowledge,
                 const int32_t reading_mm) {
    ARGUS_ASSERT(reading_mm >= 0);
    const int32_t far_mm = knowledge->robot->min_mm + ARGUS_SHORTEST_FAR_MM;
    if (is_shortest(knowledge, reading_mm) && self->before_mm > far_mm) {
        return ARGUS_IMPOSSIBLE_LEAPS;
    }
    return self->visited && reading_mm > far_mm ? ARGUS_IMPOSSIBLE_VISIT : 0;
}

// What this reading adds. Below the least counts at once, unless it is a leap, too. A leap counts with the
// next reading, when those beside it have fired, too: what one of them hears as near has come there.
static int weigh(argus_extreme_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                 const int32_t reading_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int doubted = doubt(self, knowledge, reading_mm);
    const bool company = doubted + self->waits > 0 && has_company(knowledge, sonar);
    const int counts = company ? 0 : self->waits;
    self->waits = (uint8_t)(company ? 0 : doubted);
    if (doubted == 0 && reading_mm < knowledge->robot->min_mm) {
        return counts + ARGUS_IMPOSSIBLE_CONVICTS / ARGUS_IMPOSSIBLE_ROW;
    }
    return counts - (doubted == 0 && !is_shortest(knowledge, reading_mm) ? 1 : 0);
}

static void take(argus_extreme_t *const self, const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t reading = knowledge->sonar[sonar].reading_mm;
    const bool shortest = is_shortest(knowledge, reading);
    const int level = self->level + weigh(self, knowledge, sonar, reading);
    self->level = (uint8_t)argus_between(0, ARGUS_IMPOSSIBLE_MAX, level);
    self->visited = !shortest && reading <= knowledge->robot->min_mm + ARGUS_SHORTEST_NEAR_MM &&
                    self->before_mm > knowledge->robot->min_mm + ARGUS_SHORTEST_FAR_MM;
    self->before_mm = (uint16_t)reading;
    self->row = shortest ? argus_one_more(self->row) : 0;
    if (reading <= knowledge->robot->min_mm + ARGUS_SHORTEST_NEAR_MM) {
        take_near(self, knowledge, sonar);
    } else {
        self->running = false;
        self->proved = false;
    }
}

void argus_extremes_sip(argus_extremes_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((knowledge->fresh >> i & 1u) != 0 && !argus_robot_is_sector(knowledge->robot, i)) {
            take(&self->of[i], knowledge, i);
        }
    }
}

argus_fault_kind_t argus_extremes_convicts(const argus_extremes_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_extreme_t *const e = &self->of[sonar];
    if (e->proved) {
        return ARGUS_KIND_STUCK;
    }
    if (e->level < ARGUS_IMPOSSIBLE_CONVICTS) {
        return ARGUS_KIND_NONE;
    }
    return e->row >= ARGUS_IMPOSSIBLE_ROW ? ARGUS_KIND_STUCK : ARGUS_KIND_INTERMITTENT;
}

bool argus_extremes_keeps_out(const argus_extremes_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return self->of[sonar].proved || self->of[sonar].level > ARGUS_IMPOSSIBLE_CONVICTS / 2;
}
