"""Pictures and the window of environments."""

import os
import shutil
import subprocess
import sys

import numpy as np
import pytest
import thimble
import thimble.gym
from thimble.gym.picture import Picture
from thimble.gym.raster import Camera, Layer

PLATE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]]), np.array([[0, 1, 2], [0, 2, 3]])


def camera(width=60, height=40):
    return Camera(np.zeros(3), 0.0, np.pi / 2 - 1e-9, 10.0, width, height)  # from above; x of the picture is y


def test_a_mesh_covers_the_pixels_of_its_projection():
    layer = Layer(60, 40, camera())
    layer.draw(*PLATE, np.array([200.0, 0, 0]))
    red = layer.pixels(1)[..., 1] == 0
    side = 2 * 1.2 * 40 / 10  # focal length 48 pixels, at a distance of 10
    rows, columns = np.flatnonzero(red.any(axis=1)), np.flatnonzero(red.any(axis=0))
    assert abs(len(rows) - side) <= 1 and abs(len(columns) - side) <= 1 and red.sum() == len(rows) * len(columns)
    assert abs(rows.mean() - 19.5) <= 0.5 and abs(columns.mean() - 29.5) <= 0.5


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_the_nearer_of_two_meshes_is_seen_in_any_order(order):
    layer = Layer(60, 40, camera())
    meshes = [(PLATE[0] + [0, 0, 1.0], np.array([0.0, 0, 200])), (PLATE[0], np.array([200.0, 0, 0]))]
    for k in order:
        layer.draw(meshes[k][0], PLATE[1], meshes[k][1])
    pixel = layer.pixels(1)[20, 30]
    assert pixel[2] > 100 and pixel[0] == 0


def test_both_triangles_of_one_mesh_keep_the_nearer():
    stacked = np.concatenate([PLATE[0][:3], PLATE[0][:3] + [0, 0, 1.0], PLATE[0][:3] - [0, 0, 1.0]])
    alone, all_three = Layer(60, 40, camera()), Layer(60, 40, camera())
    alone.draw(stacked, np.array([[3, 4, 5]]), np.full(3, 200.0))
    all_three.draw(stacked, np.array([[0, 1, 2], [3, 4, 5], [6, 7, 8]]), np.full(3, 200.0))
    seen = alone.inverse > 0
    assert (all_three.inverse[seen] == alone.inverse[seen]).all() and seen.any()


def test_a_mark_behind_a_surface_shines_through():
    layer = Layer(60, 40, camera())
    layer.draw(*PLATE, np.array([0.0, 200, 0]))
    before = layer.pixels(1)[20, 30].astype(int)
    layer.draw(PLATE[0] * 0.5 - [0, 0, 1.0], PLATE[1], np.array([250.0, 0, 0]), through=0.5)
    after = layer.pixels(1)[20, 30].astype(int)
    assert after[0] == pytest.approx(125, abs=2) and after[1] == pytest.approx(before[1] / 2, abs=2)


def test_meshes_behind_the_camera_are_not_drawn():
    layer, empty = Layer(60, 40, camera()), Layer(60, 40, camera())
    layer.draw(PLATE[0] + [0, 0, 20.0], PLATE[1], np.array([200.0, 0, 0]))
    assert (layer.pixels(1) == empty.pixels(1)).all()


def test_rgb_array_shows_the_moment_of_the_episode():
    env = thimble.gym.make("thimble/Contour-v0", render_mode="rgb_array", size=(240, 160))
    env.reset(seed=1)
    first = env.render()
    assert first.shape == (160, 240, 3) and first.dtype == np.uint8
    assert (env.render() == first).all()
    for _ in range(20):
        env.step((0, 0.1, -0.1))
    second = env.render()
    assert 20 < (first != second).any(axis=2).sum() < 0.1 * 160 * 240  # tip and force, not the objects
    env.reset(seed=1)
    assert (env.render() == first).all()


def test_the_tip_is_drawn_where_it_is():
    env = thimble.gym.make("thimble/Touch-v0", render_mode="rgb_array")
    env.reset(seed=1)
    env.render()
    x, y, _ = env._picture._camera.project(env.stepper.tick.tip[np.newaxis])[0] / 2
    navy = np.abs(env.render()[int(y), int(x)].astype(int) - [0x0B, 0x3C, 0x5D]).max()
    assert navy < 60


def test_an_object_that_moves_is_drawn_at_its_place():
    class Tick:
        tip = proxy = np.array([0.0, 0, 9])
        force, in_contact = np.zeros(3), False

    def meshes(y):
        return {"still": (PLATE[0] - [0, 0, 1.0], PLATE[1]), "cube": (PLATE[0] * 0.3 + [0, y, 0.5], PLATE[1])}

    moved, fresh = Picture(120, 80), Picture(120, 80)
    for y in (0.0, 0.4, 0.8):
        last = moved.draw(meshes(y), Tick)
    fresh._camera, fresh._distance = moved._camera, moved._distance
    assert (last == fresh.draw(meshes(0.8), Tick)).all()


def test_render_without_a_mode_or_an_episode_is_an_error():
    with pytest.raises(thimble.Error, match="render_mode="):
        thimble.gym.TouchEnv("rubber").render()
    with pytest.raises(thimble.Error, match=r"reset\(\)"):
        thimble.gym.TouchEnv("rubber", render_mode="rgb_array").render()


def run_script(script, *before, **environment):
    everything = {**os.environ, **environment}
    return subprocess.run(
        [*before, sys.executable, "-B", "-c", script], env=everything, capture_output=True, text=True, timeout=120
    )


def test_a_window_without_a_display_is_an_error_with_the_remedy():
    pytest.importorskip("tkinter", reason="install python3-tk")
    script = """
import thimble.gym
env = thimble.gym.make("thimble/Touch-v0", render_mode="human")
try: env.reset(seed=1)
except thimble.Error as wrong: print(wrong)
"""
    done = run_script(script, DISPLAY="")
    assert "needs a display" in done.stdout and 'render_mode="rgb_array"' in done.stdout, done.stderr


def test_a_window_without_tk_is_an_error_with_the_package():
    script = """
import sys
sys.modules["tkinter"] = None
import thimble.gym
env = thimble.gym.make("thimble/Touch-v0", render_mode="human")
try: env.reset(seed=1)
except thimble.Error as wrong: print(wrong)
"""
    assert "install python3-tk" in run_script(script).stdout


def test_window_shows_the_episode_in_real_time_until_it_is_closed():
    pytest.importorskip("tkinter", reason="install python3-tk")
    if shutil.which("xvfb-run") is None:
        pytest.skip("install xvfb")
    script = """
import types
import thimble.gym
waits = []
thimble.gym.window.time = types.SimpleNamespace(monotonic=lambda: 0.0, sleep=waits.append)   # time stands still
env = thimble.gym.make("thimble/Contour-v0", render_mode="human", seconds=30)
env.reset(seed=1)
root = env._window._root
for _ in range(50): env.step((0, 0.1, 0))
print(len(waits), round(waits[-1], 3))                # of 50 steps of 20 ms, every second is shown
print(root.winfo_width(), root.winfo_height(), root.winfo_viewable(), root.title(), env.render())
root.tk.call(root.protocol("WM_DELETE_WINDOW"))       # what the close button does
for _ in range(50): env.step((0, 0.1, 0))
print(env._window.is_open, env.render(), len(env.stepper.ticks()), len(waits))
env.close()
"""
    done = run_script(script, "xvfb-run", "-a")
    assert done.stdout.splitlines() == ["25 1.0", "480 360 1 Thimble: contour None", "False None 2001 25"], done.stderr
