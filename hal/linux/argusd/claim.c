// SPDX-License-Identifier: MIT
// Claims by flock; hil_sim/claim.py does the same.
#include "claim.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text.h"

#define TRIES 100 // each other program that ends just then costs one
#define LINE_MAX_BYTES 256
#define NAME_MAX_BYTES 32

// The process that holds a lock of this inode; 0: it is not told.
static int process_of(unsigned long inode) {
    char line[LINE_MAX_BYTES];
    int found = 0;
    FILE *const locks = fopen("/proc/locks", "re");
    while (locks != NULL && found == 0 && fgets(line, sizeof line, locks) != NULL) {
        int process = 0;
        unsigned long at = 0;
        // NOLINTNEXTLINE(cert-err34-c): the kernel writes it
        if (sscanf(line, "%*d: FLOCK %*s %*s %d %*x:%*x:%lu", &process, &at) == 2 && at == inode &&
            process > 0) {
            found = process;
        }
    }
    if (locks != NULL) {
        fclose(locks);
    }
    return found;
}

void claim_holder(const char *path, char *text, size_t capacity) {
    char place[LINE_MAX_BYTES];
    char name[NAME_MAX_BYTES] = "";
    struct stat about;
    const int process = stat(path, &about) == 0 ? process_of((unsigned long)about.st_ino) : 0;
    if (process == 0) {
        snprintf(text, capacity, "another program");
        return;
    }
    snprintf(place, sizeof place, "/proc/%d/comm", process);
    FILE *const comm = fopen(place, "re");
    if (comm != NULL) {
        if (fgets(name, sizeof name, comm) != NULL) {
            name[strcspn(name, "\n")] = '\0';
        }
        fclose(comm);
    }
    snprintf(text, capacity, name[0] != '\0' ? "%s, process %d" : "%sprocess %d", name, process);
}

// The file that was locked still has the name: one that ends takes it away.
static bool has_name(int fd, const char *path) {
    struct stat locked;
    struct stat named;
    return fstat(fd, &locked) == 0 && lstat(path, &named) == 0 && locked.st_dev == named.st_dev &&
           locked.st_ino == named.st_ino;
}

// 0: it is ours; EAGAIN: it lost its name meanwhile.
static int try_lock(claim_t *self) {
    const int fd = open(self->lock, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (fd < 0) {
        return errno;
    }
    const int problem = flock(fd, LOCK_EX | LOCK_NB) != 0 ? EBUSY : has_name(fd, self->lock) ? 0 : EAGAIN;
    if (problem != 0) {
        close(fd);
        return problem;
    }
    self->fd = fd;
    self->held = true;
    return 0;
}

bool claim_take(claim_t *self, const char *option, const char *path, char *message, size_t capacity) {
    char who[LINE_MAX_BYTES];
    int problem = ENAMETOOLONG;
    self->held = false;
    if (snprintf(self->lock, sizeof self->lock, "%s.lock", path) < (int)sizeof self->lock) {
        problem = EAGAIN;
    }
    for (int i = 0; i < TRIES && problem == EAGAIN; i++) {
        problem = try_lock(self);
    }
    if (problem == EBUSY) {
        claim_holder(self->lock, who, sizeof who);
        return text_refuse(message, capacity, "%s %s: %s has it; end that one, or name another", option, path,
                           who);
    }
    return problem == 0 || text_refuse(message, capacity,
                                       "%s %s: its lock %s: %s; name a path in a folder that can be written",
                                       option, path, self->lock, strerror(problem));
}

// The file goes while it is locked, so nobody else's is taken away.
void claim_release(claim_t *self) {
    if (self->held) {
        (void)unlink(self->lock);
        close(self->fd);
        self->held = false;
    }
}
