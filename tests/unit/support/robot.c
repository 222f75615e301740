// SPDX-License-Identifier: MIT
// The robot in memory, and what it holds against the manager at every packet.
#include "robot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "adjustment/guard.h"
#include "behaviour/state.h"
#include "knowledge/config.h"

#define TICK_MS 10u
#define TICK_S 0.01
#define SIP_MS 100u
#define PING_MS 40
#define WATCHDOG_MS 2000u
#define FLOW_CONTROL_MS 1000u // so long a sender waits for it
#define TRACK_MM 330.0
#define DEG (3.14159265358979323846 / 180.0)
#define SWING_MM 370.0
#define BODY_FRONT_MM 210.0
#define BODY_REAR_MM 301.0
#define BODY_HALF_MM 212.5

static void complain(robot_t *robot, const char *what, int value) {
    if (robot->violation[0] == '\0') {
        snprintf(robot->violation, sizeof robot->violation, "t %u ms, mode %s: %s (%d)",
                 (unsigned)robot->t_ms, argus_name(ARGUS_NAME_MODE, robot->argus.mode), what, value);
    }
}

uint32_t robot_random(robot_t *robot, uint32_t below) {
    robot->seed ^= robot->seed << 13;
    robot->seed ^= robot->seed >> 17;
    robot->seed ^= robot->seed << 5;
    return below == 0 ? 0 : robot->seed % below;
}

argus_config_t robot_config_of(int32_t profile) {
    argus_config_t config;
    argus_config_default(&config);
    config.profile = profile;
    return config;
}

argus_config_t robot_config(void) {
    return robot_config_of(ARGUS_PROFILE_PAPER);
}

static void power_up(robot_t *robot) {
    robot->phase = 0;
    robot->opened = false;
    robot->motors = false;
    robot->sonar_on = false;
    robot->moving = robot->turning = false;
    robot->vel = robot->rvel = 0;
    robot->setv = 750;
    robot->accel = robot->decel = 300;
    robot->setrv = robot->setra = robot->turn_decel = 100 * DEG;
    robot->sonar_cycle_ms = PING_MS;
    for (int array = 0; array < 2; array++) {
        robot->order_count[array] = 8;
        robot->order_at[array] = 0;
        for (int i = 0; i < 8; i++) {
            robot->order[array][i] = (uint8_t)(array * 8 + i);
        }
    }
    for (int i = 0; i < 16; i++) {
        robot->pending[i] = -1;
    }
}

void robot_init(robot_t *robot, const argus_config_t *config, uint32_t start_ms) {
    memset(robot, 0, sizeof *robot);
    robot->start_ms = start_ms;
    robot->subclass = "p3dx-sh";
    robot->unit_mm = 1.0;
    robot->position_mask = 0xFFFF;
    robot->world = robot_world_far;
    robot->seed = 2463534242u;
    robot->closest_mm = 1e9;
    power_up(robot);
    for (int i = 0; i < 16; i++) {
        robot->shown[i] = -1;
    }
    argus_manager_init(&robot->argus, config, start_ms);
    argus_link_up(&robot->argus, start_ms);
}

int robot_world_far(const robot_t *robot, int sonar) {
    (void)robot;
    (void)sonar;
    return 2600;
}

void robot_box(robot_t *robot, double x1, double y1, double x2, double y2) {
    const double wall[4][4] = {{x1, y1, x2, y1}, {x2, y1, x2, y2}, {x2, y2, x1, y2}, {x1, y2, x1, y1}};
    memcpy(robot->segment[robot->segments], wall, sizeof wall);
    robot->segments += 4;
}

void robot_in_box(robot_t *const robot, const int32_t profile, const double x1, const double y1,
                  const double x2, const double y2) {
    const argus_config_t config = robot_config_of(profile);
    robot_init(robot, &config, 1000);
    robot->world = robot_world_segments;
    robot_box(robot, x1, y1, x2, y2);
}

static double ray(const robot_t *robot, double x, double y, double angle) {
    double best = 1e9;
    const double dx = cos(angle), dy = sin(angle);
    for (int i = 0; i < robot->segments; i++) {
        const double *s = robot->segment[i];
        const double ex = s[2] - s[0], ey = s[3] - s[1];
        const double det = dx * ey - dy * ex;
        if (fabs(det) > 1e-9) {
            const double range = ((s[0] - x) * ey - (s[1] - y) * ex) / det;
            const double along = ((s[0] - x) * dy - (s[1] - y) * dx) / det;
            if (range >= 0 && along >= 0 && along <= 1 && range < best) {
                best = range;
            }
        }
    }
    return best;
}

int robot_world_segments(const robot_t *robot, int sonar) {
    const argus_sonar_pose_t *at = &argus_robot_table.poses[sonar];
    const double c = cos(robot->th), s = sin(robot->th);
    const double x = robot->x + at->x_mm * c - at->y_mm * s;
    const double y = robot->y + at->x_mm * s + at->y_mm * c;
    double best = 1e9;
    for (int off = -12; off <= 12; off += 4) {
        best = fmin(best, ray(robot, x, y, robot->th + (at->heading_deg + off) * DEG));
    }
    return best > 5000 ? 5000 : (int)lround(best);
}

int robot_world_smooth(const robot_t *r, int sonar) {
    const argus_sonar_pose_t *at = &argus_robot_table.poses[sonar];
    const double c = cos(r->th), s = sin(r->th);
    const double *w = r->segment[0];
    const double length = hypot(w[2] - w[0], w[3] - w[1]);
    const double nx = (w[3] - w[1]) / length, ny = -(w[2] - w[0]) / length;
    const double x = r->x + at->x_mm * c - at->y_mm * s, y = r->y + at->x_mm * s + at->y_mm * c;
    const double distance = (w[0] - x) * nx + (w[1] - y) * ny;
    const double bearing = r->th + at->heading_deg * DEG;
    const double square = (cos(bearing) * nx + sin(bearing) * ny) * (distance < 0 ? -1 : 1);
    return square > cos(25 * DEG) ? (int)lround(fabs(distance) / square) : 5000;
}

static int clip(int mm) {
    return mm < 100 ? 100 : mm > 5000 ? 5000 : mm;
}

static void remember(int *past, int mm) {
    memmove(past + 1, past, (ROBOT_PAST - 1) * sizeof *past);
    past[0] = mm;
}

