// SPDX-License-Identifier: MIT
// The SIP of a robot (report.py, arcos/sip.py, arcos/framing.py) in C.
#include "report.h"

#include <math.h>
#include <string.h>

enum { HEADER0 = 0xFA, HEADER1 = 0xFB, BATTERY_MAX = 255, DIGIN = 0xFF };

typedef struct {
    uint8_t *at;
} writer_t;

static void put8(writer_t *const to, const int64_t value) {
    *to->at++ = (uint8_t)value;
}

static void put16(writer_t *const to, const int64_t value) {
    put8(to, value & 0xFF);
    put8(to, value >> 8 & 0xFF);
}

static int64_t rounded(const double value) {
    return (int64_t)rint(value);
}

static double battery_v(const parts_t *const parts, const report_t *const report, const double wheels_mm_s) {
    const energy_t *const energy = parts->energy;
    const double total_j = energy->idle_s * report->idle_w + energy->sonar_s * report->sonar_w +
                           energy->wheel_m * report->wheel_j_m + energy->accel_j;
    const double share = total_j / report->capacity_j;
    const double used = share < 1.0 ? share : 1.0;
    const double open_v = report->full_v - (report->full_v - report->empty_v) * used;
    const double watts =
        report->idle_w + (parts->sonar_on ? report->sonar_w : 0.0) + report->wheel_j_m * wheels_mm_s / 1000;
    return open_v - watts / open_v * report->internal_ohm;
}

static int64_t angle_units(const double degrees, const int64_t turn) {
    const int64_t units = (rounded(degrees * (double)turn / 360) + turn / 2) % turn;
    return (units < 0 ? units + turn : units) - turn / 2;
}

static void put_stalls(const parts_t *const parts, writer_t *const to) {
    stall_t *const stall = parts->stall;
    put8(to, argus_sim_rear_pressed(parts) | (stall->seen_left || stall->left));
    put8(to, argus_sim_front_pressed(parts) | (stall->seen_right || stall->right));
    stall->seen_left = stall->seen_right = false;
}

static void put_readings(rows_t *const heard, writer_t *const to) {
    put8(to, heard->count);
    for (int64_t k = 0; k < heard->count; k++) {
        put8(to, heard->rows[k].number);
        put16(to, heard->rows[k].range_mm);
    }
}

static void put_tail(const parts_t *const parts, const report_t *const report, const int64_t battery_dv,
                     writer_t *const to) {
    put8(to, 0); // gripper
    put8(to, parts->robot->anport);
    put8(to, 0); // analog
    put8(to, DIGIN);
    put8(to, report->digout);
    put16(to, battery_dv);
    put8(to, 0); // charge
    put16(to, rounded(parts->drive->w * 10));
    put16(to, 0); // fault flags
}

uint32_t argus_sim_checksum(const uint8_t *const data, const int32_t length) {
    uint32_t sum = 0;
    for (int32_t k = 0; k + 1 < length; k += 2) {
        sum += (uint32_t)data[k] << 8 | data[k + 1];
    }
    sum &= 0xFFFF;
    return length % 2 != 0 ? sum ^ data[length - 1] : sum;
}

int32_t argus_sim_sip(const parts_t *const parts, const report_t *const report, uint8_t *const packet) {
    const drive_t *const drive = parts->drive;
    const chassis_t *const chassis = parts->chassis;
    const wheels_t wheels = argus_sim_wheels(parts);
    const int64_t left_mm_s = rounded(wheels.left), right_mm_s = rounded(wheels.right);
    const bool moves = left_mm_s != 0 || right_mm_s != 0 || argus_sim_wants_motion(parts);
    const int64_t battery_dv = rounded(battery_v(parts, report, fabs(wheels.left) + fabs(wheels.right)) * 10);
    writer_t to = {packet + 3};
    put8(&to, moves ? report->moving : report->still);
    put16(&to, rounded(chassis->odo_x / report->unit_mm) & 0xFFFF);
    put16(&to, rounded(chassis->odo_y / report->unit_mm) & 0xFFFF);
    put16(&to, angle_units(chassis->odo_th, report->turn));
    put16(&to, left_mm_s);
    put16(&to, right_mm_s);
    put8(&to, battery_dv < BATTERY_MAX ? battery_dv : BATTERY_MAX);
    put_stalls(parts, &to);
    put16(&to, 0); // control
    put16(&to, report->flags | (drive->motors ? report->motors : 0));
    put8(&to, 0); // compass
    put_readings(&parts->ring->heard, &to);
    put_tail(parts, report, battery_dv, &to);
    const int32_t length = (int32_t)(to.at - (packet + 3));
    packet[0] = HEADER0;
    packet[1] = HEADER1;
    packet[2] = (uint8_t)(length + 2);
    const uint32_t sum = argus_sim_checksum(packet + 3, length);
    put8(&to, sum >> 8);
    put8(&to, sum & 0xFF);
    return length + 5;
}
