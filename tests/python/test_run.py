"""Runs from Python equal runs of the program."""

import math
import pickle
import threading

import numpy as np
import pytest
import thimble

SCENES = ["elephant", "tin_can", "rubber", "charges"]


@pytest.mark.parametrize("scene", SCENES)
def test_run_is_bit_identical_to_the_program(scene, run_program, tmp_path):
    run_program("run", scene, "--duration", "1.5", "--record", "program.h5")
    program = thimble.read_recording(tmp_path / "program.h5")
    python = thimble.run(scene, seconds=1.5)
    assert len(python) == 1500
    for column in thimble.units():
        if column != "work":
            assert python.columns[column].tobytes() == program.columns[column].tobytes(), column


def test_stepping_is_bit_identical_to_run():
    stepper = thimble.Stepper("elephant", seconds=2)
    steps = 0
    while stepper.step():
        steps += 1
    run = thimble.run("elephant", seconds=2)
    assert steps == 2000 and stepper.end == run.end == "done"
    assert stepper.ticks().columns.tobytes() == run.columns.tobytes()
    assert not stepper.step() and len(stepper.ticks()) == 2000


def test_another_seed_is_another_tremor():
    runs = [thimble.run("elephant", seconds=0.5, seed=seed) for seed in (5, 5, 6)]
    assert runs[0].columns.tobytes() == runs[1].columns.tobytes()
    assert runs[0].columns.tobytes() != runs[2].columns.tobytes()


def test_gives_arrays_with_shapes_and_units():
    run = thimble.run("elephant", seconds=4)
    n = len(run)
    assert n == 4000 and run.stride == 1
    for array in (run.time, run.depth, run.in_contact, run.object):
        assert array.shape == (n,)
    for array in (run.tip, run.velocity, run.force, run.force_wanted, run.proxy, run.normal, run.joints):
        assert array.shape == (n, 3) and array.dtype == np.float64
    assert run.in_contact.dtype == np.bool_ and run.in_contact.any() and not run.in_contact.all()
    np.testing.assert_allclose(np.diff(run.time), 1e-3, rtol=1e-9)  # s
    assert np.abs(run.tip).max() < 0.3  # m, more than the workspace of a desktop arm
    assert 0.1 < np.linalg.norm(run.force, axis=1).max() < 9  # N
    # The velocity is that of the tip: its integral is the path, except for the lag of the estimate.
    way = np.cumsum(run.velocity, axis=0) * 1e-3
    assert np.abs(way - (run.tip - run.tip[0])).max() < 2e-3
    # A spring of the scene's 500 N/m or less on the depth, along the normal, while nothing moves.
    held = run.in_contact & (np.linalg.norm(run.velocity, axis=1) < 2e-3) & (run.depth > 1e-3)
    assert (np.einsum("ij,ij->i", run.force[held], run.normal[held]) > 0).all()
    units = thimble.units()
    assert units["p_WT"][0] == "m" and units["f_sent_W"][0] == "N" and units["time"][0] == "ns"
    assert units["heat"][0] == "1" and 0 < run.heat.max() < 0.8
    assert set(units) == set(run.columns.dtype.names)


def test_orientation_is_there_if_the_arm_measures_it():
    turned = thimble.run("rubber", arm="polhem", seconds=0.5)
    assert turned.orientation.shape == (500, 4) and turned.gimbal.shape == (500, 3)
    np.testing.assert_allclose(np.linalg.norm(turned.orientation, axis=1), 1, atol=1e-6)
    assert np.ptp(turned.gimbal, axis=0).min() > 0.01  # rad
    assert not turned.columns["has_gripper"].any() and not turned.gripper.any()
    assert not thimble.run("rubber", seconds=0.1).orientation.any()


def test_summary_and_figures_equal_those_of_the_program(run_program, tmp_path):
    run = thimble.run("rubber", seconds=1)
    assert run.summary() in run_program("run", "rubber", "--duration", "1")
    figures = {figure.name: figure for figure in run.figures()}
    assert figures["lost_contacts"].met and figures["ticks"].value == 1000
    assert figures["force_max"].value == pytest.approx(np.linalg.norm(run.force, axis=1).max())
    assert run.info["clock"] == "virtual" and run.info["rate"] == 1000


def test_recording_is_replaced_only_if_asked(tmp_path):
    file = tmp_path / "kept.h5"
    thimble.run("honey", seconds=0.1, record=file)
    with pytest.raises(thimble.Error, match="overwrite"):
        thimble.run("honey", seconds=0.2, record=file)
    assert len(thimble.read_recording(file)) == 100
    thimble.run("honey", seconds=0.2, record=file, overwrite=True)
    assert len(thimble.read_recording(file)) == 200


def test_records_what_it_returns(tmp_path):
    run = thimble.run("honey", seconds=0.5, record=tmp_path / "honey.h5")
    read = thimble.read_recording(tmp_path / "honey.h5")
    assert read.complete and read.info["scene"] == run.info["scene"]
    assert read.columns["f_sent_W"].tobytes() == run.columns["f_sent_W"].tobytes()
    stepper = thimble.Stepper("honey", record=tmp_path / "cut.h5")
    for _ in range(100):
        stepper.step()
    stepper.stop()
    assert stepper.end == "stopped" and len(thimble.read_recording(tmp_path / "cut.h5")) == 100


