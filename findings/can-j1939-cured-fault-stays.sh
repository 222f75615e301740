#!/bin/sh
# SPDX-License-Identifier: MIT
# In can-j1939 a fault that is cured stays: a DM1 without faults has two bytes, its own receiver refuses it and
# reports the last faults again.
#
# Version:   can-j1939 2.0.12, python-can 4.6.1.
# Expected:  A sender with an empty list of faults makes the others report an empty list.
# Behaviour: The frame is not filled up to eight bytes. The receiver logs that it is short, and calls the subscribers
#            all the same, with what it had. A healthy node of another make, whose DM1 has eight bytes, is reported
#            with one fault of number 0. stop_send with the callback of start_send stops nothing.
# Hurts:     Anyone who sends states of sensors as DM1: a sensor that is well again is faulty until the receiver is
#            started again, and a healthy one has a fault.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            can-j1939==2.0.12 \
            python-can==4.6.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >dm1.py <<'END'
from j1939 import Dm1, DtcLamp, ParameterGroupNumber


class Application:
    """One end of a bus: what is sent goes to the other end, and a timer is run by hand."""

    def __init__(self):
        self.timers, self.sent = [], None

    def subscribe(self, callback):
        pass

    def add_timer(self, delta_time, callback, cookie):
        self.timers.append((callback, cookie))

    def remove_timer(self, callback):
        self.timers = [timer for timer in self.timers if timer[0] != callback]

    def send_pgn(self, page, pdu_format, pdu_specific, priority, data):
        self.sent = list(data)


def faults():
    return {"awl": DtcLamp.ON if present else DtcLamp.OFF}, list(present)


def show(sender, lamps, dtcs, timestamp):
    print("    reported: lamp", lamps["awl"], dtcs)


application = Application()
sender, receiver = Dm1(application), Dm1(Application())
receiver.subscribe(show)
sender.start_send(faults)
callback, cookie = application.timers[0]
for present in ([{"spn": 520200, "fmi": 2, "oc": 1}], []):
    callback(cookie)
    print("sent by can-j1939:", bytes(application.sent).hex(" "))
    receiver._receive(6, ParameterGroupNumber.PGN.DM01, 0x80, 0.0, application.sent)
healthy = bytes.fromhex("00 ff 00 00 00 00 ff ff")
print("sent by a healthy node:", healthy.hex(" "))
receiver._receive(6, ParameterGroupNumber.PGN.DM01, 0x81, 0.0, healthy)
sender.stop_send(faults)
print("timers after stop_send:", len(application.timers))
END
venv/bin/python dm1.py >seen 2>stderr

cat >expected <<'END'
sent by can-j1939: 04 ff 08 f0 e2 01
    reported: lamp 1 [{'spn': 520200, 'fmi': 2, 'oc': 1}]
sent by can-j1939: 00 ff
    reported: lamp 1 [{'spn': 520200, 'fmi': 2, 'oc': 1}]
sent by a healthy node: 00 ff 00 00 00 00 ff ff
    reported: lamp 0 [{'spn': 0, 'fmi': 0, 'oc': 0}]
timers after stop_send: 1
END
diff expected seen || { echo "CHANGED: can-j1939-cured-fault-stays" >&2; exit 1; }
echo "PASS: after an empty DM1 the old fault is reported"
