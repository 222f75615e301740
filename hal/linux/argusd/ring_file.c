// SPDX-License-Identifier: MIT
// Reads the part of TOML that the files of rings are written in, line by line.
#include "ring_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "argusd.h"
#include "hal/meant.h"
#include "text.h"

#define LINE_MAX_BYTES 4096 // of a list over several lines, too
#define DEEP_MAX 4          // files that inherit one from the other
#define POSE_ALL 0xFu       // x_mm, y_mm, heading_deg, role
#define SECTION_LISTED 6u   // from here on those of [[name]]
#define SECTION_POSE 7u

typedef struct {
    const char *key;
    const char *section;
    size_t offset;
} figure_t;

static const figure_t figures[RING_FILE_FIGURES] = {
#define FIGURE(key, section, def, min, max, meaning) {#key, #section, offsetof(argus_ring_t, key)},
    ARGUS_RING_TABLE(FIGURE)
#undef FIGURE
};

// What only the emulator wants of a robot.
static const char *const others[] = {
    "identity.class",
    "identity.name",
    "identity.serial",
    "body.length_mm",
    "body.radius_mm",
    "body.corners_mm",
    "motion.vel_max_mm_s",
    "motion.vel_top_mm_s",
    "motion.rotvel_max_deg_s",
    "motion.rotvel_top_deg_s",
    "motion.accel_mm_s2",
    "motion.accel_top_mm_s2",
    "motion.rotaccel_deg_s2",
    "motion.rotdecel_deg_s2",
    "motion.rotaccel_top_deg_s2",
    "motion.ticks_per_mm",
    "motion.rev_count",
    "motion.four_motors",
    "odometry.vel_conv_um_s",
    "odometry.range_conv_um",
    "odometry.angle_per_turn",
    "odometry.diff_conv_urad_mm",
    "odometry.vel2_unit_mm_s",
    "sonar.transducers_per_array",
    "sonar.arrays",
    "sonar.rear_sonars",
    "sonar.array.index",
    "sonar.array.place",
    "sonar.array.order",
};

typedef struct {
    ring_file_t *self;
    FILE *file;
    const char *path;
    int depth;
    int line;  // the last one read
    int begin; // where the present statement began
    char section[40];
    unsigned sections; // that have begun
    bool posed;        // a sonar of this file: those that are inherited are no more
    char *message;
    size_t capacity;
} load_t;

__attribute__((format(printf, 2, 3))) static bool refuse(load_t *load, const char *format, ...) {
    char reason[ARGUSD_MESSAGE_MAX / 2];
    text_t text = text_in(reason, sizeof reason);
    va_list arguments;
    va_start(arguments, format);
    text_add_list(&text, format, arguments);
    va_end(arguments);
    return text_refuse(load->message, load->capacity, "%s:%d: %s", load->path, load->begin, reason);
}

// Text ------------------------------------------------------------------------------------------------------

static int opens(char letter) {
    return (letter == '[') - (letter == ']');
}

// Cuts a comment, and the blanks at both ends. Returns how many lists are open at the end.
static int tidy(char *text) {
    char quote = '\0';
    int open = 0;
    for (char *at = text; *at != '\0'; at++) {
        if (quote != '\0') {
            quote = *at == quote ? '\0' : quote;
        } else if (*at == '"' || *at == '\'') {
            quote = *at;
        } else if (*at == '#') {
            *at = '\0';
            break;
        } else {
            open += opens(*at);
        }
    }
    const size_t blanks = strspn(text, " \t");
    memmove(text, text + blanks, strlen(text + blanks) + 1);
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\r\n", text[length - 1]) != NULL) {
        text[--length] = '\0';
    }
    return open;
}

// The next statement, of several lines where a list goes over them. 1: there is one, 0: the end, -1: refused.
static int next_statement(load_t *load, char *text, size_t capacity) {
    size_t length = 0;
    text[0] = '\0';
    load->begin = load->line + 1;
    while (length + 2 < capacity && fgets(text + length, (int)(capacity - length), load->file) != NULL) {
        load->line++;
        char *const part = text + length;
        if (strchr(part, '\n') == NULL && !feof(load->file)) {
            break;
        }
        (void)tidy(part);
        char whole[LINE_MAX_BYTES];
        memcpy(whole, text, strlen(text) + 1);
        if (tidy(whole) <= 0) {
            return 1;
        }
        length = strlen(text);
    }
    if (length == 0 && feof(load->file)) {
        return 0;
    }
    (void)refuse(load, length > 0 && feof(load->file) ? "a list has no end" : "the line is too long");
    return -1;
}

