#!/bin/sh
# SPDX-License-Identifier: MIT
# After a stray byte nooploop_uwb looks for a frame where it is not, and finds none of the good ones behind it.
#
# Version:   nooploop-uwb 0.0.1, pyserial 3.5.
# Expected:  Bytes before a header are skipped, and a frame with a wrong checksum costs that frame.
# Behaviour: The place of a header is counted from the last 0x55 that was none, and used from the start of the buffer.
#            The buffer is cut only behind a good frame, so what is not one stays at its head, and each new frame is
#            appended behind it.
# Hurts:     Anyone who opens the port of a running anchor, or has one bit wrong: bearings and distances stop, without
#            an error, until the program is started again.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            nooploop-uwb==0.0.1 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >frames.py <<'END'
from nooploop_uwb.utils.nooploop_uwb_helper import find_frameheader, get_one_complete_frame


def frame(millimetres):
    """A frame about one tag."""
    body = bytearray(32)
    body[0:4] = 0x55, 0x07, 33, 0
    body[20] = 1
    body[23:26] = millimetres.to_bytes(3, "little")
    return [*body, sum(body) & 255]


def frames(received):
    """Read as the package does: a piece of the line, then frames until none is found."""
    buffer, count = [], 0
    for piece in received:
        buffer = buffer + piece
        try:
            while True:
                _, tail = get_one_complete_frame(buffer)
                buffer = buffer[tail:]
                count += 1
        except Exception as error:
            last = type(error).__name__.replace("NooploopUWB_Frame_", "")
    return f"{count} frames, {len(buffer)} bytes kept, {last}"


good = [frame(1000 + index) for index in range(20)]
wrong = [*good[0][:-1], good[0][-1] ^ 1]
print("20 good frames:", frames(good))
print("behind a byte 0x01:", frames([[0x01], *good]))
print("behind a byte 0x55:", frames([[0x55, 0x01], *good]))
print("behind a wrong checksum:", frames([wrong, *good]))
print("header behind 0x55 0x01:", find_frameheader([0x55, 0x01, *good[0]]), "instead of 2")
END
venv/bin/python frames.py >seen

cat >expected <<'END'
20 good frames: 20 frames, 0 bytes kept, Incomplete_Exception
behind a byte 0x01: 20 frames, 0 bytes kept, Incomplete_Exception
behind a byte 0x55: 0 frames, 662 bytes kept, Incomplete_Exception
behind a wrong checksum: 0 frames, 693 bytes kept, Error_Exception
header behind 0x55 0x01: 1 instead of 2
END
diff expected seen || { echo "CHANGED: nooploop-header-before-itself" >&2; exit 1; }
echo "PASS: 20 good frames behind a stray 0x55 are none"
