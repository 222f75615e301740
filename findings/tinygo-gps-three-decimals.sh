#!/bin/sh
# SPDX-License-Identifier: MIT
# A receiver whose latitude has three decimals is on the equator in the gps package of tinygo.org/x/drivers, and half
# a second is 50 ns.
#
# Version:   tinygo.org/x/drivers 0.37.0 (Go).
# Expected:  4807.038 are 48.1173 degrees, with however many decimals, and .50 is half a second. A fix of quality 0 is
#           not valid.
# Behaviour: A latitude of less than nine characters is 0; the longitude is one character longer and is right. With two
#           decimals both are 0. Valid is true in each case, also for quality 0 with satellites in use. Digits behind
#           the point of the second are taken for nanoseconds. RMC is read with 13 fields only: those of NMEA 2 have 12,
#           those of NMEA 4.1 have 14.
# Hurts:     Anyone whose receiver, simulator or test has fewer decimals than four: the robot is in the Gulf of Guinea,
#           and valid.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    export GOFLAGS=-mod=mod GOTOOLCHAIN=local
    go mod init finding && go get tinygo.org/x/drivers@v0.37.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >main.go <<'END'
package main

import (
	"fmt"

	"tinygo.org/x/drivers/gps"
)

func main() {
	parser := gps.NewParser()
	for _, sentence := range []string{
		"$GPGGA,123519.50,4807.0380,N,01131.0000,E,1,08,0.9,545.4,M,46.9,M,,*5E",
		"$GPGGA,123519.50,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*5E",
		"$GPGGA,123519,4807.03,N,01131.00,E,1,08,0.9,545.4,M,46.9,M,,*40",
		"$GPGGA,123519,4807.0380,N,01131.0000,E,0,08,0.9,545.4,M,46.9,M,,*46",
		"$GPRMC,123519.50,A,4807.0380,N,01131.0000,E,022.4,084.4,230324,003.1,W*6B",
		"$GPRMC,123519.50,A,4807.0380,N,01131.0000,E,022.4,084.4,230324,003.1,W,A*06",
		"$GPRMC,123519.50,A,4807.0380,N,01131.0000,E,022.4,084.4,230324,003.1,W,A,V*7C",
	} {
		fix, err := parser.Parse(sentence)
		fmt.Println(sentence[:len(sentence)-3])
		if err != nil {
			fmt.Println("  error:", err)
			continue
		}
		fmt.Printf("  %.4f %.4f valid %v, %d ns\n", fix.Latitude, fix.Longitude, fix.Valid, fix.Time.Nanosecond())
	}
}
END
go run . >seen

cat >expected <<'END'
$GPGGA,123519.50,4807.0380,N,01131.0000,E,1,08,0.9,545.4,M,46.9,M,,
  48.1173 11.5167 valid true, 50 ns
$GPGGA,123519.50,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,
  0.0000 11.5167 valid true, 50 ns
$GPGGA,123519,4807.03,N,01131.00,E,1,08,0.9,545.4,M,46.9,M,,
  0.0000 0.0000 valid true, 0 ns
$GPGGA,123519,4807.0380,N,01131.0000,E,0,08,0.9,545.4,M,46.9,M,,
  48.1173 11.5167 valid true, 0 ns
$GPRMC,123519.50,A,4807.0380,N,01131.0000,E,022.4,084.4,230324,003.1,W
  error: invalid RMC NMEA sentence
$GPRMC,123519.50,A,4807.0380,N,01131.0000,E,022.4,084.4,230324,003.1,W,A
  48.1173 11.5167 valid true, 50 ns
$GPRMC,123519.50,A,4807.0380,N,01131.0000,E,022.4,084.4,230324,003.1,W,A,V
  error: invalid RMC NMEA sentence
END
diff expected seen || { echo "CHANGED: tinygo-gps-three-decimals" >&2; exit 1; }
echo "PASS: 4807.038 is latitude 0, and valid"
