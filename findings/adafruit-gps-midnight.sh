#!/bin/sh
# SPDX-License-Identifier: MIT
# At midnight the clock of adafruit_gps goes back by a day: the time of one sentence is put to the date of another.
#
# Version:   adafruit-circuitpython-gps 4.0.0.
# Expected:  timestamp_utc is the date and time of one fix, and never goes back.
# Behaviour: GGA and GLL have a time and no date. Between the first of them after midnight and the next RMC the
#            timestamp has the new time and yesterday's date. With GGA before RMC in each second, as most receivers
#            send, that is a part of a second each night.
# Hurts:     Anyone who sets a clock by it, or names a log after it, when the board happens to ask just then.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            adafruit-circuitpython-gps==4.0.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >midnight.py <<'END'
import adafruit_gps


class Port:
    """A serial port that has received sentences."""

    def __init__(self, *sentences):
        self.lines = []
        for sentence in sentences:
            check = 0
            for byte in sentence.encode():
                check ^= byte
            self.lines.append(f"${sentence}*{check:02X}\r\n".encode())

    @property
    def in_waiting(self):
        return sum(map(len, self.lines))

    def readline(self):
        return self.lines.pop(0) if self.lines else b""


PLACE = "5100.0000,N,00030.0000,E"
gps = adafruit_gps.GPS(
    Port(
        f"GNGGA,235959.00,{PLACE},1,08,0.9,5.4,M,46.9,M,,",
        f"GNRMC,235959.00,A,{PLACE},000.5,054.7,271126,,,A",
        f"GNGGA,000000.00,{PLACE},1,08,0.9,5.4,M,46.9,M,,",
        f"GNRMC,000000.00,A,{PLACE},000.5,054.7,281126,,,A",
    )
)
for name in ("GGA", "RMC", "GGA", "RMC"):
    gps.update()
    now = gps.timestamp_utc
    print(f"after {name}: {now.tm_mday:02}.{now.tm_mon:02}.{now.tm_year} {now.tm_hour:02}:{now.tm_min:02}:{now.tm_sec:02}")
END
venv/bin/python midnight.py >seen

cat >expected <<'END'
after GGA: 00.00.0 23:59:59
after RMC: 27.11.2026 23:59:59
after GGA: 27.11.2026 00:00:00
after RMC: 28.11.2026 00:00:00
END
diff expected seen || { echo "CHANGED: adafruit-gps-midnight" >&2; exit 1; }
echo "PASS: midnight is the begin of the day before for one sentence"
