"""Several runs and own signals on one time line; pages in notebooks, files and browsers."""

import base64
import html
import json
import re
import shutil
import subprocess

import numpy as np
import pytest
import thimble


@pytest.fixture(scope="module")
def run():
    return thimble.run("rubber", seconds=1.5)


def data_of(page):
    return json.loads(re.search(r"^const DATA = (.*);$", page.html, re.MULTILINE)[1])


def curve_of(page, row, name):
    (curve,) = [c for r in data_of(page)["rows"] if r["name"] == row for c in r["curves"] if c["name"] == name]
    time, values = (np.frombuffer(base64.b64decode(curve[key]), "<f4") for key in ("time", "values"))
    assert len(time) == len(values) == curve["n"]
    return curve["begin"] + time.astype(float), values


def test_curves_of_a_run_are_its_values(run):
    timeline = thimble.Timeline({"a": run}, rows=["force", "depth", "tip_z"])
    page = timeline.page()
    time, force = curve_of(page, "force on the hand", "a")
    np.testing.assert_allclose(time, run.time, atol=1e-6)
    np.testing.assert_allclose(force, np.linalg.norm(run.force, axis=1), rtol=1e-6)
    np.testing.assert_allclose(curve_of(page, "depth", "a")[1], 1e3 * run.depth, rtol=1e-6)
    np.testing.assert_allclose(curve_of(page, "tip z", "a")[1], 1e3 * run.tip[:, 2], rtol=1e-6)
    assert [row["unit"] for row in data_of(page)["rows"]] == ["N", "mm", "mm"] and timeline.rows[2] == "tip z"


def test_runs_share_rows_and_shift_moves_one(run):
    timeline = thimble.Timeline([run, run], rows="depth")
    timeline.add_run("late", run, shift=0.25)
    assert timeline.rows == ["depth"]
    names = [curve["name"] for curve in data_of(timeline.page())["rows"][0]["curves"]]
    assert names == ["rubber, vintage_phantom 1", "rubber, vintage_phantom 2", "late"]
    np.testing.assert_allclose(curve_of(timeline.page(), "depth", "late")[0], run.time + 0.25, atol=1e-6)


def test_own_signals_have_a_row_or_share_one(run):
    timeline = thimble.Timeline([run], rows="force")
    timeline.add("muscle", [0, 0.5, 1], [1, np.nan, 3], unit="mV", shift=0.1).add("grip", [0, 1], [[1, 2, 3], [4, 5, 6]])
    timeline.add("limit", [0, 1.5], [1, 1], row="force on the hand")
    assert timeline.rows == ["force on the hand", "muscle", "grip"]
    time, values = curve_of(timeline.page(), "muscle", "muscle")
    np.testing.assert_allclose(time, [0.1, 0.6, 1.1], atol=1e-6)
    assert values[0] == 1 and np.isnan(values[1]) and values[2] == 3
    assert (curve_of(timeline.page(), "grip", "grip y")[1] == [2, 5]).all()
    assert (curve_of(timeline.page(), "force on the hand", "limit")[1] == [1, 1]).all()
    assert "muscle" in repr(timeline) and repr(thimble.Timeline()) == "Timeline(empty; rows none)"


def test_long_curves_keep_their_peaks_and_gaps():
    time = np.arange(300_000) * 1e-3
    values = np.sin(time)
    values[123_456], values[200_001], values[250_000] = 9.0, -8.0, np.nan
    page = thimble.Timeline().add("x", time, values).page()
    kept_time, kept = curve_of(page, "x", "x")
    assert len(kept) < 60_000 and kept[0] == values[0] and kept_time[-1] == pytest.approx(time[-1], abs=0.02)
    assert np.nanmax(kept) == 9 and np.nanmin(kept) == -8 and np.isnan(kept).sum() == 1
    assert kept_time[np.nanargmax(kept)] == pytest.approx(time[123_456], abs=0.02)


@pytest.mark.parametrize(
    "wrong, message",
    [
        (lambda t: t.add("x", [0, 1], [1]), r"values: expected the shape \(2,\)"),
        (lambda t: t.add("x", [1, 0], [1, 2]), "time: expected one or more finite numbers"),
        (lambda t: t.add("x", [], []), "time: expected one or more"),
        (lambda t: t.add("x", [0, np.nan], [1, 2]), "time: expected one or more"),
        (lambda t: t.add("x", ["a"], [1]), "time: expected numbers"),
        (lambda t: thimble.Timeline(rows="heat"), 'there is no row "heat"; there are force, '),
        (lambda t: thimble.Timeline(rows=["tip_w"]), 'no row "tip_w"'),
    ],
)
def test_wrong_signals_are_refused(wrong, message):
    with pytest.raises(thimble.ArgumentError, match=message):
        wrong(thimble.Timeline())


def test_a_file_name_is_no_run():
    with pytest.raises(TypeError, match="run: expected a run"):
        thimble.Timeline({"a": "a.h5"})


def test_names_cannot_end_the_script_of_the_page(run):
    page = thimble.Timeline({"</script><b>": run}, title="</script>").page()
    assert page.html.count("</script>") == 1 and data_of(page)["title"] == "</script>"
    assert "http://" not in page.html and "https://" not in page.html


def test_matplotlib_draws_each_row(run):
    matplotlib = pytest.importorskip("matplotlib", reason="install python3-matplotlib")
    matplotlib.use("Agg")
    figure = thimble.Timeline({"a": run}, rows=["force", "depth"]).add("muscle", [0, 1], [1, 2], unit="mV").plot()
    assert [axis.get_ylabel() for axis in figure.axes] == ["force on the hand (N)", "depth (mm)", "muscle (mV)"]
    np.testing.assert_allclose(figure.axes[1].lines[0].get_ydata(), 1e3 * run.depth)
    matplotlib.pyplot.close("all")