static bool take_string(load_t *load, const char *key, const char *value, char *into, size_t capacity) {
    const size_t length = strlen(value);
    const bool quoted = length >= 2 && (value[0] == '"' || value[0] == '\'') && value[length - 1] == value[0];
    if (!quoted || memchr(value, '\\', length) != NULL || length - 2 >= capacity) {
        return refuse(load, "%s: give a text of at most %zu letters in quotes", key, capacity - 1);
    }
    memcpy(into, value + 1, length - 2);
    into[length - 2] = '\0';
    return true;
}

// TOML has no numbers as 007.
static bool is_padded(const char *value) {
    const char *const digits = value + (*value == '-' || *value == '+');
    return digits[0] == '0' && digits[1] >= '0' && digits[1] <= '9';
}

static bool refuse_twice(load_t *load, const char *key) {
    return refuse(load, "%s stands twice", key);
}

static bool take_number(load_t *load, const char *key, const char *value, int32_t *into) {
    if (is_padded(value) || !text_number(value, into) || *into < INT16_MIN || *into > INT16_MAX) {
        return refuse(load, "%s must be a whole number", key);
    }
    return true;
}

// The keys --------------------------------------------------------------------------------------------------

// Whether a list has a comma with nothing before it.
static bool has_hole(const char *list) {
    char before = ',';
    for (const char *at = list; *at != '\0'; at++) {
        if (*at == ',' && before == ',') {
            return true;
        }
        if (strchr("[ \t\r\n", *at) == NULL) {
            before = *at;
        }
    }
    return false;
}

static bool take_forward(load_t *load, char *value) {
    argus_ring_t *const ring = &load->self->ring;
    char *rest = NULL;
    if (load->depth == 0 && load->self->forward_line != 0) {
        return refuse_twice(load, "[sonar] forward");
    }
    if (has_hole(value)) {
        return refuse(load, "not valid TOML: a comma with nothing before it");
    }
    ring->forward_count = 0;
    load->self->forward_line = load->depth == 0 ? load->begin : 0;
    for (char *word = strtok_r(value, "[], \t\r\n", &rest); word != NULL;
         word = strtok_r(NULL, "[], \t\r\n", &rest)) {
        int32_t sonar = 0;
        if (!take_number(load, "[sonar] forward", word, &sonar)) {
            return false;
        }
        if (ring->forward_count == ARGUS_FORWARD_SONARS || sonar < 0 || sonar > UINT8_MAX) {
            return refuse(load, "[sonar] forward must list 2 to %d sonars, left to right",
                          ARGUS_FORWARD_SONARS);
        }
        ring->forward[ring->forward_count++] = (uint8_t)sonar;
    }
    return true;
}

static bool take_role(load_t *load, argus_sonar_mount_t *mount, const char *value) {
    static const char *const names[] = {"none", "ahead", "astern", "abeam"};
    char name[16];
    if (!take_string(load, "role", value, name, sizeof name)) {
        return false;
    }
    for (uint8_t i = 0; i < 4; i++) {
        if (strcmp(name, names[i]) == 0) {
            mount->role = i;
            return true;
        }
    }
    return refuse(load, "role must be one of none, ahead, astern, abeam");
}

static bool begin_key(load_t *load, int sonar, unsigned bit, const char *key) {
    unsigned *const given = &load->self->given[sonar];
    const bool twice = (*given >> bit & 1u) != 0;
    *given |= 1u << bit;
    return !twice || refuse_twice(load, key);
}

// What may be given, and can only be one number. 1: taken, 0: no such key, -1: refused.
static int take_place(load_t *load, const char *key, const char *value, int sonar) {
    const bool is_number = strcmp(key, "number") == 0;
    const int32_t must = is_number ? sonar : sonar / 8;
    int32_t number = 0;
    if (!is_number && strcmp(key, "array") != 0) {
        return 0;
    }
    if (!take_number(load, key, value, &number)) {
        return -1;
    }
    return number == must || refuse(load, "%s must be %d: sonars are given in their order", key, (int)must)
               ? 1
               : -1;
}

