// SPDX-License-Identifier: MIT
// Argus on the MPS2 AN386: UART 0 is the robot's, UART 1 the operator's.
#include "board/board.h"
#include "cortexm/cortexm.h"
#include "mps2_an386/registers.h"
#include "mps2_an386/uart.h"

#define CONSOLE_BAUD 115200u
#define TICKS_PER_MS (MPS2_CLOCK_HZ / 1000u)
#define WATCHDOG_MS 1000u // until its NMI, and again until its reset

static uint32_t counted; // timer's ticks that are in `now_ms`
static uint32_t now_ms;

void cortexm_board_start(void) {
}

// The timer runs freely; a tick that is lost, as those of SysTick are in QEMU on a busy host, costs no time.
uint32_t board_now_ms(void) {
    const uint32_t passed = UINT32_MAX - MPS2_TIMER0->value - counted;
    now_ms += passed / TICKS_PER_MS;
    counted += passed / TICKS_PER_MS * TICKS_PER_MS;
    return now_ms;
}

void board_open(uint32_t baud) {
    mps2_uart_open(&mps2_robot, baud > 0 ? baud : CONSOLE_BAUD);
    cortexm_enable(MPS2_IRQ_UART0_RX);
    cortexm_enable(MPS2_IRQ_UART0_TX);
    MPS2_WATCHDOG->lock = MPS2_WATCHDOG_UNLOCK;
    MPS2_WATCHDOG->load = WATCHDOG_MS * TICKS_PER_MS;
    MPS2_WATCHDOG->control = MPS2_WATCHDOG_ON;
    MPS2_WATCHDOG->lock = 0;
}

size_t board_receive(uint8_t *bytes, size_t capacity) {
    return board_ring_take_some(&mps2_robot.in, bytes, capacity);
}

size_t board_room(void) {
    return board_ring_room(&mps2_robot.out);
}

void board_send(const uint8_t *packet, size_t count) {
    board_ring_put_all(&mps2_robot.out, packet, count);
    mps2_uart_kick(&mps2_robot);
}

static bool is_quiet(void) {
    return board_ring_is_empty(&mps2_robot.in) && board_ring_is_empty(&mps2_console.in);
}

// Looking and sleeping are one: a byte that comes in between ends the sleep, since it is pending.
void board_wait(uint32_t ms) {
    const uint32_t start_ms = board_now_ms();
    while (is_quiet() && board_now_ms() - start_ms < ms) {
        const uint32_t before = cortexm_mask();
        if (is_quiet()) {
            cortexm_sleep();
        }
        cortexm_unmask(before);
    }
}

void board_feed(void) {
    MPS2_WATCHDOG->lock = MPS2_WATCHDOG_UNLOCK;
    MPS2_WATCHDOG->clear = 1;
    MPS2_WATCHDOG->lock = 0;
}

board_ring_t *board_console_out(void) {
    return &mps2_console.out;
}

void board_console_kick(void) {
    mps2_uart_kick(&mps2_console);
}

size_t board_console_read(uint8_t *bytes, size_t capacity) {
    return board_ring_take_some(&mps2_console.in, bytes, capacity);
}

board_reset_t board_reset_reason(void) {
    return cortexm_noted_reason();
}

const char *board_name(void) {
    return "mps2-an386";
}

int main(void) {
    MPS2_TIMER0->reload = UINT32_MAX;
    MPS2_TIMER0->value = UINT32_MAX;
    MPS2_TIMER0->control = MPS2_TIMER_ON;
    CORTEXM_SYST_RVR = TICKS_PER_MS - 1u;
    CORTEXM_SYST_CVR = 0;
    CORTEXM_SYST_CSR = CORTEXM_SYST_ON;
    mps2_uart_open(&mps2_console, CONSOLE_BAUD);
    cortexm_enable(MPS2_IRQ_UART1_RX);
    cortexm_enable(MPS2_IRQ_UART1_TX);
    cortexm_enable(MPS2_IRQ_UART_OVERRUN);
    board_run();
}
