"""Compiled force laws, and forces of many arms at once."""

import ctypes
import os

import numpy as np
import pytest
import thimble


@thimble.LawFunction
def _half(time, tip, velocity, wanted, force, data):
    for k in range(3):
        force[k] = 0.5 * wanted[k]


@thimble.LawFunction
def _unset(time, tip, velocity, wanted, force, data):
    force[0] = force[1] = 0.1
    if time > 0.05:
        raise ValueError("on purpose")
    force[2] = 0.1


@thimble.LawFunction
def _time_tip_data(time, tip, velocity, wanted, force, data):
    """Sets the force from time, tip and data."""
    force[0], force[1], force[2] = time, tip[2], ctypes.cast(data, ctypes.POINTER(ctypes.c_double))[1]


def test_compiled_law_is_bit_identical_to_a_python_law():
    python = thimble.run("elephant", seconds=2, law=lambda tick: 0.5 * tick.force_wanted)
    for law in (_half, thimble.compiled_law(_half), thimble.compiled_law(ctypes.cast(_half, ctypes.c_void_p).value)):
        compiled = thimble.run("elephant", seconds=2, law=law)
        assert compiled.columns.tobytes() == python.columns.tobytes()
    assert np.linalg.norm(python.force, axis=1).max() > 0.1  # N


def test_compiled_law_gets_time_tip_and_changing_data():
    data = np.array([0.0, 0.25])
    stepper = thimble.Stepper("box", seconds=0.1, law=thimble.compiled_law(_time_tip_data, data))
    for _ in range(50):
        stepper.step()
    data[1] = -0.5
    while stepper.step():
        pass
    ticks = stepper.ticks()
    np.testing.assert_allclose(ticks.force_wanted[:, 0], ticks.time, atol=1e-12)
    np.testing.assert_array_equal(ticks.force_wanted[:, 1], ticks.tip[:, 2])
    assert (ticks.force_wanted[:50, 2] == 0.25).all() and (ticks.force_wanted[50:, 2] == -0.5).all()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_compiled_law_that_raises_gives_zero_force():
    run = thimble.run("box", seconds=0.3, law=_unset)
    assert run.end == "fault" and run[-1].fault == "force_not_finite"
    assert run.time[-1] == pytest.approx(0.051) and (run[-1].force == 0).all()
    assert (run.force_wanted[0] == 0.1).all()


def test_numba_compiles_a_law():
    pytest.importorskip("numba", reason="install python3-numba")

    @thimble.compiled_law
    def half(time, tip, velocity, wanted, force):
        for k in range(3):
            force[k] = 0.5 * wanted[k]

    assert thimble.run("box", seconds=1, law=half).columns.tobytes() == thimble.run("box", seconds=1, law=_half).columns.tobytes()


def test_numba_law_that_raises_gives_zero_force():
    if "THIMBLE_LONG" not in os.environ:
        pytest.skip("the long form (THIMBLE_LONG=1) compiles more by numba")
    numba = pytest.importorskip("numba", reason="install python3-numba")

    @thimble.compiled_law
    def half(time, tip, velocity, wanted, force):
        force[:] = 0.5 * wanted

    assert thimble.run("box", seconds=1, law=half).columns.tobytes() == thimble.run("box", seconds=1, law=_half).columns.tobytes()

    def gain(time, tip, velocity, wanted, force, data):
        if time > 0.05:
            raise ValueError("on purpose")
        force[2] = data[1]

    run = thimble.run("box", seconds=0.3, law=thimble.compiled_law(gain, np.array([0.0, 0.2])))
    assert (run.force_wanted[0] == [0, 0, 0.2]).all()
    assert run[-1].fault == "force_not_finite" and run.time[-1] == pytest.approx(0.051)
    with pytest.raises(thimble.ArgumentError, match="numba cannot compile"):
        thimble.compiled_law(lambda time, tip, velocity, wanted, force: open("/no"))

    three = numba.types.CPointer(numba.types.float64)

    @numba.cfunc(numba.types.void(numba.types.float64, three, three, three, three, numba.types.voidptr))
    def none(time, tip, velocity, wanted, force, data):
        force[0] = force[1] = force[2] = 0.0

    assert not thimble.run("box", seconds=0.1, law=none).force.any()


