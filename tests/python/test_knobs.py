"""Knobs: settings of a scene that Python changes during the run."""

import time

import numpy as np
import pytest
import thimble


def _stepped(turns, seconds=1.5, **options):
    """Steps a scene, changes knobs at the given ticks, and returns the stepper."""
    stepper = thimble.Stepper("rubber", seconds=seconds, **options)
    for tick in range(round(1000 * seconds)):
        for name, value in turns.get(tick, {}).items():
            stepper.knobs[name] = value
        stepper.step()
    return stepper


def test_knobs_are_listed_with_unit_bounds_and_value():
    knobs = thimble.Stepper("rubber").knobs
    assert "ball: stiffness" in knobs and len(knobs) == len(list(knobs)) == len(knobs.keys()) > 1
    stiffness = knobs["ball: stiffness"]
    assert isinstance(stiffness, thimble.Knob) and stiffness.unit == "N/m"
    assert stiffness.min < stiffness.value < stiffness.max
    assert knobs.ball_stiffness == stiffness == dict(knobs.items())["ball: stiffness"]
    assert "ball_stiffness" in dir(knobs)
    assert f"{stiffness.value:g} N/m" in repr(knobs)
    assert "<td>ball: stiffness</td>" in knobs._repr_html_()


def test_old_names_of_the_bounds_work_with_a_warning():
    knob = thimble.Knob("ball: stiffness", "N/m", 10, 1000, 300)
    with pytest.warns(DeprecationWarning, match="use Knob.min"):
        assert knob.least == 10
    with pytest.warns(DeprecationWarning, match="use Knob.max"):
        assert knob.most == 1000


def test_changes_of_knobs_repeat_bit_identically():
    plain = _stepped({}).ticks().columns.tobytes()
    assert plain == thimble.run("rubber", seconds=1.5).columns.tobytes()
    turned = _stepped({400: {"ball: stiffness": 50}}).ticks()
    assert turned.columns.tobytes() == _stepped({400: {"ball: stiffness": 50}}).ticks().columns.tobytes()
    plain = _stepped({}).ticks()
    assert (turned.force_wanted[:400] == plain.force_wanted[:400]).all()
    assert np.abs(turned.force_wanted - plain.force_wanted).max() > 0.1  # N


def test_change_starts_at_the_next_tick_and_reaches_its_value():
    stepper = thimble.Stepper("rubber")
    stepper.step()
    before = stepper.knobs.ball_stiffness.value
    stepper.knobs.ball_stiffness = 123
    assert stepper.knobs.ball_stiffness.value == before
    stepper.step()
    assert 123 <= stepper.knobs.ball_stiffness.value < before
    for _ in range(60):  # no contact yet, so the change takes at most 50 ms
        stepper.step()
    assert stepper.knobs.ball_stiffness.value == 123


def test_change_in_contact_causes_no_step_of_force():
    turns = {tick: {"ball: stiffness": 800 if tick // 100 % 2 else 50} for tick in range(300, 1500, 100)}
    stepper = _stepped(turns)
    plain = thimble.run("rubber", seconds=1.5)
    step = np.abs(np.diff(stepper.ticks().force_wanted, axis=0)).max()
    assert step < np.abs(np.diff(plain.force_wanted, axis=0)).max() + 0.1  # N
    assert np.abs(stepper.ticks().force_wanted - plain.force_wanted).max() > 0.1  # the change has an effect


def test_custom_law_gets_the_force_with_changed_knobs():
    turns = {200: {"ball: stiffness": 50}}
    with_law = _stepped(turns, law=lambda tick: None)
    assert with_law.ticks().force_wanted.tobytes() == _stepped(turns).ticks().force_wanted.tobytes()


def test_wrong_knob_raises_and_changes_nothing():
    stepper = thimble.Stepper("rubber")
    knobs, before = stepper.knobs, stepper.knobs.values()
    maximum = f"{knobs.ball_stiffness.max:g}"
    for wrong, error, message in [
        (lambda: knobs.__setitem__("ball: stifness", 3), thimble.ArgumentError, "no knob 'ball: stifness'.*ball: stiffness"),
        (lambda: knobs["nothing"], thimble.ArgumentError, "it has ball: stiffness"),
        (lambda: knobs.__setitem__("ball: stiffness", 1e9), ValueError, rf"must be 0 to {maximum} N/m, found 1e\+09; the knob is unchanged"),
        (lambda: knobs.__setitem__("ball: stiffness", float("nan")), thimble.ArgumentError, "found nan"),
        (lambda: knobs.__setitem__("ball: stiffness", "soft"), TypeError, "expected a number, found 'soft'"),
        (lambda: setattr(knobs, "stifness", 3), AttributeError, "it has ball_stiffness"),
        (lambda: knobs.stifness, AttributeError, "no knob 'stifness'"),
    ]:
        with pytest.raises(error, match=message):
            wrong()
    stepper.step()
    assert knobs.values() == before and not hasattr(knobs, "stifness")
    stepper.stop()
    with pytest.raises(thimble.Error, match="over"):
        knobs["ball: stiffness"] = 100
    several = thimble.Stepper("two_hands").knobs
    assert len(several) == 0 and repr(several) == "no knobs"
    with pytest.raises(thimble.ArgumentError, match="it has none"):
        several["anything"] = 1


def test_knobs_change_a_run_in_real_time():
    with thimble.open("rubber", "sim", seconds=60) as live:
        live.knobs["ball: stiffness"] = 123
        deadline = time.monotonic() + 30
        while live.knobs.ball_stiffness.value != 123 and time.monotonic() < deadline:
            time.sleep(0.01)
        assert live.knobs.ball_stiffness.value == 123
