"""Functions of the package besides run(): names, errors, arms, real time, studies."""

import inspect
import os
import signal
import subprocess
import sys
import time
import warnings

import numpy as np
import pytest
import thimble


def test_knows_scenes_and_arms_by_name(source):
    scenes = {scene.name: scene for scene in thimble.scenes()}
    assert {"elephant", "box", "clay"} <= set(scenes)
    assert scenes["elephant"].path.is_file() and "elephant" in scenes["elephant"].description
    assert "vintage_phantom" in {arm.name for arm in thimble.arms()}
    by_path = thimble.run(source / "app/scenes/box.yaml", seconds=0.1)
    assert by_path.columns.tobytes() == thimble.run("box", seconds=0.1).columns.tobytes()


@pytest.mark.parametrize(
    "wrong, message",
    [
        (lambda: thimble.run("elefant"), "Known by name: .*elephant"),
        (lambda: thimble.run("./no_such.yaml"), "no_such"),
        (lambda: thimble.run("box", arm="no_such_arm"), "vintage_phantom"),
        (lambda: thimble.run("box", seconds=-1), "seconds: expected"),
        (lambda: thimble.run("box", seconds=float("nan")), "seconds: expected"),
        (lambda: thimble.run("box", quality="best"), "draft, normal, reference or auto"),
        (lambda: thimble.run("box", record="/no/such/folder/a.h5"), "/no/such/folder"),
        (lambda: thimble.read_recording("no_such.h5"), "no such file"),
        (lambda: thimble.Simulator("box"), "no arm file with this name"),
        (lambda: thimble.Simulator(hand=(1, 1, 1)), "does not reach"),
        (lambda: thimble.Simulator(rate=0), "rate: expected"),
        (lambda: thimble.Stepper("box").mesh("no_such_object"), "no object"),
        (lambda: thimble.Stepper("box").summary(), "has not ended"),
        (lambda: thimble.open("box", "WH99", agree=True), "WH99"),
        (lambda: thimble.study("no_such_study"), 'no study "no_such_study"; there are cost, friction, '),
        (lambda: thimble.study("box", no_such_option=3), "study box: .*--no-such-option"),
    ],
)
def test_wrong_arguments_raise_a_clear_error(wrong, message):
    with pytest.raises(thimble.Error, match=message):
        wrong()


def test_a_stepper_takes_the_options_of_run():
    assert inspect.signature(thimble.Stepper).parameters == inspect.signature(thimble.run).parameters


def test_a_stepper_refuses_options_of_open():
    with pytest.raises(TypeError, match="'device'"):
        thimble.Stepper("box", device="sim")


def test_wrong_types_are_refused_before_the_run():
    stepper = thimble.Stepper("box")
    with pytest.raises(ValueError, match="hand: expected three numbers"):
        stepper.step(hand=(0, 0))
    with pytest.raises(ValueError, match="hand: expected three numbers"):
        stepper.step(hand=(0, 0, float("nan")))
    with pytest.raises(TypeError):
        thimble.run("box", law=3)
    assert stepper.tick is None