// Likewise.
static int take_pose(load_t *load, const char *key, const char *value) {
    static const char *const names[] = {"x_mm", "y_mm", "heading_deg"};
    ring_file_t *const self = load->self;
    const int sonar = self->ring.sonars - 1;
    argus_sonar_mount_t *const mount = &self->mounts[sonar];
    int16_t *const into[] = {&mount->x_mm, &mount->y_mm, &mount->heading_deg};
    if (strcmp(key, "role") == 0) {
        const bool first = begin_key(load, sonar, 3, key);
        return first && take_role(load, mount, value) ? 1 : -1;
    }
    for (unsigned i = 0; i < 3; i++) {
        int32_t number = 0;
        if (strcmp(key, names[i]) == 0) {
            const bool good = begin_key(load, sonar, i, key) && take_number(load, key, value, &number);
            *into[i] = (int16_t)number;
            return good ? 1 : -1;
        }
    }
    return take_place(load, key, value, sonar);
}

// Likewise.
static int take_figure(load_t *load, const char *key, const char *value) {
    for (int i = 0; i < RING_FILE_FIGURES; i++) {
        if (strcmp(figures[i].key, key) == 0 && strcmp(figures[i].section, load->section) == 0) {
            int32_t number = 0;
            const bool twice = load->depth == 0 && load->self->line[i] != 0;
            const bool good = twice ? refuse_twice(load, key) : take_number(load, key, value, &number);
            memcpy((char *)&load->self->ring + figures[i].offset, &number, sizeof number);
            load->self->line[i] = load->depth == 0 ? load->begin : 0;
            return good ? 1 : -1;
        }
    }
    return 0;
}

static bool load_file(load_t *load);

// The other file stands in the same folder.
static bool inherit(load_t *load, const char *value) {
    char name[64];
    char path[512];
    if (!take_string(load, "inherits", value, name, sizeof name)) {
        return false;
    }
    const char *const slash = strrchr(load->path, '/');
    const int folder = slash != NULL ? (int)(slash - load->path) + 1 : 0;
    const int length = snprintf(path, sizeof path, "%.*s%s.toml", folder, load->path, name);
    load_t other = {.self = load->self,
                    .path = path,
                    .depth = load->depth + 1,
                    .message = load->message,
                    .capacity = load->capacity};
    if (length < 0 || length >= (int)sizeof path || other.depth > DEEP_MAX) {
        return refuse(load, "inherits: too deep, or from itself");
    }
    other.file = fopen(path, "re");
    if (other.file == NULL) {
        return refuse(load, "inherits: %s: %s; argus-log ring %s --whole FILE writes all in one", path,
                      strerror(errno), load->path);
    }
    const bool good = load_file(&other);
    fclose(other.file);
    return good;
}

static bool is_other(const load_t *load, const char *key) {
    char name[80];
    snprintf(name, sizeof name, "%s.%s", load->section, key);
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        if (strcmp(others[i], name) == 0) {
            return true;
        }
    }
    return false;
}

static bool refuse_key(load_t *load, const char *key) {
    char question[HAL_MEANT_MAX];
    hal_meant_t meant;
    hal_meant_begin(&meant, key, strlen(key));
    for (int i = 0; i < RING_FILE_FIGURES; i++) {
        if (strcmp(figures[i].section, load->section) == 0) {
            hal_meant_weigh(&meant, figures[i].key, strlen(figures[i].key));
        }
    }
    hal_meant_ask(&meant, "", question, sizeof question);
    return refuse(load, "[%s] %.40s: no such key%s", load->section, key, question);
}

static bool take_key(load_t *load, const char *key, char *value) {
    if (load->section[0] == '\0' && strcmp(key, "inherits") == 0) {
        return inherit(load, value);
    }
    if (strcmp(load->section, "identity") == 0 && strcmp(key, "subclass") == 0) {
        return take_string(load, "[identity] subclass", value, load->self->name, 16);
    }
    if (strcmp(load->section, "sonar") == 0 && strcmp(key, "forward") == 0) {
        return take_forward(load, value);
    }
    const bool is_pose = strcmp(load->section, "sonar.pose") == 0;
    const int taken = is_pose ? take_pose(load, key, value) : take_figure(load, key, value);
    if (taken != 0) {
        return taken > 0;
    }
    return is_other(load, key) || refuse_key(load, key);
}

// Lines -----------------------------------------------------------------------------------------------------

static bool begin_pose(load_t *load) {
    ring_file_t *const self = load->self;
    if (!load->posed) {
        load->posed = true;
        self->ring.sonars = 0;
    }
    if (self->ring.sonars == ARGUS_SONARS) {
        return refuse(load, "this build manages %d sonars", ARGUS_SONARS);
    }
    self->given[self->ring.sonars] = 0;
    self->pose_line[self->ring.sonars] = load->depth == 0 ? load->begin : 0;
    self->ring.sonars++;
    return true;
}

