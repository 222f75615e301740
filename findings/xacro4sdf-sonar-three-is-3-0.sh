#!/bin/sh
# SPDX-License-Identifier: MIT
# sonar_${i} with i = 3 is sonar_3.0 in xacro4sdf and in SDFUtils, and 16 samples are 16.0; in xacro they are sonar_3
# and 16.
#
# Version:   xacro4sdf 2.1.0, SDFUtils 1.0.0, xacro 2.1.1, PyYAML 6.0.4.
# Expected:  A whole number in a parameter stays one in the text, as in xacro, whose language both take over.
# Behaviour: Each value that can be a number is one with a fraction. Names of links, joints and topics have .0 behind
#            them, and 1e3 or 007 are 1000.0 and 7.0.
# Hurts:     Anyone who makes a ring of sensors by a macro, and looks for its links or topics by name.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            xacro4sdf==2.1.0 \
            SDFUtils==1.0.0 \
            xacro==2.1.1 \
            PyYAML==6.0.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >ring.py <<'END'
import re
import subprocess
import sys

from xacro2sdf.xacro2sdf import converter
from xacro4sdf.xacro4sdf import XMLMacro

BODY = '<sensor name="sonar_${i}"><samples>${n}</samples></sensor>'
open("a.xmacro", "w").write(
    f"""<sdf version="1.7"><xacro_define_macro name="sonar" params="i n">{BODY}</xacro_define_macro>
<xacro_macro name="sonar" i="3" n="16"/></sdf>"""
)
NAMESPACE = 'xmlns:xacro="http://xacro"'
open("b.xacro", "w").write(
    f"""<sdf version="1.7" {NAMESPACE}><xacro:macro name="sonar" params="i n">{BODY}</xacro:macro>
<link><xacro:sonar i="3" n="16"/></link></sdf>"""
)


def shown(name, text):
    print(f"{name}: sensor {re.search('<sensor name=.([^>]*).>', text)[1]} with {re.search('<samples>(.*)</samples>', text)[1]} samples")


macro = XMLMacro()
macro.set_xml_file("a.xmacro")
macro.generate()
shown("xacro4sdf", macro.to_string())
converter().run("b.xacro", "b.sdf")
shown("SDFUtils", open("b.sdf").read())
open("c.xacro", "w").write(open("b.xacro").read().replace("http://xacro", "http://www.ros.org/wiki/xacro"))
shown("xacro", subprocess.run([sys.executable, "-c", "import xacro; xacro.main()", "c.xacro"], capture_output=True, text=True, check=True).stdout)
END
venv/bin/python ring.py >seen

cat >expected <<'END'
xacro4sdf: sensor sonar_3.0 with 16.0 samples
SDFUtils: sensor sonar_3.0 with 16.0 samples
xacro: sensor sonar_3 with 16 samples
END
diff expected seen || { echo "CHANGED: xacro4sdf-sonar-three-is-3-0" >&2; exit 1; }
echo "PASS: sonar_3 is called sonar_3.0 by two of three"