@pytest.mark.parametrize(
    "wrong, message",
    [
        (lambda: thimble.run("nope"), "Known by name: .*elephant"),
        (lambda: thimble.run("./nope.yaml"), "nope.yaml"),
        (lambda: thimble.run("box", arm="nope"), "vintage_phantom"),
        (lambda: thimble.run("box", seconds=-1), "seconds: expected 0.001 to 86400, found -1"),
        (lambda: thimble.run("box", seed=-1), "seed: expected a whole number from 0"),
        (lambda: thimble.run("box", seed=0.5), "seed: expected a whole number"),
        (lambda: thimble.run("box", quality="best"), "quality: expected draft"),
        (lambda: thimble.run("box", set={"nope.stiffness": 1}), 'no "nope"'),
        (lambda: thimble.Stepper("box").step(hand=(0, 0)), "hand: expected three numbers"),
        (lambda: thimble.Stepper("box").step(hand="left"), "hand: expected three numbers"),
        (lambda: thimble.Stepper("box").mesh("nope"), "no object"),
        (lambda: thimble.Simulator("nope"), "no arm file with this name"),
        (lambda: thimble.Simulator(rate=0), "rate: expected"),
        (lambda: thimble.Simulator().step(force=(1, 2)), "force: expected three numbers"),
        (lambda: thimble.open("box", "WH99", agree=True), "WH99"),
        (lambda: thimble.open("nope", "sim"), "Known by name"),
        (lambda: thimble.open("box", "sim", ros2={"nope": 1}), "expected namespace"),
        (lambda: thimble.read_recording("nope.h5"), "no such file"),
        (lambda: thimble.study("nope"), "there are cost"),
    ],
)
def test_unknown_names_and_values_out_of_bounds_are_refused(wrong, message):
    with pytest.raises(thimble.ArgumentError, match=message) as caught:
        wrong()
    assert isinstance(caught.value, thimble.Error) and isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    "wrong, message",
    [
        (lambda: thimble.run(3), "scene: expected a file, a name, a dict or YAML text, found 3"),
        (lambda: thimble.run("box", arm=3), "arm: expected a file or a name, found 3"),
        (lambda: thimble.run("box", seconds="2"), "seconds: expected a number, found '2'"),
        (lambda: thimble.run("box", seed="a"), "seed: expected a number, found 'a'"),
        (lambda: thimble.run("box", quality=1), "quality: expected draft"),
        (lambda: thimble.run("box", record=3), "record: expected a file"),
        (lambda: thimble.run("box", set=[("ball.stiffness", 3)]), "set: expected a dict"),
        (lambda: thimble.run("box", set={3: 4}), "set: expected paths as text, found 3"),
        (lambda: thimble.run("box", law="half"), "law: expected a function"),
        (lambda: thimble.Simulator(rate=None), "rate: expected a number, found None"),
        (lambda: thimble.open("box", 3), "device: expected"),
        (lambda: thimble.read_recording(None), "path: expected a file"),
        (lambda: thimble.study(3), "name: expected the name of a study, found 3"),
        (lambda: thimble.study("box", 3), "arguments: expected a file"),
    ],
)
def test_wrong_types_are_type_errors_with_the_expected_type(wrong, message):
    with pytest.raises(TypeError, match=message):
        wrong()


def test_mistake_in_a_file_is_no_argument_error(tmp_path):
    (tmp_path / "bad.yaml").write_text("name: bad\n")
    (tmp_path / "bad.h5").write_text("no recording")
    for wrong in (lambda: thimble.run(tmp_path / "bad.yaml"), lambda: thimble.read_recording(tmp_path / "bad.h5")):
        with pytest.raises(thimble.Error) as caught:
            wrong()
        assert not isinstance(caught.value, thimble.ArgumentError)


def test_bad_scenes_name_file_and_line(tmp_path, source):
    text = (source / "app/scenes/box.yaml").read_text()
    bad = tmp_path / "bad.yaml"
    bad.write_text(text.replace("stiffness:", "stifness:"))
    with pytest.raises(thimble.Error, match=r"bad\.yaml:\d+: .*stifness"):
        thimble.run(bad)


def test_too_stiff_wall_raises_a_warning(tmp_path, source):
    text = (source / "app/scenes/box.yaml").read_text()
    lines = ["    stiffness: 50000" if "stiffness:" in line else line for line in text.splitlines()]
    (tmp_path / "stiff.yaml").write_text("\n".join(lines))
    with pytest.warns(RuntimeWarning, match="N/m"):
        thimble.run(tmp_path / "stiff.yaml", seconds=0.01)


def test_cached_warnings_belong_to_their_scene():
    for _ in range(2):  # the second time from the cache
        with pytest.warns(RuntimeWarning, match="50000 N/m"):
            thimble.run("rubber", set={"ball.stiffness": 50000}, seconds=0.01)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            thimble.run("rubber", seconds=0.01)
        with pytest.warns(RuntimeWarning, match="40000 N/m"):
            thimble.run("rubber", set={"ball.stiffness": 40000}, seconds=0.01)


