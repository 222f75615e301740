// SPDX-License-Identifier: MIT
// Drives robots with 8, 16 and 32 sonars by a build that manages ARGUS_SONARS, and says on a line what came
// of it.
#include <stdio.h>
#include <string.h>

#include "robot.h"

#define FAR_MM 2000
#define AT_COUNT 19 // in the data of a SIP: how many readings follow
#define NUMBER_BYTES 3

static robot_t robot;
static unsigned sonars;

// All that it has, each time it lists some: those of the emulated ring as they are, the others far.
static size_t list_all(uint8_t *data, size_t count) {
    uint8_t tail[ROBOT_SIP_MAX];
    const size_t readings = data[AT_COUNT];
    const size_t at = AT_COUNT + 1 + NUMBER_BYTES * readings;
    size_t kept = 0;
    memcpy(tail, data + at, count - at);
    for (size_t k = 0; k < readings; k++) {
        const uint8_t *const from = data + AT_COUNT + 1 + NUMBER_BYTES * k;
        if (from[0] < sonars) {
            memmove(data + AT_COUNT + 1 + NUMBER_BYTES * kept++, from, NUMBER_BYTES);
        }
    }
    for (unsigned number = 16; number < sonars; number++) {
        uint8_t *const to = data + AT_COUNT + 1 + NUMBER_BYTES * kept++;
        to[0] = (uint8_t)number;
        to[1] = FAR_MM & 0xFF;
        to[2] = FAR_MM >> 8;
    }
    data[AT_COUNT] = (uint8_t)kept;
    memcpy(data + AT_COUNT + 1 + NUMBER_BYTES * kept, tail, count - at);
    return AT_COUNT + 1 + NUMBER_BYTES * kept + count - at;
}

static int count_health(argus_health_t health) {
    argus_status_t status;
    int count = 0;
    argus_status(&robot.argus, &status);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        count += status.health[i] == health;
    }
    return count;
}

// With one of the forward-facing ones dead it goes 600 mm ahead.
static void drive(const char *subclass, unsigned has, int dead) {
    argus_config_t config = robot_config();
    config.baud = 0;
    config.check_range_mm = 400; // the step of a wide body
    robot_init(&robot, &config, 1000);
    sonars = has;
    robot.subclass = subclass;
    robot.alter_sip = list_all;
    robot.fault[dead] = ROBOT_OFF;
    robot_goal(&robot, 600, 0);
    const bool reached = robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 200000);
    argus_status_t status;
    argus_status(&robot.argus, &status);
    printf("%s %d %d %d %d %d %d %d %d\n", subclass, status.sonars, reached, count_health(ARGUS_HEALTHY),
           count_health(ARGUS_DISABLED), count_health(ARGUS_ABSENT), status.health[dead] == ARGUS_DISABLED,
           robot_count_events(&robot, ARGUS_EV_SONARS_BEYOND, 0), argus_invariants_broken(&robot.argus));
}

int main(void) {
    drive("p3dx-sh", 16, 3);
    drive("p3at-sh", 16, 4);
    drive("amigo-sh", 8, 2);
    drive("peoplebot-sh", 32, 5);
    return 0;
}
