#!/bin/sh
# SPDX-License-Identifier: MIT
# canparse reads the sign of a signal out of the DBC file and decodes without it, and takes the first bit of a
# Motorola signal for its last.
#
# Version:   canparse 0.1.4 (Rust).
# Expected:  -100 with a factor of 0.5 is -50. A signal 7|16@0+ is the first two bytes, high byte first. Messages 257
#           and 258 are two.
# Behaviour: -50 is 32718, though the definition that was read has a sign. A Motorola signal is shifted by its start bit
#           from the other end: 258 is read as 1024. Messages are kept by their number without the low eight bits, so
#           257 and 258 share one signal Range, and the last definition of it wins. A frame of less than eight bytes has
#           no values.
# Hurts:     Anyone who decodes a bus with it that is not J1939 with unsigned Intel signals: speeds, offsets and torques
#           below zero.
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
canparse = "=0.1.4"
END
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >ring.dbc <<'END'
VERSION ""

BU_: ECU

BO_ 2566834686 Speed: 8 ECU
 SG_ Wheel : 0|16@1- (0.5,0) [-16000|16000] "mm/s" Vector__XXX
 SG_ Sent : 23|16@0+ (1,0) [0|65535] "mm" Vector__XXX

BO_ 257 Front: 8 ECU
 SG_ Range : 0|16@1+ (1,0) [0|65535] "mm" Vector__XXX

BO_ 258 Rear: 8 ECU
 SG_ Range : 16|16@1+ (1,0) [0|65535] "mm" Vector__XXX

END
cat >src/main.rs <<'END'
use canparse::pgn::{ParseMessage, PgnLibrary};

fn main() {
    let library = PgnLibrary::from_dbc_file("ring.dbc").unwrap();
    let frame: [u8; 8] = [0x9c, 0xff, 0x01, 0x02, 0, 0, 0, 0];
    for (name, meant) in [("Wheel", "-50"), ("Sent", "258")] {
        let signal = library.get_spn(name).unwrap();
        println!("{name}: {:?}, by the file {meant}", signal.parse_message(&frame));
    }
    let (wheel, short) = (library.get_spn("Wheel").unwrap(), &frame[..2]);
    println!("the file has a sign: {}", format!("{wheel:?}").contains("signed: true"));
    println!("in a frame of two bytes: {:?}", wheel.parse_message(short));
    println!("messages 257 and 258: {:?}", library.get_pgn(1).map(|all| format!("{all:?}").matches("start_bit").count()));
    println!("Range of 257: {:?}, by the file 40000", library.get_spn("Range").unwrap().parse_message(&[0x40, 0x9c, 1, 0, 0, 0, 0, 0]));
}
END
cargo run -q --offline >seen

cat >expected <<'END'
Wheel: Some(32718.0), by the file -50
Sent: Some(1024.0), by the file 258
the file has a sign: true
in a frame of two bytes: None
messages 257 and 258: Some(1)
Range of 257: Some(1.0), by the file 40000
END
diff expected seen || { echo "CHANGED: canparse-signs-are-ignored" >&2; exit 1; }
echo "PASS: -50 is decoded as 32718"