// Negative: the slot yields no reading.
static int reading_of(robot_t *robot, int sonar) {
    int mm = robot->world(robot, sonar);
    if (robot->noise_mm > 0 && mm < 5000) {
        mm += (int)robot_random(robot, (uint32_t)(2 * robot->noise_mm + 1)) - robot->noise_mm;
    }
    int *past = robot->past[sonar];
    const int value = robot->fault_value[sonar];
    const int late = robot->fault[sonar] == ROBOT_SLOW && past[value - 1] > 0 ? past[value - 1] : clip(mm);
    if (robot->fault[sonar] != ROBOT_STUCK || past[0] == 0) {
        remember(past, clip(mm));
    }
    switch (robot->fault[sonar]) {
    case ROBOT_OFF:
        return 5000;
    case ROBOT_SILENT:
        return -1;
    case ROBOT_SCALE:
        return clip(mm * value / 100);
    case ROBOT_VALUE:
        return value;
    case ROBOT_STUCK:
        return past[0];
    case ROBOT_GARBAGE:
        return 100 + (int)robot_random(robot, 4901);
    case ROBOT_SLOW:
        return late;
    case ROBOT_DROPOUT:
        return (int)robot_random(robot, 100) < value ? 5000 : clip(mm);
    case ROBOT_OK:
    default:
        return clip(mm);
    }
}

static void ping(robot_t *robot) {
    for (int array = 0; array < 2; array++) {
        if (robot->order_count[array] > 0) {
            const int sonar = robot->order[array][robot->order_at[array]];
            robot->order_at[array] = (robot->order_at[array] + 1) % robot->order_count[array];
            robot->pending[sonar] = reading_of(robot, sonar);
        }
    }
}

static double wrapped(double angle) {
    return remainder(angle, 360 * DEG);
}

double robot_heading_deg(const robot_t *robot) {
    return wrapped(robot->th) / DEG;
}

static double toward(double now, double target, double most) {
    return target > now + most ? now + most : target < now - most ? now - most : target;
}

static void translate(robot_t *robot) {
    double target = fmax(-robot->setv, fmin(robot->vel, robot->setv));
    if (robot->moving) {
        const double reach = sqrt(2 * robot->decel * fabs(robot->left_mm));
        const double most = robot->races_mm_s > 0 ? robot->races_mm_s : robot->setv;
        target = copysign(fmin(most, reach), robot->left_mm);
    }
    const double rate = fabs(target) > fabs(robot->v) ? robot->accel : robot->decel;
    robot->v = toward(robot->v, target, rate * TICK_S);
    if (robot->moving && fabs(robot->left_mm) <= fabs(robot->v) * TICK_S + 0.5) {
        robot->moving = false;
        robot->v = 0;
    }
    robot->left_mm -= robot->v * TICK_S;
}

static void rotate(robot_t *robot) {
    double target = fmax(-robot->setrv, fmin(robot->rvel, robot->setrv));
    const double error = wrapped(robot->heading - robot->th);
    if (robot->turning) {
        target = copysign(fmin(robot->setrv, sqrt(2 * robot->turn_decel * fabs(error))), error);
    }
    const bool brakes = fabs(target) < fabs(robot->w) || target * robot->w < 0;
    robot->w = toward(robot->w, target, (brakes ? robot->turn_decel : robot->setra) * TICK_S);
    if (robot->turning && fabs(error) <= fabs(robot->w) * TICK_S + 1e-4) {
        robot->th = robot->heading;
        robot->w = 0;
        robot->turning = false;
    }
}

static void drive(robot_t *robot) {
    if (!robot->motors || robot->stuck_wheels) {
        robot->v = robot->w = 0;
        return;
    }
    translate(robot);
    rotate(robot);
    robot->th += (robot->w + robot->pushed_w) * TICK_S;
    robot->x += robot->v * TICK_S * cos(robot->th);
    robot->y += robot->v * TICK_S * sin(robot->th);
}

// The room
// ----------------------------------------------------------------------------------------------------

typedef struct {
    double x, y;
} spot_t;

static spot_t in_body(const robot_t *robot, double x, double y, double c, double s) {
    const double dx = x - robot->x, dy = y - robot->y;
    return (spot_t){dx * c + dy * s, dy * c - dx * s};
}

static double squared(double value) {
    return value * value;
}

// Squares: of two such distances the lesser has the lesser square.
static double to_line_square(spot_t p, spot_t a, spot_t b) {
    const double ex = b.x - a.x, ey = b.y - a.y;
    const double along = ((p.x - a.x) * ex + (p.y - a.y) * ey) / fmax(squared(ex) + squared(ey), 1e-9);
    const double t = along < 0 ? 0 : along > 1 ? 1 : along;
    return squared(p.x - a.x - t * ex) + squared(p.y - a.y - t * ey);
}

static double outside(double value, double low, double high) {
    return value < low ? low - value : value > high ? value - high : 0;
}

static double to_body_square(spot_t p) {
    return squared(outside(p.x, -BODY_REAR_MM, BODY_FRONT_MM)) +
           squared(outside(p.y, -BODY_HALF_MM, BODY_HALF_MM));
}

// Whether the line from a to b passes through the body (Liang and Barsky).
static bool enters_body(spot_t a, spot_t b) {
    const double from[2] = {a.x, a.y}, way[2] = {b.x - a.x, b.y - a.y};
    const double low[2] = {-BODY_REAR_MM, -BODY_HALF_MM}, high[2] = {BODY_FRONT_MM, BODY_HALF_MM};
    double in = 0, out = 1;
    for (int i = 0; i < 2; i++) {
        if (fabs(way[i]) < 1e-9 && outside(from[i], low[i], high[i]) > 0) {
            return false;
        }
        if (fabs(way[i]) >= 1e-9) {
            const double t1 = (low[i] - from[i]) / way[i], t2 = (high[i] - from[i]) / way[i];
            in = fmax(in, fmin(t1, t2));
            out = fmin(out, fmax(t1, t2));
        }
    }
    return in <= out;
}

static double wall_gap_square(spot_t a, spot_t b) {
    static const spot_t corner[4] = {{BODY_FRONT_MM, BODY_HALF_MM},
                                     {BODY_FRONT_MM, -BODY_HALF_MM},
                                     {-BODY_REAR_MM, BODY_HALF_MM},
                                     {-BODY_REAR_MM, -BODY_HALF_MM}};
    if (enters_body(a, b)) {
        return 0;
    }
    double gap = fmin(to_body_square(a), to_body_square(b));
    for (int i = 0; i < 4; i++) {
        gap = fmin(gap, to_line_square(corner[i], a, b));
    }
    return gap;
}

