// SPDX-License-Identifier: MIT
// The two serial lines of the board: figures come in on USART2, events go out on USART1.
#ifndef TEXT_H
#define TEXT_H

#include <stdint.h>

void text_open(void);

// Waits for a line of so many whole numbers; one that is something else is passed over.
void text_wait(int32_t *figures, int count);

void text_event(const char *name, int sonar, int32_t value);
void text_number(const char *name, int32_t value);

#endif
