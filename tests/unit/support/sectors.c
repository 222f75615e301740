// SPDX-License-Identifier: MIT
#include "sectors.h"

#include <string.h>

void sectors_begin(argus_own_robot_t *own, argus_knowledge_t *k, int sonars, int count, int width_deg) {
    memset(own, 0, sizeof *own);
    argus_robot_t *const row = &own->rows[0];
    row->poses = (int16_t)((const char *)own->poses - (const char *)row);
    row->sonars = (uint8_t)(sonars + count);
    row->sector_deg = (uint8_t)width_deg;
    row->cone_deg = 30;
    for (int i = sonars; i < sonars + count && i < ARGUS_SONARS; i++) {
        own->poses[i] = (argus_sonar_pose_t){0, 0, (int16_t)((sonars + count / 2 - i) * width_deg)};
        row->sector_mask = (argus_mask_t)(row->sector_mask | 1u << i);
    }
    k->robot = row;
    k->sonars = row->sonars;
}
