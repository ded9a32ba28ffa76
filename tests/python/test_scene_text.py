"""Scenes that are given as a dict or as text, and changes of their values by `set`."""

import subprocess

import numpy as np
import pytest
import thimble

BALL = {
    "name": "a ball",
    "arm": "vintage_phantom",
    "duration": 1,
    "objects": [
        {
            "name": "ball",
            "sphere": {"radius": 0.03},
            "position": np.array([0, 0, -0.03]),
            "stiffness": np.float64(600),
            "damping": 1,
            "effects": [{"friction": "bristle", "coefficient": 0.5}],
        }
    ],
    "hand": {
        "path": [
            {"t": 0.0, "at": [0, 0, 0.01]},
            {"t": 0.4, "on": "ball", "near": [0, 0, 0], "press": 0.004},
            {"t": 1.0, "on": "ball", "near": [0.01, 0, -0.005], "press": 0.004},
        ]
    },
}
TEXT = """
name: a ball
arm: vintage_phantom
duration: 1
objects:
  - {name: ball, sphere: {radius: 0.03}, position: [0, 0, -0.03], stiffness: 600, damping: 1,
     effects: [{friction: bristle, coefficient: 0.5}]}
hand:
  path:
    - {t: 0.0, at: [0, 0, 0.01]}
    - {t: 0.4, on: ball, near: [0, 0, 0], press: 0.004}
    - {t: 1.0, on: ball, near: [0.01, 0, -0.005], press: 0.004}
"""


def _same(one, other):
    return one.columns["f_sent_W"].tobytes() == other.columns["f_sent_W"].tobytes()


def test_a_dict_a_text_and_a_file_are_the_same_scene(tmp_path):
    (tmp_path / "ball.yaml").write_text(TEXT)
    from_file = thimble.run(tmp_path / "ball.yaml")
    assert from_file.in_contact.any()
    assert _same(from_file, thimble.run(TEXT)) and _same(from_file, thimble.run(BALL))
    stepper = thimble.Stepper(BALL)
    while stepper.step():
        pass
    assert _same(from_file, stepper.ticks())


def test_set_equals_a_scene_with_that_value():
    softer = thimble.run(BALL, set={"ball.stiffness": 300, "ball.effects.friction.coefficient": 0.1})
    written = {**BALL, "objects": [{**BALL["objects"][0], "stiffness": 300}]}
    written["objects"][0]["effects"] = [{"friction": "bristle", "coefficient": 0.1}]
    assert _same(softer, thimble.run(written))
    assert softer.depth.max() > 1.2 * thimble.run(BALL).depth.max()
    assert BALL["objects"][0]["stiffness"] == 600


def test_set_changes_scenes_known_by_name():
    for scene in ("clay", "rubber"):  # one with a mesh next to it, one without
        stepper = thimble.Stepper(scene, seconds=0.1)
        name = stepper.objects[0]
        softer = thimble.run(scene, set={f"{name}.stiffness": 100})
        assert softer.depth.max() > 1.2 * thimble.run(scene).depth.max(), scene
    assert _same(thimble.run("box", seconds=0.5), thimble.run("box", seconds=0.5, set={}))


def test_recordings_of_dicts_and_texts_can_be_replayed(tmp_path, program):
    thimble.run(BALL, set={"ball.stiffness": 450}, record=tmp_path / "ball.h5")
    recording = thimble.read_recording(tmp_path / "ball.h5")
    assert "450" in recording.info["scene_text"]
    message = subprocess.run(
        [program, "replay", "ball.h5", "--verify"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert message.returncode == 0, message.stderr


@pytest.mark.parametrize(
    "wrong, message",
    [
        (lambda: thimble.run(BALL, set={"cube.stiffness": 1}), 'no "cube" there; .*of objects ball'),
        (lambda: thimble.run(BALL, set={"ball.stifness": 1}), r"a_ball-\w+\.yaml:\d+: .*stifness"),
        (lambda: thimble.run(BALL, set={"ball.stiffness": -1}), "stiffness: expected"),
        (lambda: thimble.run(BALL, set={"ball.stiffness": float("nan")}), "cannot hold nan"),
        (lambda: thimble.run({**BALL, "seed": object()}), "cannot hold"),
        (lambda: thimble.run({**BALL, "arm": "eagle"}), "the name of an arm: .*falcon"),
        (lambda: thimble.run({}), "missing"),
        (lambda: thimble.run("name: [\n"), "the scene's text:2"),
        (lambda: thimble.run("missing", set={"rate": 500}), "Known by name"),
        (lambda: thimble.run("./missing.yaml", set={"rate": 500}), "missing.yaml: cannot be read"),
    ],
)
def test_mistakes_in_scenes_are_reported(wrong, message):
    with pytest.raises(thimble.Error, match=message):
        wrong()


def test_files_of_unrecorded_scenes_are_removed(tmp_path):
    import os
    import sys

    script = f"import thimble; print(thimble.run({TEXT!r}, seconds=0.01).info['scene_file'])"
    done = subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, "TMPDIR": str(tmp_path), "XDG_STATE_HOME": str(tmp_path / "state")},
        capture_output=True, text=True, check=True,
    )
    assert done.stdout.startswith(str(tmp_path / "thimble-"))
    assert not list(tmp_path.glob("thimble-*")) and not (tmp_path / "state/thimble/scenes").exists()


@pytest.mark.parametrize(
    "name",
    ["caf\u00e9 \U0001f600", "a \\ \" ' : # {x} [y] *z &w !v | > % @ `", "\u0085\u2028\u2029\ufeff\x7f\x9b", "\u6f22\u5b57\tb"],
    ids=["emoji", "signs", "breaks", "others"],
)
def test_any_text_may_be_in_a_scene(name):
    scene = {**BALL, "name": name, "duration": 0.01}
    assert thimble.run(scene).info["scene"] == name
    assert thimble.run(BALL, set={"name": name}, seconds=0.01).info["scene"] == name


def test_paths_may_be_in_a_scene(tmp_path, source):
    arm = source / "app" / "arms" / "vintage_phantom.yaml"
    assert thimble.run({**BALL, "arm": arm}, seconds=0.01).info["arm"] == thimble.run(BALL, seconds=0.01).info["arm"]
    assert len(thimble.run(BALL, set={"arm": arm}, seconds=0.01)) == 10


def test_half_a_surrogate_pair_is_refused():
    with pytest.raises(thimble.ArgumentError, match="A scene cannot hold"):
        thimble.run({**BALL, "name": "\ud83d"})


@pytest.mark.parametrize("seed", [7.5, "0x1f", 2**53 + 1, -1, "7"])
def test_seed_of_a_scene_is_a_whole_number(seed):
    with pytest.raises(thimble.Error, match="seed: expected a whole number from 0 to 9007199254740992"):
        thimble.run({**BALL, "seed": seed}, seconds=0.01)
