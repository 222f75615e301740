// SPDX-License-Identifier: MIT
// In an argusd that counts what runs: the process that draws ends by _exit(), which would leave its counts
// behind.
#include <stdlib.h>
#include <unistd.h>

void __gcov_dump(void);                // NOLINT(bugprone-reserved-identifier): gcc's own
_Noreturn void __real__exit(int code); // NOLINT(bugprone-reserved-identifier): of the linker's --wrap
_Noreturn void __wrap__exit(int code); // NOLINT(bugprone-reserved-identifier): likewise

// NOLINTNEXTLINE(bugprone-reserved-identifier)
void __wrap__exit(int code) {
    __gcov_dump();
    __real__exit(code);
}
