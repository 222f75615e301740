// SPDX-License-Identifier: MIT
// Many fault managers in one process, as a fleet's server or a pass over an archive has them: what each of
// them takes, and that none disturbs another. Usage: fleet [ROBOTS [SECONDS]]
#include <argus/argus.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define MOST 100000
#define TICK_MS 100
#define SPEED_MM_S 200
#define SIDE_MS 6000
#define TURN_MS 3000
#define HALF_SIDE_MM (SPEED_MM_S * SIDE_MS / 2000.0)
#define NO_ECHO_MM 4000
#define FAULTY_EACH 10 // one robot in so many has a dead sonar
#define DEAD 1
#define DEAD_FROM_MS 5000
#define ROOM_MM 6000.0 // long; each robot's is as wide as its number says

static const double rad = 3.14159265358979 / 180;
static const argus_sonar_mount_t mounts[] = {
    {0, 140, 90, ARGUS_ROLE_ABEAM},       {90, 107, 50, ARGUS_ROLE_AHEAD},   {134, 41, 17, ARGUS_ROLE_AHEAD},
    {134, -41, -17, ARGUS_ROLE_AHEAD},    {90, -107, -50, ARGUS_ROLE_AHEAD}, {0, -140, -90, ARGUS_ROLE_ABEAM},
    {-121, -70, -150, ARGUS_ROLE_ASTERN}, {-121, 70, 150, ARGUS_ROLE_ASTERN}};
#define SONARS (sizeof mounts / sizeof mounts[0])

static const argus_ring_t ring = {.name = "roundbot",
                                  .front_mm = 150,
                                  .rear_mm = 150,
                                  .width_mm = 300,
                                  .swing_radius_mm = 150,
                                  .min_mm = 30,
                                  .no_echo_mm = NO_ECHO_MM,
                                  .mounts = mounts,
                                  .sonars = SONARS,
                                  .forward = {1, 2, 3, 4},
                                  .forward_count = 4};

typedef struct {
    double x;
    double y;
    double heading;
    int32_t speed_mm_s;
    int32_t turn_cdeg_s;
} pose_t;

// All that one robot needs: with it its manager can be put to disk or onto another machine.
typedef struct {
    argus_storage_t storage;
    argus_t *argus;
} member_t;

static argus_robot_storage_t body; // every robot of the fleet is built alike

static void begin(member_t *self) {
    argus_config_t config;
    argus_config_default(&config);
    self->argus = argus_init(&self->storage, &config, 0);
    if (argus_set_ring(self->argus, &body, &ring).fault != ARGUS_RING_OK) {
        exit(1);
    }
}

// A room whose walls are straight: how far the nearest of them is along a ray.
static double free_mm(double x, double y, double bearing, double half_mm) {
    const double c = cos(bearing);
    const double s = sin(bearing);
    const double along = c > 0 ? (ROOM_MM - x) / c : c < 0 ? (-ROOM_MM - x) / c : 1e9;
    const double across = s > 0 ? (half_mm - y) / s : s < 0 ? (-half_mm - y) / s : 1e9;
    return fmin(along, across);
}

// A square, again and again: along a side, then turned by 90 degrees on the spot.
static pose_t pose_at(unsigned number, uint32_t now_ms) {
    const uint32_t t_ms = now_ms + number * 37; // each robot is somewhere else on it
    const uint32_t in_ms = t_ms % (SIDE_MS + TURN_MS);
    const uint32_t corners = t_ms / (SIDE_MS + TURN_MS);
    const double corner = corners * 90.0 * rad;
    const bool turns = in_ms >= SIDE_MS;
    const double along = (turns ? SIDE_MS : in_ms) * SPEED_MM_S / 1000.0 - HALF_SIDE_MM;
    const double turned = turns ? (in_ms - SIDE_MS) * 90.0 * rad / TURN_MS : 0;
    return (pose_t){.x = along * cos(corner) + HALF_SIDE_MM * sin(corner),
                    .y = along * sin(corner) - HALF_SIDE_MM * cos(corner),
                    .heading = corner + turned,
                    .speed_mm_s = turns ? 0 : SPEED_MM_S,
                    .turn_cdeg_s = turns ? 9000 * 1000 / TURN_MS : 0};
}

