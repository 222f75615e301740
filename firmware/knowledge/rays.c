// SPDX-License-Identifier: MIT
// Logs rays, and says how far the way ahead has been seen along them.
#include "knowledge/rays.h"

#include "knowledge/angle.h"

#define TRUST_BITS 0x7FFu
#define SONAR_BITS 0x1Fu
#define LATELY_MS 5000u
#define CONE_SLOPE 27 // tan 12 degrees, / 128: within 15 where the beam still tells
#define STEP_MM 80
#define ABREAST 3 // places on either side of the middle

_Static_assert(ARGUS_RAY_TRUST_MM < 1 << 11 && ARGUS_SONARS <= 1 << 5, "a ray has so many bits for them");

void argus_rays_forget(argus_rays_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    for (int i = 0; i < self->count; i++) {
        self->at[i].free_mm = self->at[i].sonar == sonar ? 0 : self->at[i].free_mm;
    }
}

void argus_rays_forget_all(argus_rays_t *const self) {
    ARGUS_ASSERT(self->count <= ARGUS_RAYS_MAX);
    self->count = 0;
    self->next = 0;
}

static void add(argus_rays_t *const self, const argus_ray_t *const ray, const uint32_t now_ms) {
    ARGUS_ASSERT(self->next < ARGUS_RAYS_MAX);
    if (now_ms - self->newest_ms > LATELY_MS) {
        argus_rays_forget_all(self);
    }
    self->newest_ms = now_ms;
    self->at[self->next] = *ray;
    self->next = (uint8_t)((self->next + 1) % ARGUS_RAYS_MAX);
    self->count = (uint8_t)argus_min(self->count + 1, ARGUS_RAYS_MAX);
}

static bool fits(const argus_point_t at) {
    return argus_abs(at.x_mm) <= INT16_MAX && argus_abs(at.y_mm) <= INT16_MAX;
}

static void see(argus_rays_t *const self, const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_pose_t pose = argus_robot_pose(knowledge->robot, sonar);
    const argus_point_t from = argus_to_course(&knowledge->pose, (argus_point_t){pose.x_mm, pose.y_mm});
    const int32_t bearing_cdeg = knowledge->pose.heading_cdeg + pose.heading_deg * 100;
    if (!fits(from)) {
        return;
    }
    const int32_t free_mm = argus_min(knowledge->sonar[sonar].reading_mm, ARGUS_RAY_TRUST_MM);
    const argus_ray_t ray = {.x_mm = (int16_t)from.x_mm,
                             .y_mm = (int16_t)from.y_mm,
                             .c = (int16_t)argus_cos(bearing_cdeg),
                             .s = (int16_t)argus_sin(bearing_cdeg),
                             .free_mm = (uint16_t)free_mm & TRUST_BITS,
                             .sonar = (uint16_t)sonar & SONAR_BITS,
                             .t_ms = (uint16_t)(knowledge->sip_ms & 0xFFFFu)};
    add(self, &ray, knowledge->sip_ms);
}

void argus_rays_see(argus_rays_t *const self, const argus_knowledge_t *const knowledge,
                    const argus_mask_t others) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const unsigned looks = argus_robot_ahead(knowledge->robot) | argus_robot_flank(knowledge->robot) | others;
    for (int i = 0; i < knowledge->sonars; i++) {
        const bool fresh = (knowledge->fresh & looks) >> i & 1u;
        if (fresh && argus_trusted(knowledge, i)) {
            see(self, knowledge, i);
        }
    }
}

static bool shows(const argus_ray_t *const ray, const argus_point_t at) {
    ARGUS_ASSERT(ray->free_mm <= ARGUS_RAY_TRUST_MM);
    const int32_t dx = at.x_mm - ray->x_mm;
    const int32_t dy = at.y_mm - ray->y_mm;
    const int32_t along_mm = (dx * ray->c + dy * ray->s) / ARGUS_TRIG_ONE;
    if (along_mm <= 0 || along_mm >= ray->free_mm) {
        return false;
    }
    const int32_t beside_mm = argus_abs((dy * ray->c - dx * ray->s) / ARGUS_TRIG_ONE);
    return beside_mm <= along_mm * CONE_SLOPE / 128 + ARGUS_RAY_BESIDE_MM;
}

static const argus_ray_t *ray_at(const argus_rays_t *const self, const int back) {
    ARGUS_ASSERT(back >= 1 && back <= ARGUS_RAYS_MAX);
    return &self->at[((unsigned)self->next + ARGUS_RAYS_MAX - (unsigned)back) % ARGUS_RAYS_MAX];
}

// How many rays count, from the newest to the last before one that is too old.
static int count_lately(const argus_rays_t *const self, const uint32_t now_ms) {
    ARGUS_ASSERT(self->count <= ARGUS_RAYS_MAX);
    const int most = now_ms - self->newest_ms > LATELY_MS ? 0 : self->count;
    int count = 0;
    while (count < most && (uint16_t)(now_ms - ray_at(self, count + 1)->t_ms) <= LATELY_MS) {
        count++;
    }
    return count;
}

// The first of `count` rays that shows a place, the newest first: it is likeliest. NULL: none.
static const argus_ray_t *seen_by(const argus_rays_t *const self, const int count, const argus_point_t at) {
    for (int back = 1; back <= count; back++) {
        const argus_ray_t *const ray = ray_at(self, back);
        if (shows(ray, at)) {
            return ray;
        }
    }
    return NULL;
}

static bool is_shown(const argus_ray_t *const by, const argus_point_t at) {
    return by != NULL && shows(by, at);
}

// Seven places abreast. `by`: for each of them what showed the last one, which mostly shows this one, too;
// what showed its neighbour is the next likeliest.
static bool is_line_seen(const argus_rays_t *const self, const int count, const argus_frame_t *const robot,
                         const argus_point_t edge, const argus_ray_t *by[]) {
    ARGUS_ASSERT(edge.y_mm > 0);
    const argus_ray_t *beside = NULL;
    for (int k = -ABREAST; k <= ABREAST; k++) {
        const argus_point_t place = {edge.x_mm, edge.y_mm * k / ABREAST};
        const argus_point_t at = argus_from_frame(robot, place);
        const argus_ray_t **const last = &by[k + ABREAST];
        if (!is_shown(*last, at)) {
            *last = is_shown(beside, at) ? beside : seen_by(self, count, at);
        }
        if (*last == NULL) {
            return false;
        }
        beside = *last;
    }
    return true;
}

int32_t argus_rays_seen_mm(const argus_rays_t *const self, const argus_knowledge_t *const knowledge,
                           const int32_t half_mm, const int32_t most_mm) {
    ARGUS_ASSERT(half_mm > 0 && most_mm >= 0);
    const argus_frame_t robot = argus_frame_at(&knowledge->pose);
    const int32_t front_mm = knowledge->robot->front_mm;
    const int count = count_lately(self, knowledge->sip_ms);
    const argus_ray_t *by[2 * ABREAST + 1] = {NULL};
    int32_t seen_mm = 0;
    while (seen_mm < most_mm &&
           is_line_seen(self, count, &robot, (argus_point_t){front_mm + seen_mm + STEP_MM, half_mm}, by)) {
        seen_mm += STEP_MM;
    }
    return argus_min(seen_mm, most_mm);
}
