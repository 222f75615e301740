// SPDX-License-Identifier: MIT
// The robot of the fuzz target: steps of 10 ms, walls as lines, an echo from the nearest thing in the cone.
#include "plant.h"

#include <math.h>
#include <string.h>

#define STEP_S 0.01
#define SIP_MS 100u
#define PING_MS 40u
#define TRACK_MM 330.0
#define PI 3.14159265358979323846
#define DEG (PI / 180.0)
#define HALF_CONE (12 * DEG)
#define WATCHDOG_MS 2000u
#define E_STOP_DECEL 2000.0

static uint32_t chance(plant_t *self) {
    self->seed ^= self->seed << 13;
    self->seed ^= self->seed >> 17;
    self->seed ^= self->seed << 5;
    return self->seed;
}

void plant_init(plant_t *self, const safety_body_t *body, const char *subclass, const double (*walls)[4],
                unsigned wall_count, uint32_t now_ms) {
    memset(self, 0, sizeof *self);
    self->walls = walls;
    self->wall_count = wall_count;
    self->body = body;
    self->subclass = subclass;
    self->now_ms = self->heard_ms = now_ms;
    self->setv = 750;
    self->accel = self->decel = 300;
    self->setrv = self->setra = 100 * DEG;
    self->seed = 2463534242u;
    for (size_t i = 0; i < SAFETY_SONARS; i++) {
        self->pending[i] = -1;
    }
}

// ---- the room

typedef struct {
    double x, y;
} point_t;

static point_t in_body(const plant_t *self, double x, double y) {
    const double c = cos(self->th), s = sin(self->th), dx = x - self->x, dy = y - self->y;
    return (point_t){dx * c + dy * s, dy * c - dx * s};
}

static double to_line(point_t p, point_t a, point_t b) {
    const double ex = b.x - a.x, ey = b.y - a.y;
    const double along = ((p.x - a.x) * ex + (p.y - a.y) * ey) / fmax(ex * ex + ey * ey, 1e-9);
    const double t = fmin(fmax(along, 0), 1);
    return hypot(p.x - a.x - t * ex, p.y - a.y - t * ey);
}

// Liang and Barsky: whether a line enters the rectangle of the body.
static bool enters(const safety_body_t *body, point_t a, point_t b) {
    const double d[2] = {b.x - a.x, b.y - a.y}, p[2] = {a.x, a.y};
    const double low[2] = {-body->rear_mm, -body->half_mm}, high[2] = {body->front_mm, body->half_mm};
    double from = 0, to = 1;
    for (int i = 0; i < 2; i++) {
        if (fabs(d[i]) < 1e-9) {
            if (p[i] <= low[i] || p[i] >= high[i]) {
                return false;
            }
            continue;
        }
        const double t1 = (low[i] - p[i]) / d[i], t2 = (high[i] - p[i]) / d[i];
        from = fmax(from, fmin(t1, t2));
        to = fmin(to, fmax(t1, t2));
    }
    return from < to;
}

static double to_body(const safety_body_t *body, point_t p) {
    return hypot(fmax(fmax(p.x - body->front_mm, -body->rear_mm - p.x), 0),
                 fmax(fabs(p.y) - body->half_mm, 0));
}

static double wall_gap(const plant_t *self, const double *wall) {
    const safety_body_t *const body = self->body;
    const point_t a = in_body(self, wall[0], wall[1]), b = in_body(self, wall[2], wall[3]);
    if (enters(body, a, b)) {
        return 0;
    }
    double gap = fmin(to_body(body, a), to_body(body, b));
    for (int i = 0; i < 4; i++) {
        const point_t corner = {i & 1 ? body->front_mm : -body->rear_mm,
                                i & 2 ? body->half_mm : -body->half_mm};
        gap = fmin(gap, to_line(corner, a, b));
    }
    return gap;
}

static double measure(const plant_t *self) {
    double gap = 1e9;
    for (unsigned i = 0; i < self->wall_count && gap > 0; i++) {
        gap = fmin(gap, wall_gap(self, self->walls[i]));
    }
    return gap;
}

// ---- sonars

static double wrapped(double angle) {
    return remainder(angle, 2 * PI);
}

