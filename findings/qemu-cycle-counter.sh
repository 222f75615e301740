#!/bin/sh
# SPDX-License-Identifier: MIT
# The cycle counter of a Cortex-M4 in QEMU declares itself present and stands still.
#
# Version:   qemu-system-arm 7.2 (Debian 12), machine mps2-an386 (Cortex-M4).
# Expected:  DWT_CTRL has the bit NOCYCCNT set where there is no counter, or a read faults; else CYCCNT counts once it
#            is enabled.
# Behaviour: All of DWT reads as zero: NOCYCCNT is clear, the enable bit does not stay, CYCCNT is 0 for ever. SysTick
#            counts.
# Hurts:     Anyone who times code or waits by CYCCNT: the check for the counter passes, each duration is 0 and a busy
#            wait never ends.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    apt-get -qq -s install qemu-system-arm binutils-arm-none-eabi >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
PATH="$PWD/debian/usr/bin:$PWD/debian/usr/sbin:$PATH"
LD_LIBRARY_PATH="$PWD/debian/usr/lib/$(uname -m)-linux-gnu"
export PATH LD_LIBRARY_PATH

cat >count.s <<'END'
        .syntax unified
        .cpu cortex-m4
        .thumb
        .word 0x20008000, start + 1
        .rept 14
        .word stop + 1
        .endr
start:  ldr r4, =0x40004000     @ the first UART of the board
        movs r0, #1
        str r0, [r4, #8]
        ldr r1, =0xE000EDFC     @ DEMCR: trace on
        ldr r0, =0x01000000
        str r0, [r1]
        ldr r1, =0xE0001000     @ DWT_CTRL: count cycles
        movs r0, #1
        str r0, [r1]
        ldr r2, =0xE000E010     @ SysTick: count cycles
        ldr r0, =0x00FFFFFF
        str r0, [r2, #4]
        movs r0, #5
        str r0, [r2]
        ldr r3, =1000000
wait:   subs r3, #1
        bne wait
        ldr r0, [r1]            @ DWT_CTRL
        bl word
        ldr r0, [r1, #4]        @ DWT_CYCCNT
        bl word
        ldr r0, [r2, #8]        @ SysTick, which counts down from 0: has it moved?
        ldr r3, =0x00FFFFFF
        cmp r0, r3
        ite eq
        moveq r0, #0
        movne r0, #1
        bl word
stop:   movs r0, #10
        str r0, [r4]
        ldr r1, =0x20026        @ exit through semihosting
        movs r0, #0x18
        bkpt 0xAB
        b stop
word:   movs r6, #8             @ r0 in hex
digit:  lsrs r5, r0, #28
        lsls r0, r0, #4
        cmp r5, #10
        ite lo
        addlo r5, #'0'
        addhs r5, #'a' - 10
        str r5, [r4]
        subs r6, #1
        bne digit
        movs r5, #' '
        str r5, [r4]
        bx lr
        .ltorg
END
arm-none-eabi-as -o count.o count.s
arm-none-eabi-ld -Ttext=0 -e 0 -o count.elf count.o
echo "DWT_CTRL DWT_CYCCNT SysTick has moved:" >seen
timeout 60 qemu-system-arm -M mps2-an386 -display none -monitor none -serial stdio -semihosting -kernel count.elf </dev/null >>seen

cat >expected <<'END'
DWT_CTRL DWT_CYCCNT SysTick has moved:
00000000 00000000 00000001 
END
diff expected seen || { echo "CHANGED: qemu-cycle-counter" >&2; exit 1; }
echo "PASS: after a million rounds DWT_CTRL and CYCCNT are 0, SysTick has moved"
