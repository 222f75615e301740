// SPDX-License-Identifier: MIT
// Parses the command line and prints its help.
#include "options.h"

#include <getopt.h>
#include <string.h>

#include "argusd.h"
#include "course.h"
#include "text.h"

enum {
    OPT_LINK = 256,
    OPT_CONFIG,
    OPT_COURSE,
    OPT_GOAL,
    OPT_STATE,
    OPT_RECORD,
    OPT_RECORD_MAX,
    OPT_ROBOT,
    OPT_CAN_TELEMETRY,
    OPT_GUARD,
    OPT_GUARD_READINGS,
    OPT_GUARD_BEYOND,
    OPT_CONTROL,
    OPT_CONTROL_TOKEN,
    OPT_CONTROL_BEYOND,
    OPT_INJECT,
    OPT_ATTACH,
    OPT_PASSIVE,
    OPT_ACTIVE,
    OPT_JSON,
    OPT_PLAIN,
    OPT_AUTO_BAUD,
    OPT_WAIT,
    OPT_STATUS,
    OPT_CHECK,
    OPT_LIST_EVENTS,
    OPT_LIST_CONFIG,
    OPT_EXAMPLE_CONFIG,
    OPT_VERSION
};

static const struct option table[] = {
    {"link", required_argument, NULL, OPT_LINK},
    {"config", required_argument, NULL, OPT_CONFIG},
    {"course", required_argument, NULL, OPT_COURSE},
    {"goal", required_argument, NULL, OPT_GOAL},
    {"state", required_argument, NULL, OPT_STATE},
    {"record", required_argument, NULL, OPT_RECORD},
    {"record-max", required_argument, NULL, OPT_RECORD_MAX},
    {"robot", required_argument, NULL, OPT_ROBOT},
    {"can-telemetry", required_argument, NULL, OPT_CAN_TELEMETRY},
    {"guard", required_argument, NULL, OPT_GUARD},
    {"guard-readings", required_argument, NULL, OPT_GUARD_READINGS},
    {"guard-beyond-loopback", no_argument, NULL, OPT_GUARD_BEYOND},
    {"control", required_argument, NULL, OPT_CONTROL},
    {"control-token", required_argument, NULL, OPT_CONTROL_TOKEN},
    {"control-beyond-loopback", no_argument, NULL, OPT_CONTROL_BEYOND},
    {"inject", no_argument, NULL, OPT_INJECT},
    {"attach", required_argument, NULL, OPT_ATTACH},
    {"passive", no_argument, NULL, OPT_PASSIVE},
    {"active", no_argument, NULL, OPT_ACTIVE},
    {"json", no_argument, NULL, OPT_JSON},
    {"plain", no_argument, NULL, OPT_PLAIN},
    {"auto-baud", no_argument, NULL, OPT_AUTO_BAUD},
    {"wait", required_argument, NULL, OPT_WAIT},
    {"status", required_argument, NULL, OPT_STATUS},
    {"check", no_argument, NULL, OPT_CHECK},
    {"list-events", no_argument, NULL, OPT_LIST_EVENTS},
    {"list-config", no_argument, NULL, OPT_LIST_CONFIG},
    {"example-config", no_argument, NULL, OPT_EXAMPLE_CONFIG},
    {"version", no_argument, NULL, OPT_VERSION},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

void options_help(FILE *out) {
    fputs(
        "argusd " ARGUS_VERSION ": keeps a Pioneer P3-DX seeing and driving safely when its sonars fail\n"
        "\n"
        "usage: argusd --link LINK [options]\n"
        "\n"
        "  --link LINK        serial:PATH[@BAUD] (default 9600), tcp:HOST[:PORT] (default 8101), or\n"
        "                     can:IFACE[,robot=K][,tx=ID][,rx=ID][,pad=BYTE|none][,stmin=MS][,bs=N][,fd]:\n"
        "                     ISO-TP (default robot=0, tx=0x640+K, rx=0x648+K, pad=0xCC, stmin=0, bs=0)\n"
        "  --can-telemetry IFACE[,robot=K] | none\n"
        "                     health and readings as CAN frames, orders from there (tools/argus.dbc); with "
        "a\n"
        "                     can link its interface is the default\n"
        "  --auto-baud        serial: try 9600 38400 115200 19200 57600 and say what was found\n"
        "  --config FILE      settings (see --list-config)\n"
        "  --course FILE      drive this course: x_mm,y_mm per line, # comments\n"
        "  --goal X,Y         drive to this one point; mm, x ahead and y left of where the robot stands\n"
        "  --robot NAME       whose body and sonars it has, where it does not say so itself: p3dx-sh, "
        "amigo-sh,\n"
        "                     p3at-sh, peoplebot-sh; one that is not known is never driven\n"
        "  --guard PORT       pty:PATH or tcp:HOST:PORT, up to 4 times: there an ARCOS client (ARIA, p2os, "
        "...)\n"
        "                     finds the robot; its motion is bounded by what trusted sonars see "
        "(docs/guardian.md)\n"
        "  --guard-readings withhold|cover|pass\n"
        "                     what it gets of sonars that are out: nothing (default), what others have "
        "heard\n"
        "                     there lately, or what they say\n"
        "  --guard-beyond-loopback\n"
        "                     let a guard port listen where other machines reach it\n"
        "  --passive          diagnose and report, never command a motion\n"
        "  --active           drive; needed on a serial or can link, which starts passive\n"
        "  --state FILE       keep the sonars' history over restarts in FILE.a and FILE.b\n"
        "  --record FILE      append all bytes of the link, both directions, with their times (see "
        "argus-log)\n"
        "  --record-max MB    size at which FILE becomes FILE.1 and so on to FILE.4 (default 64)\n"
        "  --control unix:PATH | tcp:127.0.0.1:PORT\n"
        "                     a socket on which programs of this user watch and order (see argusctl)\n"
        "  --control-token FILE\n"
        "                     whoever connects must say its first line; needed with tcp\n"
        "  --control-beyond-loopback\n"
        "                     allow an address that other machines reach\n"
        "  --inject           arm argusctl fail: faults of sonars made by argusd itself, for tests\n"
        "  --attach PLACE     no robot of its own: the screen of the argusd whose --control is at PLACE\n"
        "  --wait SECONDS     at start, how long to try for the port and for a robot's answer; or 'forever'\n"
        "                     (default: the port must be there, a robot has 30 s)\n"
        "  --check            connect, tell what is there, leave\n"
        "  --json             one JSON object per line on standard output\n"
        "  --plain            no screen on a terminal, a line per event instead\n"
        "  --status MS        time between status lines, 0 for none (default 500 with --json, else 2000)\n"
        "  --list-events      the event catalogue\n"
        "  --list-config      every setting: type, range, default, unit, meaning\n"
        "  --example-config   a config file with every setting\n"
        "  --version          print the version\n"
        "  --help             print this\n"
        "\n"
        "keys on the screen: arrows or w a s d drive, space stops, g goes on, r checks again, p "
        "passive/active,\n  n b choose a sonar, t re-tests it, k pins it or ends that, x takes it out; q "
        "ends\n"
        "\n"
        "examples:\n"
        "  argusd --link serial:/dev/ttyUSB0@9600 --check\n"
        "  argusd --link serial:/dev/ttyUSB0 --auto-baud\n"
        "  argusd --link serial:/dev/ttyUSB0@9600 --active --goal 3000,0 --config argusd.conf\n"
        "  argusd --link tcp:localhost --course course.csv --json\n"
        "  argusd --link serial:/dev/ttyUSB0@9600 --guard tcp:127.0.0.1:8101 --guard pty:/run/argus/robot\n"
        "  argusd --link can:can0 --active --goal 3000,0\n"
        "  argusd --link serial:/dev/ttyUSB0@9600 --can-telemetry can0,robot=2\n"
        "  argusd --link tcp:localhost --control unix:/tmp/argus.sock --inject\n"
        "  argusd --attach unix:/tmp/argus.sock\n"
        "\n"
        "exit codes:\n",
        out);
#define EXIT_LINE(name, code, meaning) fprintf(out, "  %d  %s\n", code, meaning);
    ARGUSD_EXIT_TABLE(EXIT_LINE)
#undef EXIT_LINE
}

typedef struct {
    char *text;
    size_t capacity;
} message_t;

static bool take_seconds(options_t *options, const char *text, const message_t *message) {
    int32_t seconds = 0;
    options->has_wait = true;
    options->wait_ms = OPTIONS_WAIT_FOREVER;
    if (strcmp(text, "forever") == 0) {
        return true;
    }
    if (!text_number(text, &seconds) || seconds < 1 || seconds > 86400) {
        return text_refuse(message->text, message->capacity,
                           "--wait %s: give seconds, 1 to 86400, or 'forever'", text);
    }
    options->wait_ms = (uint32_t)seconds * 1000u;
    return true;
}

static bool take_status(options_t *options, const char *text, const message_t *message) {
    int32_t period = 0;
    if (!text_number(text, &period) || (period != 0 && (period < 50 || period > 3600000))) {
        return text_refuse(message->text, message->capacity,
                           "--status %s: give milliseconds, 50 to 3600000, or 0 for none", text);
    }
    options->has_status = true;
    options->status_ms = (uint32_t)period;
    return true;
}

static bool take_record_max(options_t *options, const char *text, const message_t *message) {
    int32_t megabytes = 0;
    if (!text_number(text, &megabytes) || megabytes < 1 || megabytes > 100000) {
        return text_refuse(message->text, message->capacity, "--record-max %s: give megabytes, 1 to 100000",
                           text);
    }
    options->record_max_bytes = (uint64_t)megabytes * 1000000u;
    return true;
}

static bool take_goal(options_t *options, const char *text, const message_t *message) {
    char problem[ARGUSD_MESSAGE_MAX / 2];
    options->has_goal = true;
    if (!course_parse_point(text, &options->goal, problem, sizeof problem)) {
        return text_refuse(message->text, message->capacity, "--goal: %s", problem);
    }
    return true;
}

static bool take_link(options_t *options, const char *text, const message_t *message) {
    if (hal_link_spec_target(&options->link)[0] != '\0') {
        return text_refuse(message->text, message->capacity, "--link is given twice; keep one");
    }
    return hal_link_spec_parse(&options->link, text, message->text, message->capacity);
}

static bool take_telemetry(options_t *options, const char *text, const message_t *message) {
    options->no_telemetry = strcmp(text, "none") == 0;
    if (options->no_telemetry) {
        options->telemetry.interface[0] = '\0';
        return true;
    }
    char problem[ARGUSD_MESSAGE_MAX / 2];
    if (!hal_can_spec_parse_telemetry(&options->telemetry, text, problem, sizeof problem)) {
        return text_refuse(message->text, message->capacity, "--can-telemetry: %s", problem);
    }
    return true;
}

static bool take_guard(options_t *options, const char *text, const message_t *message) {
    guards_options_t *const guards = &options->guards;
    if (guards->count == GUARDS_MAX) {
        return text_refuse(message->text, message->capacity, "--guard %s: %d ports are the most", text,
                           GUARDS_MAX);
    }
    return guard_spec_parse(&guards->at[guards->count++], text, message->text, message->capacity);
}

static bool take_readings(options_t *options, const char *text, const message_t *message) {
    static const char *const names[] = {"withhold", "cover", "pass"};
    options->readings = text;
    for (int i = 0; i < 3; i++) {
        if (strcmp(text, names[i]) == 0) {
            options->guards.readings = (argus_readings_t)i;
            return true;
        }
    }
    return text_refuse(message->text, message->capacity, "--guard-readings %s: give withhold, cover or pass",
                       text);
}

static bool take_place(options_t *options, int option, const message_t *message) {
    char problem[ARGUSD_MESSAGE_MAX / 2];
    if (option == OPT_ATTACH) {
        options->action = OPTIONS_ATTACH;
    }
    return control_spec_parse(option == OPT_ATTACH ? &options->attach : &options->control, optarg, problem,
                              sizeof problem) ||
           text_refuse(message->text, message->capacity, "%s %s",
                       option == OPT_ATTACH ? "--attach" : "--control", problem);
}

// What is kept as it was written.
static bool take_text(options_t *options, int option) {
    switch (option) {
    case OPT_CONFIG:
        options->config_path = optarg;
        return true;
    case OPT_COURSE:
        options->course_path = optarg;
        return true;
    case OPT_STATE:
        options->state_path = optarg;
        return true;
    case OPT_RECORD:
        options->record_path = optarg;
        return true;
    case OPT_CONTROL_TOKEN:
        options->token_path = optarg;
        return true;
    case OPT_ROBOT:
        options->robot = optarg;
        return true;
    default:
        return false;
    }
}

static bool take_flag(options_t *options, int option) {
    switch (option) {
    case OPT_PASSIVE:
        options->passive = true;
        return true;
    case OPT_ACTIVE:
        options->active = true;
        return true;
    case OPT_JSON:
        options->json = true;
        return true;
    case OPT_PLAIN:
        options->plain = true;
        return true;
    case OPT_AUTO_BAUD:
        options->auto_baud = true;
        return true;
    case OPT_GUARD_BEYOND:
        options->guards.beyond = true;
        return true;
    case OPT_CONTROL_BEYOND:
        options->control_beyond_loopback = true;
        return true;
    case OPT_INJECT:
        options->inject = true;
        return true;
    default:
        return take_text(options, option);
    }
}

static options_action_t action_of(int option) {
    switch (option) {
    case OPT_CHECK:
        return OPTIONS_CHECK;
    case OPT_LIST_EVENTS:
        return OPTIONS_LIST_EVENTS;
    case OPT_LIST_CONFIG:
        return OPTIONS_LIST_CONFIG;
    case OPT_EXAMPLE_CONFIG:
        return OPTIONS_EXAMPLE_CONFIG;
    case OPT_VERSION:
        return OPTIONS_VERSION;
    case 'h':
        return OPTIONS_HELP;
    default:
        return OPTIONS_RUN;
    }
}

static bool take(options_t *options, int option, char **argv, const message_t *message) {
    switch (option) {
    case OPT_LINK:
        return take_link(options, optarg, message);
    case OPT_GOAL:
        return take_goal(options, optarg, message);
    case OPT_WAIT:
        return take_seconds(options, optarg, message);
    case OPT_STATUS:
        return take_status(options, optarg, message);
    case OPT_CAN_TELEMETRY:
        return take_telemetry(options, optarg, message);
    case OPT_RECORD_MAX:
        return take_record_max(options, optarg, message);
    case OPT_GUARD:
        return take_guard(options, optarg, message);
    case OPT_GUARD_READINGS:
        return take_readings(options, optarg, message);
    case OPT_CONTROL:
    case OPT_ATTACH:
        return take_place(options, option, message);
    case ':':
        return text_refuse(message->text, message->capacity, "%s needs a value; see argusd --help",
                           argv[optind - 1]);
    case '?':
        return text_refuse(message->text, message->capacity, "unknown option %s; see argusd --help",
                           argv[optind - 1]);
    default:
        break;
    }
    if (!take_flag(options, option)) {
        options->action = action_of(option);
    }
    return true;
}

// What contradicts, or is missing.
static bool agree(const options_t *options, const message_t *message) {
    const bool has_link = hal_link_spec_target(&options->link)[0] != '\0';
    const bool serial = options->link.scheme == HAL_SCHEME_SERIAL;
    const int family = options->control.family;
    const struct {
        bool wrong;
        const char *problem;
    } rules[] = {
        {options->passive && options->active, "--passive and --active contradict each other; give one"},
        {options->course_path != NULL && options->has_goal,
         "--course and --goal contradict each other; give one"},
        {!has_link,
         "no link is given; add --link serial:/dev/ttyUSB0@9600, tcp:HOST:8101 or can:can0 (see --help)"},
        {options->action == OPTIONS_CHECK && options->telemetry.interface[0] != '\0',
         "--check only looks at the robot; leave out --can-telemetry"},
        {options->action == OPTIONS_CHECK && options->guards.count > 0,
         "--check only looks at the robot; leave out --guard"},
        {options->guards.count == 0 && (options->readings != NULL || options->guards.beyond),
         "--guard-readings and --guard-beyond-loopback are for --guard PORT; add it"},
        {options->record_max_bytes > 0 && options->record_path == NULL,
         "--record-max is for --record FILE; add it"},
        {options->action == OPTIONS_CHECK && family != 0,
         "--check only looks at the robot; leave out --control"},
        {family == 0 && options->token_path != NULL, "--control-token is for --control or --attach; add it"},
        {family == 0 && options->inject, "--inject is for orders at --control; add it"},
        {(family == AF_INET || family == AF_INET6) && options->token_path == NULL,
         "whoever reaches --control tcp: could drive the robot; add --control-token FILE"},
        {family != 0 && !options->control.loopback && !options->control_beyond_loopback,
         "this address of --control is reached by other machines; take 127.0.0.1, or add "
         "--control-beyond-loopback"},
        {options->auto_baud && !serial, "--auto-baud is for serial links; no other has a rate to look for"},
        {options->auto_baud && options->link.has_baud,
         "--auto-baud and a rate in --link contradict each other; leave out @BAUD"},
    };
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) {
        if (rules[i].wrong) {
            return text_refuse(message->text, message->capacity, "%s", rules[i].problem);
        }
    }
    return true;
}

bool options_parse(options_t *options, int argc, char **argv, char *message_text, size_t capacity) {
    const message_t message = {.text = message_text, .capacity = capacity};
    memset(options, 0, sizeof *options);
    optind = 0; // the library's way to begin anew
    opterr = 0;
    for (;;) {
        const int option = getopt_long(argc, argv, ":h", table, NULL);
        if (option == -1) {
            break;
        }
        if (!take(options, option, argv, &message)) {
            return false;
        }
    }
    if (optind < argc) {
        return text_refuse(message_text, capacity, "'%s' is not an option; see argusd --help", argv[optind]);
    }
    if (options->action == OPTIONS_ATTACH &&
        (hal_link_spec_target(&options->link)[0] != '\0' || options->control.family != 0)) {
        return text_refuse(message_text, capacity,
                           "--attach shows an argusd that runs already; leave out --link and --control");
    }
    const bool needs_link = options->action == OPTIONS_RUN || options->action == OPTIONS_CHECK;
    return !needs_link || agree(options, &message);
}
