#!/bin/sh
# SPDX-License-Identifier: MIT
# asc2log reads the date that its sibling log2asc writes only on a machine that has the German locale.
#
# Version:   log2asc and asc2log of can-utils 2020.11.0 (Debian 12).
# Expected:  A log that goes to ASC by log2asc and back by asc2log has its times again, on any machine.
# Behaviour: A date of 24 hours is tried under de_DE, one with am or pm under en_US; other locales are not asked.
#            Where de_DE is not installed (a container, a server) asc2log puts the present, with a line on standard
#            error only. The locale of the user does not matter.
# Hurts:     Anyone who converts on a server what was right on the desktop: each run of one file has other times.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    apt-get -qq -s install can-utils=2020.11.0-1 >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
PATH="$PWD/debian/usr/bin:$PWD/debian/usr/sbin:$PATH"
LD_LIBRARY_PATH="$PWD/debian/usr/lib/$(uname -m)-linux-gnu"
export PATH LD_LIBRARY_PATH

export TZ=UTC
{ apt-get -qq download locales && dpkg -x locales_*.deb locales; } >locales.log 2>&1 || exit 2
mkdir german english
for pair in german:de_DE english:en_US; do
    I18NPATH=locales/usr/share/i18n localedef -i "${pair#*:}" -f ISO-8859-1 "${pair%%:*}/${pair#*:}" >>locales.log 2>&1 || true
done
printf '(1700000000.000000) can0 123#0102
' >bus.log
log2asc -I bus.log can0 >bus.asc
head -1 bus.asc >seen
for locales in english german; do
    seconds=$(LOCPATH=$PWD/$locales asc2log -I bus.asc 2>/dev/null | sed 's/^(\([0-9]*\).*/\1/')
    if [ "$seconds" -gt 1750000000 ]; then seconds="the present"; else seconds=$(date -d "@$seconds" +%F); fi
    echo "$locales: $seconds"
done >>seen

cat >expected <<'END'
date Tue Nov 14 22:13:20 2023
english: the present
german: 2023-11-14
END
diff expected seen || { echo "CHANGED: asc2log-needs-german" >&2; exit 1; }
echo "PASS: the date survives log2asc and asc2log under de_DE, and is the present without it"
