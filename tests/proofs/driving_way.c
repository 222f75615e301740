// SPDX-License-Identifier: MIT
// S5: the way until the robot stands is worked out in 32 bits as in 64: nothing overflows, and nothing is
// lost but what is less than a millimetre.
// Bounds: a P3-DX at 9,600 baud and with its own brake; each speed up to 2,047 mm/s; links that are prompt, 500 and 2,000 ms late
// Sources: firmware/knowledge/angle.c
// Unwind: 18
// Ci: no
// Mutant: firmware/knowledge/config.c | const uint32_t travel_um = v * (t_us / 1000) + v * (t_us % 1000) / 1000; | const uint32_t travel_um = v * t_us / 1000;
// Mutant: firmware/knowledge/config.c | const uint32_t brake_um = v * v * 1000 / (2 * sure_decel_mm_s2(config, robot)); | const uint32_t brake_um = v * v * 2000 / (4 * sure_decel_mm_s2(config, robot));
#include "proof.h"

#include "knowledge/config.c"

#define UNIT 600000000u // of these parts of a millimetre all that is added is whole

void proof(void) {
    const argus_robot_t robot = {.arrays = 2, .front_mm = 208, .sonar_face_mm = 166, .decel_mm_s2 = 300};
    argus_config_t config = {.decel_mm_s2 = 600, .sonar_cycle_ms = 40, .baud = 9600};
    const int32_t late_ms = nondet_bool() ? 2000 : nondet_bool() ? 500 : 0;
    config.speed_mm_s = any_between(0, 2047);
    argus_config_report_t report;
    work_out_driving(&report, &config, &robot, late_ms);
    const uint64_t v = (uint64_t)config.speed_mm_s;
    const uint64_t t_us = (uint64_t)reaction_us(&config, &robot) + (uint64_t)late_ms * 1000;
    const uint64_t way = (uint64_t)(report.driving_mm - report.overhang_mm) * UNIT;
    const uint64_t exact = v * t_us * (UNIT / 1000000) + v * v * (UNIT / 600);
    PROVE(way <= exact && exact < way + UNIT + UNIT / 400, "as in 64 bits");
}