// The nearest point of a wall within the cone that looks along x from the origin, 1e9: none.
static double echo_of(point_t a, point_t b) {
    double best = 1e9;
    const point_t d = {b.x - a.x, b.y - a.y};
    const double square = fmax(d.x * d.x + d.y * d.y, 1e-9);
    const double foot = -(a.x * d.x + a.y * d.y) / square;
    const point_t near = {a.x + foot * d.x, a.y + foot * d.y};
    const point_t all[3] = {a, b, near};
    for (int i = 0; i < (foot > 0 && foot < 1 ? 3 : 2); i++) {
        if (fabs(atan2(all[i].y, all[i].x)) <= HALF_CONE) {
            best = fmin(best, hypot(all[i].x, all[i].y));
        }
    }
    for (int edge = -1; edge <= 1; edge++) {
        const double c = cos(edge * HALF_CONE), s = sin(edge * HALF_CONE);
        const double across = d.x * s - d.y * c;
        const double t = fabs(across) < 1e-9 ? -1 : (a.y * c - a.x * s) / across;
        const double range = (a.x + t * d.x) * c + (a.y + t * d.y) * s;
        if (t >= 0 && t <= 1 && range > 0) {
            best = fmin(best, range);
        }
    }
    return best;
}

static int32_t truth_of(const plant_t *self, uint32_t sonar) {
    const safety_mount_t *const at = &self->body->mount[sonar];
    const double c = cos(at->bearing_deg * DEG), s = sin(at->bearing_deg * DEG);
    double best = 1e9;
    for (unsigned i = 0; i < self->wall_count; i++) {
        const double *const wall = self->walls[i];
        point_t end[2] = {in_body(self, wall[0], wall[1]), in_body(self, wall[2], wall[3])};
        for (int k = 0; k < 2; k++) {
            const double x = end[k].x - at->x_mm, y = end[k].y - at->y_mm;
            end[k] = (point_t){x * c + y * s, y * c - x * s};
        }
        best = fmin(best, echo_of(end[0], end[1]));
    }
    return best >= 5000 ? 5000 : best < 100 ? 100 : (int32_t)lround(best);
}

static int32_t reading_of(plant_t *self, uint32_t sonar) {
    switch (self->fault[sonar]) {
    case PLANT_OFF:
        return 5000;
    case PLANT_SILENT:
        return -1;
    case PLANT_NEAR:
        return 240;
    case PLANT_FAR:
        return 3100;
    case PLANT_GARBAGE:
        return 100 + (int32_t)(chance(self) % 4901);
    default:
        break;
    }
    const int32_t mm = truth_of(self, sonar);
    return mm >= 5000 ? 5000 : mm + (int32_t)(chance(self) % 9) - 4;
}

static void ping(plant_t *self) {
    for (uint32_t array = 0; array * 8 < self->body->sonars; array++) {
        const uint32_t sonar = array * 8 + self->fires[array] % 8u;
        self->fires[array]++;
        if (sonar < self->body->sonars) {
            self->pending[sonar] = reading_of(self, sonar);
        }
    }
}

// ---- wheels

static double toward(double now, double target, double most) {
    return target > now + most ? now + most : target < now - most ? now - most : target;
}

static void translate(plant_t *self, bool dead) {
    double target = dead ? 0 : self->vel;
    if (self->moving && !dead) {
        const double reach = sqrt(2 * self->decel * fabs(self->left_mm));
        target = copysign(fmin(self->setv, reach), self->left_mm);
    }
    const bool slower = fabs(target) < fabs(self->v) || target * self->v < 0;
    const double rate = self->braking ? E_STOP_DECEL : slower ? self->decel : self->accel;
    self->v = toward(self->v, target, rate * STEP_S);
    if (self->moving && !dead && fabs(self->left_mm) <= fabs(self->v) * STEP_S + 0.5) {
        self->moving = false;
        self->vel = self->v = 0;
    }
    self->left_mm -= self->v * STEP_S;
}

static void rotate(plant_t *self, bool dead) {
    double target = dead ? 0 : fmax(-self->setrv, fmin(self->rvel, self->setrv));
    const double error = wrapped(self->heading - (self->th - self->th0));
    if (self->turning && !dead) {
        target = copysign(fmin(self->setrv, sqrt(2 * self->setra * fabs(error))), error);
    }
    self->w = toward(self->w, target, self->setra * STEP_S);
    if (self->turning && fabs(error) <= fabs(self->w) * STEP_S + 1e-4) {
        self->turning = false;
        self->rvel = self->w = 0;
    }
}

static void touch(plant_t *self, double from_x, double from_y, double from_th) {
    self->contact = true;
    self->contact_v = self->v;
    self->contact_w = self->w;
    if (self->v >= 0) {
        self->touch_front = 0x08;
    } else {
        self->touch_rear = 0x08;
    }
    self->x = from_x;
    self->y = from_y;
    self->th = from_th;
    self->v = self->w = 0;
}

