// SPDX-License-Identifier: MIT
// What to do when a serial port cannot be opened.
#include <ctype.h>
#include <dirent.h>
#include <glob.h>
#include <grp.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/serial.h"

#define CANDIDATES_MAX 8

typedef struct {
    char *text;
    size_t capacity;
    size_t used;
} line_t;

__attribute__((format(printf, 2, 3))) static void add(line_t *line, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int count = vsnprintf(line->text + line->used, line->capacity - line->used, format, arguments);
    va_end(arguments);
    if (count > 0) {
        line->used += (size_t)count;
        line->used = line->used < line->capacity ? line->used : line->capacity - 1;
    }
}

static void list_candidates(line_t *line) {
    static const char *const patterns[] = {"/dev/serial/by-id/*", "/dev/ttyUSB*", "/dev/ttyACM*"};
    glob_t found = {0};
    for (size_t i = 0; i < sizeof patterns / sizeof patterns[0]; i++) {
        glob(patterns[i], i == 0 ? 0 : GLOB_APPEND, NULL, &found);
    }
    if (found.gl_pathc == 0) {
        add(line,
            "; there is no /dev/ttyUSB*, /dev/ttyACM* or /dev/serial/by-id/*: is the adapter plugged in?");
    } else {
        add(line, "; the ports there are:");
        for (size_t i = 0; i < found.gl_pathc && i < CANDIDATES_MAX; i++) {
            add(line, " %s", found.gl_pathv[i]);
        }
    }
    globfree(&found);
}

static void explain_denied(line_t *line, const char *path) {
    struct stat about;
    const struct group *group = NULL;
    if (stat(path, &about) == 0) {
        group = getgrgid(about.st_gid);
    }
    const char *const name =
        group != NULL && strcmp(group->gr_name, "root") != 0 ? group->gr_name : "dialout";
    add(line, "; join the group that owns it: sudo usermod -aG %s \"$USER\", then log in again", name);
}

static bool holds(const char *process, const char *device) {
    char folder[64];
    char name[PATH_MAX];
    char target[PATH_MAX];
    snprintf(folder, sizeof folder, "/proc/%.20s/fd", process);
    DIR *const files = opendir(folder);
    bool held = false;
    for (const struct dirent *entry = NULL; files != NULL && !held && (entry = readdir(files)) != NULL;) {
        snprintf(name, sizeof name, "%s/%s", folder, entry->d_name);
        const ssize_t length = readlink(name, target, sizeof target - 1);
        if (length > 0) {
            target[length] = '\0';
            held = strcmp(target, device) == 0;
        }
    }
    if (files != NULL) {
        closedir(files);
    }
    return held;
}

static void name_process(line_t *line, const char *process) {
    char path[64];
    char name[64] = "?";
    snprintf(path, sizeof path, "/proc/%.20s/comm", process);
    FILE *const file = fopen(path, "re");
    if (file != NULL) {
        if (fgets(name, sizeof name, file) != NULL) {
            name[strcspn(name, "\n")] = '\0';
        }
        fclose(file);
    }
    add(line, "; process %s (%s) has it open", process, name);
}

static void explain_busy(line_t *line, const char *path) {
    char device[PATH_MAX];
    bool found = false;
    DIR *const processes = realpath(path, device) == NULL ? NULL : opendir("/proc");
    for (const struct dirent *entry = NULL; processes != NULL && (entry = readdir(processes)) != NULL;) {
        const bool other =
            isdigit((unsigned char)entry->d_name[0]) && strtol(entry->d_name, NULL, 10) != getpid();
        if (other && holds(entry->d_name, device)) {
            name_process(line, entry->d_name);
            found = true;
        }
    }
    if (processes != NULL) {
        closedir(processes);
    }
    if (!found) {
        add(line,
            "; another argusd, a terminal program or ModemManager may hold it: sudo fuser -v %s names it",
            path);
    }
}

void hal_serial_explain(hal_link_error_t error, const char *path, char *text, size_t capacity) {
    line_t line = {.text = text, .capacity = capacity, .used = 0};
    add(&line, "%s: %s", path, hal_link_error_text(error));
    switch (error) {
    case HAL_LINK_NOT_FOUND:
        list_candidates(&line);
        break;
    case HAL_LINK_DENIED:
        explain_denied(&line, path);
        break;
    case HAL_LINK_BUSY:
        explain_busy(&line, path);
        break;
    case HAL_LINK_NOT_SERIAL:
        add(&line, "; give a device such as /dev/ttyUSB0");
        break;
    case HAL_LINK_BAD_BAUD:
        add(&line, "; the rates are " HAL_BAUD_LIST);
        break;
    case HAL_LINK_GONE:
        add(&line, "; plug it in again, or start the robot's end again");
        break;
    default:
        break;
    }
}
