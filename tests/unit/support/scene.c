// SPDX-License-Identifier: MIT
// The room, the sonars and what their faults make of the readings.
#include "scene.h"
#include "health.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "awareness/numbers.h"
#include "knowledge/angle.h"

#define DEG (3.14159265358979323846 / 180.0)
#define TICK_MS 10u
#define PING_MS 40u
#define SIP_MS 100u
#define SPEED_MM_S 200.0
#define TURN_DEG_S 60.0
#define TRACK_MM 330.0
#define REST_MS 2000u
#define FAR_MM 5000
#define BODY_MM 450.0 // keep away from things ahead

uint32_t scene_random(scene_t *self, uint32_t below) {
    self->seed ^= self->seed << 13;
    self->seed ^= self->seed >> 17;
    self->seed ^= self->seed << 5;
    return below == 0 ? 0 : self->seed % below;
}

void scene_init(scene_t *self, uint32_t seed, uint32_t start_ms) {
    memset(self, 0, sizeof *self);
    self->seed = seed * 2654435761u | 1u;
    for (int i = 0; i < 8; i++) {
        scene_random(self, 2);
    }
    self->start_ms = start_ms;
    argus_knowledge_init(&self->k);
    argus_knowledge_reopen(&self->k, start_ms);
    argus_evidence_init(&self->e);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        self->pending[i] = -1;
        for (int n = 0; n < SCENE_PAST; n++) {
            self->past[i][n] = -1;
        }
    }
}

void scene_box(scene_t *self, double x1, double y1, double x2, double y2) {
    const double wall[4][4] = {{x1, y1, x2, y1}, {x2, y1, x2, y2}, {x2, y2, x1, y2}, {x1, y2, x1, y1}};
    memcpy(self->wall[self->walls], wall, sizeof wall);
    self->walls += 4;
}

void scene_office(scene_t *self) {
    scene_box(self, -2600, -2400, 3400, 2600);
    scene_box(self, 1500, 900, 2000, 1500);
    scene_box(self, 1700, -2400, 2400, -1500);
    scene_box(self, -1900, 1400, -1300, 2600);
    scene_box(self, -2600, -2400, -1600, -1900);
    self->noise_mm = 5;
    self->crosstalk_permille = 10;
}

static double ray_to_walls(const scene_t *self, double x, double y, double angle) {
    double best = 1e9;
    double incidence = 0;
    const double dx = cos(angle), dy = sin(angle);
    for (int i = 0; i < self->walls; i++) {
        const double *s = self->wall[i];
        const double ex = s[2] - s[0], ey = s[3] - s[1];
        const double det = dx * ey - dy * ex;
        if (fabs(det) > 1e-9) {
            const double range = ((s[0] - x) * ey - (s[1] - y) * ex) / det;
            const double along = ((s[0] - x) * dy - (s[1] - y) * dx) / det;
            if (range >= 0 && along >= 0 && along <= 1 && range < best) {
                best = range;
                incidence = acos(fmin(1, fabs(det) / hypot(ex, ey)));
            }
        }
    }
    return self->smooth_deg > 0 && incidence > self->smooth_deg * DEG ? 1e9 : best;
}

static double ray_to_person(const scene_t *self, double x, double y, double angle) {
    const double px = self->person_x - x, py = self->person_y - y;
    const double along = px * cos(angle) + py * sin(angle);
    const double off = fabs(py * cos(angle) - px * sin(angle));
    if (along <= 0 || off >= self->person_r) {
        return 1e9;
    }
    return along - sqrt(self->person_r * self->person_r - off * off);
}

static double range_of(const scene_t *self, double x, double y, double angle) {
    double best = 1e9;
    for (int off = -12; off <= 12; off += 4) {
        best = fmin(best, ray_to_walls(self, x, y, angle + off * DEG));
        best = fmin(best, ray_to_person(self, x, y, angle + off * DEG));
    }
    return best;
}

static int clip(double mm) {
    return mm < 100 ? 100 : mm >= FAR_MM ? FAR_MM : (int)lround(mm);
}

static int with_noise(scene_t *self, double mm) {
    double sum = 0;
    for (int i = 0; i < 12; i++) {
        sum += scene_random(self, 1000) / 1000.0;
    }
    return mm >= FAR_MM ? FAR_MM : clip(mm + (sum - 6) * self->noise_mm);
}

