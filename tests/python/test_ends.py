"""Runs that are deleted, still open at the end of the program, or part of a reference cycle; laws that fail."""

import gc
import subprocess
import sys
import weakref

import pytest
import thimble


def last_tick(file) -> int:
    recording = thimble.read_recording(file)
    assert recording.complete
    return int(recording.columns["tick"][-1]) + 1 if len(recording) else 0


@pytest.mark.parametrize("steps", [0, 500, 5000])
def test_dropped_stepper_keeps_its_recording(tmp_path, steps):
    stepper = thimble.Stepper("box", seconds=60, record=tmp_path / "touch.h5")
    for _ in range(steps):
        assert stepper.step()
    del stepper
    gc.collect()
    assert last_tick(tmp_path / "touch.h5") == steps


def test_stepper_in_a_with_closes_its_recording(tmp_path):
    with thimble.Stepper("box", seconds=60, record=tmp_path / "touch.h5") as stepper:
        for _ in range(300):
            stepper.step()
    assert stepper.end == "stopped" and not stepper.step()
    assert last_tick(tmp_path / "touch.h5") == 300


def test_exception_in_a_with_closes_the_recording(tmp_path):
    with pytest.raises(ValueError, match="on purpose"):
        with thimble.Stepper("box", seconds=60, record=tmp_path / "touch.h5") as stepper:
            for _ in range(300):
                stepper.step()
            raise ValueError("on purpose")
    assert last_tick(tmp_path / "touch.h5") == 300


def test_dropped_live_keeps_its_recording(tmp_path):
    live = thimble.open("box", "sim", seconds=600, record=tmp_path / "touch.h5")
    while live.tick is None or live.tick.columns["tick"] < 200:
        pass
    del live
    gc.collect()
    assert last_tick(tmp_path / "touch.h5") > 200


PROGRAM = """
import sys, thimble
def keep(run):
    keep.run = run                                   # reached from a module: freed late, if at all
{make}
{end}
"""
STEPPER = """
run = thimble.Stepper("box", seconds=60, record=sys.argv[1])
for _ in range(500):
    run.step()
keep(run)
"""
CYCLE = """
run = thimble.Stepper("box", seconds=60, record=sys.argv[1], law=lambda tick: run and None)
for _ in range(500):
    run.step()
run.itself = run
"""
LIVE = """
run = thimble.open("box", "sim", seconds=600, record=sys.argv[1])
while run.tick is None or run.tick.columns["tick"] < 400:
    pass
keep(run)
"""


@pytest.mark.parametrize("make", [STEPPER, CYCLE, LIVE], ids=["stepper", "cycle", "live"])
@pytest.mark.parametrize("end, code", [("", 0), ("raise ValueError()", 1), ("sys.exit(3)", 3)], ids=["end", "error", "exit"])
def test_end_of_the_program_closes_recordings(tmp_path, make, end, code):
    file = tmp_path / "touch.h5"
    program = PROGRAM.format(make=make, end=end)
    done = subprocess.run([sys.executable, "-c", program, str(file)], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == code, done.stderr
    assert last_tick(file) == 500 if make != LIVE else last_tick(file) > 400


def test_failed_law_raises_at_each_step():
    stepper = thimble.Stepper("box", law=lambda tick: 1 / 0)
    for _ in range(3):
        with pytest.raises(ZeroDivisionError) as caught:
            stepper.step()
        assert caught.traceback[-1].name == "<lambda>"
    stepper.stop()
    with pytest.raises(ZeroDivisionError):
        stepper.step()


@pytest.mark.parametrize("law", [lambda tick: "no force", lambda tick: [1, 2], lambda tick: [1, 2, 3, 4]])
def test_wrong_return_value_of_a_law_raises_at_each_step(law):
    stepper = thimble.Stepper("box", law=law)
    for _ in range(3):
        with pytest.raises(ValueError, match="three numbers"):
            stepper.step()


class Law:
    """A law that refers to the run that calls it."""

    def __init__(self, fails):
        self.fails = fails
        self.run = None

    def __call__(self, tick):
        if self.fails:
            raise ValueError("on purpose")


@pytest.mark.parametrize("fails", [False, True])
def test_cycle_through_a_law_is_freed(fails):
    gone = []
    for _ in range(20):
        law = Law(fails)
        law.run = thimble.Stepper("box", seconds=1, law=law)
        try:
            law.run.step()
        except ValueError:
            pass
        gone.append(weakref.ref(law.run))
        del law
    gc.collect()
    assert sum(one() is not None for one in gone) == 0


def test_cycle_through_a_compiled_law_is_freed():
    @thimble.LawFunction
    def none(time, tip, velocity, wanted, force, data):
        for k in range(3):
            force[k] = 0

    class Kept:
        pass

    gone = []
    for _ in range(5):
        law = thimble.compiled_law(none)
        stepper = thimble.Stepper("box", seconds=1, law=law)
        kept = Kept()
        kept.stepper, stepper.kept = stepper, kept
        stepper.step()
        gone.append(weakref.ref(stepper))
        del law, stepper, kept
    gc.collect()
    assert sum(one() is not None for one in gone) == 0


def test_garbage_collector_may_run_while_a_run_is_created():
    gc.set_threshold(1)
    try:
        for _ in range(5):
            assert thimble.Stepper("box", seconds=1, law=lambda tick: None).step()
            with pytest.raises(thimble.ArgumentError):
                thimble.Stepper("no_such_scene", law=lambda tick: None)
    finally:
        gc.set_threshold(700, 10, 10)