// From the body's rectangle to the nearest wall.
static void measure_clearance(robot_t *robot) {
    const double c = cos(robot->th), s = sin(robot->th);
    double gap = squared(robot->closest_mm);
    for (int i = 0; i < robot->segments; i++) {
        const double *wall = robot->segment[i];
        const spot_t a = in_body(robot, wall[0], wall[1], c, s), b = in_body(robot, wall[2], wall[3], c, s);
        gap = fmin(gap, wall_gap_square(a, b));
    }
    robot->closest_mm = sqrt(gap);
}

static void put16(uint8_t *at, long value) {
    at[0] = (uint8_t)(value & 0xFF);
    at[1] = (uint8_t)(value >> 8 & 0xFF);
}

static size_t list_readings(robot_t *robot, uint8_t *at) {
    size_t count = 0;
    for (int i = 0; i < 16; i++) {
        const int mm = robot->lists_all && robot->pending[i] < 0 ? robot->shown[i] : robot->pending[i];
        if (robot->sonar_on && mm >= 0) {
            at[3 * count] = (uint8_t)i;
            put16(at + 3 * count + 1, mm);
            robot->shown[i] = mm;
            count++;
        }
        robot->pending[i] = -1;
    }
    return count;
}

static size_t build_sip(robot_t *robot, uint8_t *packet) {
    uint8_t data[ROBOT_SIP_MAX] = {0};
    const double ox = robot->x - robot->x0, oy = robot->y - robot->y0;
    const double c = cos(-robot->th0), s = sin(-robot->th0);
    data[0] = fabs(robot->v) + fabs(robot->w) > 0 ? 0x33 : 0x32;
    put16(data + 1, lround((ox * c - oy * s) / robot->unit_mm) & robot->position_mask);
    put16(data + 3, lround((ox * s + oy * c) / robot->unit_mm) & robot->position_mask);
    put16(data + 5, lround(wrapped(robot->th - robot->th0) / (360 * DEG) * 4096));
    put16(data + 7, lround(robot->v - (robot->w + robot->pushed_w) * TRACK_MM / 2));
    put16(data + 9, lround(robot->v + (robot->w + robot->pushed_w) * TRACK_MM / 2));
    data[11] = 126;
    data[12] = (uint8_t)(robot->bumpers_rear | (robot->stall ? 1 : 0));
    data[13] = robot->bumpers_front;
    put16(data + 16, (robot->motors ? 1 : 0) | (robot->sonar_on ? 6 : 0) | (robot->stop_button ? 0x20 : 0));
    const size_t count = list_readings(robot, data + 20);
    data[19] = (uint8_t)count;
    data[20 + 3 * count + 1] = robot->anport;
    const size_t standard = 20 + 3 * count + 12;
    const size_t length = robot->alter_sip != NULL ? robot->alter_sip(data, standard) : standard;
    return argus_frame_encode(packet, 255, data, length);
}

void robot_say(robot_t *robot, const uint8_t *data, size_t count) {
    uint8_t packet[ARCOS_FRAME_SEND_TOTAL_MAX];
    robot_deliver(robot, packet, argus_frame_encode(packet, sizeof packet, data, count));
}

static size_t put_text(uint8_t *at, const char *text) {
    memcpy(at, text, strlen(text) + 1);
    return strlen(text) + 1;
}

// Its settings in their places, the rest 0 (SPEC.md, CONFIGpac).
static void tell_settings(robot_t *robot) {
    uint8_t data[160] = {0x20};
    size_t at = 1;
    at += put_text(data + at, "Pioneer");
    at += put_text(data + at, robot->subclass);
    at += put_text(data + at, "TEST1") + 1;
    put16(data + at, 360);
    put16(data + at + 2, 1500);
    at += 10;
    at += put_text(data + at, "Test");
    data[at] = SIP_MS;
    data[at + 7] = 1;
    put16(data + at + 8, 115);
    put16(data + at + 12, (long)WATCHDOG_MS);
    put16(data + at + 23, lround(robot->setrv / DEG));
    put16(data + at + 25, lround(robot->setv));
    put16(data + at + 27, lround(robot->setra / DEG));
    put16(data + at + 29, lround(robot->turn_decel / DEG));
    put16(data + at + 37, lround(robot->accel));
    put16(data + at + 39, lround(robot->decel));
    data[at + 50] = (uint8_t)robot->sonar_cycle_ms;
    at += 61;
    at += put_text(data + at, "2.6");
    robot_say(robot, data, at);
}

static void reply_sync(robot_t *robot, uint8_t command) {
    uint8_t data[80] = {command};
    size_t length = 1;
    if (command == 2) {
        length +=
            (size_t)snprintf((char *)data + 1, sizeof data - 1, "Test%cPioneer%c%s", 0, 0, robot->subclass) +
            1;
    }
    if (command == 2 && robot->config_before_sync2) {
        robot_say(robot, robot->config, robot->config_count);
    }
    robot_say(robot, data, length);
    if (command == 2 && robot->config_after_sync2) {
        robot_say(robot, robot->config, robot->config_count);
    }
}

static void set_polling(robot_t *robot, const uint8_t *list, size_t count) {
    bool named[2] = {false, false};
    for (size_t i = 0; i < count; i++) {
        const int sonar = list[i] - 1;
        if (sonar < 0 || sonar > 15) {
            complain(robot, "POLLING names an impossible sonar", sonar);
            continue;
        }
        if (!named[sonar / 8]) {
            named[sonar / 8] = true;
            robot->order_count[sonar / 8] = 0;
            robot->order_at[sonar / 8] = 0;
        }
        if (robot->order_count[sonar / 8] >= 16) {
            complain(robot, "POLLING is longer than 16 for one array", sonar);
            continue;
        }
        robot->order[sonar / 8][robot->order_count[sonar / 8]++] = (uint8_t)sonar;
    }
}

// Low byte right, high byte left, in 20 mm/s.
static void obey_pair(robot_t *robot, int32_t argument) {
    const double right = (int8_t)(argument & 0xFF) * 20.0;
    const double left = (int8_t)(argument >> 8 & 0xFF) * 20.0;
    robot->moving = robot->turning = false;
    robot->vel = (right + left) / 2;
    robot->rvel = (right - left) / TRACK_MM;
}

