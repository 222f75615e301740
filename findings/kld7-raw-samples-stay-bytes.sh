#!/bin/sh
# SPDX-License-Identifier: MIT
# kld7 looks for raw samples under the code RDAC, the radar sends RADC: read_RADC returns 3072 bytes, where read_RFFT
# returns lists.
#
# Version:   kld7 0.2.1, pyserial 3.5.
# Expected:  read_RADC returns two channels of 256 pairs, as the decoder beside that of the spectrum is written to do.
# Behaviour: Two letters of the code are swapped in the decoder and nowhere else. No frame ever matches, and a frame
#            without a decoder is passed on as bytes.
# Hurts:     Anyone who processes the samples of a K-LD7: len() is 3072 and indexing gives numbers below 256, so it
#            looks like data of eight bits.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            kld7==0.2.1 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >frames.py <<'END'
import struct

from kld7 import KLD7


class Port:
    """A radar whose samples are 40000."""

    timeout = 0
    waiting = b""

    def write(self, packet):
        name, count = (b"RADC", 1536) if packet[8:9] == b"\1" else (b"RFFT", 512)
        data = struct.pack(f"<{count}H", *[40000] * count)
        answer = b"RESP" + struct.pack("<IB", 1, 0)
        self.waiting = answer + name + struct.pack("<I", len(data)) + data

    def read(self, count):
        data, self.waiting = self.waiting[:count], self.waiting[count:]
        return data

    def close(self):
        pass


radar = KLD7.__new__(KLD7)
radar._port = Port()
spectrum = radar.read_RFFT()
print("read_RFFT:", type(spectrum).__name__, [len(part) for part in spectrum], "first", spectrum[0][0])
radar._port = Port()
samples = radar.read_RADC()
print("read_RADC:", type(samples).__name__, len(samples), "first", samples[0])
END
venv/bin/python frames.py >seen

cat >expected <<'END'
read_RFFT: list [256, 256] first 40000
read_RADC: bytes 3072 first 64
END
diff expected seen || { echo "CHANGED: kld7-raw-samples-stay-bytes" >&2; exit 1; }
echo "PASS: the spectrum is a list of lists, the samples are bytes"
