#!/bin/sh
# SPDX-License-Identifier: MIT
# In a ROS 2 parameter file 010 is 8, 08 is the floating-point number 8.0, and ~ is a text.
#
# Version:   rcl of ros-rclpy 9.1.2.
# Expected:  A number in a parameter file is decimal, as in YAML 1.2, or else of one kind for 07, 08, 09 and 010; ~ is
#            no value, as in YAML.
# Behaviour: A leading zero means octal, where the digits allow it; where they do not, the value becomes a double. So
#            07 and 010 are the integers 7 and 8, 08 and 09 doubles, and a list of 07 and 08 stops the node.
#            9223372036854775808 becomes a double, 1e400 and ~ texts.
# Hurts:     Anyone who numbers sonars, joints or robots with two digits, or pads an id with zeros.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            ros-rclpy==9.1.2 \
            ros-rmw-fastrtps-cpp==9.3.3 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >parameters.py <<'END'
import pathlib

import rclpy

for text in ("07", "08", "010", "0x10", "~", "9223372036854775808", "1e400", "[07, 06]", "[07, 08]"):
    file = pathlib.Path("parameters.yaml")
    file.write_text(f"probe:\n  ros__parameters:\n    value: {text}\n")
    context = rclpy.Context()
    try:
        rclpy.init(args=["--ros-args", "--params-file", str(file)], context=context)
    except Exception as error:
        print(f"{text}: {str(error).rstrip().partition('Error: ')[2].partition(', at')[0]}")
        continue
    node = rclpy.create_node(
        "probe", context=context, automatically_declare_parameters_from_overrides=True, start_parameter_services=False
    )
    value = node.get_parameter("value")
    print(f"{text}: {value.type_.name} {value.value!r}")
    node.destroy_node()
    rclpy.shutdown(context=context)
END
venv/bin/python parameters.py >seen

cat >expected <<'END'
07: INTEGER 7
08: DOUBLE 8.0
010: INTEGER 8
0x10: INTEGER 16
~: STRING '~'
9223372036854775808: DOUBLE 9.223372036854776e+18
1e400: STRING '1e400'
[07, 06]: INTEGER_ARRAY [7, 6]
[07, 08]: Sequence should be of same type. Value type 'double' do not belong at line_num 3
END
diff expected seen || { echo "CHANGED: ros2-parameter-leading-zero" >&2; exit 1; }
echo "PASS: 010 is 8 and 08 is 8.0"