static void obey_motion(robot_t *robot, uint8_t command, int32_t argument) {
    switch (command) {
    case ARCOS_CMD_VEL2:
        obey_pair(robot, argument);
        break;
    case ARCOS_CMD_MOVE:
        robot->vel = 0;
        robot->moving = robot->motors;
        robot->left_mm = argument;
        break;
    case ARCOS_CMD_HEAD:
        robot->rvel = 0;
        robot->turning = robot->motors;
        robot->heading = robot->th0 + argument * DEG;
        break;
    case ARCOS_CMD_VEL:
        robot->moving = false;
        robot->vel = argument;
        break;
    case ARCOS_CMD_RVEL:
        robot->turning = false;
        robot->rvel = argument * DEG;
        break;
    case ARCOS_CMD_STOP:
        robot->moving = robot->turning = false;
        robot->vel = robot->rvel = 0;
        break;
    case ARCOS_CMD_E_STOP:
        robot->moving = robot->turning = false;
        robot->vel = robot->rvel = 0;
        robot->v = robot->w = 0;
        robot->motors = robot->motors && !robot->e_stop_cuts_motors;
        break;
    default:
        break;
    }
}

static void obey_setting(robot_t *robot, uint8_t command, int32_t argument) {
    switch (command) {
    case ARCOS_CMD_SETV:
        robot->setv = argument;
        break;
    case ARCOS_CMD_SETA:
        *(argument < 0 ? &robot->decel : &robot->accel) = fabs((double)argument);
        break;
    case ARCOS_CMD_SETRV:
        robot->setrv = argument * DEG;
        break;
    case ARCOS_CMD_SETRA:
        *(argument < 0 ? &robot->turn_decel : &robot->setra) = fabs((double)argument) * DEG;
        break;
    case ARCOS_CMD_SONAR:
        robot->sonar_on = (argument & 1) != 0;
        break;
    case ARCOS_CMD_ENABLE:
        robot->motors = argument != 0 && !robot->stop_button && !robot->deny_motors;
        robot->moving = robot->turning = false;
        robot->vel = robot->rvel = 0;
        break;
    case ARCOS_CMD_SONAR_CYCLE:
        robot->sonar_cycle_ms = argument;
        break;
    case ARCOS_CMD_SETO:
        robot->x0 = robot->x;
        robot->y0 = robot->y;
        robot->th0 = robot->th;
        break;
    case ARCOS_CMD_ADSEL:
        robot->anport = (uint8_t)argument;
        break;
    case ARCOS_CMD_CLOSE:
        power_up(robot);
        break;
    default:
        break;
    }
}

static bool is_in_session(const robot_t *robot) {
    return robot->phase == 3 && (robot->opened || !robot->has_line);
}

static void obey(robot_t *robot, const uint8_t *packet, const robot_command_t *sent) {
    robot->opened = robot->opened || (robot->phase == 3 && sent->command == ARCOS_CMD_OPEN);
    if (!is_in_session(robot)) {
        if (sent->command == robot->phase) {
            reply_sync(robot, sent->command);
            robot->phase++;
        } else if (sent->command == 0) {
            robot->phase = 1;
            reply_sync(robot, 0);
        }
        return;
    }
    if (robot->ignores[sent->command]) {
        return;
    }
    if (sent->command == ARCOS_CMD_CONFIG && robot->config != NULL) {
        robot_say(robot, robot->config, robot->config_count);
    } else if (sent->command == ARCOS_CMD_CONFIG && robot->tells_settings) {
        tell_settings(robot);
    } else if (sent->command == ARCOS_CMD_OPEN) {
        robot->next_sip_ms = robot->t_ms + SIP_MS;
        robot->next_ping_ms = robot->t_ms + PING_MS;
    } else if (sent->command == ARCOS_CMD_POLLING) {
        set_polling(robot, packet + 6, packet[5]);
    } else {
        obey_setting(robot, sent->command, sent->argument);
        obey_motion(robot, sent->command, sent->argument);
    }
}

// The nearest echo shown by a sonar that is relied on.
static double nearest_shown_mm(const robot_t *robot) {
    double nearest = 1e9;
    for (int i = 0; i < 16 && i < ARGUS_SONARS; i++) {
        const argus_sonar_pose_t *at = &argus_robot_table.poses[i];
        if (!argus_is_out(&robot->argus.knowledge, i) && robot->argus.knowledge.sonar[i].reported &&
            robot->shown[i] >= 0 && robot->shown[i] < 5000) {
            nearest = fmin(nearest, hypot(at->x_mm + robot->shown[i] * cos(at->heading_deg * DEG),
                                          at->y_mm + robot->shown[i] * sin(at->heading_deg * DEG)));
        }
    }
    return nearest;
}

// Turned by so much, the body is so far from the echo that a sonar shows; 0: it would touch it.
static double body_to_shown_mm(const robot_t *robot, int sonar, double by) {
    const argus_sonar_pose_t *at = &argus_robot_table.poses[sonar];
    const double ex = at->x_mm + robot->shown[sonar] * cos(at->heading_deg * DEG);
    const double ey = at->y_mm + robot->shown[sonar] * sin(at->heading_deg * DEG);
    const double x = ex * cos(by) + ey * sin(by);
    const double y = ey * cos(by) - ex * sin(by);
    return sqrt(to_body_square((spot_t){x, y}));
}

// The turn leaves 30 mm to the echo of a sonar that is relied on, or brings the body no nearer to it than it
// is.
static bool clears(const robot_t *robot, int sonar, double by) {
    if (argus_is_out(&robot->argus.knowledge, sonar) || robot->shown[sonar] < 0 ||
        robot->shown[sonar] >= 5000) {
        return true;
    }
    const double least_mm = fmin(30, body_to_shown_mm(robot, sonar, 0));
    for (int part = 1; part <= 20; part++) {
        if (body_to_shown_mm(robot, sonar, by * part / 20) < least_mm) {
            return false;
        }
    }
    return true;
}

// S7: a turn so small that the body clears everything in it, where the profile lets it.
static bool is_nudge(const robot_t *robot, int32_t to_deg) {
    const double by = wrapped(robot->th0 + to_deg * DEG - robot->th);
    bool clear = argus_rules(&robot->argus)->nudges && fabs(by) <= 21 * DEG;
    for (int i = 0; i < 16 && i < ARGUS_SONARS; i++) {
        clear = clear && clears(robot, i, by);
    }
    return clear;
}