def test_wrong_laws_are_refused_before_the_run():
    for wrong, error, message in [
        (lambda: thimble.compiled_law(0), thimble.ArgumentError, "not the address of a function"),
        (lambda: thimble.compiled_law(-4), thimble.ArgumentError, "not the address of a function"),
        (lambda: thimble.compiled_law("law"), TypeError, "a function or its address"),
        (lambda: thimble.compiled_law(_half, [1.0]), thimble.ArgumentError, "array of float64"),
        (lambda: thimble.compiled_law(_half, np.zeros(4)[::2]), thimble.ArgumentError, "C-contiguous"),
        (lambda: thimble.run("box", law=3), TypeError, "law: expected a function of a tick"),
        (lambda: thimble.run("two_hands", law=_half), thimble.Error, "supports one arm"),
    ]:
        with pytest.raises(error, match=message):
            wrong()


def test_missing_numba_is_reported_with_its_package(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "numba", None)
    with pytest.raises(ImportError, match="python3-numba"):
        thimble.compiled_law(lambda time, tip, velocity, wanted, force: None)


def _spring(ticks):
    return -200 * ticks.tip - 1 * ticks.velocity


def test_each_of_many_arms_is_bit_identical_to_a_single_arm():
    hands = np.array([[0.0, 0.0, 0.0], [0.01, 0.0, 0.01], [0.0, -0.02, 0.0]])
    many = thimble.Simulators(3, hand=hands, seed=5)
    alone = [thimble.Simulator(hand=hand, seed=5 + i) for i, hand in enumerate(hands)]
    ticks, each = many.step(), [arm.step() for arm in alone]
    goals = hands + [0.0, 0.0, 0.01]
    for _ in range(200):
        each = [arm.step(_spring(tick), goal) for arm, tick, goal in zip(alone, each, goals)]
        ticks = many.step(_spring(ticks), goals)
    assert len(many) == len(ticks) == 3 and ticks.tip.shape == (3, 3)
    assert [ticks[i].tip.tobytes() for i in range(3)] == [tick.tip.tobytes() for tick in each]
    np.testing.assert_array_equal(many.true_force, [arm.true_force for arm in alone])
    assert (many.name, many.force_max) == (alone[0].name, alone[0].force_max)


def test_fault_of_one_arm_leaves_the_others():
    arms = thimble.Simulators(3)
    forces = np.full((3, 3), 0.2)
    forces[1, 0] = np.nan
    arms.step(forces)
    for _ in range(200):
        ticks = arms.step((0.2, 0.2, 0.2))
    assert [ticks[i].fault for i in range(3)] == ["", "force_not_finite", ""]
    assert not ticks.force[1].any() and (ticks.force[[0, 2]] > 0.15).all()
    arms.activate()
    for _ in range(200):
        ticks = arms.step((0.2, 0.2, 0.2))
    assert (ticks.force > 0.15).all()


def test_wrong_shapes_are_refused_and_step_no_arm():
    arms = thimble.Simulators(2)
    begin = arms.step().time[0]
    for wrong, message in [
        (lambda: arms.step(np.zeros((3, 3))), r"force: expected the shape \(2, 3\)"),
        (lambda: arms.step(hand=(0, 0, np.nan)), "hand: expected"),
        (lambda: arms.step("hard"), "force: expected"),
        (lambda: thimble.Simulators(0), "count: expected a whole number from 1"),
        (lambda: thimble.Simulators(2, seed=[1, 2, 3]), "seed: expected 2 seeds, found 3"),
        (lambda: thimble.Simulators(2, "box"), "no arm file with this name"),
    ]:
        with pytest.raises(thimble.ArgumentError, match=message):
            wrong()
    assert arms.step().time[0] == pytest.approx(begin + 1e-3)
