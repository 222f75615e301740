// SPDX-License-Identifier: MIT
// Fuzz target: the manager, its guard port and a robot in a room live through what the input tells, and the
// monitor of S1 to S8 watches. An input is a scenario and a list of orders (docs/safety-monitor.md). With
// libFuzzer, or, built with FUZZ_REPLAY, a program that replays files.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "argus/argus.h"
#include "plant.h"
#include "safety.h"

#define STEP_MS 10u
#define OPENS_MS 2600u
#define MOST_MS 8000u // of one input: it is short, so that many are tried
#define BODIES 5
#define WORLDS 8
#define SCENARIOS (WORLDS * BODIES * 2)

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t length);

// Everything that lives; copied back as it was after its session had opened.
typedef struct {
    argus_storage_t storage;
    argus_port_storage_t port;
    plant_t plant;
    safety_t monitor;
    uint32_t due_ms, last_pulse_ms;
    uint32_t deaf_ms, mute_ms; // until then nothing passes to the manager, to the robot
    uint32_t release_ms;       // of the bumpers
    uint32_t end_ms;
    bool guard, there, pulses, corrupts;
} sim_t;

static sim_t sim;
static bool shows;             // a replay tells what passes
static const char *input_line; // ... of this input
static sim_t *opened[SCENARIOS];

static argus_t *core(void) {
    return (argus_t *)&sim.storage;
}

#define BOX(x1, y1, x2, y2)                                 \
    {x1, y1, x2, y1}, {x2, y1, x2, y2}, {x2, y2, x1, y2}, { \
        x1, y2, x1, y1                                      \
    }
static const double room[][4] = {BOX(-2500, -2000, 2500, 2000)};
static const double wide[][4] = {BOX(-7000, -7000, 7000, 7000)};
static const double corridor[][4] = {BOX(-3000, -480, 3000, 480)};
static const double boxes[][4] = {BOX(-2500, -2000, 2500, 2000), BOX(900, -200, 1300, 250),
                                  BOX(-300, 700, 200, 1000)};
static const double posts[][4] = {BOX(-3000, -3000, 3000, 3000), BOX(700, 150, 760, 210),
                                  BOX(500, -500, 560, -440), BOX(-600, 330, -540, 390)};
static const double wall_beside[][4] = {{-3000, 300, 3000, 300}, {2000, 300, 2000, -2000}};
static const double niche[][4] = {{-500, 330, 900, 330}, {900, 330, 900, -330}, {900, -330, -500, -330}};
static const double slant[][4] = {
    {-500, -700, 4000, 530}, {-2000, 1500, 4000, 1400}, {1500, -3000, 1500, 3000}};
#define WORLD(walls) {walls, sizeof walls / sizeof walls[0]}
static const struct {
    const double (*walls)[4];
    unsigned count;
} worlds[WORLDS] = {WORLD(room),  WORLD(wide),        WORLD(corridor), WORLD(boxes),
                    WORLD(posts), WORLD(wall_beside), WORLD(niche),    WORLD(slant)};

// ---- one turn of the loop, as a platform does it

static void tell_health(void) {
    argus_status_t status;
    uint32_t out = 0, doubted = 0;
    argus_status(core(), &status);
    for (uint32_t k = 0; k < ARGUS_SONARS; k++) {
        const argus_health_t health = status.health[k];
        out |= health >= ARGUS_DISABLED ? (uint32_t)1 << k : 0;
        doubted |= health == ARGUS_SUSPECT && status.kind[k] != ARGUS_KIND_NONE ? (uint32_t)1 << k : 0;
    }
    safety_health(&sim.monitor, out, doubted);
}

static void show(const char *who, const uint8_t *packet, size_t length) {
    if (shows) {
        const plant_t *const plant = &sim.plant;
        printf("%u ms, at %.0f %.0f %.1f deg, %.0f mm/s, %.1f deg/s, gap %.0f mm: %s",
               (unsigned)plant->now_ms, plant->x, plant->y, plant->th * 57.2958, plant->v, plant->w * 57.2958,
               plant->gap_mm, who);
        for (size_t i = 3; i + 2 < length && i < 12; i++) {
            printf(" %u", packet[i]);
        }
        putchar('\n');
    }
}

