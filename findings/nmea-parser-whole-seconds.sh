#!/bin/sh
# SPDX-License-Identifier: MIT
# Ten fixes a second have one time in nmea-parser, whose GGA and GLL are of the year 2000 and whose 1994 is 2094.
#
# Version:   nmea-parser 0.10.0 (Rust).
# Expected:  092725.90 is nine tenths of a second behind 092725.00. A time without a date has no date, or that of the
#           last RMC.
# Behaviour: The fraction of the second is dropped in all sentences. The date of GGA and GLL is the first of January
#           2000, also after an RMC with a date by the same parser. Two digits of a year are always of this century.
# Hurts:     Anyone who computes speeds, or lays a track of 5 or 10 Hz beside other sensors: differences of time are 0
#           or 1 s.
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
nmea-parser = "=0.10.0"
END
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >src/main.rs <<'END'
use nmea_parser::{NmeaParser, ParsedMessage};

fn main() {
    let mut parser = NmeaParser::new();
    for body in [
        "GPRMC,092725.00,A,4717.114,N,00833.916,E,1.0,90.0,141123,,",
        "GPRMC,092725.90,A,4717.114,N,00833.916,E,1.0,90.0,141123,,",
        "GPGGA,092725.90,4717.114,N,00833.916,E,1,08,1.01,499.6,M,48.0,M,,",
        "GPGLL,4717.114,N,00833.916,E,092725.90,A,A",
        "GPRMC,092725.00,A,4717.114,N,00833.916,E,1.0,90.0,191194,,",
    ] {
        let sentence = format!("${body}*{:02X}", body.bytes().fold(0, |sum, byte| sum ^ byte));
        let time = match parser.parse_sentence(&sentence).unwrap() {
            ParsedMessage::Rmc(rmc) => rmc.timestamp,
            ParsedMessage::Gga(gga) => gga.timestamp,
            ParsedMessage::Gll(gll) => gll.timestamp,
            _ => None,
        };
        println!("{body}: {time:?}");
    }
}
END
cargo run -q --offline >seen

cat >expected <<'END'
GPRMC,092725.00,A,4717.114,N,00833.916,E,1.0,90.0,141123,,: Some(2023-11-14T09:27:25Z)
GPRMC,092725.90,A,4717.114,N,00833.916,E,1.0,90.0,141123,,: Some(2023-11-14T09:27:25Z)
GPGGA,092725.90,4717.114,N,00833.916,E,1,08,1.01,499.6,M,48.0,M,,: Some(2000-01-01T09:27:25Z)
GPGLL,4717.114,N,00833.916,E,092725.90,A,A: Some(2000-01-01T09:27:25Z)
GPRMC,092725.00,A,4717.114,N,00833.916,E,1.0,90.0,191194,,: Some(2094-11-19T09:27:25Z)
END
diff expected seen || { echo "CHANGED: nmea-parser-whole-seconds" >&2; exit 1; }
echo "PASS: 092725.90 is 092725, and 1994 is 2094"