static void observe(member_t *self, unsigned number, uint32_t now_ms) {
    const pose_t pose = pose_at(number, now_ms);
    const double half_mm = 1600 + number % 13 * 50;
    const int deaf = number % FAULTY_EACH == 0 && now_ms >= DEAD_FROM_MS ? DEAD : -1;
    argus_range_t ranges[SONARS];
    argus_observation_t seen = {
        .pose = {(int32_t)pose.x, (int32_t)pose.y, (int32_t)(remainder(pose.heading, 360 * rad) / rad * 100)},
        .speed_mm_s = pose.speed_mm_s,
        .turn_cdeg_s = pose.turn_cdeg_s,
        .ranges = ranges};
    for (unsigned i = now_ms / TICK_MS % 2; i < SONARS; i += 2) { // half of them in each round
        const argus_sonar_mount_t *const m = &mounts[i];
        const double at_x = pose.x + m->x_mm * cos(pose.heading) - m->y_mm * sin(pose.heading);
        const double at_y = pose.y + m->x_mm * sin(pose.heading) + m->y_mm * cos(pose.heading);
        const double mm = free_mm(at_x, at_y, pose.heading + m->heading_deg * rad, half_mm);
        const int range_mm = (int)i == deaf || mm > NO_ECHO_MM ? NO_ECHO_MM : (int)mm;
        ranges[seen.count++] = (argus_range_t){(uint8_t)i, (uint16_t)range_mm, 0};
    }
    (void)argus_observe(self->argus, now_ms, &seen);
    (void)argus_process(self->argus, now_ms);
}

// What an operator would be told of: here only which sonars are named.
static unsigned named(member_t *self) {
    argus_event_t event;
    argus_status_t status;
    unsigned mask = 0;
    while (argus_next_event(self->argus, &event)) {
    }
    argus_status(self->argus, &status);
    for (unsigned i = 0; i < SONARS; i++) {
        mask |= status.kind[i] != ARGUS_KIND_NONE ? 1u << i : 0u;
    }
    return mask;
}

static double cpu_s(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + (double)t.tv_nsec / 1e9;
}

int main(int argc, char **argv) {
    const unsigned long robots = argc > 1 ? strtoul(argv[1], NULL, 10) : 1000;
    const unsigned long seconds = argc > 2 ? strtoul(argv[2], NULL, 10) : 30;
    if (argc > 3 || robots < 1 || robots > MOST || seconds < 1 || seconds > 3600) {
        fprintf(stderr, "usage: fleet [ROBOTS [SECONDS]]: 1 to %d, 1 to 3600\n", MOST);
        return 2;
    }
    member_t *const fleet = calloc(robots, sizeof *fleet);
    if (fleet == NULL) {
        fprintf(stderr, "fleet: no memory for %lu managers of %zu bytes\n", robots, sizeof *fleet);
        return 1;
    }
    for (unsigned long i = 0; i < robots; i++) {
        begin(&fleet[i]);
    }
    const double before_s = cpu_s();
    for (uint32_t now_ms = TICK_MS; now_ms <= seconds * 1000; now_ms += TICK_MS) {
        for (unsigned long i = 0; i < robots; i++) {
            observe(&fleet[i], (unsigned)i, now_ms);
        }
    }
    const double spent_s = cpu_s() - before_s;
    unsigned long found = 0, wrong = 0;
    for (unsigned long i = 0; i < robots; i++) {
        const unsigned mask = named(&fleet[i]);
        const unsigned dead = i % FAULTY_EACH == 0 ? 1u << DEAD : 0u;
        found += dead != 0 && (mask & dead) != 0;
        wrong += (mask & ~dead) != 0;
    }
    printf("%lu robots, %lu s: %.1f MB, %.4f cores; %lu of %lu dead sonars named, and %lu healthy ones\n",
           robots, seconds, (double)(robots * sizeof *fleet) / 1e6, spent_s / (double)seconds, found,
           (robots + FAULTY_EACH - 1) / FAULTY_EACH, wrong);
    free(fleet);
    return 0;
}
