"""Compares the observations on a page (page_browser.py) with the recording of the run.

  page_check.py FOUND.json TICKS.csv TIME...     TICKS: from `thimble export`
"""
import csv
import json
import math
import sys


def main():
    found = json.load(open(sys.argv[1], encoding="utf-8"))
    with open(sys.argv[2], encoding="utf-8") as file:
        rows = list(csv.reader(file))
    place = {name.split(" ")[0]: i for i, name in enumerate(rows[0])}
    ticks = rows[1:]
    begin = int(ticks[0][place["time"]])
    wrong = []

    def check(true, what):
        if not true:
            wrong.append(what)

    times = [float(time) for time in sys.argv[3:]]
    check(len(found["forces"]) == len(times), "not every time was shown")
    touched = 0
    for time, shown in zip(times, found["forces"]):
        row = [row for row in ticks if int(row[place["time"]]) - begin <= time * 1e9 + 0.5][-1]
        force = math.hypot(*(float(row[place[f"f_sent_W.{axis}"]]) for axis in "xyz"))
        touched += force > 0.05
        check(shown["tick"] == int(row[place["tick"]]), f"{time} s: tick {shown['tick']}, expected {row[place['tick']]}")
        check(abs(shown["force"] - force) < 1e-6, f"{time} s: {shown['force']} N, expected {force} N")
    check(touched > 0, "no contact at any of these times: choose others")
    check(found["played"] and found["held"], "play and pause do not work")
    check(abs(found["scrubbed"] - found["duration"] / 2) < 0.01 * found["duration"], f"scrubbed to {found['scrubbed']}")
    check(abs(found["window"][0] - found["duration"] / 4) < 1e-6, f"zoomed to {found['window']}")
    check(found["plotted"][0] > 100 and found["plotted"][1] == 0, f"plots with {found['plotted']} points")
    check("Force, maximum" in found["words"], "no figures")
    check(found["leaks"] == "held", "a request could leave the page")
    check(len(found["requests"]) == 1 and found["requests"][0].startswith("file:"), f"requested {found['requests']}")
    check(not found["said"], f"console messages: {found['said']}")
    print("\n".join(wrong) if wrong else "as it should be")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