static void drain(void) {
    uint8_t packet[256];
    argus_event_t event;
    tell_health();
    for (size_t length; (length = argus_transmit(core(), packet, sizeof packet)) > 0;) {
        show("to the robot", packet, length);
        safety_feed(&sim.monitor, sim.plant.now_ms, SAFETY_TO_ROBOT, packet, length);
        if ((int32_t)(sim.plant.now_ms - sim.mute_ms) >= 0) {
            plant_take(&sim.plant, packet, length);
        }
    }
    while (argus_next_event(core(), &event)) {
        if (shows) {
            printf("%u ms: event %u, %d, %d\n", (unsigned)sim.plant.now_ms, (unsigned)event.id,
                   (int)event.sonar, (int)event.value);
        }
        safety_event(&sim.monitor, sim.plant.now_ms, event.id, event.value);
    }
}

static void pass(const uint8_t *client, size_t client_count, const uint8_t *robot, size_t robot_count) {
    uint8_t out[1024];
    argus_port_io_t io = {.there = sim.there,
                          .client = client,
                          .client_count = client_count,
                          .robot = robot,
                          .robot_count = robot_count,
                          .out = out,
                          .capacity = sizeof out,
                          .readings = ARGUS_READINGS_COVER};
    if (!sim.guard) {
        return;
    }
    while (argus_guard_port(core(), &sim.port, sim.plant.now_ms, &io) > 0) {
        io.client_count = io.robot_count = 0;
    }
}

static void client_says(const uint8_t *data, size_t length) {
    uint8_t packet[256];
    const size_t size = plant_frame(packet, data, length);
    show("the client", packet, size);
    pass(packet, size, NULL, 0);
    drain();
}

static void order(uint8_t command, int32_t value) {
    const uint32_t size = (uint32_t)(value < 0 ? -value : value);
    const uint8_t data[4] = {command, value < 0 ? 0x1b : 0x3b, (uint8_t)size, (uint8_t)(size >> 8)};
    client_says(data, sizeof data);
}

static void pulse(void) {
    const uint8_t data = 0;
    if (sim.guard && sim.pulses && sim.plant.now_ms - sim.last_pulse_ms >= 500) {
        sim.last_pulse_ms = sim.plant.now_ms;
        client_says(&data, 1);
    }
}

static void hear(void) {
    uint8_t packet[256];
    for (size_t length; (length = plant_say(&sim.plant, packet, sizeof packet)) > 0;) {
        if ((int32_t)(sim.plant.now_ms - sim.deaf_ms) < 0) {
            continue;
        }
        if (sim.corrupts) {
            packet[length / 2] ^= 0x10;
            sim.corrupts = false;
        }
        safety_feed(&sim.monitor, sim.plant.now_ms, SAFETY_FROM_ROBOT, packet, length);
        argus_receive(core(), sim.plant.now_ms, packet, length);
        pass(NULL, 0, packet, length);
        drain();
        sim.due_ms = sim.plant.now_ms;
    }
}

// An unseen corner beside the body in a tight curve is not promised (docs/guardian.md).
static bool curves_tightly(const plant_t *plant) {
    const double v = plant->contact_v < 0 ? -plant->contact_v : plant->contact_v;
    const double w = plant->contact_w < 0 ? -plant->contact_w : plant->contact_w;
    return v > 20 && v < w * 700;
}

static void step(void) {
    plant_t *const plant = &sim.plant;
    plant_step(plant);
    if (plant->bumpers_front + plant->bumpers_rear + plant->stalls != 0 &&
        (int32_t)(plant->now_ms - sim.release_ms) >= 0) {
        plant->bumpers_front = plant->bumpers_rear = plant->stalls = 0;
    }
    if (plant->contact && !curves_tightly(plant)) {
        safety_truth(&sim.monitor, plant->now_ms, plant->contact_v, plant->contact_w * 57.2958, 0, true);
    } else if (plant->now_ms % 100 == 0) {
        safety_truth(&sim.monitor, plant->now_ms, plant->v, plant->w * 57.2958, plant->gap_mm, false);
    }
    hear();
    if ((int32_t)(plant->now_ms - sim.due_ms) >= 0) {
        sim.due_ms = plant->now_ms + argus_process(core(), plant->now_ms);
        pass(NULL, 0, NULL, 0);
        drain();
    }
    pulse();
}

static void run(uint32_t ms) {
    for (uint32_t at = 0; at < ms && (int32_t)(sim.plant.now_ms - sim.end_ms) < 0; at += STEP_MS) {
        step();
    }
}

// ---- the scenario

static void client_opens(void) {
    for (uint8_t sync = 0; sync < 3; sync++) {
        client_says(&sync, 1);
    }
    order(1, 1);
}

