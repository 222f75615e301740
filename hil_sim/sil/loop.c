// SPDX-License-Identifier: MIT
// The loop of one mission (run.py, line.py, server.py) in C, as long as what is due is plain; the rest is
// Python's.
#include "sightings.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum {
    HELD = 128,
    ROOM = 32,
    NOTES = 1 << 16,
    ROWS = 64,
    FIELDS = 8,
    BRIEF = 128,
    DATA_AT = 3,
    READINGS = 32
};

static const double backlog_ms = 200.0, moving_mm_s = 5.0, turning_deg_s = 1.0;

typedef struct {
    double t_ms;
    int32_t length;
    uint8_t data[FRAME_MAX];
} packet_t;

typedef struct {
    double byte_ms, free_ms;
    int64_t first, count;
    packet_t held[HELD];
} line_t;

typedef struct {
    double t_ms;
    uint8_t bytes[BRIEF];
} brief_t;

// Functions of libargus.so.
typedef struct {
    void *core;
    void (*receive)(void *core, uint32_t now_ms, const uint8_t *data, size_t length);
    uint32_t (*process)(void *core, uint32_t now_ms);
    size_t (*transmit)(void *core, uint8_t *data, size_t capacity);
    bool (*event)(void *core, int32_t *fields);
    void (*brief)(const void *core, uint8_t *bytes);
} core_t;

// Python's: a sub-step; the fault manager has taken a SIP.
typedef struct {
    void (*step)(void);
    void (*taken)(void);
} calls_t;

enum { PULSE, SETV, MOVE, VEL, HEAD, ADSEL, COMMANDS };

typedef struct {
    parts_t *parts;
    core_t core;
    calls_t calls;
    sightings_t *seen; // NULL: nobody wants to know
    report_t report;
    double vel_top;
    double now_ms, next_sip_ms, core_due_ms, brief_ms, verifying_ms, driving_ms;
    int64_t turns, sips, packets, sip_cycle_ms;
    int32_t command[COMMANDS], negative, positive;
    int32_t verifying, over_first, over_second, brief_size;
    int32_t notes_count, events_count, briefs_count, fields;
    bool traces, stops_at_goal, stop;
    uint8_t brief[BRIEF];
    line_t to_core, to_robot;
    uint8_t out[FRAME_MAX];
    int32_t out_length;
    sighting_t made;
    int32_t events[ROWS * FIELDS];
    brief_t briefs[ROWS];
    uint8_t notes[NOTES];
} sil_t;

void argus_sim_loop(sil_t *sil, double end_ms);
size_t argus_sim_loop_size(void);

size_t argus_sim_loop_size(void) {
    return sizeof(sil_t);
}

// ---- lines ------------------------------------------------------------------------------------------------

static packet_t *held(line_t *const line, const int64_t k) {
    return &line->held[(line->first + k) % HELD];
}

static double due_ms(line_t *const line) {
    return line->count > 0 ? held(line, 0)->t_ms : INFINITY;
}

static void push(line_t *const line, const uint8_t *const data, const int32_t length, const double now_ms) {
    if (line->free_ms - now_ms > backlog_ms) {
        return;
    }
    line->free_ms = (now_ms > line->free_ms ? now_ms : line->free_ms) + length * line->byte_ms;
    packet_t *const packet = held(line, line->count++);
    packet->t_ms = line->free_ms;
    packet->length = length;
    memcpy(packet->data, data, (size_t)length);
}

static const packet_t *pop(line_t *const line) {
    const packet_t *const packet = held(line, 0);
    line->first = (line->first + 1) % HELD;
    line->count--;
    return packet;
}

static void note(sil_t *const sil, const packet_t *const packet, const bool to_robot) {
    uint8_t *at = &sil->notes[sil->notes_count];
    memcpy(at, &sil->now_ms, sizeof sil->now_ms);
    at += sizeof sil->now_ms;
    *at++ = to_robot;
    memcpy(at, packet->data, (size_t)packet->length);
    sil->notes_count += (int32_t)sizeof sil->now_ms + 1 + packet->length;
}

// ---- the fault manager ------------------------------------------------------------------------------------