def test_a_notebook_shows_a_page_in_a_frame_without_access(run):
    timeline = thimble.Timeline([run])
    shown = timeline._repr_html_()
    frame = re.fullmatch(r'<iframe sandbox="allow-scripts" style="([^"]*)" srcdoc="([^"]*)"></iframe>', shown)
    assert "height:510px" in frame[1] and html.unescape(frame[2]) == timeline.page().html


def test_page_is_saved_as_a_file(run, tmp_path):
    timeline = thimble.Timeline([run])
    timeline.save(tmp_path / "a.html")
    assert (tmp_path / "a.html").read_text(encoding="utf-8") == timeline.page().html
    assert "MB" in repr(timeline.page())


def browser(page, tmp_path, *options):
    """Returns the DOM of a page after its scripts have run, and a picture of it."""
    chromium = shutil.which("chromium")
    if chromium is None:
        pytest.skip("install chromium")
    (tmp_path / "page.html").write_text(page, encoding="utf-8")
    picture = tmp_path / "page.png"
    common = [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=1280,720",
              "--virtual-time-budget=4000", "--disable-features=IsolateSandboxedIframes", f"--user-data-dir={tmp_path / 'profile'}", *options]
    address = (tmp_path / "page.html").as_uri()
    dom = subprocess.run([*common, "--dump-dom", address], capture_output=True, text=True, timeout=120).stdout
    subprocess.run([*common, f"--screenshot={picture}", address], capture_output=True, timeout=120)
    return dom, picture


def share_of(picture, colour):
    """Returns the number of pixels near a colour."""
    image = pytest.importorskip("PIL.Image", reason="install python3-pil")
    pixels = np.asarray(image.open(picture).convert("RGB")).astype(int)
    return int((np.abs(pixels - colour).max(axis=2) < 12).sum())


def test_a_browser_draws_the_curves_also_in_a_notebook_frame(run, tmp_path):
    timeline = thimble.Timeline({"a": run}).add("muscle", run.time, np.sin(9 * run.time), unit="mV")
    dom, picture = browser(timeline.page().html, tmp_path)
    assert dom.count("<canvas") == 4 and ">0 to 1.499 s</output>" in dom and "muscle, mV" in dom
    assert share_of(picture, (0x00, 0x72, 0xB2)) > 1500 and share_of(picture, (0xD5, 0x5E, 0x00)) > 500
    _, picture = browser("<body style='margin:0'>" + timeline._repr_html_(), tmp_path)
    assert share_of(picture, (0x00, 0x72, 0xB2)) > 1000


def test_show_plays_the_same_run(run):
    page = thimble.show(run, height=700)
    assert "rubber" in page.html and page.height == 700 and len(page.html) > 500_000
    assert f"{1e3 * run.depth.max():.4g}"[:4] in page.html  # the same figures


def test_show_takes_recordings_and_time_lines(run, tmp_path):
    record = tmp_path / "a.h5"
    thimble.run("box", seconds=0.5, record=record)
    assert len(thimble.show(record).html) > 500_000
    assert data_of(thimble.show(thimble.read_recording(record)))["title"] == "box, vintage_phantom"
    timeline = thimble.Timeline([run])
    assert thimble.show(timeline).html == timeline.page().html


def test_show_draws_curves_of_runs_that_cannot_be_repeated():
    run = thimble.run("box", seconds=0.2, law=lambda tick: 0.5 * tick.force_wanted)
    assert len(data_of(thimble.show(run))["rows"]) == 3


def test_a_timeline_below_a_run_follows_the_moment_that_is_played(run, tmp_path):
    timeline = thimble.Timeline({"a": run}, title="below").add("muscle", [0, 1], [1, 2])
    page = thimble.show(run, timeline=timeline)
    assert page.height == 1000 and "below" in page.html
    dom, _ = browser(page.html, tmp_path, "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
    peak = run.time[np.linalg.norm(run.force, axis=1).argmax()]  # where the page of a run begins
    assert float(re.search(r'data-time="([^"]*)"', dom)[1]) == pytest.approx(peak, abs=2e-3)


def test_a_timeline_shows_the_values_at_a_posted_time(run, tmp_path):
    image = pytest.importorskip("PIL.Image", reason="install python3-pil")
    frame = "<body style='margin:0'>" + thimble.Timeline({"a": run})._repr_html_()
    post = "<script>onload = () => setTimeout(() => document.querySelector('iframe').contentWindow.postMessage({time: %s}, '*'), 500)</script>"
    pictures = []
    for time in ("1.2", "'x'"):
        _, picture = browser(frame + post % time, tmp_path)
        pictures.append(np.asarray(image.open(picture).convert("L")).astype(int))
    changed = (np.abs(pictures[0] - pictures[1])[40:500] > 20).mean(axis=0)  # share of each column of pixels
    x = 14 + 58 + (1.2 - run.time[0]) / (run.time[-1] - run.time[0]) * (1280 - 28 - 66)
    assert abs(int(changed.argmax()) - x) < 2 and changed.max() > 0.5


def test_show_refuses_other_things(tmp_path):
    with pytest.raises(TypeError, match="run: expected a Run"):
        thimble.show(3)
    with pytest.raises(thimble.ArgumentError, match="thimble replay: .*no_such"):
        thimble.show("no_such.h5")
    with pytest.raises(TypeError, match="timeline: expected a Timeline"):
        thimble.show(thimble.Timeline(), timeline=[])
    with pytest.raises(thimble.ArgumentError, match="height: expected"):
        thimble.show(thimble.Timeline(), height=3)
