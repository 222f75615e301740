// SPDX-License-Identifier: MIT
// Eight HC-SR04 round a robot that is no Pioneer, on an STM32F405: which of them fails, printed as it is
// found.
#include <argus/argus.h>

#include "text.h"

#define US_THERE_AND_BACK 2000 // at 343 m/s
#define FIGURES 6              // t_ms x_mm y_mm heading_cdeg speed_mm_s turn_cdeg_s, then each echo in us

static const argus_sonar_mount_t mounts[] = {
    {0, 140, 90, ARGUS_ROLE_ABEAM},       {90, 107, 50, ARGUS_ROLE_AHEAD},   {134, 41, 17, ARGUS_ROLE_AHEAD},
    {134, -41, -17, ARGUS_ROLE_AHEAD},    {90, -107, -50, ARGUS_ROLE_AHEAD}, {0, -140, -90, ARGUS_ROLE_ABEAM},
    {-121, -70, -150, ARGUS_ROLE_ASTERN}, {-121, 70, 150, ARGUS_ROLE_ASTERN}};
#define SONARS (sizeof mounts / sizeof mounts[0])

static const argus_ring_t ring = {.name = "roundbot",
                                  .front_mm = 150,
                                  .rear_mm = 150,
                                  .width_mm = 300,
                                  .swing_radius_mm = 150, // it is round
                                  .min_mm = 30,
                                  .no_echo_mm = 4000,
                                  .mounts = mounts,
                                  .sonars = SONARS,
                                  .forward = {1, 2, 3, 4},
                                  .forward_count = 4};
static argus_storage_t storage;
static argus_robot_storage_t robot;

// One line of the card that fires the sonars and counts the wheels; an echo of 0 us: not fired since.
static uint32_t observe(argus_t *argus, const int32_t *figures) {
    argus_range_t ranges[SONARS];
    argus_observation_t seen = {.pose = {figures[1], figures[2], figures[3]},
                                .speed_mm_s = figures[4],
                                .turn_cdeg_s = figures[5],
                                .ranges = ranges};
    for (uint8_t i = 0; i < SONARS; i++) {
        const int32_t range_mm = figures[FIGURES + i] * 343 / US_THERE_AND_BACK;
        if (range_mm > 0) {
            ranges[seen.count++] = (argus_range_t){i, (uint16_t)range_mm, 0};
        }
    }
    (void)argus_observe(argus, (uint32_t)figures[0], &seen);
    return argus_process(argus, (uint32_t)figures[0]);
}

int main(void) {
    int32_t figures[FIGURES + SONARS];
    argus_config_t config;
    argus_event_t event;
    argus_config_default(&config);
    argus_t *const argus = argus_init(&storage, &config, 0);
    text_open();
    text_number("ring", argus_set_ring(argus, &robot, &ring).fault);
    for (;;) {
        text_wait(figures, FIGURES + SONARS);
        (void)observe(argus, figures);
        while (argus_next_event(argus, &event)) {
            text_event(argus_name(ARGUS_NAME_EVENT, event.id), event.sonar, event.value);
        }
        text_number("done", figures[0]);
    }
}
