#!/bin/sh
# SPDX-License-Identifier: MIT
# An echo sounder whose depth is measured from the keel is refused by nmea for Rust, as are headings and winds that it
# can parse.
#
# Version:   nmea 0.8.0 (Rust).
# Expected:  The offset of DPT may have either sign: above zero it leads to the surface, below zero to the keel. What
#           the parser reads, the object of the stream reads, too.
# Behaviour: parse_str refuses a negative offset, and with it the depth. DPT, HDT and MWV are read by parse_str and
#           refused by Nmea::parse. GLL without the field of the mode, as receivers before NMEA 2.3 send it, is refused;
#           so is any sentence of a leap second.
# Hurts:     Anyone who reads depths of a boat with an offset to its keel: the sounder is silent. Take the sentence
#           apart by hand.
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
nmea = "=0.8.0"
END
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >src/main.rs <<'END'
fn main() {
    for body in [
        "SDDPT,2.4,0.5,10.0",
        "SDDPT,2.4,0.0,10.0",
        "SDDPT,2.4,-0.5,10.0",
        "HEHDT,270.5,T",
        "WIMWV,41.1,R,1.0,N,A",
        "GPGLL,4916.45,N,12311.12,W,225444,A,A",
        "GPGLL,4916.45,N,12311.12,W,225444,A",
        "GNRMC,235960.00,A,4916.45,N,12311.12,W,0.5,,311216,,,A",
    ] {
        let sentence = format!("${body}*{:02X}\r\n", body.bytes().fold(0, |sum, byte| sum ^ byte));
        let alone = if nmea::parse_str(&sentence).is_ok() { "read" } else { "refused" };
        let stream = if nmea::Nmea::default().parse(&sentence).is_ok() { "read" } else { "refused" };
        println!("{body}: {alone} alone, {stream} in a stream");
    }
}
END
cargo run -q --offline >seen

cat >expected <<'END'
SDDPT,2.4,0.5,10.0: read alone, refused in a stream
SDDPT,2.4,0.0,10.0: read alone, refused in a stream
SDDPT,2.4,-0.5,10.0: refused alone, refused in a stream
HEHDT,270.5,T: read alone, refused in a stream
WIMWV,41.1,R,1.0,N,A: read alone, refused in a stream
GPGLL,4916.45,N,12311.12,W,225444,A,A: read alone, read in a stream
GPGLL,4916.45,N,12311.12,W,225444,A: refused alone, refused in a stream
GNRMC,235960.00,A,4916.45,N,12311.12,W,0.5,,311216,,,A: refused alone, refused in a stream
END
diff expected seen || { echo "CHANGED: nmea-crate-keel" >&2; exit 1; }
echo "PASS: a depth with an offset to the keel is refused"