static void begin(unsigned scenario) {
    const unsigned world = scenario % WORLDS, body = scenario / WORLDS % BODIES;
    const bool unknown = body >= safety_body_count;
    const safety_body_t *const row = &safety_bodies[unknown ? 0 : body];
    argus_config_t config;
    safety_settings_t settings = safety_defaults();
    memset(&sim, 0, sizeof sim);
    sim.guard = scenario / (WORLDS * BODIES) != 0;
    const uint32_t start_ms = world % 2 == 0 ? 1000 : UINT32_MAX - 4000; // the clock wraps
    argus_config_default(&config);
    settings.sonars = ARGUS_SONARS;
    settings.guard = sim.guard;
    plant_init(&sim.plant, row, unknown ? "pioneer9" : row->subclass, worlds[world].walls,
               worlds[world].count, start_ms);
    safety_init(&sim.monitor, &settings);
    argus_init(&sim.storage, &config, start_ms);
    argus_link_up(core(), start_ms);
    sim.due_ms = sim.deaf_ms = sim.mute_ms = sim.last_pulse_ms = start_ms;
    sim.there = sim.pulses = sim.guard;
    sim.end_ms = start_ms + OPENS_MS;
    run(OPENS_MS);
    if (sim.guard) {
        client_opens();
    }
}

static void restore(unsigned scenario) {
    if (opened[scenario] == NULL) {
        begin(scenario);
        opened[scenario] = malloc(sizeof sim);
        if (opened[scenario] == NULL) {
            abort();
        }
        memcpy(opened[scenario], &sim, sizeof sim);
    } else {
        memcpy(&sim, opened[scenario], sizeof sim);
    }
    sim.end_ms = sim.plant.now_ms + MOST_MS;
}

// ---- the orders of an input

typedef struct {
    const uint8_t *at;
    size_t left;
} input_t;

static uint8_t next(input_t *input) {
    if (input->left == 0) {
        return 0;
    }
    input->left--;
    return *input->at++;
}

// Extremes and the small come up as often as all between.
static int32_t value_of(input_t *input, int32_t unit) {
    static const int16_t chosen[] = {0,    1,   -1,  2,    -2,  32767, -32767, 255,
                                     -255, 256, 360, -360, 180, -180,  90,     -90};
    const uint8_t byte = next(input);
    return byte < sizeof chosen / sizeof chosen[0] ? chosen[byte] : ((int32_t)byte - 136) * unit;
}

static void hold(bool holds) {
    safety_hold(&sim.monitor, sim.plant.now_ms, holds);
}

static void operate(input_t *input) {
    const argus_op_t op = (argus_op_t)(next(input) % 11 + 1);
    const int32_t value = value_of(input, 2);
    if (shows) {
        printf("%u ms: operator %d, %d\n", (unsigned)sim.plant.now_ms, (int)op, (int)value);
    }
    const bool counts = argus_operator(core(), sim.plant.now_ms, op, value);
    if (op == ARGUS_OP_STOP || (op == ARGUS_OP_PASSIVE && !sim.guard)) {
        hold(true);
    } else if (counts && op <= ARGUS_OP_RETEST) { // any order that may move it lets it go
        hold(false);
    }
    drain();
}

static void set_course(input_t *input) {
    const argus_point_t goal = {value_of(input, 25), value_of(input, 25)};
    hold(false); // a course that is given is begun
    argus_set_course(core(), &goal, 1);
    argus_operator(core(), sim.plant.now_ms, ARGUS_OP_GO, 0);
    drain();
}

static void disturb(input_t *input) {
    const uint8_t what = next(input);
    const uint32_t ms = 50u * (next(input) % 64u);
    if (what % 8 > 2) {
        sim.monitor.set.contact = 0; // a line or a sonar that has just failed promises nothing
    }
    switch (what % 8) {
    case 0:
        sim.plant.bumpers_front = (uint8_t)(what >> 3 & 0x1f) << 1;
        break;
    case 1:
        sim.plant.bumpers_rear = (uint8_t)(what >> 3 & 0x1f) << 1;
        break;
    case 2:
        sim.plant.stalls = what >> 3 & 3;
        break;
    case 3:
        sim.deaf_ms = sim.plant.now_ms + ms;
        return;
    case 4:
        sim.mute_ms = sim.plant.now_ms + ms;
        return;
    case 5:
        sim.corrupts = true;
        return;
    default:
        sim.plant.fault[ms / 50u % 16u] = (uint8_t)(what >> 3) % PLANT_FAULTS;
        return;
    }
    sim.release_ms = sim.plant.now_ms + ms;
}

static void come_and_go(input_t *input) {
    const uint8_t what = next(input);
    if (what % 4 == 0) {
        sim.there = false;
        pass(NULL, 0, NULL, 0);
        drain();
    } else if (what % 4 == 1) {
        sim.there = true;
        client_opens();
    } else {
        sim.pulses = what % 4 == 2;
    }
}