static void look_at_brief(sil_t *const sil) {
    uint8_t fresh[BRIEF];
    sil->core.brief(sil->core.core, fresh);
    if (sil->brief[0] == sil->verifying) {
        sil->verifying_ms += sil->now_ms - sil->brief_ms;
    }
    sil->brief_ms = sil->now_ms;
    if (memcmp(fresh, sil->brief, (size_t)sil->brief_size) != 0) {
        memcpy(sil->brief, fresh, (size_t)sil->brief_size);
        brief_t *const row = &sil->briefs[sil->briefs_count++];
        row->t_ms = sil->now_ms;
        memcpy(row->bytes, fresh, (size_t)sil->brief_size);
    }
}

static void serve_core(sil_t *const sil) {
    const core_t *const core = &sil->core;
    const int64_t now = (int64_t)sil->now_ms;
    sil->core_due_ms = (double)(now + core->process(core->core, (uint32_t)now));
    uint8_t data[FRAME_MAX];
    size_t length;
    while ((length = core->transmit(core->core, data, sizeof data)) != 0) {
        push(&sil->to_robot, data, (int32_t)length, sil->now_ms);
    }
    while (sil->events_count < ROWS && core->event(core->core, &sil->events[FIELDS * sil->events_count])) {
        sil->events_count++;
    }
    look_at_brief(sil);
}

static void to_manager(sil_t *const sil, const packet_t *const packet) {
    note(sil, packet, false);
    sil->core.receive(sil->core.core, (uint32_t)(int64_t)sil->now_ms, packet->data, (size_t)packet->length);
    serve_core(sil);
    if (sil->seen != NULL &&
        argus_sim_sighting_taken(sil->seen, sil->parts, sil->brief[0], packet->data, packet->length) &&
        sil->traces) {
        sil->calls.taken();
    }
}

// ---- the robot's server -----------------------------------------------------------------------------------

static void look_at_robot(sil_t *const sil) {
    const drive_t *const drive = sil->parts->drive;
    if (fabs(drive->v) > moving_mm_s || fabs(drive->w) > turning_deg_s) {
        sil->driving_ms += (double)sil->sip_cycle_ms;
    }
    if (sil->seen != NULL) {
        argus_sim_sighting_sent(sil->seen, &sil->made, sil->out, sil->out_length);
    }
}

static void advance(sil_t *const sil) {
    robot_t *const robot = sil->parts->robot;
    while ((double)(robot->now_ms + STEP_MS) <= sil->now_ms) {
        if (!argus_sim_run(sil->parts, sil->next_sip_ms, sil->now_ms)) {
            sil->calls.step();
        }
        if ((double)robot->now_ms >= sil->next_sip_ms) {
            sil->next_sip_ms += (double)sil->sip_cycle_ms;
            sil->sips++;
            sil->out_length = argus_sim_sip(sil->parts, &sil->report, sil->out);
            if (sil->seen != NULL) {
                sil->made = argus_sim_sighting(sil->seen, sil->parts);
            }
            sil->parts->ring->heard.count = 0;
        }
    }
}

static bool is_intact(const uint8_t *const data, const int32_t length) {
    const int32_t count = length - DATA_AT;
    if (length < 6 || data[0] != 0xFA || data[1] != 0xFB || data[2] != count) {
        return false;
    }
    const uint32_t sum = argus_sim_checksum(&data[DATA_AT], count - 2);
    return sum == ((uint32_t)data[length - 2] << 8 | data[length - 1]);
}

static bool is_to_be_obeyed(const sil_t *const sil, const packet_t *const packet) {
    const uint8_t *const data = packet->data;
    const int32_t count = packet->length - DATA_AT;
    if (!is_intact(data, packet->length)) {
        return false;
    }
    if (data[DATA_AT] == sil->command[PULSE]) {
        return true;
    }
    bool known = false;
    for (int32_t k = SETV; k < COMMANDS; k++) {
        known |= data[DATA_AT] == sil->command[k];
    }
    return known && count == 6 && (data[DATA_AT + 1] == sil->negative || data[DATA_AT + 1] == sil->positive);
}