static int true_reading(scene_t *self, int sonar) {
    const argus_sonar_pose_t *at = &argus_robot_table.poses[sonar];
    const double c = cos(self->th), s = sin(self->th);
    const double x = self->x + at->x_mm * c - at->y_mm * s;
    const double y = self->y + at->x_mm * s + at->y_mm * c;
    const int axis_deg = at->heading_deg + self->bent_deg[sonar];
    const int mm = with_noise(self, range_of(self, x, y, self->th + axis_deg * DEG));
    if ((int)scene_random(self, 1000) < self->crosstalk_permille) {
        return 300 +
               (int)scene_random(self, (uint32_t)(mm > 400 ? mm - 300 : 100)); // another one's echo: too near
    }
    return mm;
}

static int faulty(scene_t *self, int sonar, int mm) {
    const scene_fault_t *fault = &self->fault[sonar];
    int *past = self->past[sonar];
    const int late = past[fault->value > 0 && fault->value <= SCENE_PAST ? fault->value - 1 : 0];
    memmove(past + 1, past, (SCENE_PAST - 1) * sizeof *past);
    past[0] = mm;
    switch (fault->kind) {
    case ARGUS_KIND_OFF:
        return FAR_MM;
    case ARGUS_KIND_SILENT:
        return -1;
    case ARGUS_KIND_STUCK:
        self->stuck_mm[sonar] = fault->value > 0            ? fault->value
                                : self->stuck_mm[sonar] > 0 ? self->stuck_mm[sonar]
                                                            : mm;
        return self->stuck_mm[sonar];
    case ARGUS_KIND_WRONG:
        return clip(mm * fault->value / 100.0);
    case ARGUS_KIND_GARBAGE:
        return 100 + (int)scene_random(self, FAR_MM - 99);
    case ARGUS_KIND_SLOW:
        return late >= 0 ? late : mm;
    case ARGUS_KIND_INTERMITTENT:
        return (int)scene_random(self, 100) < fault->value ? FAR_MM : mm;
    case ARGUS_KIND_NONE:
    default:
        return mm;
    }
}

static void ping(scene_t *self) {
    for (int array = 0; array < 2; array++) {
        const int sonar = array * 8 + self->next;
        const int mm = faulty(self, sonar, true_reading(self, sonar));
        if ((self->mute >> sonar & 1u) == 0) {
            self->pending[sonar] = mm;
        }
    }
    self->next = (self->next + 1) % 8;
}

static void note(scene_t *self) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const argus_fault_kind_t kind = argus_evidence_convicts(&self->e, i);
        if (kind != ARGUS_KIND_NONE && self->convicted[i] == ARGUS_KIND_NONE) {
            self->convicted[i] = kind;
            self->convicted_ms[i] = self->t_ms;
            put_health(&self->k.sonar[i], ARGUS_DISABLED, kind, self->start_ms + self->t_ms);
        }
        self->named |= (uint16_t)(argus_evidence_names(&self->e, i) != ARGUS_KIND_NONE ? 1u << i : 0u);
        for (int test = 0; test < ARGUS_TESTS; test++) {
            const int score = self->e.of[i].score[test];
            if (score < argus_bounds[test].floor || score > ARGUS_CEILING) {
                snprintf(self->broken, sizeof self->broken, "sonar %d test %d score %d", i, test, score);
            }
        }
    }
}

static argus_sip_t sip_of(const scene_t *self) {
    argus_sip_t sip;
    memset(&sip, 0, sizeof sip);
    sip.flags = 7;
    sip.x_raw = (uint16_t)((unsigned)lround(self->x) & 0xFFFFu);
    sip.y_raw = (uint16_t)((unsigned)lround(self->y) & 0xFFFFu);
    sip.heading_raw = (int16_t)lround(remainder(self->th, 360 * DEG) / (360 * DEG) * 4096);
    sip.vel_left_mm_s = (int16_t)lround(self->v_mm_s - self->w_rad_s * TRACK_MM / 2);
    sip.vel_right_mm_s = (int16_t)lround(self->v_mm_s + self->w_rad_s * TRACK_MM / 2);
    return sip;
}

// A scene puts the robot where it likes, also as no robot moves: the pose follows.
static void follow(scene_t *self, const argus_sip_t *sip) {
    if (self->k.leapt) {
        self->k.pose.x_mm = (int32_t)lround(self->x);
        self->k.pose.y_mm = (int32_t)lround(self->y);
        self->k.pose.heading_cdeg = argus_angle_wrap((int32_t)sip->heading_raw * 36000 / 4096);
        self->k.heading_offset_cdeg = 0;
    }
}

