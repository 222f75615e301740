#!/bin/sh
# SPDX-License-Identifier: MIT
# A timing budget of 50 ms is read back as 206 s by the vl53l1x package of tinygo.org/x/drivers, so a change of the
# mode leaves the times of the old one.
#
# Version:   tinygo.org/x/drivers 0.37.0 (Go).
# Expected:  GetMeasurementTimingBudget returns what was set, to some microseconds, and SetDistanceMode keeps the budget
#           with the new pulse periods.
# Behaviour: The guard time is multiplied where it was subtracted before. SetDistanceMode reads the budget, sets the
#           periods and sets that budget again: it is refused as too long, nothing looks at the refusal, and
#           SetDistanceMode returns true. The registers of the timeouts are those of the mode before.
# Hurts:     Anyone who changes to short range or shows the budget: the sensor measures for another time than was asked.
#           Call SetMeasurementTimingBudget with the number after each SetDistanceMode.
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

	"tinygo.org/x/drivers/vl53l1x"
)

// Bus keeps the registers of a sensor that is ready.
type Bus map[uint16]byte

func (bus Bus) Tx(address uint16, written, read []byte) error {
	register := uint16(written[0])<<8 | uint16(written[1])
	for i, value := range written[2:] {
		bus[register+uint16(i)] = value
	}
	for i := range read {
		read[i] = bus[register+uint16(i)]
	}
	return nil
}

func timeouts(bus Bus) string {
	return fmt.Sprintf("%02x%02x", bus[vl53l1x.RANGE_CONFIG_TIMEOUT_MACROP_A], bus[vl53l1x.RANGE_CONFIG_TIMEOUT_MACROP_A+1])
}

func main() {
	bus := Bus{vl53l1x.WHO_AM_I: 0xea, vl53l1x.WHO_AM_I + 1: 0xcc, vl53l1x.FIRMWARE_SYSTEM_STATUS: 1,
		vl53l1x.OSC_MEASURED_FAST_OSC_FREQUENCY: 0xb0}
	sensor := vl53l1x.New(bus)
	fmt.Println("configured:", sensor.Configure(true))
	for _, budget := range []uint32{50000, 100000} {
		fmt.Println("set", budget, "us:", sensor.SetMeasurementTimingBudget(budget), "read back:", sensor.GetMeasurementTimingBudget())
	}
	fmt.Println("timeout of the long mode:", timeouts(bus))
	fmt.Println("short mode:", sensor.SetDistanceMode(vl53l1x.SHORT), "timeout:", timeouts(bus))
	fmt.Println("set 100000 us again:", sensor.SetMeasurementTimingBudget(100000), "timeout:", timeouts(bus))
}
END
go run . >seen

cat >expected <<'END'
configured: true
set 50000 us: true read back: 205806656
set 100000 us: true read back: 431518400
timeout of the long mode: 01e3
short mode: true timeout: 01e3
set 100000 us again: true timeout: 02e3
END
diff expected seen || { echo "CHANGED: tinygo-vl53l1x-budget" >&2; exit 1; }
echo "PASS: 50000 us are read back as 205806656"
