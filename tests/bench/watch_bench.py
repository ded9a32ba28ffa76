"""Measures the cost of viewers for a run, and writes figures as `thimble study` does: reported, never pass criteria.

  watch_bench.py BUILD_DIR SCENE FIGURES.json      SCENE: shown on the page (the scan of an elephant)

- The page of a run: runs with and without it alternate; the figure is the median of the differences of the pairs.
- The live page: runs in real time with and without a watching browser alternate. Chromium draws in software here, so its
  own time, which another computer or a graphics card would take, has no goal.
- The viewer's picture of 82,000 triangles (bench_view), by processor time over all cores, which does not depend on other
  load. The wall time is at least this time divided by the number of cores.
Each figure has processor seconds and wall-clock seconds; only the latter depend on other load.
"""
import asyncio
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import websockets

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "program"))
from page_browser import DRAWN, Tab, in_chromium  # noqa: E402

PAIRS = 3  # fewer runs would let one disturbed run change the median
LIVE_PAIRS = 3
LIVE_SECONDS = 10
PICTURE_MS = 1000 / 30  # at 30 pictures a second
CORES = 2  # cores that a picture may use: a lab computer has at least two


def figure(name, value, unit, most=None, note=""):
    """One entry of figures.json (app/report/figure_output.cpp); `most`: the goal is to stay below it."""
    entry = {"name": name, "value": value, "unit": unit}
    if most is not None:
        entry.update(goal=f"< {most:.4g}", met=value < most)
    if note:
        entry["note"] = note
    return entry


def spend(command, **options):
    """Runs a command to its end. Returns wall-clock seconds and processor seconds."""
    begin = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, **options)
    _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        raise RuntimeError(f"{command} failed")
    return time.monotonic() - begin, used.ru_utime + used.ru_stime


def processor_seconds(pid):
    """Returns the processor seconds of a process (/proc/PID/stat, proc(5))."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure_page(thimble, scene, folder):
    """Measures the page of a run, in addition to the run and its report."""
    without = dict(os.environ, XDG_DATA_DIRS=str(folder / "nowhere"))  # has no libraries of the page
    clock, processor = [], []
    for _ in range(PAIRS):
        plain = spend([thimble, "run", scene, "--no-view", "--report", folder / "plain"], env=without,
                      stderr=subprocess.DEVNULL)  # hides the message about the missing page
        paged = spend([thimble, "run", scene, "--no-view", "--report", folder / "paged"])
        clock.append(paged[0] - plain[0])
        processor.append(paged[1] - plain[1])
    if (folder / "plain/index.html").exists() or not (folder / "paged/index.html").exists():
        raise RuntimeError("the pairs do not differ by the page: are libjs-three and libjs-dygraphs installed?")
    note = f"median of {PAIRS} pairs"
    return [figure("page.clock", statistics.median(clock), "s", 1.5, note),
            figure("page.processor", statistics.median(processor), "s", 1.5, note)]


async def watch(address, page, viewer):
    """Watches a live page. Returns the server's processor seconds per second, and the pictures drawn per second."""
    async with websockets.connect(address, max_size=None) as socket:
        tab = Tab(socket)
        await tab.call("Page.enable")
        await tab.call("Page.navigate", url=page)
        await tab.wait_for("window.thimblePage !== undefined && thimblePage.begun")
        await tab.value(DRAWN)
        drawn = await tab.value("thimblePage.state().drawn")
        begin, used = time.monotonic(), processor_seconds(viewer)
        await asyncio.sleep(LIVE_SECONDS)
        seconds, used = time.monotonic() - begin, processor_seconds(viewer) - used
        return used / seconds, (await tab.value("thimblePage.state().drawn") - drawn) / seconds


def live_run(thimble, scene, folder, chromium):
    """Runs in real time. Returns the report, and the result of `watch` if a browser is given."""
    name, report = f"bench_{os.getpid()}", folder / "live"
    run = subprocess.Popen([thimble, "run", scene, "--clock", "wall", "--duration", "300", "--no-view", "--name", name,
                            "--report", report], stdout=subprocess.DEVNULL)
    seen = None
    try:
        for _ in range(600):
            listed = subprocess.run([thimble, "view", "--list"], capture_output=True, text=True, check=False).stdout
            if f"{name}:" in listed:
                break
            time.sleep(0.1)
        if chromium:
            viewer = subprocess.Popen([thimble, "view", name, "--web"], stdout=subprocess.PIPE, text=True)
            page = next(line.split()[1] for line in viewer.stdout if line.startswith("Open "))
            seen = in_chromium(chromium, lambda tab: watch(tab, page, viewer.pid))
        else:
            time.sleep(LIVE_SECONDS)
    finally:
        subprocess.run([thimble, "view", name, "--stop"], check=False)
        run.wait()
    if chromium:
        viewer.wait()
    return json.loads((report / "report.json").read_text(encoding="utf-8")), seen


def measure_live(thimble, scene, folder, chromium):
    """Measures the live page during a servo loop at 1 kHz."""
    served, pictures, missed, missed_alone = [], [], [], []
    for _ in range(LIVE_PAIRS):
        alone, _ = live_run(thimble, scene, folder, None)
        watched, seen = live_run(thimble, scene, folder, chromium)
        served.append(seen[0])
        pictures.append(seen[1])
        missed_alone.append(missed_percent(alone))
        missed.append(missed_percent(watched))
    note = f"median of {LIVE_PAIRS} runs"
    return [figure("live_page.server", 100 * statistics.median(served), "% of one core", 5, note),
            figure("live_page.pictures", statistics.median(pictures), "1/s", note="Chromium draws in software"),
            figure("live_page.missed_beside_alone", statistics.median(missed) - statistics.median(missed_alone),
                   "% of ticks", note="0 wanted; Chromium takes the same cores"),
            figure("live_page.missed_alone", statistics.median(missed_alone), "% of ticks", note="without a viewer")]


def missed_percent(report):
    """Returns the percentage of requested ticks that were missed."""
    rate = report["rate_Hz"]
    return 100 * max(0.0, 1 - rate["reached"] / rate["asked"])


def measure_viewer(bench):
    """Measures pictures of 82,000 triangles (20 * 4^6) while the camera turns."""
    text = subprocess.run([bench, "--benchmark_filter=subdivisions:6/all:./turns:1", "--benchmark_format=json",
                           "--benchmark_min_time=2"], capture_output=True, text=True, check=True).stdout
    figures = []
    for one in json.loads(text[text.index("{"):])["benchmarks"]:
        if one.get("error_occurred"):
            raise RuntimeError(one["error_message"])
        name = "viewer.everything" if "/all:1/" in one["name"] else "viewer.reduced"
        figures.append(figure(name + ".clock", one["real_time"], "ms", PICTURE_MS, one["label"]))
        figures.append(figure(name + ".processor", one["cpu_time"], "ms", CORES * PICTURE_MS, f"of {CORES} cores"))
    return figures


def show(figures):
    for one in figures:
        goal = f"goal {one['goal']}: {'met' if one['met'] else 'NOT MET'}" if "goal" in one else ""
        note = f"({one['note']})" if "note" in one else ""
        print(f"{one['name']:32}{one['value']:10.3g} {one['unit']:14}{goal:24}{note}", flush=True)
    return figures


def main():
    build, scene, out = (pathlib.Path(one).resolve() for one in sys.argv[1:])
    thimble, bench = build / "app/thimble", build / "tests/bench/bench_view"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        figures = show(measure_viewer(bench))
        figures += show(measure_live(thimble, scene, folder, "chromium"))
        figures += show(measure_page(thimble, scene, folder))
    out.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
