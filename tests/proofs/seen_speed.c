// SPDX-License-Identifier: MIT
// S5: from the speed that a range lets, the robot stands before the end of it: the same rule that the
// settings are checked by, asked back.
// Bounds: a P3-DX at 9,600 baud and its own brake; each range of 0 to 2,000 mm on a prompt link
// Sources: firmware/knowledge/angle.c
// Unwind: 18
// Ci: no
// Mutant: firmware/knowledge/config.c | argus_max(0, range_mm - overhang_mm - 1); | argus_max(0, range_mm);
// Mutant: firmware/knowledge/config.c | return (int32_t)argus_sqrt(square) - slower_mm_s; | return (int32_t)argus_sqrt(square) - slower_mm_s / 2;
#include "proof.h"

#include "knowledge/config.c"

void proof(void) {
    const argus_robot_t robot = {.arrays = 2, .front_mm = 208, .sonar_face_mm = 166, .decel_mm_s2 = 300};
    argus_config_t config = {.decel_mm_s2 = 600, .sonar_cycle_ms = 40, .baud = 9600};
    const int32_t range_mm = any_between(0, 2000);
    config.speed_mm_s = argus_config_speed_mm_s(&config, &robot, range_mm, 0);
    if (config.speed_mm_s > 0) {
        argus_config_report_t report;
        work_out_driving(&report, &config, &robot, 0);
        PROVE(report.driving_mm < range_mm, "it stands before");
    }
}
