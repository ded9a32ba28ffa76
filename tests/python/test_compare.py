"""Differences between runs, and what objects print of themselves."""

import inspect
import typing

import numpy as np
import pytest
import thimble
import thimble.experiment as experiment
import thimble.gym


@pytest.fixture(scope="module")
def pair():
    return thimble.run("rubber", seconds=2), thimble.run("rubber", set={"ball.stiffness": 200}, seconds=2)


def ticks_like(run, **columns):
    """Returns a copy of ticks with other values in some columns."""
    changed = run.columns.copy()
    for name, values in columns.items():
        changed[name] = values
    return thimble.Ticks(changed)


def test_a_run_is_bit_identical_to_its_repetition(pair):
    same = pair[0].compare(thimble.run("rubber", seconds=2))
    assert same.bit_identical and same.first_difference is None and same.ticks == 2000
    assert all(one.max == 0.0 and one.rms == 0.0 for one in same) and "bit-identical" in repr(same)


def test_a_changed_column_is_found_with_its_time(pair):
    force = pair[0].force.copy()
    force[1200] += [0.3, 0.0, 0.4]
    found = pair[0].compare(ticks_like(pair[0], f_sent_W=force))
    assert not found.bit_identical and found["force"].max == pytest.approx(0.5)
    assert found["force"].at == found.first_difference == pytest.approx(pair[0].time[1200])
    assert found["force"].rms == pytest.approx(0.5 / np.sqrt(2000)) and found["tip"].max == 0.0
    assert found.series("force").argmax() == 1200


def test_a_difference_in_other_columns_is_not_bit_identical(pair):
    counts = pair[0].columns["counts"].copy()
    counts[5] += 1
    found = pair[0].compare(ticks_like(pair[0], counts=counts))
    assert not found.bit_identical and found.first_difference is None and "no difference" in repr(found)


def test_runs_of_other_rates_are_compared_at_the_first_ones_times(pair):
    half = thimble.Ticks(pair[0].columns[::2])
    slow = thimble.Ticks(half.columns[:0:-1][::-1])  # from the second on
    found = pair[0].compare(slow)
    assert found.ticks == 1997 and found.time[0] == pair[0].time[2]
    between = 0.5 * (half.tip[500] + half.tip[501])
    k = int(np.flatnonzero(found.time == pair[0].time[1001])[0])
    assert found.series("tip")[k] == pytest.approx(np.linalg.norm(pair[0].tip[1001] - between), abs=1e-12)
    assert found.series("tip")[k + 1] == 0.0


def test_shift_moves_the_other_run(pair):
    later = thimble.Ticks(pair[0].columns[:1900])
    found = pair[0][100:].compare(later, shift=0.1)
    expected = np.linalg.norm(pair[0].tip[100:2000] - pair[0].tip[:1900], axis=1)
    assert found.ticks == 1900 and not pair[0].compare(pair[0], shift=1e-3).bit_identical
    np.testing.assert_allclose(found.series("tip"), expected, atol=1e-6)


def test_contact_agreement_is_the_share_of_equal_ticks(pair):
    contact = pair[0].columns["in_contact"].copy()
    contact[:500] = 1 - contact[:500]
    found = pair[0].compare(ticks_like(pair[0], in_contact=contact))
    assert found.contact_agreement == pytest.approx(0.75) and found.first_difference == pair[0].time[0]


def test_ticks_that_do_not_overlap_have_no_differences(pair):
    found = pair[0][:10].compare(pair[0][20:30])
    assert found.ticks == 0 and found["tip"].max == 0.0 and found.first_difference is None
    assert pair[0][:0].compare(pair[0]).ticks == 0 and pair[0].compare(pair[0][:0]).ticks == 0


def test_a_recording_is_compared_with_its_run(tmp_path):
    run = thimble.run("box", seconds=1, record=tmp_path / "a.h5")
    assert run.compare(thimble.read_recording(tmp_path / "a.h5")).bit_identical


def test_a_comparison_is_shown_as_a_table(pair):
    found = pair[0].compare(pair[1])
    html = found._repr_html_()
    assert f"<td>force</td><td>{found['force'].max:.4g}</td>" in html and html.count("<tr>") == 7
    assert len(found) == 6 and [one.name for one in found][0] == "tip" and "force " in repr(found)
    with pytest.raises(KeyError, match="heat: expected one of tip"):
        found["heat"]
    with pytest.raises(TypeError, match="other: expected a run"):
        pair[0].compare("b.h5")


def test_run_prints_scene_arm_end_and_largest_values(pair):
    text = repr(pair[0])
    force = np.linalg.norm(pair[0].force, axis=1).max()
    assert text.startswith("Run(rubber, vintage_phantom: done, 2000 ticks, 0.000 to 1.999 s") and f"{force:.3g} N" in text
    assert f"depth up to {1e3 * pair[0].depth.max():.3g} mm" in text
    assert f"in contact {100 * pair[0].in_contact.mean():.0f} %" in text
    assert repr(pair[0][:0]) == "Ticks(0 ticks)" and repr(pair[0][:7]).startswith("Ticks(7 ticks, 0.000 to 0.006 s")


