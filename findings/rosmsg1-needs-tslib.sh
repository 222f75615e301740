#!/bin/sh
# SPDX-License-Identifier: MIT
# The JavaScript serializer of ROS 1 and the reader of its bags cannot be loaded after they are installed, unless
# tslib is there by chance.
#
# Version:   @foxglove/rosmsg-serialization 2.0.4, @foxglove/rosbag 0.4.1.
# Expected:  What npm brings with a package is all that it needs.
# Behaviour: Both require tslib and declare it nowhere. In a project with TypeScript tools it is there, in a fresh
#            folder or a slim container it is not.
# Hurts:     Anyone whose program works on the desk and not where only its own dependencies are installed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit @foxglove/rosmsg-serialization@2.0.4 @foxglove/rosbag@0.4.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

missing() {
    node -e '
        try { require(process.argv[1]); console.log(process.argv[1], "loaded"); }
        catch (error) { console.log(process.argv[1], error.code, error.message.split("\n")[0]); }' "$1"
}
for package in @foxglove/rosmsg-serialization @foxglove/rosbag; do missing "$package"; done >seen
npm install --silent --no-fund --no-audit tslib@2.9.1 >>setup.log 2>&1 || { echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
for package in @foxglove/rosmsg-serialization @foxglove/rosbag; do missing "$package"; done >>seen

cat >expected <<'END'
@foxglove/rosmsg-serialization MODULE_NOT_FOUND Cannot find module 'tslib'
@foxglove/rosbag MODULE_NOT_FOUND Cannot find module 'tslib'
@foxglove/rosmsg-serialization loaded
@foxglove/rosbag loaded
END
diff expected seen || { echo "CHANGED: rosmsg1-needs-tslib" >&2; exit 1; }
echo "PASS: both want tslib, which nothing installs"