// Of the end that leads six sonars face ahead, from this one.
static bool rear_leads(const robot_t *robot) {
    return robot->argus.knowledge.robot->reversed;
}

static int first_ahead(const robot_t *robot) {
    return rear_leads(robot) ? 9 : 1;
}

static unsigned all_ahead(const robot_t *robot) {
    return 0x3Fu << first_ahead(robot);
}

static int nearest_ahead_mm(const robot_t *robot, unsigned blind) {
    int nearest = 5000;
    for (int i = first_ahead(robot); (all_ahead(robot) >> i & 1u) != 0; i++) {
        if ((blind >> i & 1u) == 0 && robot->shown[i] >= 0 && robot->shown[i] < nearest) {
            nearest = robot->shown[i];
        }
    }
    return nearest;
}

// Neither out nor with the name of a fault.
static bool trusts(const robot_t *robot, int sonar) {
    const argus_sonar_t *s = &robot->argus.knowledge.sonar[sonar];
    return s->health == ARGUS_HEALTHY || (s->health == ARGUS_SUSPECT && s->kind == ARGUS_KIND_NONE);
}

// Suspects with a name, ahead, in a place where none has looked at them, though there is room to, and
// with no trusted sonar beside them; but not those that were cleared a moment ago.
static unsigned unlooked(const robot_t *robot) {
    const argus_t *argus = &robot->argus;
    const unsigned open = argus_with_health(&argus->knowledge, ARGUS_SUSPECT) & ~argus->algorithm1.verified;
    const argus_guard_t guard = argus_guard(argus);
    unsigned mask = 0;
    for (int i = first_ahead(robot); (all_ahead(robot) >> i & 1u) != 0 && argus_guard_may_turn(&guard); i++) {
        const bool alone = !trusts(robot, i - 1) && !trusts(robot, i + 1);
        mask |= (open >> i & 1u) != 0 && !trusts(robot, i) && alone && argus->looks.hold[i].cleared == 0
                    ? 1u << i
                    : 0u;
    }
    return mask;
}

// What the plan must cover for: all that are out, and with the paper's rules the suspects.
static unsigned blind_ahead(const robot_t *robot) {
    const argus_knowledge_t *known = &robot->argus.knowledge;
    const unsigned suspects =
        argus_rules(&robot->argus)->disparity ? argus_with_health(known, ARGUS_SUSPECT) : 0;
    return (argus_out(known) | suspects) & all_ahead(robot);
}

// S1: a step after a sweep; or, where the profile lets it, as far as others have seen.
static void watch_blind_move(robot_t *robot, int32_t mm, unsigned blind) {
    const argus_guard_t guard = argus_guard(&robot->argus);
    const bool steps = robot->argus.mode != ARGUS_MODE_DRIVING;
    const int range_mm = steps ? robot->argus.config.check_range_mm : robot->argus.config.object_range_mm;
    if ((blind & ~(unsigned)robot->argus.plan.disabled) != 0) {
        complain(robot, "S1, S6: MOVE ahead without a plan for a suspect or one that is out", (int)blind);
    }
    if (nearest_ahead_mm(robot, blind) <= range_mm) {
        complain(robot, "S1: MOVE ahead towards an object", nearest_ahead_mm(robot, blind));
    }
    const bool seen = argus_rules(&robot->argus)->drives_seen && argus_guard_seen_mm(&guard) >= mm;
    if (steps && (mm > robot->argus.config.step_mm || !(robot->swept || seen))) {
        complain(robot, "S1: MOVE ahead beyond the step or without a sweep", mm);
    }
    if (!steps && (!guard.profile->drives_seen || mm > argus_guard_seen_mm(&guard))) {
        complain(robot, "S1: MOVE ahead farther than was seen", mm);
    }
}

// S5: no faster than the shortest reading ahead allows, but for the speed that the settings allow anyway.
static void watch_speed(robot_t *robot) {
    const argus_config_t *config = &robot->argus.config;
    const int range_mm = nearest_ahead_mm(robot, argus_out(&robot->argus.knowledge) & all_ahead(robot));
    const argus_robot_t *body = robot->argus.knowledge.robot;
    const int safe = argus_rules(&robot->argus)->adapts_speed && range_mm > 0
                         ? argus_config_speed_mm_s(config, body, range_mm, 0)
                         : 0;
    if (robot->speed_asked_mm_s > fmax(config->speed_mm_s, fmin(safe, config->speed_max_mm_s))) {
        complain(robot, "S5: MOVE ahead faster than what is seen allows", (int)robot->speed_asked_mm_s);
    }
}

// With nothing to see by: only where the setting lets it, slowly, in short ways.
static void watch_creep(robot_t *robot, int32_t mm) {
    const argus_guard_t guard = argus_guard(&robot->argus);
    const int32_t most_mm_s = robot->argus.config.creep_mm_s;
    if (most_mm_s == 0 || !argus_is_unseen(&robot->argus, &guard)) {
        complain(robot, "S1: creeps without leave, or while a sonar sees", mm);
    }
    if (robot->speed_asked_mm_s > most_mm_s || mm > 150) {
        complain(robot, "S1: creeps too fast or too far", (int)robot->speed_asked_mm_s);
    }
}

static void watch_ahead(robot_t *robot, int32_t mm) {
    const unsigned blind = blind_ahead(robot);
    if (!robot->checked) {
        complain(robot, "S6: MOVE ahead before a health check", mm);
    }
    if (robot->argus.mode == ARGUS_MODE_CREEPING) {
        watch_creep(robot, mm);
        return;
    }
    if (blind != 0) {
        watch_blind_move(robot, mm, blind);
    }
    if (argus_rules(&robot->argus)->evidence && unlooked(robot) != 0) {
        complain(robot, "S6: MOVE ahead with a suspect and no trusted sonar beside it", (int)unlooked(robot));
    }
    watch_speed(robot);
}