static bool begin_section(load_t *load, unsigned row, const char *text) {
    const bool listed = text[1] == '[';
    const bool twice = !listed && (load->sections >> row & 1u) != 0;
    load->sections |= 1u << row;
    if (twice) {
        return refuse_twice(load, text);
    }
    return row != SECTION_POSE || begin_pose(load);
}

static bool refuse_section(load_t *load, const char *const *known, size_t count) {
    char question[HAL_MEANT_MAX];
    hal_meant_t meant;
    hal_meant_begin(&meant, load->section, strlen(load->section));
    for (size_t i = 0; i < count; i++) {
        hal_meant_weigh(&meant, known[i], strlen(known[i]));
    }
    hal_meant_ask(&meant, "", question, sizeof question);
    return refuse(load, "[%s]: no such section%s", load->section, question);
}

static bool take_head(load_t *load, const char *text) {
    static const char *const known[] = {"identity", "body",  "motion",      "odometry",
                                        "sonar",    "laser", "sonar.array", "sonar.pose"};
    const bool listed = text[1] == '[';
    const size_t from = listed ? 2 : 1;
    const size_t length = strcspn(text + from, "]");
    if (strcmp(text + from + length, listed ? "]]" : "]") != 0 || length >= sizeof load->section) {
        return refuse(load, "write a section as [name] or [[name]]");
    }
    memcpy(load->section, text + from, length);
    load->section[length] = '\0';
    for (unsigned i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (strcmp(load->section, known[i]) == 0 && listed == (i >= SECTION_LISTED)) {
            return begin_section(load, i, text);
        }
    }
    return refuse_section(load, known, sizeof known / sizeof known[0]);
}

static bool take_statement(load_t *load, char *text) {
    if (text[0] == '[') {
        return take_head(load, text);
    }
    char *const equals = strchr(text, '=');
    if (equals == NULL || equals == text) {
        return refuse(load, "not valid TOML: write key = value");
    }
    *equals = '\0';
    (void)tidy(text);
    (void)tidy(equals + 1);
    return take_key(load, text, equals + 1);
}

static bool load_file(load_t *load) {
    char text[LINE_MAX_BYTES];
    int more = 0;
    while ((more = next_statement(load, text, sizeof text)) > 0) {
        if (text[0] != '\0' && !take_statement(load, text)) {
            return false;
        }
    }
    return more == 0;
}

static bool check_whole(load_t *load) {
    const ring_file_t *const self = load->self;
    for (int i = 0; i < self->ring.sonars; i++) {
        if (self->given[i] != POSE_ALL) {
            load->begin = self->pose_line[i];
            return refuse(load, "sonar %d: x_mm, y_mm, heading_deg and role must be given", i);
        }
    }
    return true;
}

bool ring_file_load(ring_file_t *self, const char *path, char *message, size_t capacity) {
    load_t load = {.self = self, .path = path, .message = message, .capacity = capacity};
    memset(self, 0, sizeof *self);
    load.file = fopen(path, "re");
    if (load.file == NULL) {
        return text_refuse(message, capacity, "%s: cannot be opened: %s", path, strerror(errno));
    }
    const bool good = load_file(&load) && check_whole(&load);
    const bool failed = ferror(load.file) != 0;
    fclose(load.file);
    if (good && failed) {
        return text_refuse(message, capacity, "%s: cannot be read", path);
    }
    self->ring.name = self->name;
    self->ring.mounts = self->mounts;
    return good;
}

static const char *meaning_of(int32_t fault) {
    switch (fault) {
#define MEANING(id, name, meaning) \
    case id:                       \
        return meaning;
        ARGUS_RING_FAULT_TABLE(MEANING)
#undef MEANING
    default:
        return "";
    }
}

void ring_file_explain(const ring_file_t *self, const char *path, argus_ring_report_t report, char *message,
                       size_t capacity) {
    text_t text = text_in(message, capacity);
    const bool of_sonar = report.sonar >= 0 && report.sonar < self->ring.sonars;
    const int of_forward = report.fault == ARGUS_RING_UNSAFE ? 0 : self->forward_line;
    const int of_rest = report.key >= 0 ? self->line[report.key] : of_forward;
    const int line = of_sonar ? self->pose_line[report.sonar] : of_rest;
    text_add(&text, "%s:", path);
    if (line > 0) {
        text_add(&text, "%d:", line);
    }
    if (report.key >= 0) {
        text_add(&text, " [%s] %s:", figures[report.key].section, figures[report.key].key);
    } else if (of_sonar) {
        text_add(&text, " sonar %d:", (int)report.sonar);
    }
    text_add(&text, " %s", meaning_of(report.fault));
}
