# SPDX-License-Identifier: MIT
"""Make a data frame of a log, a row for each SIP and a column for each sonar; argument: the log."""

import sys

import argus
import pandas


def frame(path: str) -> pandas.DataFrame:
    """Return times, poses and readings of a log; a sonar that a SIP does not report is empty there."""
    rows = [
        {"t_s": packet["t"], "x_mm": packet["x_mm"], "y_mm": packet["y_mm"]}
        | {f"sonar_{number}": mm for number, mm in packet["sonar"].items()}
        for packet in argus.log.decode(path, direction="r2c")
        if packet["type"] == "SIP" and packet["ok"]
    ]
    return pandas.DataFrame(rows).set_index("t_s")


if __name__ == "__main__":
    table = frame(sys.argv[1])
    heard = table.filter(like="sonar_").where(lambda mm: mm < 5000)
    print(heard[["sonar_2", "sonar_3", "sonar_4"]].describe().round(0).astype(int))