// Wherever in its cone that is, the body passes it by on the usual way back, or does not come to it.
static bool stands_beside_way(const robot_t *robot, int sonar) {
    const argus_robot_t *built = robot->argus.knowledge.robot;
    const argus_sonar_pose_t pose = argus_robot_pose(built, sonar);
    const int off_deg = 180 - abs(pose.heading_deg);
    for (int deg = off_deg - 15; deg <= off_deg + 15; deg++) {
        const double x = robot->shown[sonar] * cos(deg * 3.14159265358979 / 180) - pose.x_mm;
        const double y = robot->shown[sonar] * sin(deg * 3.14159265358979 / 180) + abs(pose.y_mm);
        if (y < argus_robot_half_width_mm(built) + 15 &&
            x < built->rear_mm + robot->argus.config.backoff_mm + 100) {
            return false;
        }
    }
    return robot->argus.config.profile == ARGUS_PROFILE_ARGUS && off_deg > 15;
}

static void watch_back(robot_t *robot, int32_t mm) {
    const int first = rear_leads(robot) ? 0 : 8;
    const argus_guard_t guard = argus_guard(&robot->argus);
    if (guard.creeps && !argus_guard_rear_is_watched(&guard)) { // from what it has touched
        if (robot->speed_asked_mm_s > robot->argus.config.creep_mm_s || robot->bumpers_rear != 0) {
            complain(robot, "S7: creeps back too fast, or against a bumper", (int)robot->speed_asked_mm_s);
        }
        return;
    }
    for (int i = first; i < first + 8 && i < ARGUS_SONARS; i++) {
        const bool abeam =
            robot->argus.config.profile == ARGUS_PROFILE_ARGUS && (i == first || i == first + 7);
        const int clear_mm = abeam ? 250 : robot->argus.config.rear_clear_mm;
        const bool near = robot->shown[i] <= clear_mm && (abeam || !stands_beside_way(robot, i));
        if (argus_is_out(&robot->argus.knowledge, i) || near) {
            complain(robot, "S7: MOVE back though a rear sonar does not read clear", i);
        }
        if (!abeam && robot->shown[i] + mm < 150) {
            complain(robot, "S7: MOVE back farther than the rear reads clear", mm);
        }
    }
}

// Ahead is where the end is that leads.
static void watch_move(robot_t *robot, int32_t asked_mm) {
    const int32_t mm = rear_leads(robot) ? -asked_mm : asked_mm;
    if (mm < -300 || mm > 5000 || mm == 0) {
        complain(robot, "MOVE out of range", mm);
    }
    if (mm > 0) {
        watch_ahead(robot, mm);
    }
    if (mm > 0 && robot->bumpers_seen != 0) {
        complain(robot, "MOVE ahead with a bumper pressed", mm);
    }
    if (mm < 0) {
        watch_back(robot, mm);
    }
    robot->swept = robot->swept && mm < 0;
}

static void watch_motion(robot_t *robot, const robot_command_t *sent) {
    if (sent->command == ARCOS_CMD_MOVE) {
        watch_move(robot, sent->argument);
    } else if (sent->command == ARCOS_CMD_HEAD) {
        if (sent->argument < -180 || sent->argument > 180) {
            complain(robot, "HEAD out of range", sent->argument);
        }
        if (robot->bumpers_seen != 0) {
            complain(robot, "S7: HEAD with a bumper pressed", sent->argument);
        }
        const double margin_mm = robot->argus.config.profile == ARGUS_PROFILE_ARGUS ? 20 : 0;
        if (nearest_shown_mm(robot) < SWING_MM + margin_mm - 2 && !is_nudge(robot, sent->argument)) {
            complain(robot, "S7: HEAD in a blocked swing circle", (int)nearest_shown_mm(robot));
        }
    }
}

static void watch(robot_t *robot, const robot_command_t *sent) {
    const uint8_t c = sent->command;
    if ((c == ARCOS_CMD_VEL || c == ARCOS_CMD_RVEL) && sent->argument != 0) {
        complain(robot, "VEL or RVEL other than 0", sent->argument);
    }
    if (c == ARCOS_CMD_VEL2 || c == ARCOS_CMD_ROTATE || c == ARCOS_CMD_DHEAD || c == ARCOS_CMD_DCHEAD) {
        complain(robot, "a motion command that is not used", c);
    }
    robot->speed_asked_mm_s = c == ARCOS_CMD_SETV ? sent->argument : robot->speed_asked_mm_s;
    if (c == ARCOS_CMD_SETV && (sent->argument <= 0 || sent->argument > 750)) {
        complain(robot, "SETV out of range", sent->argument);
    }
    const bool motion =
        c == ARCOS_CMD_MOVE || c == ARCOS_CMD_HEAD || (c == ARCOS_CMD_ENABLE && sent->argument != 0);
    if (robot->argus.orders.passive && motion) {
        complain(robot, "passive, yet commands a motion", c);
    }
    watch_motion(robot, sent);
}

static robot_command_t command_of(const robot_t *robot, const uint8_t *packet, size_t length) {
    robot_command_t sent = {.t_ms = robot->t_ms, .command = packet[3]};
    if (length >= 9 && (packet[4] == 0x3B || packet[4] == 0x1B)) {
        sent.has_argument = true;
        sent.argument = packet[5] | packet[6] << 8;
        sent.argument = packet[4] == 0x1B ? -sent.argument : sent.argument;
    }
    return sent;
}

// The line
// ----------------------------------------------------------------------------------------------------

static bool is_before(uint32_t a_ms, uint32_t b_ms) {
    return (int32_t)(a_ms - b_ms) < 0;
}

static void put_on_line(robot_t *robot, robot_way_t way, uint8_t byte, uint32_t due_ms) {
    robot_line_t *line = &robot->line;
    line->last_ms[way] = is_before(line->last_ms[way], due_ms) ? due_ms : line->last_ms[way];
    if (line->held[way] < ROBOT_LINE_MAX) {
        line->due_ms[way][line->held[way]] = line->last_ms[way];
        line->bytes[way][line->held[way]++] = byte;
    } else {
        complain(robot, "more bytes than the line holds", way);
    }
}

// How long this harm holds up the byte that passes now.
static uint32_t hold_up_ms(const robot_t *robot, robot_harm_t *harm, uint32_t at) {
    if (harm->kind == ROBOT_DELAY) {
        return at == harm->at ? harm->with : 0;
    }
    if (harm->kind != ROBOT_LATENCY || at < harm->at) {
        return 0;
    }
    harm->since_ms = at == harm->at ? robot->t_ms : harm->since_ms;
    return robot->t_ms - harm->since_ms < harm->lasts_ms ? harm->with : 0;
}