def test_scenes_with_names_of_any_bytes_are_listed(tmp_path):
    folder = tmp_path / "thimble" / "scenes"
    folder.mkdir(parents=True)
    (folder / "latin1.yaml").write_bytes(b"name: a\ndescription: caf\xe9\n")
    (folder / "utf8.yaml").write_bytes("name: b\ndescription: caf\u00e9\n".encode())
    (folder / "broken.yaml").write_bytes(b"description: [\n")
    os.mkfifo(folder / "pipe.yaml")
    open(os.fsencode(folder) + b"/caf\xe9.yaml", "wb").close()
    program = """import thimble
print({one.name: one.description for one in thimble.scenes()})
try:
    thimble.run("none of them")
except thimble.ArgumentError as wrong:
    print("ArgumentError", ascii(str(wrong)))
"""
    done = subprocess.run(
        [sys.executable, "-X", "utf8", "-c", program],
        env={**os.environ, "XDG_DATA_HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        errors="surrogateescape",
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    assert "'latin1': ''" in done.stdout and "'utf8': 'caf\u00e9'" in done.stdout and "'broken': ''" in done.stdout
    assert "pipe" not in done.stdout and "'caf\\udce9'" in done.stdout
    assert "ArgumentError" in done.stdout and "caf\\ufffd" in done.stdout  # the known names


def test_hands_move_only_if_all_arms_reach_their_targets():
    arms = thimble.Simulators(2)
    alone = thimble.Simulators(2)
    for _ in range(50):
        before = arms.step()
        alone.step()
    with pytest.raises(thimble.ArgumentError, match="hand: arm 1 does not reach"):
        arms.step(hand=[(0.03, 0.0, 0.0), (0.1, 0.1, 0.1)])
    for _ in range(500):
        after, undisturbed = arms.step(), alone.step()
    assert after.columns.tobytes() == undisturbed.columns.tobytes()
    assert np.abs(after.tip - before.tip).max() < 2e-3


def test_force_displaces_the_hand_of_a_simulated_arm():
    arm = thimble.Simulator("vintage_phantom", hand=(0, 0, 0))
    rest = [arm.step() for _ in range(300)][-1]
    pushed = [arm.step(force=(0.5, 0, 0)) for _ in range(600)][-1]
    assert pushed.time == pytest.approx(0.899) and pushed.fault == ""
    # The hand's spring is displaced by the force, most along its direction.
    way = pushed.tip - rest.tip
    assert way[0] > 5e-4 and abs(way[0]) > 2 * max(abs(way[1]), abs(way[2]))
    np.testing.assert_allclose(arm.true_force, [0.5, 0, 0], atol=0.05)
    again = thimble.Simulator("vintage_phantom", hand=(0, 0, 0))
    assert [again.step().tip.tobytes() for _ in range(300)][-1] == rest.tip.tobytes()


def test_nan_force_is_a_fault_until_activate():
    arm = thimble.Simulator()
    arm.step(force=(float("nan"), 0, 0))
    assert arm.step(force=(0.5, 0, 0)).fault == "force_not_finite"
    for _ in range(100):
        assert (arm.step(force=(0.5, 0, 0)).force == 0).all()
    arm.activate()
    assert [arm.step(force=(0.5, 0, 0)) for _ in range(300)][-1].force[0] > 0.4


_BEHIND_SOFTWARE = {"inverse3", "omega3", "touch"}


def test_every_arm_without_vendor_software_can_be_simulated():
    for arm in thimble.arms():
        if arm.name in _BEHIND_SOFTWARE:
            with pytest.raises(thimble.Error, match="simulat"):
                thimble.Simulator(arm.path)
            continue
        simulator = thimble.Simulator(arm.path, hand=_middle(arm.name))
        assert simulator.step().fault == ""


def _middle(name):
    lower, upper = thimble.Simulator(name).workspace if name == "vintage_phantom" else (0, 0)
    return (0.0, 0.0, 0.0) if name == "vintage_phantom" else _reached(name)


def _reached(name):
    for x in np.arange(-0.2, 0.21, 0.05):
        for z in np.arange(-0.2, 0.21, 0.05):
            try:
                thimble.Simulator(name, hand=(x, 0, z))
                return (x, 0, z)
            except thimble.Error:
                pass
    raise AssertionError(f"{name} reaches nothing")


def test_ticks_of_a_run_in_real_time_can_be_read():
    with thimble.open("elephant", "sim", seconds=30) as live:
        begin = time.monotonic()
        while (live.tick is None or live.tick.time < 0.05) and time.monotonic() < begin + 20:
            time.sleep(0.005)
        assert live.running and live.tick.time >= 0.05
        with pytest.raises(thimble.Error, match="has not ended"):
            live.ticks()
    assert not live.running and live.end == "stopped"
    assert live.ticks()[-1].time >= 0.05
    assert "zero force" in live.summary()
    live.stop()  # a second close has no effect


def test_run_in_real_time_refuses_laws_and_steps():
    core = thimble._core
    with pytest.raises(thimble.Error, match="requires virtual time"):
        core.Run("box", real_time=True, law=lambda tick: None)
    with pytest.raises(thimble.Error, match="cannot be stepped"):
        core.Run("box", real_time=True).step()


def test_hold_to_run_gives_no_force_without_the_button():
    with thimble.open("box", "sim", seconds=1.5, hold_to_run="button") as live:
        begin = time.monotonic()
        while live.running and time.monotonic() < begin + 60:
            time.sleep(0.02)
    assert not any(any(tick.force) for tick in live.ticks())


@pytest.mark.parametrize("held", ["foot", "key", "button17", "button0", ""])
def test_hold_to_run_refuses_unknown_buttons(held):
    with pytest.raises(ValueError, match="hold_to_run"):
        thimble.open("box", "sim", hold_to_run=held)


def test_wrong_studies_and_options_are_value_errors(tmp_path):
    with pytest.raises(ValueError, match="there are cost"):
        thimble.study("no_such_study", out=tmp_path)
    with pytest.raises(ValueError, match="no-such-option"):
        thimble.study("box", out=tmp_path, no_such_option=3)


def test_auto_without_an_arm_is_an_error():
    if not _arms_plugged_in():
        with pytest.raises(thimble.Error, match='No arm is plugged in.*thimble doctor.*device="sim"'):
            thimble.open("box", agree=True)


def _arms_plugged_in():
    try:
        return thimble.devices()
    except thimble.Error:  # no USB
        return []


def test_real_arm_requires_agreement():
    with pytest.raises(thimble.Error, match="agree=True"):
        thimble.open("box", "WH02")


def _python(script):
    """Starts a Python that handles SIGINT even if the tests run in the background."""
    return subprocess.Popen(
        [sys.executable, "-c", script],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )


@pytest.mark.parametrize(
    "way_out", ["end", "exception", "SIGTERM", "SIGINT", "SIGHUP", "SIGQUIT", "SIGUSR1", "SIGALRM"]
)
def test_every_end_of_python_sends_zero_force(way_out, tmp_path):
    record = tmp_path / "left.h5"
    last = {"end": "", "exception": "raise SystemExit(3)"}.get(way_out, "time.sleep(60)")
    script = f"""
import time, thimble
live = thimble.open("elephant", "sim", seconds=60, record={str(record)!r})
while live.tick is None or live.tick.time < 0.1: time.sleep(0.005)
print("on", flush=True)
{last}
"""
    with _python(script) as python:
        assert python.stdout.readline() == "on\n"
        if way_out.startswith("SIG"):
            python.send_signal(getattr(signal, way_out))
        code = python.wait(timeout=60)
    by_signal = -getattr(signal, way_out) if way_out.startswith("SIG") else 0
    assert code == {"end": 0, "exception": 3}.get(way_out, by_signal)
    # Closed after the loop had ended with zero force.
    assert thimble.read_recording(record).complete


def test_ctrl_c_ends_a_run_in_virtual_time():
    script = """
import thimble
print("on", flush=True)
try:
    thimble.run("elephant", seconds=86400, quality="reference")
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    with _python(script) as python:
        assert python.stdout.readline() == "on\n"
        time.sleep(0.3)
        python.send_signal(signal.SIGINT)
        assert python.stdout.readline() == "interrupted\n"
        assert python.wait(timeout=60) == 0


def test_study_returns_its_figures(tmp_path):
    figures = thimble.study("box", out=tmp_path / "box")
    assert figures and all(figure.met for figure in figures)
    assert (tmp_path / "box/figures.json").is_file()


@pytest.mark.parametrize("pybind11, numpy, refused", [
    ("2.10.3", "1.24.2", False), ("2.10.3", "2.0.0", True), ("2.11.1", "2.1.0rc1", True), ("2.12.0", "2.0.0", False),
    ("3.0.1", "2.3.0", False), ("", "1.26.4", False), ("", "2.0.0", True), ("2.12", "1.24.2", False),
])
def test_numpy_2_is_refused_by_a_module_for_numpy_1(pybind11, numpy, refused):
    if not refused:
        thimble._numpy_version.check(pybind11, numpy)
        return
    with pytest.raises(thimble.Error, match='Install "numpy<2", or build thimble with pybind11 2.12'):
        thimble._numpy_version.check(pybind11, numpy)
