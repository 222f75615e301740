// SPDX-License-Identifier: MIT
// Parses the command line and prints its help.
#include "options.h"

#include <getopt.h>
#include <string.h>

#include "argusd.h"
#include "course.h"
#include "hal/meant.h"
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
    OPT_RING,
    OPT_CAN_TELEMETRY,
    OPT_CONTROL,
    OPT_CONTROL_TOKEN,
    OPT_CONTROL_BEYOND,
    OPT_INJECT,
    OPT_ATTACH,
    OPT_GUARD,
    OPT_GUARD_READINGS,
    OPT_GUARD_BEYOND,
    OPT_REALTIME,
    OPT_PRIORITY,
    OPT_CPUS,
    OPT_PASSIVE,
    OPT_ACTIVE,
    OPT_JSON,
    OPT_PLAIN,
    OPT_AUTO_BAUD,
    OPT_WAIT,
    OPT_STATUS,
    OPT_CHECK,
    OPT_SURVEY,
    OPT_PICTURE,
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
    {"ring", required_argument, NULL, OPT_RING},
    {"can-telemetry", required_argument, NULL, OPT_CAN_TELEMETRY},
    {"control", required_argument, NULL, OPT_CONTROL},
    {"control-token", required_argument, NULL, OPT_CONTROL_TOKEN},
    {"control-beyond-loopback", no_argument, NULL, OPT_CONTROL_BEYOND},
    {"inject", no_argument, NULL, OPT_INJECT},
    {"attach", required_argument, NULL, OPT_ATTACH},
    {"guard", required_argument, NULL, OPT_GUARD},
    {"guard-readings", required_argument, NULL, OPT_GUARD_READINGS},
    {"guard-beyond-loopback", no_argument, NULL, OPT_GUARD_BEYOND},
    {"realtime", no_argument, NULL, OPT_REALTIME},
    {"realtime-priority", required_argument, NULL, OPT_PRIORITY},
    {"cpus", required_argument, NULL, OPT_CPUS},
    {"passive", no_argument, NULL, OPT_PASSIVE},
    {"active", no_argument, NULL, OPT_ACTIVE},
    {"json", no_argument, NULL, OPT_JSON},
    {"plain", no_argument, NULL, OPT_PLAIN},
    {"auto-baud", no_argument, NULL, OPT_AUTO_BAUD},
    {"wait", required_argument, NULL, OPT_WAIT},
    {"status", required_argument, NULL, OPT_STATUS},
    {"check", no_argument, NULL, OPT_CHECK},
    {"survey", no_argument, NULL, OPT_SURVEY},
    {"picture", required_argument, NULL, OPT_PICTURE},
    {"list-events", no_argument, NULL, OPT_LIST_EVENTS},
    {"list-config", no_argument, NULL, OPT_LIST_CONFIG},
    {"example-config", no_argument, NULL, OPT_EXAMPLE_CONFIG},
    {"version", no_argument, NULL, OPT_VERSION},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

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

static bool take_priority(options_t *options, const char *text, const message_t *message) {
    int32_t *const priority = &options->precedence.priority;
    if (!text_number(text, priority) || *priority < 1 || *priority > 99) {
        return text_refuse(message->text, message->capacity, "--realtime-priority %s: give 1 to 99", text);
    }
    return true;
}

static bool take_cpus(options_t *options, const char *text, const message_t *message) {
    return precedence_parse_cpus(text, &options->precedence.cpus) ||
           text_refuse(message->text, message->capacity,
                       "--cpus %s: give numbers of processors, 0 to %d, as 1 or 0,2-3", text,
                       PRECEDENCE_CPUS - 1);
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

static bool take_place(control_spec_t *spec, const char *option, const char *text, const message_t *message) {
    char problem[ARGUSD_MESSAGE_MAX / 2];
    return control_spec_parse(spec, text, problem, sizeof problem) ||
           text_refuse(message->text, message->capacity, "%s %s", option, problem);
}

static bool take_control(options_t *options, const char *text, const message_t *message) {
    if (options->control.family != 0) {
        return text_refuse(message->text, message->capacity, "--control is given twice; keep one");
    }
    return take_place(&options->control, "--control", text, message);
}

static bool take_attach(options_t *options, const char *text, const message_t *message) {
    options->action = OPTIONS_ATTACH;
    return take_place(&options->attach, "--attach", text, message);
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
    case OPT_RING:
        options->ring_path = optarg;
        return true;
    case OPT_PICTURE:
        options->picture_path = optarg;
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
    case OPT_REALTIME:
        options->precedence.on = true;
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
    case OPT_CONTROL_BEYOND:
        options->control_beyond_loopback = true;
        return true;
    case OPT_INJECT:
        options->inject = true;
        return true;
    case OPT_GUARD_BEYOND:
        options->guards.beyond = true;
        return true;
    default:
        return take_text(options, option);
    }
}