static void pass_byte(robot_t *robot, robot_way_t way, uint8_t byte) {
    robot_line_t *line = &robot->line;
    const uint32_t at = line->passed[way]++;
    uint32_t due_ms = robot->t_ms;
    bool lost = false;
    for (int i = 0; i < line->harms; i++) {
        robot_harm_t *harm = &line->harm[i];
        if (harm->way != way) {
            continue;
        }
        due_ms += hold_up_ms(robot, harm, at);
        if (harm->at != at) {
            continue;
        }
        lost = lost || harm->kind == ROBOT_DROP;
        byte = (uint8_t)(byte ^ (harm->kind == ROBOT_FLIP ? harm->with : 0));
        if (harm->kind == ROBOT_DUPLICATE || harm->kind == ROBOT_INSERT) {
            put_on_line(robot, way, harm->kind == ROBOT_INSERT ? (uint8_t)harm->with : byte, due_ms);
        }
    }
    if (!lost) {
        put_on_line(robot, way, byte, due_ms);
    }
}

static void hear(robot_t *robot, const uint8_t *bytes, size_t count) {
    robot_line_t *line = &robot->line;
    argus_packet_t packet;
    size_t done = 0;
    do {
        done += argus_parser_push(&line->parser, robot->t_ms, bytes + done, count - done);
        while (argus_parser_next(&line->parser, robot->t_ms, &packet)) {
            uint8_t whole[ARGUS_FRAME_TOTAL_MAX];
            const size_t length = argus_frame_encode(whole, sizeof whole, packet.data, packet.count);
            const robot_command_t sent = command_of(robot, whole, length);
            line->heard_ms = robot->t_ms;
            obey(robot, whole, &sent);
        }
    } while (done < count);
}

// ISO-TP: up to 7 bytes go in a single frame; more in a first one with 6, which the receiver answers with
// flow control, and in consecutive ones. Where one of them is damaged, is lost, comes twice or has another
// between, the packet does not arrive; where flow control stays away, its sender waits for a second besides.
// A single frame may come twice, and each may come late.
static void pass_on_can(robot_t *robot, robot_way_t way, const uint8_t *bytes, size_t count) {
    robot_line_t *line = &robot->line;
    const uint32_t first = line->passed[way];
    const uint32_t frames = count <= 7 ? 1 : 1 + (uint32_t)(count / 7);
    uint32_t due_ms = robot->t_ms;
    int times = 1;
    line->passed[way] += frames;
    for (int i = 0; i < line->harms; i++) {
        robot_harm_t *harm = &line->harm[i];
        const bool hits = harm->way == way && harm->at - first < frames;
        if (harm->way == way) {
            due_ms += hold_up_ms(robot, harm, hits ? harm->at : first);
        }
        if (!hits || harm->kind == ROBOT_DELAY || harm->kind == ROBOT_LATENCY) {
            continue;
        }
        times = harm->kind == ROBOT_DUPLICATE && frames == 1 ? 2 : 0;
        if (frames > 1 && harm->at == first) {
            line->last_ms[way] = due_ms + FLOW_CONTROL_MS;
        }
    }
    for (size_t i = 0; i < count * (size_t)times; i++) {
        put_on_line(robot, way, bytes[i % count], due_ms);
    }
}

void robot_put(robot_t *robot, robot_way_t way, const uint8_t *bytes, size_t count) {
    if (robot->line.can && way <= ROBOT_TO_MANAGER) {
        pass_on_can(robot, way, bytes, count);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        pass_byte(robot, way, bytes[i]);
    }
}

// The others move up.
size_t robot_taken(robot_t *robot, robot_way_t way, uint8_t *bytes) {
    robot_line_t *line = &robot->line;
    size_t count = 0;
    while (count < line->held[way] && !is_before(robot->t_ms, line->due_ms[way][count])) {
        count++;
    }
    memcpy(bytes, line->bytes[way], count);
    line->held[way] -= count;
    memmove(line->bytes[way], line->bytes[way] + count, line->held[way]);
    memmove(line->due_ms[way], line->due_ms[way] + count, line->held[way] * sizeof line->due_ms[way][0]);
    return count;
}

static void run_line(robot_t *robot, robot_way_t way) {
    uint8_t bytes[ROBOT_LINE_MAX];
    const size_t count = robot_taken(robot, way, bytes);
    if (count > 0 && way == ROBOT_TO_ROBOT) {
        hear(robot, bytes, count);
    } else if (count > 0) {
        argus_receive(&robot->argus, robot->start_ms + robot->t_ms, bytes, count);
        if (robot->after != NULL) {
            robot->after(robot, bytes, count);
        }
    }
}

static void send_on_line(robot_t *robot, robot_way_t way, const uint8_t *bytes, size_t count) {
    robot_put(robot, way, bytes, count);
    run_line(robot, way);
}

static void keep_watchdog(robot_t *robot) {
    if (is_in_session(robot) && robot->t_ms - robot->line.heard_ms > WATCHDOG_MS) {
        obey_motion(robot, ARCOS_CMD_STOP, 0);
    }
}

// Then the manager cannot know yet what the robot has shown.
static bool is_held_up(const robot_t *robot) {
    for (int i = 0; i < robot->line.harms; i++) {
        const robot_harm_t *harm = &robot->line.harm[i];
        if (harm->way == ROBOT_TO_MANAGER && (harm->kind == ROBOT_DELAY || harm->kind == ROBOT_LATENCY)) {
            return true;
        }
    }
    return false;
}

static void take_packet(robot_t *robot, const uint8_t *packet, size_t length) {
    const robot_command_t sent = command_of(robot, packet, length);
    // One a SIP, of which nothing but the port comes.
    if (sent.command != ARCOS_CMD_ADSEL && robot->commands < ROBOT_COMMANDS_MAX) {
        robot->command[robot->commands++] = sent;
    }
    if (robot->after == NULL && !is_held_up(robot)) {
        watch(robot, &sent);
    }
    if (robot->has_line) {
        send_on_line(robot, ROBOT_TO_ROBOT, packet, length);
    } else if (!robot->mute) {
        obey(robot, packet, &sent);
    }
}

