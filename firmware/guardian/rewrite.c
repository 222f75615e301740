// SPDX-License-Identifier: MIT
// Rewrites the list of sonars in a SIP.
#include "guardian/rewrite.h"

#include <string.h>

#include "knowledge/angle.h"

#define LIST (ARCOS_SIP_OFFSET_SONAR - ARCOS_SIP_OFFSET_TYPE)
#define LISTED (ARCOS_SIP_OFFSET_SONAR_COUNT - ARCOS_SIP_OFFSET_TYPE)
#define FLAGS (ARCOS_SIP_OFFSET_FLAGS - ARCOS_SIP_OFFSET_TYPE)
#define ENTRY ARCOS_SIP_SONAR_BYTES
#define ARRAY ARCOS_TIMING_TRANSDUCERS_PER_ARRAY
#define ARRAYS 4
#define FIRST_ARRAY_FLAG ((unsigned)ARCOS_FLAG_SONAR1) // the next bits are those of the other arrays
#define LATELY_MS 2000u

static bool is_echo_of(const argus_t *const self, const argus_ray_t *const ray) {
    return ray->free_mm > 0 && ray->free_mm < ARGUS_RAY_TRUST_MM &&
           argus_trusted(&self->knowledge, ray->sonar);
}

// From the transducer to the end of the ray, if that lies within its cone, else 0.
static int32_t seen_mm(const argus_ray_t *const ray, const argus_point_t from, const int32_t bearing_cdeg,
                       const int32_t cone_deg) {
    const argus_point_t way = {ray->x_mm + ray->free_mm * ray->c / ARGUS_TRIG_ONE - from.x_mm,
                               ray->y_mm + ray->free_mm * ray->s / ARGUS_TRIG_ONE - from.y_mm};
    const argus_point_t seen = argus_in_frame(way, bearing_cdeg);
    const int32_t half_mm = seen.x_mm * argus_sin(cone_deg * 50) / ARGUS_TRIG_ONE + ARGUS_RAY_BESIDE_MM;
    const bool is_within = seen.x_mm > 0 && argus_abs(seen.y_mm) <= half_mm;
    return is_within ? argus_hypot(way.x_mm, way.y_mm) : 0;
}

int32_t argus_rewrite_cover_mm(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_knowledge_t *const knowledge = &self->knowledge;
    const argus_sonar_pose_t pose = argus_robot_pose(knowledge->robot, sonar);
    const argus_point_t from = argus_to_course(&knowledge->pose, (argus_point_t){pose.x_mm, pose.y_mm});
    const int32_t bearing_cdeg = argus_angle_wrap(knowledge->pose.heading_cdeg + pose.heading_deg * 100);
    int32_t nearest_mm = 0;
    const argus_rays_t *const rays = &self->rays;
    const int count = knowledge->sip_ms - rays->newest_ms > LATELY_MS ? 0 : rays->count;
    for (int i = 1; i <= count; i++) { // the newest first: their times are modulo 65,536 ms
        const argus_ray_t *const ray = &rays->at[(rays->next + ARGUS_RAYS_MAX - i) % ARGUS_RAYS_MAX];
        if ((uint16_t)(knowledge->sip_ms - ray->t_ms) > LATELY_MS) {
            break;
        }
        const int32_t mm =
            is_echo_of(self, ray) ? seen_mm(ray, from, bearing_cdeg, knowledge->robot->cone_deg) : 0;
        nearest_mm = mm > 0 && (nearest_mm == 0 || mm < nearest_mm) ? mm : nearest_mm;
    }
    return nearest_mm;
}

static bool is_wanted(const argus_rewrite_t *const how, const uint8_t number) {
    return number / ARRAY >= ARRAYS || (how->arrays >> (number / ARRAY) & 1u) != 0;
}

static bool is_passed(const argus_t *const self, const argus_rewrite_t *const how, const uint8_t number) {
    return how->readings == ARGUS_READINGS_PASS || number >= self->knowledge.sonars ||
           !argus_is_out(&self->knowledge, number);
}

// One entry of the list; the bytes written.
static size_t entry(const argus_t *const self, const argus_rewrite_t *const how, const uint8_t *const from,
                    uint8_t *const to) {
    if (!is_wanted(how, from[0])) {
        return 0;
    }
    to[0] = from[0];
    to[1] = from[1];
    to[2] = from[2];
    if (is_passed(self, how, from[0])) {
        return ENTRY;
    }
    const int32_t cover_mm =
        how->readings == ARGUS_READINGS_COVER ? argus_rewrite_cover_mm(self, from[0]) : 0;
    to[1] = (uint8_t)(cover_mm & 0xFF);
    to[2] = (uint8_t)(cover_mm >> 8);
    return cover_mm > 0 ? ENTRY : 0;
}

static size_t list(const argus_t *const self, const argus_rewrite_t *const how, const uint8_t *const data,
                   uint8_t *const out) {
    size_t length = LIST;
    for (size_t i = 0; i < data[LISTED]; i++) {
        length += entry(self, how, data + LIST + i * ENTRY, out + length);
    }
    out[LISTED] = (uint8_t)((length - LIST) / ENTRY);
    return length;
}

// Where the port stands in a SIP, its value behind it; 0: in none that is so short.
static size_t analog_at(const uint8_t *const data, const size_t count) {
    const size_t at =
        count > LISTED ? LIST + (size_t)data[LISTED] * ENTRY + ARCOS_SIP_AFTER_SONAR_ANPORT : count;
    return at + 1 < count ? at : 0;
}

void argus_rewrite_note_analog(argus_analog_t *const analog, const uint8_t *const data, const size_t count) {
    const size_t at = analog_at(data, count);
    if (at == 0 || data[at] >= ARGUS_ANALOG_PORTS) {
        return;
    }
    analog->value[data[at]] = data[at + 1];
    analog->known |= (uint8_t)(1u << data[at]);
    if (!analog->begun) {
        analog->begun = true;
        analog->wants = analog->shows = data[at];
    }
    if (analog->wants < ARGUS_ANALOG_PORTS && (analog->known >> analog->wants & 1u) != 0) {
        analog->shows = analog->wants;
    }
}

static void show_analog(const argus_analog_t *const analog, uint8_t *const out, const size_t count) {
    const size_t at = analog_at(out, count);
    if (analog != NULL && analog->begun && at != 0 && out[at] < ARGUS_ANALOG_PORTS) {
        out[at] = analog->shows;
        out[at + 1] = analog->value[analog->shows];
    }
}

size_t argus_rewrite_sip(const argus_t *const self, const argus_rewrite_t *const how,
                         const uint8_t *const data, const size_t count, uint8_t *const out) {
    if (count < LIST || count < LIST + (size_t)data[LISTED] * ENTRY) {
        return 0;
    }
    const size_t tail = LIST + (size_t)data[LISTED] * ENTRY;
    memcpy(out, data, LIST);
    const unsigned off = ~(unsigned)how->arrays & 0x0Fu;
    out[FLAGS] &= (uint8_t)~(off * FIRST_ARRAY_FLAG);
    const size_t length = list(self, how, data, out);
    memcpy(out + length, data + tail, count - tail);
    show_analog(how->analog, out, length + count - tail);
    return length + count - tail;
}
