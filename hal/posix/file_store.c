// SPDX-License-Identifier: MIT
// Store slots as files, replaced atomically.
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#include "hal/store.h"

static hal_store_error_t error_of(int error_number) {
    switch (error_number) {
    case EACCES:
    case EPERM:
    case EROFS:
        return HAL_STORE_DENIED;
    case ENOENT:
    case ENOTDIR:
    case ENOSPC:
    case EDQUOT:
        return HAL_STORE_NO_PLACE;
    default:
        return HAL_STORE_IO;
    }
}

const char *hal_file_error_text(int error) {
    switch (error) {
    case HAL_STORE_TOO_LONG:
        return "the record is too long";
    case HAL_STORE_DENIED:
        return "no permission";
    case HAL_STORE_NO_PLACE:
        return "the folder is missing or the disk is full";
    default:
        return hal_store_error_text(error);
    }
}

bool hal_file_medium_init(hal_file_medium_t *self, const char *path) {
    const size_t length = strlen(path);
    if (length == 0 || length >= sizeof self->path) {
        return false;
    }
    memset(self, 0, sizeof *self);
    memcpy(self->path, path, length + 1);
    return true;
}

static const char *slot_path(hal_file_medium_t *self, int slot) {
    snprintf(self->target, sizeof self->target, "%s.%c", self->path, 'a' + slot);
    return self->target;
}

// Reads up to the end or the count; bytes read, or -1.
static ssize_t read_all(int fd, size_t offset, uint8_t *bytes, size_t count) {
    size_t done = 0;
    ssize_t got = 1;
    while (got != 0 && done < count) {
        got = pread(fd, bytes + done, count - done, (off_t)(offset + done));
        if (got > 0) {
            done += (size_t)got;
        } else if (got < 0 && errno != EINTR) {
            return -1;
        }
    }
    return (ssize_t)done;
}

static int slot_read(void *context, int slot, size_t offset, uint8_t *bytes, size_t count) {
    const int fd = open(slot_path(context, slot), O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        return errno == ENOENT ? HAL_STORE_EMPTY : (int)error_of(errno);
    }
    const ssize_t got = read_all(fd, offset, bytes, count);
    close(fd);
    return got < 0 ? HAL_STORE_IO : (int)got;
}

static int write_all(int fd, const uint8_t *bytes, size_t count) {
    while (count > 0) {
        const ssize_t written = write(fd, bytes, count);
        if (written < 0 && errno != EINTR) {
            return error_of(errno);
        }
        if (written > 0) {
            bytes += written;
            count -= (size_t)written;
        }
    }
    return HAL_STORE_OK;
}

static int write_slot(int fd, const uint8_t *header, const uint8_t *record, size_t count) {
    int result = write_all(fd, header, HAL_STORE_HEADER);
    if (result == HAL_STORE_OK) {
        result = write_all(fd, record, count);
    }
    if (result == HAL_STORE_OK && fsync(fd) != 0) {
        result = error_of(errno);
    }
    return result;
}

// Without this the rename itself may be lost with the power.
static int sync_folder(hal_file_medium_t *self) {
    const char *const slash = strrchr(self->path, '/');
    const size_t length = slash == NULL ? 0 : (size_t)(slash - self->path);
    memcpy(self->scratch, self->path, length);
    self->scratch[length] = '\0';
    const char *const folder = slash == NULL ? "." : length == 0 ? "/" : self->scratch;
    const int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) {
        return error_of(errno);
    }
    // Some file systems cannot sync a folder and say EINVAL: there is nothing more to be done then.
    const int result = fsync(fd) == 0 || errno == EINVAL ? HAL_STORE_OK : (int)error_of(errno);
    close(fd);
    return result;
}

static int slot_write(void *context, int slot, const uint8_t *header, const uint8_t *record, size_t count) {
    hal_file_medium_t *const self = context;
    snprintf(self->scratch, sizeof self->scratch, "%s.tmp", self->path);
    const int fd = open(self->scratch, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (fd < 0) {
        return error_of(errno);
    }
    int result = write_slot(fd, header, record, count);
    if (close(fd) != 0 && result == HAL_STORE_OK) {
        result = error_of(errno);
    }
    if (result == HAL_STORE_OK && rename(self->scratch, slot_path(self, slot)) != 0) {
        result = error_of(errno);
    }
    if (result != HAL_STORE_OK) {
        unlink(self->scratch);
        return result;
    }
    return sync_folder(self);
}

hal_medium_t hal_file_medium(hal_file_medium_t *self) {
    static const hal_medium_ops_t ops = {.read = slot_read, .write = slot_write};
    return (hal_medium_t){.ops = &ops, .context = self};
}
