#!/bin/sh
# SPDX-License-Identifier: MIT
# A lost echo of 65535 is read as the longest valid range by go.einride.tech/can, and a signal of one bit has neither
# factor nor offset.
#
# Version:   go.einride.tech/can 0.17.0 (Go).
# Expected:  A physical value is factor times raw value plus offset, for each length of a signal. A value outside the
#           limits of the database is shown as it is, or as an error.
# Behaviour: Values are cut to the limits on reading and on writing: 65.535 m becomes 5 m, a wall at the end of the
#           range. A signal of one bit is 0 or 1 in whatever unit. A value between two steps is not rounded: 0.29 m at 1
#           cm is 28.999999999999996, which is 28 as an integer.
# Hurts:     Anyone who marks lost echoes by a value above the range, as many sensors do, or sends distances back.
#           Compare the raw value, and round before it is packed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    export GOFLAGS=-mod=mod GOTOOLCHAIN=local
    go mod init finding && go get go.einride.tech/can@v0.17.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >main.go <<'END'
package main

import (
	"fmt"

	"go.einride.tech/can"
	"go.einride.tech/can/pkg/descriptor"
)

func main() {
	front := descriptor.Signal{Name: "Front", Length: 16, Scale: 0.001, Max: 5, Unit: "m"}
	for _, raw := range []uint64{1200, 5000, 5001, 65535} {
		var data can.Data
		front.MarshalUnsigned(&data, raw)
		fmt.Println("raw", raw, "is", front.UnmarshalPhysical(data), front.Unit)
	}
	power := descriptor.Signal{Name: "Supply", Length: 1, Scale: 12, Offset: 12, Unit: "V"}
	wide := descriptor.Signal{Name: "Supply", Length: 2, Scale: 12, Offset: 12, Unit: "V"}
	var data can.Data
	data.SetBit(0, true)
	fmt.Println("one bit, factor 12, offset 12:", power.UnmarshalPhysical(data), power.Unit)
	fmt.Println("two bits, factor 12, offset 12:", wide.UnmarshalPhysical(data), wide.Unit)
	step := descriptor.Signal{Name: "Step", Length: 16, Scale: 0.01, Unit: "m"}
	fmt.Println("0.29 m in steps of 1 cm:", step.FromPhysical(0.29), "as an integer", uint64(step.FromPhysical(0.29)))
}
END
go run . >seen

cat >expected <<'END'
raw 1200 is 1.2 m
raw 5000 is 5 m
raw 5001 is 5 m
raw 65535 is 5 m
one bit, factor 12, offset 12: 1 V
two bits, factor 12, offset 12: 24 V
0.29 m in steps of 1 cm: 28.999999999999996 as an integer 28
END
diff expected seen || { echo "CHANGED: einride-can-no-echo-is-the-maximum" >&2; exit 1; }
echo "PASS: 65535 is the longest valid range"
