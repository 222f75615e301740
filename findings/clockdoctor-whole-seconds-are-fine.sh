#!/bin/sh
# SPDX-License-Identifier: MIT
# clockdoctor calls the stamps of a sensor coarse if they are tenths of a second, and not if they are whole seconds.
#
# Version:   clockdoctor 0.1.0, pandas 3.0.6, numpy 2.4.6.
# Expected:  The coarser a clock is, the rather it is reported: stamps of whole seconds at 10 Hz are the worst case.
# Behaviour: The resolution is found from the part below a second, and messages where that is zero are left out. With
#            whole seconds none remains, and the resolution is n/a. Instead a drift of 0.7 % and a jitter of 288 ms of
#            that clock are reported. 101 messages in 10 s are 10.10 Hz.
# Hurts:     Anyone who looks by it for the sensor whose times are rounded.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            clockdoctor==0.1.0 \
            pandas==3.0.6 \
            numpy==2.4.6 \
            python-dateutil==2.9.0.post0 \
            six==1.17.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >seconds.py <<'END'
import contextlib
import io
import json
from pathlib import Path

from clockdoctor.analyze import analyze_jsonl

MS = 1_000_000
for name, step in (("milliseconds", MS), ("tenths of a second", 100 * MS), ("whole seconds", 1000 * MS)):
    rows = []
    for count in range(101):
        now = 1_700_000_000_000 * MS + count * 100 * MS + (3 * MS if step == MS else 0)
        stamp = now // step * step
        header = {"stamp": {"sec": stamp // (1000 * MS), "nanosec": stamp % (1000 * MS)}, "frame_id": "sonar"}
        rows.append({"topic": "/sonar", "schema_name": "sensor_msgs/msg/Range", "data": {"header": header}, "log_time_ns": now + 5 * MS, "publish_time_ns": now + 4 * MS})
    Path("log_messages.jsonl").write_text("\n".join(map(json.dumps, rows)))
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        analyze_jsonl("log_messages.jsonl")
    report = printed.getvalue()
    resolution = report.split("resolution~")[1].split(";")[0]
    print(f"{name}: resolution {resolution}, called coarse: {'is coarse' in report}, jitter {report.split('jitter=')[1].split('.')[0]} ms, {report.split('/sonar')[1].split()[1]} Hz")
END
venv/bin/python seconds.py >seen

cat >expected <<'END'
milliseconds: resolution 1.0000ms, called coarse: False, jitter 0 ms, 10.10 Hz
tenths of a second: resolution 100.0000ms, called coarse: True, jitter 0 ms, 10.10 Hz
whole seconds: resolution n/a, called coarse: False, jitter 288 ms, 10.10 Hz
END
diff expected seen || { echo "CHANGED: clockdoctor-whole-seconds-are-fine" >&2; exit 1; }
echo "PASS: stamps of whole seconds are not called coarse"
