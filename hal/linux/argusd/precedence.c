// SPDX-License-Identifier: MIT
// Asks the system for SCHED_FIFO, locked memory and processors.
#define _GNU_SOURCE // sched_setaffinity, SCHED_RESET_ON_FORK
#include "precedence.h"

#include <errno.h>
#include <sched.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include "text.h"

#define STACK_BYTES 262144u // more than argusd ever uses, in memory before that is locked
#define PATH_BYTES 256

static bool take_number(const char **at, int *number) {
    *number = 0;
    int digits = 0;
    for (; **at >= '0' && **at <= '9' && digits < 3; (*at)++, digits++) {
        *number = *number * 10 + (**at - '0');
    }
    return digits > 0 && *number < PRECEDENCE_CPUS;
}

// One number, or from .. to.
static bool take_part(const char **at, uint64_t *cpus) {
    int from = 0;
    if (!take_number(at, &from)) {
        return false;
    }
    int to = from;
    if (**at == '-') {
        (*at)++;
        if (!take_number(at, &to) || to < from) {
            return false;
        }
    }
    for (int cpu = from; cpu <= to; cpu++) {
        *cpus |= UINT64_C(1) << cpu;
    }
    return true;
}

bool precedence_parse_cpus(const char *text, uint64_t *cpus) {
    *cpus = 0;
    while (take_part(&text, cpus)) {
        if (*text == '\0') {
            return true;
        }
        if (*text++ != ',') {
            return false;
        }
    }
    return false;
}

static bool take_cpus(uint64_t cpus) {
    cpu_set_t set;
    CPU_ZERO(&set);
    for (size_t cpu = 0; cpu < PRECEDENCE_CPUS; cpu++) {
        if ((cpus >> cpu & 1u) != 0) {
            CPU_SET(cpu, &set);
        }
    }
    return sched_setaffinity(0, sizeof set, &set) == 0;
}

static uint64_t cpus_now(void) {
    cpu_set_t set;
    uint64_t cpus = 0;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0) {
        for (size_t cpu = 0; cpu < PRECEDENCE_CPUS; cpu++) {
            cpus |= CPU_ISSET(cpu, &set) ? UINT64_C(1) << cpu : 0u;
        }
    }
    return cpus;
}

// The pages of the stack are there before they are locked, so that none is waited for later.
__attribute__((noinline)) static void touch_stack(void) {
    volatile char room[STACK_BYTES];
    for (size_t i = 0; i < sizeof room; i += 1024) {
        room[i] = 0;
    }
}

// What comes later is locked only where there is no limit: else a page too many would end the program.
static bool lock_memory(void) {
    struct rlimit most = {0};
    touch_stack();
    const bool unlimited = getrlimit(RLIMIT_MEMLOCK, &most) == 0 && most.rlim_cur == RLIM_INFINITY;
    if (unlimited && mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
        return true;
    }
    return mlockall(MCL_CURRENT) == 0;
}

// Its children, such as the screen, begin without it.
static bool take_turn(int32_t priority) {
    const struct sched_param wanted = {.sched_priority = priority};
    return sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &wanted) == 0;
}

static unsigned long limit_of(bool memory) {
    struct rlimit most = {0};
    if (memory) {
        getrlimit(RLIMIT_MEMLOCK, &most);
    } else {
        getrlimit(RLIMIT_RTPRIO, &most);
    }
    return (unsigned long)most.rlim_cur;
}

// What is missing, and both ways to grant it.
static void explain(const precedence_t *granted, int32_t priority, int turn_errno, int lock_errno,
                    char *message, size_t capacity) {
    char path[PATH_BYTES] = "argusd";
    text_t text = text_in(message, capacity);
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    path[length > 0 ? length : 0] = '\0';
    text_add(&text, "--realtime:");
    if (granted->priority == 0) {
        text_add(&text, " SCHED_FIFO %d is not granted (%s): no CAP_SYS_NICE, and `ulimit -r` is %lu;",
                 (int)priority, strerror(turn_errno), limit_of(false));
    }
    if (!granted->locked) {
        text_add(&text, " memory is not locked (%s): no CAP_IPC_LOCK, and `ulimit -l` is %lu KB;",
                 strerror(lock_errno), limit_of(true) / 1024);
    }
    text_add(&text,
             " it drives on without. Run `sudo setcap cap_sys_nice,cap_ipc_lock+ep %s`, or run it as a "
             "service with LimitRTPRIO=%d and LimitMEMLOCK=infinity (argusd.service has them)",
             length > 0 ? path : "argusd", (int)priority);
}

bool precedence_take(const precedence_options_t *options, precedence_t *granted, char *message,
                     size_t capacity) {
    *granted = (precedence_t){.asked = options->on, .cpus = cpus_now()};
    message[0] = '\0';
    if (!options->on) {
        return true;
    }
    const int32_t priority = options->priority != 0 ? options->priority : PRECEDENCE_PRIORITY;
    if (options->cpus != 0 && !take_cpus(options->cpus)) {
        return text_refuse(message, capacity, "--cpus: %s; this machine lets it run on other processors only",
                           strerror(errno));
    }
    granted->cpus = cpus_now();
    granted->locked = lock_memory();
    const int lock_errno = errno;
    granted->priority = take_turn(priority) ? priority : 0;
    const int turn_errno = errno;
    if (!granted->locked || granted->priority == 0) {
        explain(granted, priority, turn_errno, lock_errno, message, capacity);
    }
    return true;
}

static void add_cpus(text_t *text, uint64_t cpus) {
    const char *between = "";
    for (int cpu = 0; cpu < PRECEDENCE_CPUS; cpu++) {
        int last = cpu;
        if ((cpus >> cpu & 1u) == 0) {
            continue;
        }
        while (last + 1 < PRECEDENCE_CPUS && (cpus >> (last + 1) & 1u) != 0) {
            last++;
        }
        text_add(text, "%s%d", between, cpu);
        if (last > cpu) {
            text_add(text, "-%d", last);
        }
        between = ",";
        cpu = last;
    }
}

void precedence_describe(const precedence_t *granted, char *text, size_t capacity) {
    text_t line = text_in(text, capacity);
    if (!granted->asked) {
        text_add(&line, "not asked for (--realtime)");
        return;
    }
    if (granted->priority > 0) {
        text_add(&line, "SCHED_FIFO %d, ", (int)granted->priority);
    } else {
        text_add(&line, "SCHED_FIFO not granted, ");
    }
    text_add(&line, "memory %s, processors ", granted->locked ? "locked" : "not locked");
    add_cpus(&line, granted->cpus);
}
