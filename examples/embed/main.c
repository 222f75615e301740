// SPDX-License-Identifier: MIT
// The fault manager in a port of its own: a link in memory, a clock that is a variable, events on standard
// output.
#include <argus/argus.h>
#include <stdio.h>

#include "robot.h"

#define SECONDS 20
#define STEP_MS 10

static argus_storage_t storage;

static void transmit(argus_t *argus, robot_t *robot) {
    uint8_t packet[ARGUS_PACKET_MAX];
    for (size_t n = argus_transmit(argus, packet, sizeof packet); n > 0;
         n = argus_transmit(argus, packet, sizeof packet)) {
        robot_take(robot, packet, n);
    }
}

int main(void) {
    argus_config_t config;
    argus_event_t event;
    robot_t robot = {0};
    uint8_t bytes[256];
    argus_config_default(&config);
    config.active = 0; // only report: this robot cannot drive
    argus_t *const argus = argus_init(&storage, &config, 0);
    argus_link_up(argus, 0);
    for (uint32_t now_ms = 0; !argus_closed(argus); now_ms += STEP_MS) {
        argus_receive(argus, now_ms, bytes, robot_give(&robot, now_ms, bytes, sizeof bytes));
        transmit(argus, &robot);
        (void)argus_process(argus, now_ms); // says how long it can wait; this loop has no end of time
        transmit(argus, &robot);
        while (argus_next_event(argus, &event)) {
            printf("%5u ms  %-18s sonar %2d  value %d\n", (unsigned)event.t_ms,
                   argus_name(ARGUS_NAME_EVENT, event.id), event.sonar, (int)event.value);
        }
        if (now_ms == SECONDS * 1000) {
            argus_shutdown(argus, now_ms);
        }
    }
    argus_status_t status;
    argus_status(argus, &status);
    printf("%u SIPs from %s; sonar 3 is %s\n", (unsigned)status.sips, status.robot_name,
           argus_name(ARGUS_NAME_HEALTH, (int)status.health[3]));
    return 0;
}