def test_recordings_and_runs_of_several_arms_print_what_is_special(tmp_path):
    recording = thimble.Recording({"scene": "a", "arm": "b"}, thimble.run("box", seconds=0.1).columns, False)
    assert repr(recording).startswith("Recording(a, b: 100 ticks") and repr(recording).endswith("incomplete)")
    assert repr(thimble.run("two_hands", seconds=0.1)).endswith("arms left, right)")


def test_steppers_and_live_runs_print_their_state():
    stepper = thimble.Stepper("box", seconds=0.02)
    assert repr(stepper) == "Stepper(box, vintage_phantom: not begun)"
    stepper.step(), stepper.step()
    assert repr(stepper) == "Stepper(box, vintage_phantom: at 0.001 s)"
    while stepper.step():
        pass
    assert repr(stepper) == "Stepper(box, vintage_phantom: done)"
    with thimble.open("box", "sim", seconds=20) as live:
        assert repr(live).startswith("Live(box, vintage_phantom, device sim: running")
    assert "stopped" in repr(live)


def test_simulators_print_arm_limit_and_faults():
    arm, arms = thimble.Simulator(), thimble.Simulators(3)
    assert repr(arm) == "Simulator(vintage_phantom, force up to 5 N)"
    assert repr(arms) == "Simulators(3 times vintage_phantom, force up to 5 N, 0 in fault)"
    for _ in range(3):
        arm.step(force=(float("nan"), 0, 0))
        arms.step(force=[(float("nan"), 0, 0), (0, 0, 0), (0, 0, 0)])
    assert "activate()" in repr(arm) and "1 in fault" in repr(arms)


def test_experiments_print_their_progress(tmp_path):
    staircase = experiment.Staircase(3.0, 0.5, down=1, up=1, reversals=2, last=1)
    trials = experiment.ConstantStimuli([1, 2], 3)
    assert repr(staircase) == "Staircase(1 down, 1 up: level 3, 0 trials, 0 of 2 reversals)"
    with experiment.Session(tmp_path / "log.jsonl", staircase) as session:
        session.answer(True)
        assert repr(session).startswith("Session(log.jsonl: 1 trials done, Staircase(1 down, 1 up: level 2.5")
        log = session._log
        session.answer(False), session.answer(True)
    assert "threshold" in repr(staircase) and repr(log) == "SubjectLog(log.jsonl: 3 trials, closed)"
    trials.take({"correct": True})
    assert repr(trials) == "ConstantStimuli(6 trials, 1 done)"
    assert repr(experiment.Interleaved({"a": trials})) == "Interleaved(a: ConstantStimuli(6 trials, 1 done))"


def test_environments_print_scene_actions_and_time():
    env = thimble.gym.TouchEnv("rubber", seconds=2)
    assert repr(env) == str(env) == 'TouchEnv("rubber", actions="world", no episode)'
    env.reset(seed=1)
    env.step((0, 0, 0.02))
    assert repr(env) == 'TouchEnv("rubber", actions="world", 0.011 s of 2 s)'
    envs = thimble.gym.make_vec("thimble/Touch-v0", 2)
    assert repr(envs) == str(envs) == 'TouchVectorEnv("rubber", 2 arms, actions="move")'
    envs.close()
    assert "closed" in repr(envs)


@pytest.mark.parametrize("module", [thimble, experiment, thimble.gym])
def test_all_public_classes_have_a_repr_of_their_own(module):
    for name in module.__all__:
        one = getattr(module, name)
        if inspect.isclass(one) and not issubclass(one, Exception) and not getattr(one, "_is_protocol", False):
            if name != "LawFunction":
                assert one.__repr__ is not object.__repr__, name


def test_arrays_have_the_types_that_they_declare(pair):
    columns = thimble.Ticks.__mro__[1]
    of_tick, of_ticks = (dict(zip(columns.__parameters__, typing.get_args(one.__orig_bases__[0]))) for one in (thimble.Tick, thimble.Ticks))
    names = [name for name, one in vars(columns).items() if isinstance(one, property)]
    assert len(names) == 14
    for name in names:
        declared = typing.get_type_hints(vars(columns)[name].fget)["return"]
        all_values, value = getattr(pair[0], name), getattr(pair[0][3], name)
        dtype = typing.get_args(typing.get_args(of_ticks.get(declared, declared))[1])[0]
        assert np.issubdtype(all_values.dtype, typing.get_origin(dtype) or dtype), name
        assert len(all_values) == 2000 and all_values[3].tobytes() == value.tobytes(), name
        scalar = of_tick.get(declared)
        assert isinstance(value, np.ndarray if scalar is None else typing.get_origin(scalar) or scalar), name
