"""Measures the time from the command to the first tick, and writes figures as `thimble study` does: reported, never pass
criteria.

  start_bench.py BUILD_DIR FIGURES.json

A run of 0.01 s with one object of 10^6 triangles from an OFF file of 38 MB (a bumpy ring): without the mesh cache, with an
empty one, which is written, and with a filled one. Then the scene `elephant`. The kinds alternate in each round; the
figures are medians of the rounds. The file is in the kernel's cache.
"""
import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

ROUNDS = 5
AROUND, ACROSS = 1000, 500  # quads of the ring
SCENE = """name: million
arm: vintage_phantom
duration: 1
objects:
  - {name: ring, mesh: ring.off, scale: 1, position: [0, 0, -0.02], stiffness: 500, damping: 1}
hand:
  path:
    - {t: 0, at: [0.03, 0, 0.02]}
    - {t: 1, at: [0.03, 0, 0.01]}
"""
# Goals: seconds by the wall clock, MB of memory.
GOALS = {"none": (0.6, 150), "written": (None, 150), "read": (0.6, 150), "elephant": (0.2, None)}


def write_ring(file):
    """Writes a ring with a tube of 12 mm around a circle of 30 mm, a row at a time: the memory of this process would count
    as that of the programs that it starts (getrusage(2))."""
    with file.open("w", encoding="ascii") as out:
        out.write(f"OFF\n{AROUND * ACROSS} {2 * AROUND * ACROSS} 0\n")
        for i in range(AROUND):
            u = 2 * math.pi * i / AROUND
            for j in range(ACROSS):
                v = 2 * math.pi * j / ACROSS
                tube = 0.012 + 0.0005 * math.sin(7 * u) * math.sin(5 * v)
                ring = 0.03 + tube * math.cos(v)
                out.write(f"{ring * math.cos(u):.7f} {ring * math.sin(u):.7f} {tube * math.sin(v):.7f}\n")
        for i in range(AROUND):
            for j in range(ACROSS):
                a, b = i * ACROSS + j, (i + 1) % AROUND * ACROSS + j
                c, d = (i + 1) % AROUND * ACROSS + (j + 1) % ACROSS, i * ACROSS + (j + 1) % ACROSS
                out.write(f"3 {a} {b} {c}\n3 {a} {c} {d}\n")


def spend(command, cache):
    """Runs a command. Returns wall-clock seconds, processor seconds and MB of memory at most."""
    environment = dict(os.environ)
    environment.pop("THIMBLE_MESH_CACHE", None)
    if cache is not None:
        environment["THIMBLE_MESH_CACHE"] = str(cache)
    begin = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, env=environment)
    _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        raise RuntimeError(f"{command} failed")
    return time.monotonic() - begin, used.ru_utime + used.ru_stime, used.ru_maxrss * 1.024e-3


def figure(name, value, unit, most=None):
    """One entry of figures.json (app/report/figure_output.cpp); `most`: the goal is to stay below it."""
    entry = {"name": name, "value": value, "unit": unit}
    if most is not None:
        entry.update(goal=f"< {most:.4g}", met=value < most)
    return entry


def main():
    build, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    thimble = str(build / "app" / "thimble")
    spent = {kind: [] for kind in GOALS}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_ring(folder / "ring.off")
        scene, cache = folder / "million.yaml", folder / "cache"
        scene.write_text(SCENE, encoding="ascii")
        run = [thimble, "run", str(scene), "--duration", "0.01"]
        for _ in range(ROUNDS):
            spent["none"].append(spend(run, None))
            shutil.rmtree(cache, ignore_errors=True)
            spent["written"].append(spend(run, cache))
            spent["read"].append(spend(run, cache))
            spent["elephant"].append(spend([thimble, "run", "elephant", "--duration", "0.01"], None))
    figures = []
    for kind, rounds in spent.items():
        wall, processor, memory = (statistics.median(column) for column in zip(*rounds))
        name = "start.elephant" if kind == "elephant" else f"start.million.cache_{kind}"
        figures.append(figure(f"{name}.clock", wall, "s", GOALS[kind][0]))
        figures.append(figure(f"{name}.processor", processor, "s"))
        figures.append(figure(f"{name}.memory", memory, "MB", GOALS[kind][1]))
    for one in figures:
        goal = f"goal {one['goal']}: {'met' if one['met'] else 'NOT MET'}" if "goal" in one else ""
        print(f"{one['name']:40}{one['value']:10.3f} {one['unit']:6}{goal}")
    out.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