static options_action_t action_of(int option) {
    switch (option) {
    case OPT_CHECK:
        return OPTIONS_CHECK;
    case OPT_SURVEY:
        return OPTIONS_SURVEY;
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

// What has a value that is read at once.
static const struct {
    int option;
    bool (*take)(options_t *options, const char *text, const message_t *message);
} valued[] = {
    {OPT_LINK, take_link},
    {OPT_GOAL, take_goal},
    {OPT_WAIT, take_seconds},
    {OPT_STATUS, take_status},
    {OPT_CAN_TELEMETRY, take_telemetry},
    {OPT_RECORD_MAX, take_record_max},
    {OPT_CONTROL, take_control},
    {OPT_ATTACH, take_attach},
    {OPT_GUARD, take_guard},
    {OPT_GUARD_READINGS, take_readings},
    {OPT_PRIORITY, take_priority},
    {OPT_CPUS, take_cpus},
};

static bool refuse_unknown(const char *given, const message_t *message) {
    const char *const word = given + strspn(given, "-");
    char question[HAL_MEANT_MAX];
    hal_meant_t meant;
    hal_meant_begin(&meant, word, strcspn(word, "="));
    for (const struct option *row = table; row->name != NULL; row++) {
        hal_meant_weigh(&meant, row->name, strlen(row->name));
    }
    hal_meant_ask(&meant, "--", question, sizeof question);
    return text_refuse(message->text, message->capacity, "unknown option %s%s see argusd --help", given,
                       question[0] == '\0' ? ";" : question);
}

static bool take(options_t *options, int option, char **argv, const message_t *message) {
    if (option == ':') {
        return text_refuse(message->text, message->capacity, "%s needs a value; see argusd --help",
                           argv[optind - 1]);
    }
    if (option == '?') {
        return refuse_unknown(argv[optind - 1], message);
    }
    for (size_t i = 0; i < sizeof valued / sizeof valued[0]; i++) {
        if (valued[i].option == option) {
            return valued[i].take(options, optarg, message);
        }
    }
    if (!take_flag(options, option)) {
        options->action = action_of(option);
    }
    return true;
}

// What contradicts, or is missing.
typedef struct {
    bool wrong;
    const char *problem;
} rule_t;

static bool keeps(const rule_t *rules, size_t count, const message_t *message) {
    for (size_t i = 0; i < count; i++) {
        if (rules[i].wrong) {
            return text_refuse(message->text, message->capacity, "%s", rules[i].problem);
        }
    }
    return true;
}

static bool agree_on_link(const options_t *options, const message_t *message) {
    const bool has_link = hal_link_spec_target(&options->link)[0] != '\0';
    const bool has_rate = hal_link_spec_has_rate(&options->link);
    char forms[ARGUSD_MESSAGE_MAX / 2];
    char none[ARGUSD_MESSAGE_MAX];
    hal_scheme_forms(forms, sizeof forms);
    snprintf(none, sizeof none, "no link is given; add --link %s (see --help)", forms);
    const rule_t rules[] = {
        {options->passive && options->active, "--passive and --active contradict each other; give one"},
        {options->course_path != NULL && options->has_goal,
         "--course and --goal contradict each other; give one"},
        {!has_link, none},
        {!options->precedence.on && (options->precedence.priority != 0 || options->precedence.cpus != 0),
         "--realtime-priority and --cpus are for --realtime; add it"},
        {options->record_max_bytes > 0 && options->record_path == NULL,
         "--record-max is for --record FILE; add it"},
        {options->auto_baud && !has_rate, "--auto-baud is for serial links; no other has a rate to look for"},
        {options->auto_baud && options->link.has_baud,
         "--auto-baud and a rate in --link contradict each other; leave out @BAUD"},
    };
    return keeps(rules, sizeof rules / sizeof rules[0], message);
}

static bool agree_on_check(const options_t *options, const message_t *message) {
    const rule_t rules[] = {
        {options->telemetry.interface[0] != '\0',
         "--check only looks at the robot; leave out --can-telemetry"},
        {options->guards.count > 0, "--check only looks at the robot; leave out --guard"},
        {options->control.family != 0, "--check only looks at the robot; leave out --control"},
    };
    return options->action != OPTIONS_CHECK || keeps(rules, sizeof rules / sizeof rules[0], message);
}

static bool is_svg(const char *path) {
    static const char end[] = ".svg";
    const size_t length = strlen(path);
    return length >= sizeof end && strcmp(path + length - (sizeof end - 1), end) == 0;
}

static bool agree_on_picture(const options_t *options, const message_t *message) {
    const char *const path = options->picture_path;
    const rule_t rules[] = {
        {path != NULL && options->action != OPTIONS_SURVEY, "--picture is of a survey; add --survey"},
        {path != NULL && !is_svg(path), "--picture draws an SVG; give a name that ends in .svg"},
    };
    return keeps(rules, sizeof rules / sizeof rules[0], message);
}

static bool agree_on_survey(const options_t *options, const message_t *message) {
    const rule_t rules[] = {
        {options->passive, "--survey turns the robot; leave out --passive"},
        {options->course_path != NULL || options->has_goal,
         "--survey only turns on the spot; leave out --course and --goal"},
        {options->telemetry.interface[0] != '\0',
         "--survey is for a robot of one's own; leave out --can-telemetry"},
        {options->guards.count > 0, "--survey is for a robot of one's own; leave out --guard"},
        {options->control.family != 0, "--survey is for a robot of one's own; leave out --control"},
        {!options->active && !hal_link_spec_stays_here(&options->link),
         "--survey turns the robot on the spot, and a real one may be there: give it room, and add --active"},
    };
    return options->action != OPTIONS_SURVEY || keeps(rules, sizeof rules / sizeof rules[0], message);
}

static bool agree_on_ports(const options_t *options, const message_t *message) {
    const int family = options->control.family;
    const rule_t rules[] = {
        {options->guards.count == 0 && (options->readings != NULL || options->guards.beyond),
         "--guard-readings and --guard-beyond-loopback are for --guard PORT; add it"},
        {family == 0 && options->token_path != NULL, "--control-token is for --control or --attach; add it"},
        {family == 0 && options->inject, "--inject is for orders at --control; add it"},
        {(family == AF_INET || family == AF_INET6) && options->token_path == NULL,
         "whoever reaches --control tcp: could drive the robot; add --control-token FILE"},
        {family != 0 && !options->control.loopback && !options->control_beyond_loopback,
         "this address of --control is reached by other machines; take 127.0.0.1, or add "
         "--control-beyond-loopback"},
    };
    return keeps(rules, sizeof rules / sizeof rules[0], message);
}

static bool agree_on_attach(const options_t *options, const message_t *message) {
    const rule_t rule = {hal_link_spec_target(&options->link)[0] != '\0' || options->control.family != 0,
                         "--attach shows an argusd that runs already; leave out --link and --control"};
    return keeps(&rule, 1, message);
}

static bool agree(const options_t *options, const message_t *message) {
    if (options->action == OPTIONS_ATTACH) {
        return agree_on_attach(options, message);
    }
    if (options->action != OPTIONS_RUN && options->action != OPTIONS_CHECK &&
        options->action != OPTIONS_SURVEY) {
        return true;
    }
    return agree_on_link(options, message) && agree_on_check(options, message) &&
           agree_on_survey(options, message) && agree_on_picture(options, message) &&
           agree_on_ports(options, message);
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
    return agree(options, &message);
}
