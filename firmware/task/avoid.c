// SPDX-License-Identifier: MIT
// Leg by leg round what stands in the way, and the end of trying.
#include "task/task.h"

#include "knowledge/angle.h"

#define LEG_DONE_MM 60
#define ESCAPE_MM 300 // way straight ahead out of a place too narrow to turn in
#define ESCAPE_LEAST_MM 100
#define ESCAPE_BESIDE_MM 20
#define ESCAPE_ROOM_MM 250 // beyond it
#define REFUSED_NEAR_MM 350
#define REFUSED_AHEAD_MM 100 // of the body
#define PROGRESS_MM 100
#define SET_BACK_MM 500
#define SET_BACKS_MAX 32
#define CLOSED_MAX 2                       // a map found closed is doubted so often, and then believed
#define VAIN_MS (ARGUS_FORGET_MS + 30000u) // what bars a turn from memory alone is forgotten first
#define GAP_MS 500u

void argus_task_refuse(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                       argus_echoes_t *const echoes) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    bool heard = false;
    self->has_leg = false;
    self->refused = true;
    for (int i = 0; i < knowledge->sonars; i++) {
        if (argus_counts_ahead(knowledge, i) && argus_usable(knowledge, i) &&
            argus_reading_ahead_mm(knowledge, i) <= REFUSED_NEAR_MM) {
            const argus_point_t echo = argus_echo_robot(knowledge, i);
            argus_grid_mark(&echoes->grid, argus_to_course(&knowledge->pose, echo), false);
            heard = true;
        }
    }
    if (!heard) {
        const argus_point_t ahead = {knowledge->robot->front_mm + REFUSED_AHEAD_MM, 0};
        argus_grid_mark(&echoes->grid, argus_to_course(&knowledge->pose, ahead), false);
    }
}

// What is left to go has changed by a new plan.
static void note_way(argus_progress_t *const self, const int32_t to_go_mm) {
    const bool is_set_back = self->least_mm > 0 && to_go_mm > self->least_mm + SET_BACK_MM;
    if (self->least_mm == 0 || is_set_back) {
        self->least_mm = argus_max(1, to_go_mm);
        self->set_backs = (uint8_t)(self->set_backs + (is_set_back ? 1 : 0));
    }
}

static void note_driven(argus_progress_t *const self, const int32_t to_go_mm) {
    if (self->least_mm - to_go_mm >= PROGRESS_MM) {
        self->least_mm = argus_max(1, to_go_mm);
        self->vain_ms = 0;
    }
}

// Counted once until there is a way again, which is then measured anew: the map has been faded for it.
static void note_no_way(argus_progress_t *const self) {
    self->closed = (uint8_t)(self->closed + (self->least_mm > 0 ? 1 : 0));
    self->least_mm = 0;
}

argus_search_news_t argus_task_choose(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                                      const argus_echoes_t *const echoes, const bool stopped) {
    ARGUS_ASSERT(self->next <= self->count);
    const argus_ground_t ground = {knowledge, &echoes->grid, stopped};
    const argus_search_news_t news = self->next < self->count
                                         ? argus_way_find(&self->search, &ground, self->waypoint[self->next])
                                         : ARGUS_SEARCH_NO_WAY;
    self->has_leg = news == ARGUS_SEARCH_FOUND;
    if (news == ARGUS_SEARCH_NO_WAY) {
        note_no_way(&self->progress);
    }
    if (self->has_leg) {
        self->leg = self->search.leg;
        self->avoiding = !self->leg.direct;
        note_way(&self->progress, self->leg.to_go_mm + argus_task_leg_mm(self, knowledge));
    }
    return news;
}

bool argus_task_escape(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                       const argus_echoes_t *const echoes, const int32_t by_cdeg) {
    ARGUS_ASSERT(self->count <= ARGUS_WAYPOINTS_MAX);
    const int32_t half_mm = argus_robot_half_width_mm(knowledge->robot) + ESCAPE_BESIDE_MM;
    const int32_t heading_cdeg = argus_angle_wrap(knowledge->pose.heading_cdeg + by_cdeg);
    const int32_t free_mm = argus_echoes_clear_mm(echoes, knowledge, heading_cdeg, half_mm);
    const int32_t way_mm = argus_min(ESCAPE_MM, free_mm - knowledge->robot->front_mm - ESCAPE_ROOM_MM);
    if (self->next >= self->count || way_mm < ESCAPE_LEAST_MM) {
        return false;
    }
    const argus_point_t ahead = {way_mm, 0};
    const argus_pose_t turned = {knowledge->pose.x_mm, knowledge->pose.y_mm, heading_cdeg};
    self->leg.to_go_mm += argus_task_leg_mm(self, knowledge);
    self->leg.to = argus_to_course(&turned, ahead);
    self->leg.direct = false;
    self->leg.narrow = true;
    self->avoiding = true;
    self->has_leg = true;
    return true;
}

void argus_task_keep(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                     const argus_echoes_t *const echoes) {
    const argus_ground_t ground = {knowledge, &echoes->grid, false};
    const bool done = self->avoiding && argus_task_leg_mm(self, knowledge) <= LEG_DONE_MM;
    self->has_leg = self->has_leg && !done && argus_way_is_free(&ground, &self->leg);
}

bool argus_task_is_hopeless(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                            const bool drives) {
    argus_progress_t *const mine = &self->progress;
    const uint32_t since_ms = knowledge->sip_ms - mine->last_ms;
    mine->last_ms = knowledge->sip_ms;
    if (!drives || self->next >= self->count) {
        return false;
    }
    mine->vain_ms += since_ms <= GAP_MS ? since_ms : 0;
    if (self->has_leg) {
        note_driven(mine, self->leg.to_go_mm + argus_task_leg_mm(self, knowledge));
    }
    return mine->vain_ms >= VAIN_MS || mine->set_backs > SET_BACKS_MAX || mine->closed > CLOSED_MAX;
}