static void deliver(scene_t *self, const argus_sip_t *sip) {
    argus_knowledge_sip(&self->k, sip, 1000, self->start_ms + self->t_ms);
    follow(self, sip);
    argus_evidence_sip(&self->e, &self->k);
    note(self);
}

static void send_sip(scene_t *self) {
    argus_sip_t sip = sip_of(self);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (self->pending[i] >= 0) {
            sip.sonar[sip.sonar_count].number = (uint8_t)i;
            sip.sonar[sip.sonar_count].range_mm = (uint16_t)self->pending[i];
            sip.sonar_count++;
            self->pending[i] = -1;
        }
    }
    deliver(self, &sip);
}

void scene_say(scene_t *self, unsigned sonars, const int *reading_mm) {
    argus_sip_t sip = sip_of(self);
    self->t_ms += SIP_MS;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if ((sonars >> i & 1u) != 0) {
            sip.sonar[sip.sonar_count].number = (uint8_t)i;
            sip.sonar[sip.sonar_count].range_mm = (uint16_t)reading_mm[i];
            sip.sonar_count++;
        }
    }
    deliver(self, &sip);
}

static void tick(scene_t *self) {
    const double s = TICK_MS / 1000.0;
    self->t_ms += TICK_MS;
    self->th += self->w_rad_s * s;
    self->x += self->v_mm_s * cos(self->th) * s;
    self->y += self->v_mm_s * sin(self->th) * s;
    self->person_x += self->person_vx * s;
    self->person_y += self->person_vy * s;
    if (self->t_ms % PING_MS == 0) {
        ping(self);
    }
    if (self->t_ms % SIP_MS == 0) {
        send_sip(self);
    }
}

void scene_run(scene_t *self, uint32_t ms) {
    for (uint32_t at = 0; at < ms; at += TICK_MS) {
        tick(self);
    }
}

void scene_turn(scene_t *self, double deg) {
    self->w_rad_s = copysign(TURN_DEG_S, deg) * DEG;
    scene_run(self, (uint32_t)(fabs(deg) / TURN_DEG_S * 1000));
    self->w_rad_s = 0;
    scene_run(self, 400);
}

void scene_look(scene_t *self) {
    static const double by[] = {-20, 40, -20};
    for (int i = 0; i < 3; i++) {
        scene_turn(self, by[i]);
        scene_run(self, REST_MS);
    }
}

void scene_drive(scene_t *self, double mm) {
    self->v_mm_s = SPEED_MM_S;
    for (double done = 0; done < mm && range_of(self, self->x, self->y, self->th) > BODY_MM + 200;
         done += 20) {
        scene_run(self, 100);
        if (done >= 200 && self->coming.kind != ARGUS_KIND_NONE) {
            self->fault[self->coming_to] = self->coming;
            self->coming.kind = ARGUS_KIND_NONE;
        }
    }
    self->v_mm_s = 0;
    scene_run(self, 400);
}

void scene_inject(scene_t *self, int sonar, argus_fault_kind_t kind, int value) {
    self->coming = (scene_fault_t){kind, value};
    self->coming_to = sonar;
}

void scene_tour(scene_t *self, int legs) {
    for (int leg = 0; leg < legs; leg++) {
        scene_look(self);
        scene_drive(self, 300 + scene_random(self, 900));
        const double free = range_of(self, self->x, self->y, self->th);
        const double deg = 25 + scene_random(self, 60) + (free < 900 ? 60 : 0);
        scene_turn(self, scene_random(self, 2) == 0 ? deg : -deg);
    }
}

bool scene_all_quiet(const scene_t *self) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (self->convicted[i] != ARGUS_KIND_NONE) {
            return false;
        }
    }
    return true;
}

const char *scene_text(const scene_t *self) {
    static char text[400];
    int used = snprintf(text, sizeof text, "t %u ms, start %u, %s", (unsigned)self->t_ms,
                        (unsigned)self->start_ms, self->broken);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (self->convicted[i] != ARGUS_KIND_NONE) {
            used +=
                snprintf(text + used, sizeof text - (size_t)used, " [%d %s at %u ms]", i,
                         argus_name(ARGUS_NAME_KIND, self->convicted[i]), (unsigned)self->convicted_ms[i]);
        }
    }
    return text;
}

void scene_blank(argus_knowledge_t *k, argus_evidence_t *e) {
    argus_knowledge_init(k);
    argus_evidence_init(e);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        k->sonar[i].health = ARGUS_HEALTHY;
    }
    k->sip_ms = 2000; // the clock has wrapped a moment ago
}