static void drive(plant_t *self) {
    const bool dead = self->now_ms - self->heard_ms > WATCHDOG_MS || !self->motors;
    const double x = self->x, y = self->y, th = self->th;
    translate(self, dead);
    rotate(self, dead);
    if (self->v == 0 && self->w == 0) {
        self->braking = false;
        return;
    }
    self->th += self->w * STEP_S;
    self->x += self->v * STEP_S * cos(self->th);
    self->y += self->v * STEP_S * sin(self->th);
    self->gap_used_mm += fabs(self->v) * STEP_S + fabs(self->w) * STEP_S * 420;
    if (self->gap_used_mm >= self->gap_mm) {
        self->gap_mm = measure(self);
        self->gap_used_mm = 0;
        if (self->gap_mm <= 0) {
            touch(self, x, y, th);
            return;
        }
    }
    self->touch_front = self->touch_rear = 0;
}

// ---- the wire

static uint16_t checksum(const uint8_t *data, size_t length) {
    uint16_t sum = 0;
    size_t i = 0;
    for (; i + 1 < length; i += 2) {
        sum = (uint16_t)(sum + (uint16_t)(data[i] << 8 | data[i + 1]));
    }
    return i < length ? (uint16_t)(sum ^ data[i]) : sum;
}

size_t plant_frame(uint8_t *packet, const uint8_t *data, size_t length) {
    const uint16_t sum = checksum(data, length);
    packet[0] = 0xfa;
    packet[1] = 0xfb;
    packet[2] = (uint8_t)(length + 2);
    memcpy(packet + 3, data, length);
    packet[3 + length] = (uint8_t)(sum >> 8);
    packet[4 + length] = (uint8_t)(sum & 0xff);
    return length + 5;
}

static void say(plant_t *self, const uint8_t *data, size_t length) {
    if (self->out_length + length + 5 <= sizeof self->out) {
        self->out_length += plant_frame(self->out + self->out_length, data, length);
    }
}

size_t plant_say(plant_t *self, uint8_t *packet, size_t capacity) {
    if (self->out_length < 3) {
        return 0;
    }
    const size_t length = (size_t)self->out[2] + 3;
    if (length > capacity || length > self->out_length) {
        return 0;
    }
    memcpy(packet, self->out, length);
    memmove(self->out, self->out + length, self->out_length - length);
    self->out_length -= length;
    return length;
}

static void put16(uint8_t *at, long value) {
    at[0] = (uint8_t)(value & 0xff);
    at[1] = (uint8_t)(value >> 8 & 0xff);
}

static void say_sip(plant_t *self) {
    uint8_t data[20 + 3 * SAFETY_SONARS + 12] = {0};
    const double ox = self->x - self->x0, oy = self->y - self->y0, c = cos(self->th0), s = sin(self->th0);
    const double unit = self->body->mm_per_unit;
    data[0] = self->v != 0 || self->w != 0 ? 0x33 : 0x32;
    put16(data + 1, lround((ox * c + oy * s) / unit));
    put16(data + 3, lround((oy * c - ox * s) / unit));
    put16(data + 5, lround(wrapped(self->th - self->th0) / (2 * PI) * 4096));
    put16(data + 7, lround(self->v - self->w * TRACK_MM / 2));
    put16(data + 9, lround(self->v + self->w * TRACK_MM / 2));
    data[11] = 126;
    data[12] = (uint8_t)(self->bumpers_rear | self->touch_rear | (self->stalls & 1));
    data[13] = (uint8_t)(self->bumpers_front | self->touch_front | (self->stalls >> 1 & 1));
    put16(data + 16, (self->motors ? 1 : 0) | (self->sonar_on ? 6 : 0));
    size_t n = 0;
    for (uint32_t k = 0; k < self->body->sonars && self->sonar_on; k++) {
        if (self->pending[k] >= 0) {
            data[20 + 3 * n] = (uint8_t)k;
            put16(data + 21 + 3 * n, self->pending[k]);
            self->pending[k] = -1;
            n++;
        }
    }
    data[19] = (uint8_t)n;
    data[21 + 3 * n] = self->port;
    put16(data + 25 + 3 * n, 126);
    say(self, data, 20 + 3 * n + 12);
}