static void leave_vel2(drive_t *const drive) {
    if (drive->vel2) {
        drive->vel2 = false;
        drive->v_set = drive->w_set = 0.0;
    }
}

static void go_ahead(drive_t *const drive, const bool to_place, const double value) {
    if (drive->motors) {
        leave_vel2(drive);
        drive->move_mode = to_place;
        *(to_place ? &drive->move_left : &drive->v_set) = value;
    }
}

static void head(const parts_t *const parts, const double degrees) {
    drive_t *const drive = parts->drive;
    if (drive->motors) {
        leave_vel2(drive);
        drive->head_mode = true;
        drive->head_left = remainder(degrees - parts->chassis->odo_th, 360);
        drive->head_set = degrees;
    }
}

static void obey(const sil_t *const sil, const uint8_t *const data) {
    const int32_t number = data[0];
    if (number == sil->command[PULSE]) {
        return;
    }
    const int32_t magnitude = data[2] | data[3] << 8;
    const int32_t value = data[1] == sil->negative ? -magnitude : magnitude;
    if (number == sil->command[ADSEL]) {
        sil->parts->robot->anport = value & 0xFF;
    } else if (number == sil->command[SETV]) {
        sil->parts->settings->v_max = fmin((double)magnitude, sil->vel_top);
    } else if (number == sil->command[HEAD]) {
        head(sil->parts, value);
    } else {
        go_ahead(sil->parts->drive, number == sil->command[MOVE], value);
    }
}

static void collect(sil_t *const sil) {
    if (sil->out_length == 0) {
        return;
    }
    look_at_robot(sil);
    push(&sil->to_core, sil->out, sil->out_length, sil->now_ms);
    sil->out_length = 0;
}

// ---- time -------------------------------------------------------------------------------------------------

static double next_ms(sil_t *const sil) {
    return fmin(fmin(sil->core_due_ms, sil->next_sip_ms),
                fmin(due_ms(&sil->to_core), due_ms(&sil->to_robot)));
}

static bool has_room(const sil_t *const sil) {
    return sil->notes_count <= NOTES / 2 && sil->events_count <= ROWS / 2 && sil->briefs_count <= ROWS / 2 &&
           sil->to_core.count <= HELD - ROOM && sil->to_robot.count <= HELD - ROOM &&
           sil->parts->ring->heard.count < READINGS &&
           (sil->seen == NULL || argus_sim_sightings_have_room(sil->seen));
}

// Whether all that is due can be done here, and there is room for what comes of it: of one SIP, not more.
static bool is_plain(sil_t *const sil, const double now_ms) {
    if (sil->stop || !has_room(sil)) {
        return false;
    }
    for (int64_t k = 0; k < sil->to_robot.count && held(&sil->to_robot, k)->t_ms <= now_ms; k++) {
        if (!is_to_be_obeyed(sil, held(&sil->to_robot, k))) {
            return false;
        }
    }
    return now_ms < sil->next_sip_ms + (double)sil->sip_cycle_ms;
}

static void turn(sil_t *const sil) {
    while (due_ms(&sil->to_robot) <= sil->now_ms) {
        const packet_t *const packet = pop(&sil->to_robot);
        note(sil, packet, true);
        advance(sil);
        sil->packets++;
        sil->parts->robot->last_heard_ms = sil->parts->robot->now_ms;
        obey(sil, &packet->data[DATA_AT]);
    }
    if (sil->next_sip_ms <= sil->now_ms) {
        advance(sil);
    }
    collect(sil);
    while (due_ms(&sil->to_core) <= sil->now_ms) {
        to_manager(sil, pop(&sil->to_core));
    }
    if (sil->core_due_ms <= sil->now_ms) {
        serve_core(sil);
    }
}

static bool is_over(const sil_t *const sil) {
    return sil->stops_at_goal && (sil->brief[1] == sil->over_first || sil->brief[1] == sil->over_second);
}

void argus_sim_loop(sil_t *const sil, const double end_ms) {
    double due;
    while ((due = next_ms(sil)) <= end_ms && is_plain(sil, due) && !is_over(sil)) {
        sil->now_ms = due;
        turn(sil);
        sil->turns++;
    }
}
