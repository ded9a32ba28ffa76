#!/usr/bin/env python3
"""Compares the log of a program (proof.h) with the recordings of its arms.

check.py LOG RECORDING.csv...: one recording for each arm, in the order of the arms. Each position that the program read is
in the recording. After the soft start, the tick after it has the requested force, and the motors got that force within 1 %.
"""
import csv
import itertools
import math
import sys

SAME = 1e-9  # m or N: both files have all digits
LARGEST_ERROR = 0.01  # of the requested force
SMALLEST = 0.05  # N; smaller forces are compared with 1 % of this
SOFT_START_NS = 500_000_000  # the rise of the first force is over
WINDOW = 100  # ticks; chosen: above the ticks in which the tip rests at first
FORCES_MIN = 200


def recording(path):
    """Returns time, position, requested force and sent force of all ticks."""
    with open(path) as file:
        lines = csv.reader(itertools.dropwhile(lambda line: not line.startswith("tick,"), file))
        titles = next(lines)
        time = titles.index("time [ns]")
        places = [titles.index(title) for title in ("p_WT.x [m]", "f_wanted_W.x [N]", "f_sent_W.x [N]")]
        return [(int(line[time]), *([float(x) for x in line[place:place + 3]] for place in places)) for line in lines]


def main():
    log, *files = sys.argv[1:]
    ticks = [recording(file) for file in files]
    place = [0] * len(files)
    compared = [0] * len(files)
    begin = [None] * len(files)
    lost, worst_request, worst_motors, largest = 0, 0.0, 0.0, 0.0
    for line in open(log):
        arm, *numbers = line.split()
        arm, numbers = int(arm), [float(x) for x in numbers]
        position, force = numbers[:3], numbers[3:]
        end = len(ticks[arm]) - 1
        if begin[arm] is not None:
            end = min(end, place[arm] + WINDOW)
        here = [tick for tick in range(place[arm], end) if math.dist(ticks[arm][tick][1], position) < SAME]
        if not here:
            lost += 1
            continue
        # While the tip rests, several ticks have this position: take the first of them with the force.
        rest = [tick for nth, tick in enumerate(here) if tick == here[0] + nth]
        tick = next((tick for tick in rest if math.dist(ticks[arm][tick + 1][2], force) < SAME), rest[0])
        place[arm] = tick + 1
        time, _, requested, sent = ticks[arm][tick + 1]
        begin[arm] = time if begin[arm] is None else begin[arm]
        if time - begin[arm] < SOFT_START_NS:
            continue
        size = max(math.hypot(*force), SMALLEST)
        compared[arm] += size > SMALLEST
        largest = max(largest, size)
        worst_request = max(worst_request, math.dist(requested, force))
        worst_motors = max(worst_motors, math.dist(sent, force) / size)
    print(f"{log}: compared {compared} forces up to {largest:.2f} N; {lost} positions not recorded; requested force at most "
          f"{worst_request:.1e} N off, motors {100 * worst_motors:.2g} %")
    right = lost == 0 and worst_request < SAME and worst_motors <= LARGEST_ERROR and min(compared) >= FORCES_MIN
    sys.exit(0 if right else 1)


main()