// Many small turns, one after the other.
static void creep_round(input_t *input) {
    const uint8_t what = next(input);
    const int32_t deg = (int32_t)(what % 7) - 3;
    const uint32_t wait_ms = 50u + 100u * (what / 7u % 4u);
    for (int i = 0; i < 24; i++) {
        order(13, deg);
        run(wait_ms);
    }
}

static void client_order(input_t *input, uint8_t which) {
    static const struct {
        uint8_t command, unit;
    } motions[] = {{11, 6}, {21, 1}, {8, 25}, {12, 2}, {13, 1}, {9, 1},  {22, 2}, {6, 6}, {10, 2}, {23, 3},
                   {5, 6},  {4, 1},  {28, 1}, {7, 1},  {29, 1}, {55, 1}, {57, 1}, {3, 1}, {48, 1}, {18, 1}};
    const uint8_t row = which % (uint8_t)(sizeof motions / sizeof motions[0]);
    order(motions[row].command, value_of(input, motions[row].unit));
}

static void wheels(input_t *input) {
    const uint8_t data[4] = {32, 0x3b, next(input), next(input)};
    client_says(data, sizeof data);
}

static void raw(input_t *input) {
    const size_t length = next(input) % 16u;
    const size_t held = length < input->left ? length : input->left;
    pass(input->at, held, NULL, 0);
    input->at += held;
    input->left -= held;
    drain();
}

static void live(input_t *input) {
    const uint8_t what = next(input);
    if (what < 96) {
        run(50u * (what % 48u + 1u));
    } else if (what < 116) {
        disturb(input);
    } else if (what < 132) {
        operate(input);
    } else if (!sim.guard) {
        set_course(input);
    } else if (what < 140) {
        come_and_go(input);
    } else if (what < 152) {
        creep_round(input);
    } else if (what < 160) {
        wheels(input);
    } else if (what < 164) {
        raw(input);
    } else {
        client_order(input, what);
    }
}

static void complain(void) {
    const safety_violation_t *one = NULL;
    for (uint32_t i = 0; (one = safety_kept(&sim.monitor, i)) != NULL; i++) {
        fprintf(stderr, "%u ms: %s (%s)\n", (unsigned)one->t_ms, safety_meaning(one->rule), one->reason);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t length) {
    input_t input = {bytes, length};
    if (length < 3) {
        return 0;
    }
    restore(next(&input) % SCENARIOS);
    while (input.left > 0 && (int32_t)(sim.plant.now_ms - sim.end_ms) < 0 &&
           safety_count(&sim.monitor) == 0) {
        live(&input);
    }
    run(1000);
    const int broken = argus_invariants_broken(core());
    if (safety_count(&sim.monitor) != 0 || broken != 0) {
        complain();
        fprintf(stderr, "invariants broken: %d\n%s", broken, input_line != NULL ? input_line : "");
        abort();
    }
    return 0;
}

#ifdef FUZZ_REPLAY
// An input is a line of hexadecimal digits; what stands behind a blank is a remark.
static size_t read_line(const char *line, uint8_t *bytes, size_t capacity) {
    size_t length = 0;
    unsigned byte = 0;
    while (length < capacity && sscanf(line + 2 * length, "%2x", &byte) == 1 && line[2 * length] != ' ') {
        bytes[length++] = (uint8_t)byte;
    }
    return length;
}

static unsigned replay(const char *path) {
    static char line[1024];
    uint8_t bytes[256];
    unsigned inputs = 0;
    FILE *const file = fopen(path, "r");
    if (file == NULL) {
        fprintf(stderr, "%s: cannot be read\n", path);
        exit(2);
    }
    while (fgets(line, sizeof line, file) != NULL) {
        const size_t length = line[0] == '#' ? 0 : read_line(line, bytes, sizeof bytes);
        if (length > 0) {
            inputs++;
            input_line = line;
            LLVMFuzzerTestOneInput(bytes, length);
        }
    }
    fclose(file);
    return inputs;
}

// With FUZZ_SHOW in the environment it tells all that passes on the wire.
int main(int argc, char **argv) {
    unsigned inputs = 0;
    shows = getenv("FUZZ_SHOW") != NULL;
    setvbuf(stdout, NULL, _IONBF, 0);
    for (int i = 1; i < argc; i++) {
        inputs += replay(argv[i]);
    }
    printf("%u inputs, no rule broken\n", inputs);
    return inputs > 0 ? 0 : 2;
}
#endif
