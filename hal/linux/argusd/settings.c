// SPDX-License-Identifier: MIT
// Config files, over the firmware's table of settings.
#include "settings.h"

#include <errno.h>
#include <stddef.h>
#include <string.h>

#include "argusd.h"
#include "hal/meant.h"
#include "text.h"

#define SECTION "argus"
#define BLANKS " \t\r"
#define LINE_MAX_BYTES 200

typedef struct {
    const char *key;
    int32_t value;
    int32_t minimum;
    int32_t maximum;
    const char *unit;
    const char *choices;
    const char *meaning;
    size_t offset;
} row_t;

static const row_t rows[SETTINGS_COUNT] = {
#define ROW(key, def, min, max, unit, choices, meaning) \
    {#key, def, min, max, unit, choices, meaning, offsetof(argus_config_t, key)},
    ARGUS_CONFIG_TABLE(ROW)
#undef ROW
};

void settings_default(settings_t *self) {
    memset(self, 0, sizeof *self);
    argus_config_default(&self->config);
}

// "" where none is near.
static void ask_for_key(const char *name, char *question, size_t capacity) {
    hal_meant_t meant;
    hal_meant_begin(&meant, name, strlen(name));
    for (int i = 0; i < SETTINGS_COUNT; i++) {
        hal_meant_weigh(&meant, rows[i].key, strlen(rows[i].key));
    }
    hal_meant_ask(&meant, "", question, capacity);
}

static void ask_for_choice(const row_t *row, const char *text, char *question, size_t capacity) {
    hal_meant_t meant;
    hal_meant_begin(&meant, text, strlen(text));
    hal_meant_weigh_list(&meant, row->choices);
    hal_meant_weigh_heads(&meant, row->choices);
    hal_meant_ask(&meant, "", question, capacity);
}

// The value of one of "a|b|c", or -1.
static int32_t choice(const char *choices, const char *text) {
    const size_t length = strlen(text);
    const char *at = choices;
    for (int32_t value = 0; length > 0; value++) {
        const size_t size = strcspn(at, "|");
        if (size == length && strncmp(at, text, size) == 0) {
            return value;
        }
        if (at[size] == '\0') {
            break;
        }
        at += size + 1;
    }
    return -1;
}

// A number, or a word for its default.
static bool is_auto(const row_t *row) {
    return strcmp(row->choices, "auto") == 0;
}

static bool is_choice(const row_t *row) {
    return row->choices[0] != '\0' && !is_auto(row);
}

typedef struct {
    settings_t *settings;
    FILE *file;
    int line;      // that the parser is at
    int bad_line;  // the first one refused
    text_t reason; // of that
} load_t;

__attribute__((format(printf, 2, 3))) static int refuse(load_t *load, const char *format, ...) {
    if (load->bad_line == 0) {
        va_list arguments;
        load->bad_line = load->line;
        va_start(arguments, format);
        text_add_list(&load->reason, format, arguments);
        va_end(arguments);
    }
    return 0;
}

static int refuse_unknown(load_t *load, const char *name) {
    char question[HAL_MEANT_MAX];
    ask_for_key(name, question, sizeof question);
    return refuse(load, "unknown key '%.60s'%s", name,
                  question[0] == '\0' ? "; argusd --list-config lists the keys" : question);
}

static int take_value(load_t *load, const row_t *row, const char *text) {
    int32_t value = choice(row->choices, text);
    const bool is_named = value >= 0;
    if (!is_named && is_choice(row)) {
        char question[HAL_MEANT_MAX];
        ask_for_choice(row, text, question, sizeof question);
        return refuse(load, "%s = '%.40s'%s choose one of %s", row->key, text,
                      question[0] == '\0' ? ":" : question, row->choices);
    }
    if (!is_named && !text_number(text, &value)) {
        return refuse(load, "%s = '%.40s': give a whole number, %d to %d %s%s", row->key, text,
                      (int)row->minimum, (int)row->maximum, row->unit, is_auto(row) ? ", or auto" : "");
    }
    if (!is_named && (value < row->minimum || value > row->maximum)) {
        return refuse(load, "%s = %d is out of range; give %d to %d %s", row->key, (int)value,
                      (int)row->minimum, (int)row->maximum, row->unit);
    }
    memcpy((char *)&load->settings->config + row->offset, &value, sizeof value);
    return 1;
}

static int take_key(load_t *load, const char *name, const char *value) {
    for (int i = 0; i < SETTINGS_COUNT; i++) {
        if (strcmp(rows[i].key, name) != 0) {
            continue;
        }
        if (load->settings->line[i] != 0) {
            return refuse(load, "%s was given on line %d already; keep one of the two", name,
                          load->settings->line[i]);
        }
        load->settings->line[i] = load->line;
        return take_value(load, &rows[i], value);
    }
    return refuse_unknown(load, name);
}

// Cuts the blanks at both ends.
static void trim(char *line) {
    const size_t blanks = strspn(line, BLANKS);
    memmove(line, line + blanks, strlen(line + blanks) + 1);
    size_t length = strlen(line);
    while (length > 0 && strchr(BLANKS, line[length - 1]) != NULL) {
        line[--length] = '\0';
    }
}

// A remark behind a value begins with a semicolon after a blank.
static void cut_remark(char *text) {
    for (char *at = strchr(text, ';'); at != NULL; at = strchr(at + 1, ';')) {
        if (at == text || strchr(BLANKS, at[-1]) != NULL) {
            *at = '\0';
            return;
        }
    }
}

static int take_section(load_t *load, const char *line) {
    return strcmp(line, "[" SECTION "]") == 0
               ? 1
               : refuse(load, "unknown section %.60s; use [" SECTION "] or none", line);
}

// KEY = VALUE or KEY : VALUE, a section, a comment, or nothing.
static int take_line(load_t *load, char *line) {
    trim(line);
    if (line[0] == '\0' || strchr("#;", line[0]) != NULL) {
        return 1;
    }
    if (line[0] == '[') {
        return take_section(load, line);
    }
    cut_remark(line);
    char *const sign = strpbrk(line, "=:");
    if (sign == NULL) {
        return refuse(load, "malformed line; write key = value");
    }
    *sign = '\0';
    trim(line);
    trim(sign + 1);
    return take_key(load, line, sign + 1);
}

// Whether there was one; what is too long of it is refused, not split.
static bool read_line(load_t *load, char *line, size_t capacity) {
    const text_read_t found = text_read_line(load->file, line, capacity);
    load->line += found != TEXT_END;
    if (found == TEXT_NUL) {
        refuse(load, "a NUL byte: this is not a text file");
    } else if (found == TEXT_LONG) {
        refuse(load, "the line is longer than %d characters", (int)capacity - 1);
    }
    return found != TEXT_END;
}

bool settings_read(settings_t *self, FILE *file, const char *path, char *message, size_t capacity) {
    char reason[ARGUSD_MESSAGE_MAX / 2];
    char line[LINE_MAX_BYTES];
    load_t load = {.settings = self, .file = file, .reason = text_in(reason, sizeof reason)};
    settings_default(self);
    while (read_line(&load, line, sizeof line)) {
        if (load.line == 1) {
            text_drop_mark(line);
        }
        take_line(&load, line);
    }
    if (ferror(file)) {
        return text_refuse(message, capacity, "%s: cannot be read: %s", path, strerror(errno));
    }
    if (load.bad_line > 0) {
        return text_refuse(message, capacity, "%s:%d: %s", path, load.bad_line, reason);
    }
    return true;
}

bool settings_load(settings_t *self, const char *path, char *message, size_t capacity) {
    FILE *const file = fopen(path, "re");
    if (file == NULL) {
        return text_refuse(
            message, capacity,
            "%s: cannot be opened: %s; give the config file's path (argusd --example-config prints one)",
            path, strerror(errno));
    }
    const bool good = settings_read(self, file, path, message, capacity);
    fclose(file);
    return good;
}

bool settings_choose(settings_t *self, int row, const char *text, const char *option, char *message,
                     size_t capacity) {
    const int32_t value = choice(rows[row].choices, text);
    if (value < 0) {
        char question[HAL_MEANT_MAX];
        ask_for_choice(&rows[row], text, question, sizeof question);
        return text_refuse(message, capacity, "%s %.40s%s choose one of %s", option, text,
                           question[0] == '\0' ? ":" : question, rows[row].choices);
    }
    memcpy((char *)&self->config + rows[row].offset, &value, sizeof value);
    return true;
}

bool settings_check(const settings_t *self, char *message, size_t capacity) {
    const argus_config_t *const config = &self->config;
    const argus_config_report_t report = argus_config_check(config);
    switch (report.fault) {
    case ARGUS_CONFIG_OK:
        return true;
    case ARGUS_CONFIG_DRIVING:
        return text_refuse(
            message, capacity,
            "driving would be unsafe (S5): overhang %d + travel %d (%d mm/s x %d ms) + braking %d = %d mm "
            "must be less than object_range_mm = %d; lower speed_mm_s, or raise object_range_mm (or "
            "decel_mm_s2, of which 300 at most count)",
            (int)report.overhang_mm, (int)report.travel_mm, (int)report.speed_mm_s, (int)report.reaction_ms,
            (int)report.brake_mm, (int)report.driving_mm, (int)report.object_range_mm);
    case ARGUS_CONFIG_STEP:
        return text_refuse(
            message, capacity,
            "a step would be unsafe (S5): reach of a %d mm step %d + 3 x noise %d + 20 = %d mm must be "
            "less than check_range_mm = %d; lower step_mm, or raise check_range_mm",
            (int)config->step_mm, (int)report.reach_mm, (int)config->noise_mm, (int)report.stepping_mm,
            (int)report.check_range_mm);
    case ARGUS_CONFIG_RANGE:
    default:
        break;
    }
    const int row = report.key >= 0 && report.key < SETTINGS_COUNT ? (int)report.key : 0;
    return text_refuse(message, capacity, "%s is out of range; give %d to %d %s", rows[row].key,
                       (int)rows[row].minimum, (int)rows[row].maximum, rows[row].unit);
}

bool settings_check_ranges(const settings_t *self, char *message, size_t capacity) {
    return argus_config_check(&self->config).fault != ARGUS_CONFIG_RANGE ||
           settings_check(self, message, capacity);
}

static void name_value(const row_t *row, int32_t value, char *text, size_t capacity) {
    const char *at = row->choices;
    if (at[0] == '\0' || (is_auto(row) && value != ARGUS_AUTO)) {
        snprintf(text, capacity, "%d", (int)value);
        return;
    }
    for (int32_t i = 0; i < value; i++) {
        at += strcspn(at, "|") + 1;
    }
    snprintf(text, capacity, "%.*s", (int)strcspn(at, "|"), at);
}

static void name_range(const row_t *row, char *text, size_t capacity) {
    if (is_choice(row)) {
        snprintf(text, capacity, "%s", row->choices);
    } else {
        snprintf(text, capacity, "%d..%d", (int)row->minimum, (int)row->maximum);
    }
}

void settings_list(FILE *out) {
    fprintf(out, "%-18s %-7s %-13s %-8s %-6s %s\n", "KEY", "TYPE", "RANGE", "DEFAULT", "UNIT", "MEANING");
    for (int i = 0; i < SETTINGS_COUNT; i++) {
        char value[32];
        char range[80];
        name_value(&rows[i], rows[i].value, value, sizeof value);
        name_range(&rows[i], range, sizeof range);
        fprintf(out, "%-18s %-7s %-13s %-8s %-6s %s\n", rows[i].key,
                is_choice(&rows[i]) ? "choice" : "integer", range, value,
                rows[i].unit[0] == '\0' ? "-" : rows[i].unit, rows[i].meaning);
    }
}

void settings_example(FILE *out) {
    fprintf(
        out,
        "# Settings of argusd, with their defaults; every line may be left out. Use: argusd --config FILE\n"
        "[" SECTION "]\n");
    for (int i = 0; i < SETTINGS_COUNT; i++) {
        char value[32];
        char range[80];
        name_value(&rows[i], rows[i].value, value, sizeof value);
        name_range(&rows[i], range, sizeof range);
        fprintf(out, "\n# %s (%s%s%s)\n%s = %s\n", rows[i].meaning, range, rows[i].unit[0] == '\0' ? "" : " ",
                rows[i].unit, rows[i].key, value);
    }
}
