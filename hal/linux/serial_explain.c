// SPDX-License-Identifier: MIT
// What to do when a serial port cannot be opened.
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <glob.h>
#include <grp.h>
#include <limits.h>
#include <pwd.h>
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

// The ports whose names differ from this one's in their number only, and those of the usual names.
static void find_candidates(const char *path, glob_t *found) {
    static const char *const patterns[] = {"/dev/serial/by-id/*", "/dev/ttyUSB*", "/dev/ttyACM*"};
    char siblings[HAL_PATH_MAX + 1];
    size_t length = strlen(path);
    while (length > 0 && isdigit((unsigned char)path[length - 1])) {
        length--;
    }
    for (size_t i = 0; i < sizeof patterns / sizeof patterns[0]; i++) {
        glob(patterns[i], i == 0 ? 0 : GLOB_APPEND, NULL, found);
    }
    if (length == 0 || path[length - 1] == '/' || path[length] == '\0') {
        return; // no number, or nothing else
    }
    snprintf(siblings, sizeof siblings, "%.*s*", (int)length, path);
    if (strcmp(siblings, patterns[1]) != 0 && strcmp(siblings, patterns[2]) != 0) {
        glob(siblings, GLOB_APPEND, NULL, found);
    }
}

static void explain_missing(line_t *line, const char *path) {
    glob_t found = {0};
    char target[HAL_PATH_MAX];
    const ssize_t length = readlink(path, target, sizeof target - 1);
    if (length > 0) {
        target[length] = '\0';
        add(line, "; it is a name for %s, which is not there", target);
    }
    find_candidates(path, &found);
    if (found.gl_pathc == 0 && strncmp(path, "/dev/", 5) != 0) {
        add(line, "; the program that makes this name does not run yet, or it is another one");
    } else if (found.gl_pathc == 0) {
        add(line,
            "; there is no /dev/ttyUSB*, /dev/ttyACM* or /dev/serial/by-id/*: is the adapter plugged in?");
    } else {
        add(line, "; the ports there are:");
        for (size_t i = 0; i < found.gl_pathc && i < CANDIDATES_MAX; i++) {
            add(line, " %s", found.gl_pathv[i]);
        }
        if (strstr(path, "/by-id/") == NULL) {
            add(line, "; an adapter that is plugged in again may get another number: give its name under "
                      "/dev/serial/by-id, which stays");
        }
    }
    globfree(&found);
}

// "sudo " where there is one, for advice that needs it.
static const char *as_root(void) {
    static const char *const places[] = {"/usr/bin/sudo", "/bin/sudo", "/usr/local/bin/sudo"};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        if (geteuid() != 0 && access(places[i], X_OK) == 0) {
            return "sudo ";
        }
    }
    return geteuid() == 0 ? "" : "as root: ";
}

static bool is_member(gid_t group) {
    gid_t groups[NGROUPS_MAX];
    const int count = getgroups(NGROUPS_MAX, groups);
    bool member = getegid() == group;
    for (int i = 0; i < count; i++) {
        member = member || groups[i] == group;
    }
    return member;
}

#define READ_AND_WRITE 06u

static const char *may(unsigned bits) {
    static const char *const texts[] = {"nothing", "write", "read", "read and write"};
    return texts[bits >> 1 & 3u];
}

// The kernel asks one of the three alone: the owner gets nothing of what the group or the others may.
static void advise_denied(line_t *line, const char *path, const struct stat *about, const char *group) {
    const bool owner = about->st_uid == geteuid();
    const bool member = is_member(about->st_gid);
    const unsigned of_group = about->st_mode >> 3;
    const unsigned mine = owner ? about->st_mode >> 6 : member ? of_group : about->st_mode;
    if ((mine & READ_AND_WRITE) == READ_AND_WRITE) {
        add(line, ": that would do; something else forbids it, as a container or a security module");
    } else if (owner) {
        add(line, ": you own it, but may not read and write it: chmod u+rw %s", path);
    } else if (member) {
        add(line, ": you are in that group, which may not read and write it: %schmod g+rw %s", as_root(),
            path);
    } else if ((of_group & READ_AND_WRITE) == READ_AND_WRITE) {
        add(line, ": join the group: %susermod -aG %s \"$USER\", then log in again", as_root(), group);
    } else {
        add(line, ": you are one of the others: %schmod g+rw %s, and join the group, or a udev rule",
            as_root(), path);
    }
}

static void explain_denied(line_t *line, const char *path) {
    struct stat about;
    char user_name[32];
    char group_name[32];
    if (stat(path, &about) != 0) {
        add(line,
            errno == EACCES ? "; a folder on the way to it may not be entered" : "; and it is gone now");
        return;
    }
    const struct passwd *const user = getpwuid(about.st_uid);
    const struct group *const group = getgrgid(about.st_gid);
    snprintf(user_name, sizeof user_name, "%u", (unsigned)about.st_uid);
    snprintf(group_name, sizeof group_name, "%u", (unsigned)about.st_gid);
    const char *const group_text = group != NULL ? group->gr_name : group_name;
    const unsigned mode = about.st_mode & 0777u;
    add(line, "; it belongs to user %s and group %s, mode %03o (owner: %s, group: %s, others: %s)",
        user != NULL ? user->pw_name : user_name, group_text, mode, may(mode >> 6), may(mode >> 3),
        may(mode));
    advise_denied(line, path, &about, group_text);
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
        add(line, "; another argusd, a terminal program or ModemManager may hold it: %sfuser -v %s names it",
            as_root(), path);
    }
}

void hal_serial_explain(hal_link_error_t error, const char *path, char *text, size_t capacity) {
    line_t line = {.text = text, .capacity = capacity, .used = 0};
    add(&line, "%s: %s", path, hal_link_error_text(error));
    switch (error) {
    case HAL_LINK_NOT_FOUND:
        explain_missing(&line, path);
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
