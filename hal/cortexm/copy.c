// SPDX-License-Identifier: MIT
// What the compiler calls to copy, fill and compare memory, for size: a word at a time where both sides allow
// it.
//
// Compiled apart from the rest (cmake/Board.cmake). The optimiser of the whole program may need these after
// it has looked for them. Nor must it turn their loops into calls to themselves.
#include <stddef.h>
#include <stdint.h>

#define WORD sizeof(uint32_t)

void *memcpy(void *restrict to, const void *restrict from, size_t count);
void *memmove(void *to, const void *from, size_t count);
void *memset(void *to, int value, size_t count);
int memcmp(const void *a, const void *b, size_t count);
size_t strlen(const char *text);

// Memory of any type.
typedef uint32_t __attribute__((may_alias)) word_t;

void *memcpy(void *restrict to, const void *restrict from, size_t count) {
    uint8_t *out = to;
    const uint8_t *in = from;
    if ((((uintptr_t)to | (uintptr_t)from) & (WORD - 1u)) == 0) {
        for (; count >= WORD; count -= WORD) {
            *(word_t *)out = *(const word_t *)in;
            out += WORD;
            in += WORD;
        }
    }
    while (count-- > 0) {
        *out++ = *in++;
    }
    return to;
}

void *memmove(void *to, const void *from, size_t count) {
    uint8_t *const out = to;
    const uint8_t *const in = from;
    if (out <= in) {
        for (size_t i = 0; i < count; i++) {
            out[i] = in[i];
        }
    } else {
        while (count-- > 0) {
            out[count] = in[count];
        }
    }
    return to;
}

void *memset(void *to, int value, size_t count) {
    uint8_t *out = to;
    const uint32_t byte = (uint8_t)value;
    if (((uintptr_t)to & (WORD - 1u)) == 0) {
        for (; count >= WORD; count -= WORD) {
            *(word_t *)out = byte * 0x01010101u;
            out += WORD;
        }
    }
    while (count-- > 0) {
        *out++ = (uint8_t)value;
    }
    return to;
}

int memcmp(const void *a, const void *b, size_t count) {
    const uint8_t *one = a;
    const uint8_t *other = b;
    for (; count > 0; count--, one++, other++) {
        if (*one != *other) {
            return *one - *other;
        }
    }
    return 0;
}

size_t strlen(const char *text) {
    size_t length = 0;
    while (text[length] != '\0') {
        length++;
    }
    return length;
}
