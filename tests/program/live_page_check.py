"""Compares the observations on the page of a live run (live_page_browser.py) with the recording.

  live_page_check.py FOUND.json TICKS.csv ADDRESS     TICKS: from `thimble export`
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
    ticks = {int(row[place["tick"]]): row for row in rows[1:]}
    wrong = []

    def check(true, what):
        if not true:
            wrong.append(what)

    for shown in found["forces"]:
        row = ticks.get(shown["tick"])
        if row is None:
            wrong.append(f"tick {shown['tick']} is not in the run")
            continue
        force = math.hypot(*(float(row[place[f"f_sent_W.{axis}"]]) for axis in "xyz"))
        check(abs(shown["force"] - force) < 1e-6, f"tick {shown['tick']}: {shown['force']} N, expected {force} N")
    check(len({shown["tick"] for shown in found["forces"]}) == len(found["forces"]), "not every time was shown")
    check(any(shown["force"] > 0.05 for shown in found["forces"]), "no contact at any of these times")
    end = found["end"]
    check(end["tick"] == max(ticks), f"the last tick is {end['tick']}, expected {max(ticks)}")
    check(found["followed"] and found["came_back"], "the page does not follow the run")
    check(found["held"], "it does not stay where it is")
    check("the run continues" in found["held_words"], f"it says {found['held_words']}")
    check("Force, maximum" in found["words"] and "ended" in found["words"], "no figures, or not that it ended")
    check(found["paused_words"] == "Resume run" and not found["steps_by_the_wall"], "the buttons do not show how the run stands")
    check(found["knob_anew"] and not found["steer_note"], f"the restart did not restore the knob of the file: {found['steer_note']}")
    check(found["leaks"] == "held", "a request could leave the page")
    socket = sys.argv[3].replace("http:", "ws:").replace("/?", "/live?")
    steer = sys.argv[3].split("?")[0] + "steer"
    check(all(one in (sys.argv[3], socket, steer) for one in found["requests"]), f"requested {found['requests']}")
    check(not found["said"], f"console messages: {found['said']}")
    print("\n".join(wrong) if wrong else "as it should be")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