static void take_events(robot_t *robot) {
    argus_event_t event;
    while (argus_next_event(&robot->argus, &event)) {
        if (robot->events < ROBOT_EVENTS_MAX) {
            robot->event[robot->events++] = event;
        }
        const bool lost = event.id == ARGUS_EV_SESSION_OPEN || event.id == ARGUS_EV_LINK_LOST ||
                          event.id == ARGUS_EV_LINK_STALLED || event.id == ARGUS_EV_LINK_RESUMED;
        robot->checked = event.id == ARGUS_EV_HEALTH_CHECK || (robot->checked && !lost);
        robot->swept = robot->swept || event.id == ARGUS_EV_SWEEP;
        if (event.id == ARGUS_EV_INVARIANT) {
            complain(robot, "INVARIANT event", event.value);
        }
        if (event.id == ARGUS_EV_EVENTS_LOST) {
            complain(robot, "events lost", event.value);
        }
    }
}

void robot_drain(robot_t *robot) {
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    size_t length = 0;
    take_events(robot);
    while ((length = argus_transmit(&robot->argus, packet, sizeof packet)) > 0) {
        if (robot->reply_length == 0 && packet[3] != ARCOS_CMD_ADSEL) {
            memcpy(robot->reply, packet, length);
            robot->reply_length = length;
        }
        take_packet(robot, packet, length);
        take_events(robot);
    }
    const int broken = argus_invariants_broken(&robot->argus);
    if (broken != 0) {
        complain(robot, "argus_invariants_broken", broken);
    }
}

void robot_deliver(robot_t *robot, const uint8_t *bytes, size_t count) {
    if (robot->host_asleep) {
        if (robot->late_count + count <= sizeof robot->late) {
            memcpy(robot->late + robot->late_count, bytes, count);
            robot->late_count += count;
        }
        return;
    }
    if (robot->has_line) {
        send_on_line(robot, ROBOT_TO_MANAGER, bytes, count);
        return;
    }
    argus_receive(&robot->argus, robot->start_ms + robot->t_ms, bytes, count);
    if (robot->after != NULL) {
        robot->after(robot, bytes, count);
    }
}

static bool is_answered(const robot_t *robot, bool open) {
    const argus_t *argus = &robot->argus;
    return open && argus_session_is_open(&argus->session) && !argus->orders.passive &&
           !argus->orders.shutdown;
}

static void send_sip(robot_t *robot) {
    uint8_t packet[255];
    const size_t length = build_sip(robot, packet);
    robot->next_sip_ms += SIP_MS;
    robot->sips++;
    if (robot->mute) {
        return;
    }
    const bool open = argus_session_is_open(&robot->argus.session);
    const uint16_t pressed = (uint16_t)(robot->bumpers_front << 8 | robot->bumpers_rear);
    const bool hit = (pressed & ~(unsigned)robot->bumpers_seen) != 0;
    robot->bumpers_seen = pressed;
    robot->reply_length = 0;
    if (robot->before_sip != NULL) {
        robot->before_sip(robot);
    }
    robot_deliver(robot, packet, length);
    if (robot->host_asleep) {
        return;
    }
    robot_drain(robot);
    if (hit && is_answered(robot, open) &&
        (robot->reply_length == 0 || robot->reply[3] != ARCOS_CMD_E_STOP)) {
        complain(robot, "S2: a bumper was not answered by E_STOP at once", robot->reply[3]);
    }
}

static void process(robot_t *robot) {
    argus_process(&robot->argus, robot->start_ms + robot->t_ms);
    robot_drain(robot);
}

// True when a SIP was due.
static bool step(robot_t *robot) {
    robot->t_ms += TICK_MS;
    if (robot->has_line) {
        run_line(robot, ROBOT_TO_ROBOT);
        run_line(robot, ROBOT_TO_MANAGER);
        robot_drain(robot);
        keep_watchdog(robot);
    }
    drive(robot);
    if (robot->t_ms % 50 == 0) {
        measure_clearance(robot);
    }
    if (!is_in_session(robot)) {
        return false;
    }
    if (robot->sonar_on && (int32_t)(robot->t_ms - robot->next_ping_ms) >= 0) {
        robot->next_ping_ms += (uint32_t)robot->sonar_cycle_ms;
        ping(robot);
    }
    if ((int32_t)(robot->t_ms - robot->next_sip_ms) < 0) {
        return false;
    }
    send_sip(robot);
    return true;
}

void robot_tick(robot_t *robot) {
    step(robot);
    if (!robot->host_asleep) {
        process(robot);
    }
}

void robot_wake(robot_t *robot) {
    robot->host_asleep = false;
    robot_deliver(robot, robot->late, robot->late_count);
    robot->late_count = 0;
    robot_drain(robot);
}

void robot_run(robot_t *robot, uint32_t ms) {
    for (uint32_t at = 0; at < ms; at += TICK_MS) {
        robot_tick(robot);
    }
}

void robot_next_sip(robot_t *robot) {
    for (int i = 0; i < 100; i++) {
        if (step(robot)) {
            return;
        }
        process(robot);
    }
    complain(robot, "no SIP within a second", 0);
}

bool robot_until_mode(robot_t *robot, argus_mode_t mode, uint32_t ms) {
    for (uint32_t at = 0; at < ms && robot->argus.mode != mode; at += TICK_MS) {
        robot_tick(robot);
    }
    return robot->argus.mode == mode;
}

bool robot_until_event(robot_t *robot, int id, uint32_t ms) {
    const int from = robot->events;
    for (uint32_t at = 0; at < ms && robot_count_events(robot, id, from) == 0; at += TICK_MS) {
        robot_tick(robot);
    }
    return robot_count_events(robot, id, from) > 0;
}

int robot_count_events(const robot_t *robot, int id, int from) {
    int count = 0;
    for (int i = from; i < robot->events; i++) {
        count += robot->event[i].id == id;
    }
    return count;
}

int robot_count_commands(const robot_t *robot, int command, int from) {
    int count = 0;
    for (int i = from; i < robot->commands; i++) {
        count += robot->command[i].command == command;
    }
    return count;
}

const robot_command_t *robot_last_command(const robot_t *robot, int command) {
    for (int i = robot->commands - 1; i >= 0; i--) {
        if (robot->command[i].command == command) {
            return &robot->command[i];
        }
    }
    return NULL;
}

const argus_event_t *robot_last_event(const robot_t *robot, int id) {
    for (int i = robot->events - 1; i >= 0; i--) {
        if (robot->event[i].id == id) {
            return &robot->event[i];
        }
    }
    return NULL;
}

bool robot_goal(robot_t *robot, int x_mm, int y_mm) {
    const argus_point_t goal = {x_mm, y_mm};
    return argus_set_course(&robot->argus, &goal, 1);
}
