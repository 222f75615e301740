#!/bin/sh
# SPDX-License-Identifier: MIT
# candump-parse refuses frames without data and interfaces with a point or a dash, and cannot tell 00000123 from 123.
#
# Version:   candump-parse 0.1.0 (Rust).
# Expected:  Each line that candump -L writes is read, and an extended identifier differs from a standard one: candump
#           tells it by eight digits.
# Behaviour: A frame without data, a remote frame, a CAN FD frame and any frame of can0.1 or slcan-1 raise an error. 123
#           and 00000123 give one and the same frame. An error frame is a data frame with the identifier 0x20000004. A
#           time with one digit behind the point is that many microseconds: .5 is 5 us.
# Hurts:     Anyone who counts heartbeats without data, or has two kinds of identifiers on a bus, and anyone who skips
#           the lines that raise.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    mkdir src && touch src/main.rs && cat >Cargo.toml <<'END' && cargo fetch -q || return 1
[package]
name = "finding"
version = "0.1.0"
edition = "2021"

[dependencies]
candump-parse = "=0.1.0"
chumsky = "=0.9.3"
END
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >src/main.rs <<'END'
use candump_parse::parser;
use chumsky::Parser;

fn main() {
    for line in [
        "(1700000000.000100) can0 123#0102",
        "(1700000000.000100) can0 00000123#0102",
        "(1700000000.000100) can0 123#",
        "(1700000000.000100) can0 123#R",
        "(1700000000.000100) can0 123##10102",
        "(1700000000.000100) can0.1 123#0102",
        "(1700000000.000100) slcan-1 123#0102",
        "(1700000000.000100) can0 20000004#0008000000000000",
        "(1700000000.5) can0 123#0102",
    ] {
        match parser().parse(line) {
            Ok(frame) => println!("{line}: {:#x}, {} bytes, {} us", frame.id, frame.data.len(), frame.timestamp.subsec_micros()),
            Err(_) => println!("{line}: raises"),
        }
    }
}
END
cargo run -q --offline >seen

cat >expected <<'END'
(1700000000.000100) can0 123#0102: 0x123, 2 bytes, 100 us
(1700000000.000100) can0 00000123#0102: 0x123, 2 bytes, 100 us
(1700000000.000100) can0 123#: raises
(1700000000.000100) can0 123#R: raises
(1700000000.000100) can0 123##10102: raises
(1700000000.000100) can0.1 123#0102: raises
(1700000000.000100) slcan-1 123#0102: raises
(1700000000.000100) can0 20000004#0008000000000000: 0x20000004, 8 bytes, 100 us
(1700000000.5) can0 123#0102: 0x123, 2 bytes, 5 us
END
diff expected seen || { echo "CHANGED: candump-parse-fractions" >&2; exit 1; }
echo "PASS: a frame without data raises, 00000123 is 123"