def test_mesh_returns_the_present_shape(source):
    stepper = thimble.Stepper("clay")
    vertices, triangles = stepper.mesh()
    assert vertices.shape[1] == triangles.shape[1] == 3
    assert 0 <= triangles.min() and triangles.max() < len(vertices)
    while stepper.step():
        pass
    sculpted, _ = stepper.mesh(stepper.objects[0])
    assert 1e-4 < np.abs(sculpted - vertices).max() < 0.05  # m


def test_hand_moves_to_its_target():
    stepper = thimble.Stepper("box", seconds=1)
    stepper.step()
    goal = stepper.tick.tip + [0.0, 0.0, 0.02]
    while stepper.step(hand=goal):
        pass
    # The hand's spring carries the arm's weight and friction.
    assert np.linalg.norm(stepper.tick.tip - goal) < 5e-3


def test_force_of_a_custom_law_goes_through_the_gate():
    asked = []

    def push(tick):
        asked.append(tick.time)
        return [0.0, 0.0, 0.4]

    run = thimble.run("box", seconds=0.3, law=push)
    assert len(asked) == 300 and np.diff(asked).min() > 0
    assert (run.force_wanted == [0.0, 0.0, 0.4]).all()
    assert np.linalg.norm(run.force[0]) < 0.01  # soft start
    np.testing.assert_allclose(run.force[-1], [0.0, 0.0, 0.4], atol=0.01)  # steps of the currents
    strong = thimble.run("box", seconds=0.3, law=lambda tick: (0, 0, 1000.0))
    assert np.linalg.norm(strong.force, axis=1).max() <= thimble.Simulator().force_max * 1.001


def test_law_that_returns_none_keeps_the_force_of_the_scene():
    own = thimble.run("elephant", seconds=2, law=lambda tick: None)
    assert own.columns.tobytes() == thimble.run("elephant", seconds=2).columns.tobytes()


def test_law_that_raises_gives_zero_force_and_its_exception():
    def fail(tick):
        if tick.time > 0.05:
            raise ZeroDivisionError("mine")
        return (0, 0, 0.3)

    stepper = thimble.Stepper("box", law=fail)
    with pytest.raises(ZeroDivisionError, match="mine"):
        while stepper.step():
            pass
    assert stepper.tick.time == pytest.approx(0.051)
    assert (stepper.tick.force == 0).all()
    with pytest.raises(ValueError, match="three numbers"):
        thimble.run("box", law=lambda tick: (1.0, 2.0))
    not_finite = thimble.run("box", law=lambda tick: (math.nan, 0, 0))
    assert not_finite.end == "fault" and not_finite[-1].fault == "force_not_finite"


def test_a_law_may_not_step_its_own_run():
    held = []
    stepper = thimble.Stepper("box", law=lambda tick: held[0].step() and None)
    held.append(stepper)
    with pytest.raises(thimble.Error, match="already being stepped"):
        stepper.step()


def test_other_python_threads_continue_during_a_run():
    counted = [0]
    done = threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    while counted[0] == 0:
        pass
    before = counted[0]
    thimble.run("elephant")
    between = counted[0]
    done.set()
    thread.join()
    assert between > before


def test_runs_in_threads_do_not_disturb_each_other():
    alone = thimble.run("tin_can", seconds=1).columns.tobytes()
    felt = [b""] * 3

    def feel(i):
        felt[i] = thimble.run("tin_can", seconds=1).columns.tobytes()

    threads = [threading.Thread(target=feel, args=(i,)) for i in range(len(felt))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert felt == [alone] * len(felt)


def test_a_scene_with_several_arms_gives_each_of_them():
    run = thimble.run("two_hands", seconds=2)
    assert list(run.arms) == ["left", "right"]
    left, right = run.arms["left"], run.arms["right"]
    assert len(left) == len(right) == len(run) == 2000
    assert np.array_equal(left.force, run.force)  # the run itself is its first arm
    assert not np.array_equal(left.force, right.force)
    # Lifted, each hand carries half of the beam, and they press against each other.
    assert left.force[-1, 2] < -0.3 and right.force[-1, 2] < -0.3
    assert (left.tip[:, 1] < 0).all() and (right.tip[:, 1] > 0).all()
    assert left.info["arm_in_scene"] == "left" and right.info["seed"] == left.info["seed"] + 1
    assert "2.0 s" in right.summary()
    assert thimble.run("box", seconds=0.1).arms == {}
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(again.arms["right"].force, right.force)


def test_several_arms_are_stepped_together_and_recorded_each(tmp_path):
    stepper = thimble.Stepper("two_hands", seconds=0.5, record=tmp_path / "two.h5")
    while stepper.step():
        pass
    left = thimble.read_recording(tmp_path / "two_left.h5")
    right = thimble.read_recording(tmp_path / "two_right.h5")
    assert len(left) == len(right) == 500
    assert np.array_equal(left.force, stepper.ticks().force)
    assert right.info["arm_in_scene"] == "right"
    with pytest.raises(thimble.Error, match="one arm"):
        thimble.Stepper("two_hands").step(hand=(0, 0, 0))
    with pytest.raises(thimble.Error, match="supports one arm"):
        thimble.run("two_hands", law=lambda tick: None)


def test_held_buttons_are_in_the_ticks_until_they_are_released():
    with thimble.Stepper("rubber", seconds=0.1) as stepper:
        stepper.step()
        stepper.hold_buttons(1, 3)
        stepper.step()
        assert stepper.tick.buttons == 5
        stepper.hold_buttons()
        stepper.step()
        assert stepper.tick.buttons == 0
        with pytest.raises(thimble.ArgumentError, match="from 1 to 16"):
            stepper.hold_buttons(17)
