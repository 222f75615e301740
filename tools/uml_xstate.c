// SPDX-License-Identifier: MIT
// Lets Debian 12's User-Mode Linux run on a CPU whose processes have more registers than it makes room for
// (AMX).
//
// It saves and restores a process's floating-point state with ptrace(NT_X86_XSTATE), in a buffer of fixed
// size. The host reads out a part of what it has, but takes none back (EFAULT), and the guest dies with its
// first process. Preloaded, this takes the part that the guest holds for the beginning of the whole. What
// lies beyond, the tile registers, no process may use unless it asked the host for leave.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/uio.h>

#define STATE_MAX 65536

typedef long ptrace_t(int request, ...);

// Not on the stack: this runs on that of the guest's kernel, which has 16 KiB. It has one thread.
static uint8_t state[STATE_MAX];

static ptrace_t *libc_ptrace(void) {
    void *const symbol = dlsym(RTLD_NEXT, "ptrace");
    ptrace_t *found = NULL;
    // ISO C casts no pointer to an object into one to a function.
    memcpy((void *)&found, (const void *)&symbol, sizeof found);
    return found;
}

static long pass_state(ptrace_t *real, int request, pid_t process, void *kind, struct iovec *part) {
    struct iovec whole = {.iov_base = state, .iov_len = sizeof state};
    const long result = real(PTRACE_GETREGSET, process, kind, &whole);
    if (result != 0) {
        return result;
    }
    const size_t shared = part->iov_len < whole.iov_len ? part->iov_len : whole.iov_len;
    if (request == PTRACE_SETREGSET) {
        memcpy(state, part->iov_base, shared);
        return real(PTRACE_SETREGSET, process, kind, &whole);
    }
    memcpy(part->iov_base, state, shared);
    part->iov_len = shared;
    return 0;
}

// In place of the C library's.
long ptrace(enum __ptrace_request request, ...) {
    va_list rest;
    va_start(rest, request);
    const pid_t process = va_arg(rest, pid_t);
    void *const address = va_arg(rest, void *);
    void *const data = va_arg(rest, void *);
    va_end(rest);
    ptrace_t *const real = libc_ptrace();
    const int wanted = (int)request;
    if ((wanted == PTRACE_GETREGSET || wanted == PTRACE_SETREGSET) && (uintptr_t)address == NT_X86_XSTATE) {
        return pass_state(real, wanted, process, address, data);
    }
    return real(wanted, process, address, data);
}
