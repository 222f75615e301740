#!/bin/sh
# SPDX-License-Identifier: MIT
# A scan that hokuyolx takes up 0.3 s late is the last one: from then on it synchronises the clock of the laser over
# and over.
#
# Version:   hokuyolx 0.9.0, numpy 2.4.6.
# Expected:  A scan that waited for half a second, while the program was busy or the clock was set, has a late time
#            stamp or makes a warning.
# Behaviour: Each time stamp is held against the clock of the computer. Off by more than 300 ms, the laser is stopped
#            and synchronised anew, which takes a second, and the same old stamp is looked at again: it is later still.
#            The next scan never comes.
# Hurts:     Anyone who draws, saves or plans between two scans, or whose clock is set by NTP: the robot drives on
#            without a laser.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            hokuyolx==0.9.0 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >late.py <<'END'
import logging
import types

from hokuyolx import hokuyo

logging.disable(logging.CRITICAL)
now = 1000.0  # seconds


def sleep(duration):
    """Let time go by."""
    global now
    now += duration


def line(text):
    """Return a line with its check sum."""
    return text + chr((sum(text.encode()) & 0x3F) + 0x30) + "\n"


def stamp(time):
    """Return a time of the laser, four characters of six bits."""
    milliseconds = round(time * 1000) & 0xFFFFFF
    return line("".join(chr((milliseconds >> shift & 0x3F) + 0x30) for shift in (18, 12, 6, 0)))


class Enough(Exception):
    """The laser was asked for its time a hundred times since the last scan."""


class Laser:
    """The socket of a UST-10LX that sends 40 scans a second where MD was ordered."""

    def __init__(self, *args):
        self.answers, self.scanning, self.next, self.asked = [], "", 0.0, 0

    def settimeout(self, value):
        pass

    connect = settimeout

    def send(self, data):
        order = data.decode().strip()
        answer = order + "\n" + line("00")
        if order == "%ST":
            answer += line("004" if self.scanning else "000")
        elif order == "TM1":
            self.asked += 1
            if self.asked > 110:
                raise Enough
            answer += stamp(now)
        elif order[:2] == "MD":
            self.scanning, self.next = order[:-2], now
        elif order == "QT":
            self.scanning = ""
        self.answers.append(answer + "\n")
        return len(data)

    def recv(self, size):
        global now
        if not self.answers:
            now = max(now, self.next)
            self.answers.append(self.scanning + "00\n" + line("99") + stamp(self.next) + line("0OX" * 3) + "\n")
            self.next += 0.025
            self.asked = 10
        answer = self.answers.pop(0)
        return answer.encode()


hokuyo.time = types.SimpleNamespace(time=lambda: now, sleep=sleep)
hokuyo.socket = types.SimpleNamespace(socket=Laser, AF_INET=0, SOCK_STREAM=0, timeout=TimeoutError)
laser = hokuyo.HokuyoLX(info=False, activate=False)
scans = laser.iter_dist()
for work in (0.1, 0.25, 0.35):
    begin = now
    try:
        next(scans)
        sleep(work)
        scan, time, _ = next(scans)
        print(f"{work} s between two scans: the next one is {round(now * 1000 - time)} ms old")
        laser._sock.next = now
    except Enough:
        print(f"{work} s between two scans: 10 synchronisations in {now - begin:.0f} s, no scan")
END
venv/bin/python late.py >seen

cat >expected <<'END'
0.1 s between two scans: the next one is 75 ms old
0.25 s between two scans: the next one is 225 ms old
0.35 s between two scans: 10 synchronisations in 10 s, no scan
END
diff expected seen || { echo "CHANGED: hokuyolx-a-late-scan-stops-all" >&2; exit 1; }
echo "PASS: 0.35 s between two scans are enough for no further one"