static void say_name(plant_t *self) {
    uint8_t data[48] = "\x02"
                       "Fuzz"
                       "\0"
                       "Pioneer"
                       "\0";
    size_t length = 1 + 5 + 8;
    for (const char *c = self->subclass; *c != 0 && length < sizeof data - 1; c++) {
        data[length++] = (uint8_t)*c;
    }
    data[length++] = 0;
    say(self, data, length);
}

static void take_sync(plant_t *self, const uint8_t *data) {
    if (self->phase == 2 && data[0] == 2) {
        say_name(self);
        self->phase = 4;
    } else if (self->phase == 4 && data[0] == 1) {
        self->phase = 3;
        self->next_sip_ms = self->now_ms + SIP_MS;
        self->next_ping_ms = self->now_ms;
    } else if (data[0] == 0 || (data[0] == 1 && self->phase == 1)) {
        say(self, data, 1);
        self->phase = data[0] == 0 ? 1 : 2;
    }
}

static void stop(plant_t *self, bool hard) {
    self->moving = self->turning = false;
    self->vel = self->rvel = 0;
    self->braking = hard;
}

static void close_session(plant_t *self) {
    stop(self, false);
    self->phase = 0;
    self->motors = false;
}

static void turn_to(plant_t *self, double to) {
    self->heading = to;
    self->turning = true;
}

static void set_acceleration(double *up, double *down, int32_t value, double unit) {
    if (value > 0) {
        *up = value * unit;
    } else if (value < 0 && down != NULL) {
        *down = -value * unit;
    }
}

static void go(plant_t *self, double vel) {
    self->vel = fmax(-1500, fmin(vel, 1500));
    self->moving = false;
}

static void spin(plant_t *self, double rate) {
    self->rvel = rate;
    self->turning = false;
}

static void obey(plant_t *self, uint8_t command, int32_t value, const uint8_t *data) {
    switch (command) {
    case 2:
        close_session(self);
        break;
    case 4:
        self->motors = value != 0;
        if (value == 0) {
            stop(self, false);
        }
        break;
    case 5:
        set_acceleration(&self->accel, &self->decel, value, 1);
        break;
    case 6:
        self->setv = value > 0 ? value : self->setv;
        break;
    case 7:
        self->x0 = self->x;
        self->y0 = self->y;
        self->th0 = self->th;
        break;
    case 8:
        self->left_mm = value;
        self->moving = true;
        break;
    case 9:
    case 21:
        spin(self, value * DEG);
        break;
    case 10:
        self->setrv = value > 0 ? value * DEG : self->setrv;
        break;
    case 11:
        go(self, value);
        break;
    case 12:
        turn_to(self, value * DEG);
        break;
    case 13:
    case 22:
        turn_to(self, self->th - self->th0 + value * DEG);
        break;
    case 23:
        set_acceleration(&self->setra, NULL, value < 0 ? -value : value, DEG);
        break;
    case 28:
        self->sonar_on = value != 0;
        break;
    case 29:
        stop(self, false);
        break;
    case 32:
        go(self, ((int8_t)data[2] + (int8_t)data[3]) * 10.0);
        spin(self, ((int8_t)data[3] - (int8_t)data[2]) * 20.0 / TRACK_MM);
        break;
    case 35:
        self->port = (uint8_t)value;
        break;
    case 55:
    case 57:
        stop(self, true);
        break;
    default:
        break;
    }
}

void plant_take(plant_t *self, const uint8_t *packet, size_t length) {
    const uint8_t *const data = packet + 3;
    int32_t value = 0;
    self->heard_ms = self->now_ms;
    if (length < 6) {
        return;
    }
    if (self->phase != 3) {
        take_sync(self, data);
        return;
    }
    if (length >= 9 && (data[1] == 0x3b || data[1] == 0x1b)) {
        value = data[2] | data[3] << 8;
        value = data[1] == 0x1b ? -value : value;
    } else if (data[0] == 32) {
        return;
    }
    obey(self, data[0], value, data);
}

void plant_step(plant_t *self) {
    self->now_ms += 10;
    self->contact = false;
    drive(self);
    if (self->phase != 3) {
        return;
    }
    if (self->sonar_on && (int32_t)(self->now_ms - self->next_ping_ms) >= 0) {
        self->next_ping_ms = self->now_ms + PING_MS;
        ping(self);
    }
    if ((int32_t)(self->now_ms - self->next_sip_ms) >= 0) {
        self->next_sip_ms += SIP_MS;
        say_sip(self);
    }
}
