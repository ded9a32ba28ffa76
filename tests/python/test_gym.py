"""Environments: Gymnasium's interface, bit-identical results in several processes, ends of the processes."""

import functools
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import thimble
import thimble.gym


def lightly(tick, action):
    return -abs(float(np.linalg.norm(tick.force)) - 1.0) - float(np.linalg.norm(action - tick.tip))


def deep(tick, action):
    return float(tick.depth) > 0.003


def broken(tick, action):
    raise RuntimeError("no reward today")


SHORT = functools.partial(thimble.gym.TouchEnv, "rubber", lightly, seconds=0.25)


def into(k, z=-0.02):
    return np.array([0.002 * np.sin(k), 0.0, z])


def results(env, seed, steps=40):
    """Returns all results of an environment over several episodes."""
    observation, info = env.reset(seed=seed)
    results = [observation.tobytes(), info]
    over = False
    for k in range(steps):
        if over:
            observation, info = env.reset()
            results += [observation.tobytes(), 0.0, False, False, info]
            over = False
            continue
        observation, *rest = env.step(into(k))
        results += [observation.tobytes(), *rest]
        over = rest[1] or rest[2]
    return results


def test_interface():
    env = SHORT(terminated=deep)
    assert env.action_space.shape == (3,) and env.observation_space.shape == (11,)
    np.testing.assert_allclose(env.action_space.low, [-0.1, -0.1, -0.1])
    np.testing.assert_allclose(env.action_space.high, [0.1, 0.1, 0.1])
    env.action_space.seed(3)
    drawn = env.action_space.sample()
    assert env.action_space.contains(drawn) and not env.action_space.contains(drawn + 1)
    env.action_space.seed(3)
    assert (env.action_space.sample() == drawn).all()
    observation, info = env.reset(seed=5)
    assert env.observation_space.contains(observation) and observation.dtype == env.observation_space.dtype
    assert env.seconds_per_step == pytest.approx(0.01) and env.unwrapped is env
    at = info["time"]
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
    assert info["time"] - at == pytest.approx(env.seconds_per_step)
    assert isinstance(reward, float) and terminated is False and truncated is False
    env.close()
    with pytest.raises(thimble.Error, match=r"reset\(\)"):
        env.step((0, 0, 0))


def test_observation_equals_the_last_tick():
    env = thimble.gym.TouchEnv("rubber", seconds=3)
    env.reset(seed=1)
    touched = 0
    for k in range(120):
        observation, *_ = env.step((0.0, 0.0, -0.02))
        tick = env.stepper.tick
        np.testing.assert_array_equal(observation[:3], tick.tip)
        np.testing.assert_array_equal(observation[3:6], tick.velocity)
        np.testing.assert_array_equal(observation[6:9], tick.force)
        assert observation[9] == tick.depth and observation[10] == tick.in_contact
        touched += bool(observation[10])
    assert touched > 5


def test_environment_equals_a_stepper_with_the_same_targets():
    env = thimble.gym.TouchEnv("rubber", seconds=1, frame_skip=7)
    env.reset(seed=4, options={"seed": 9})
    stepper = thimble.Stepper("rubber", seconds=2, seed=9)
    stepper.step()
    for k in range(60):
        observation, *_ = env.step(into(k))
        for _ in range(7):
            stepper.step(hand=into(k))
        assert observation[:3].tobytes() == stepper.tick.tip.tobytes()


def test_same_seed_repeats_all_episodes_bit_identically():
    assert results(SHORT(), 3) == results(SHORT(), 3)
    assert results(SHORT(), 3) != results(SHORT(), 4)
    env = SHORT()
    assert results(env, 3) == results(env, 3)


def test_episodes_end_by_time_and_by_the_goal():
    env = SHORT(seconds=0.105, frame_skip=20)
    env.reset(seed=0)
    ends = [env.step((0, 0, 0.02))[2:4] for _ in range(6)]
    assert ends == [(False, False)] * 5 + [(False, True)]
    assert len(env.stepper.ticks()) == 105
    with pytest.raises(thimble.Error, match="over"):
        env.step((0, 0, 0.02))
    env = thimble.gym.TouchEnv("rubber", lightly, terminated=deep, seconds=5)
    env.reset(seed=0)
    for _ in range(400):
        observation, _, terminated, truncated, _ = env.step((0, 0, -0.03))
        if terminated or truncated:
            break
    assert terminated and not truncated and observation[9] > 0.003


def test_unreachable_target_keeps_the_hand_and_clears_reached():
    env, same = SHORT(), SHORT()
    env.reset(seed=0)
    same.reset(seed=0)
    for there, reached in (((0, 0, 0.02), True), ((0.1, 0.1, 0.1), False), ((0, 0, 0.01), True)):
        *_, info = env.step(there)
        assert info["reached"] is reached
        same.step(there if reached else (0, 0, 0.02))
    assert env.stepper.ticks().columns.tobytes() == same.stepper.ticks().columns.tobytes()


@pytest.mark.parametrize(
    "wrong, message",
    [
        (lambda: SHORT(frame_skip=0), "frame_skip"),
        (lambda: thimble.gym.TouchEnv("no_such"), "Known by name"),
        (lambda: thimble.gym.VectorEnv([]), "count"),
        (lambda: thimble.gym.VectorEnv(SHORT, 2, start="fork"), "spawn"),
        (lambda: thimble.gym.VectorEnv(SHORT, 2, workers=0), "workers"),
    ],
)
def test_wrong_arguments_raise_a_clear_error(wrong, message):
    with pytest.raises(thimble.Error, match=message):
        wrong()


@pytest.mark.parametrize("start, workers", [("spawn", 2), ("forkserver", 3)])
def test_vector_env_is_bit_identical_to_single_environments(start, workers):
    count, steps = 5, 40
    alone = [results(SHORT(), 20 + i, steps) for i in range(count)]
    with_ends = sum(True in one for one in alone)
    with thimble.gym.VectorEnv(SHORT, count, workers=workers, start=start) as envs:
        assert envs.action_space.shape == (count, 3) and envs.observation_space.shape == (count, 11)
        observations, infos = envs.reset(seed=20)
        together = [[observations[i].tobytes(), of(infos, i)] for i in range(count)]
        for k in range(steps):
            observations, *rest, infos = envs.step(np.tile(into(k), (count, 1)))
            for i in range(count):
                together[i] += [observations[i].tobytes(), *(one[i] for one in rest), of(infos, i)]
        assert with_ends == count and together == alone


def of(infos, i):
    return {key: infos[key][i] for key in infos if not key.startswith("_") and infos["_" + key][i]}


def test_seeds_one_for_each():
    with thimble.gym.VectorEnv([SHORT, SHORT], workers=1) as envs:
        first, _ = envs.reset(seed=[7, 7])
        assert first[0].tobytes() == first[1].tobytes()
        with pytest.raises(thimble.Error, match="2 seeds"):
            envs.reset(seed=[7])
        with pytest.raises(thimble.Error, match="shape"):
            envs.step(np.zeros((3, 3)))


def gone(number):
    """Returns whether a process has ended; a zombie counts as ended."""
    try:
        with open(f"/proc/{number}/stat") as stat:
            return stat.read().rsplit(")", 1)[1].split()[0] == "Z"
    except (FileNotFoundError, ProcessLookupError):
        return True


def all_gone(numbers):
    begin = time.monotonic()
    while time.monotonic() < begin + 30:
        if all(map(gone, numbers)):
            return True
        time.sleep(0.02)
    return False


def test_processes_end_when_closed_or_deleted():
    envs = thimble.gym.VectorEnv(SHORT, 2, workers=2)
    running = envs.processes
    assert len(running) == 2 and not any(map(gone, running))
    envs.close()
    envs.close()
    assert all_gone(running) and envs.processes == []
    with pytest.raises(thimble.Error, match="closed"):
        envs.reset()
    envs = thimble.gym.VectorEnv(SHORT, 2, workers=2)
    running = envs.processes
    del envs
    assert all_gone(running)


def test_a_killed_process_closes_all_with_an_error():
    with thimble.gym.VectorEnv(SHORT, 2, workers=2) as envs:
        envs.reset(seed=0)
        running = envs.processes
        os.kill(running[1], signal.SIGKILL)
        with pytest.raises(thimble.Error, match=r"environments 1 ended \(exit code -9\)"):
            for _ in range(3):
                envs.step(np.zeros((2, 3)))
        assert all_gone(running)


def test_an_exception_in_an_environment_reaches_the_caller():
    make = functools.partial(thimble.gym.TouchEnv, "rubber", broken)
    envs = thimble.gym.VectorEnv([SHORT, make], workers=1)
    running = envs.processes
    envs.reset(seed=0)
    with pytest.raises(thimble.Error, match="(?s)environment 1: .*no reward today"):
        envs.step(np.zeros((2, 3)))
    assert all_gone(running)
    with pytest.raises(thimble.Error, match="(?s)environment 0: .*Known by name"):
        thimble.gym.VectorEnv(functools.partial(thimble.gym.TouchEnv, "no_such"))


@pytest.mark.parametrize("start", ["spawn", "forkserver"])
def test_processes_end_when_the_parent_is_killed(start, tmp_path):
    script = tmp_path / "parent.py"  # no main guard: processes that do not need the script do not run it
    script.write_text(
        f"""
import functools, time, thimble.gym
print("began", flush=True)
envs = thimble.gym.VectorEnv(functools.partial(thimble.gym.TouchEnv, "rubber"), 2, workers=2, start="{start}")
envs.reset(seed=0)
print(*envs.processes, flush=True)
time.sleep(60)
"""
    )
    with subprocess.Popen([sys.executable, script], stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout.readline() == "began\n"
        running = [int(one) for one in parent.stdout.readline().split()]
        assert len(running) == 2 and not any(map(gone, running))
        parent.send_signal(signal.SIGKILL)
        parent.wait(timeout=30)
        assert all_gone(running)


def test_uses_the_base_classes_of_gymnasium_if_installed(tmp_path):
    """Uses a minimal module with the base classes, because Gymnasium itself may be missing."""
    (tmp_path / "gymnasium/vector").mkdir(parents=True)
    (tmp_path / "gymnasium/__init__.py").write_text(
        """
import numpy as np
from . import spaces, vector
class Env:
    _np_random = None
    def reset(self, *, seed=None, options=None):
        if seed is not None: self._np_random = np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed)))
    @property
    def np_random(self): return self._np_random
"""
    )
    (tmp_path / "gymnasium/spaces.py").write_text(
        """
import numpy as np
class Box:
    def __init__(self, low, high, shape=None, dtype=np.float32, seed=None):
        self.low, self.high, self.dtype = np.asarray(low, dtype), np.asarray(high, dtype), np.dtype(dtype)
        self.shape = self.low.shape
"""
    )
    (tmp_path / "gymnasium/vector/__init__.py").write_text(
        """
class VectorEnv:
    closed = False
    def __del__(self):
        if not getattr(self, "closed", True): self.close()
class AutoresetMode: NEXT_STEP = "its own word"
"""
    )
    script = """
import functools, gymnasium, thimble.gym
make = functools.partial(thimble.gym.TouchEnv, "rubber", seconds=1)
assert issubclass(thimble.gym.TouchEnv, gymnasium.Env) and issubclass(thimble.gym.VectorEnv, gymnasium.vector.VectorEnv)
assert type(make().action_space) is gymnasium.spaces.Box
observation, _ = make().reset(seed=3)
with thimble.gym.VectorEnv(make, 2, workers=1) as envs:
    assert type(envs.action_space) is gymnasium.spaces.Box and envs.metadata["autoreset_mode"] == "its own word"
    assert envs.reset(seed=3)[0][0].tobytes() == observation.tobytes()
assert envs.closed
try: thimble.gym.VectorEnv([])
except thimble.Error: pass
print(observation.tobytes().hex())
"""
    paths = os.pathsep.join([str(tmp_path), os.environ["PYTHONPATH"]])
    command = [sys.executable, "-B", "-W", "error", "-c", script]
    done = subprocess.run(command, env={**os.environ, "PYTHONPATH": paths}, capture_output=True, text=True)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert done.stdout.strip() == thimble.gym.TouchEnv("rubber", seconds=1).reset(seed=3)[0].tobytes().hex()


def test_gymnasium_checks_the_environment():
    pytest.importorskip("gymnasium")
    from gymnasium.utils.env_checker import check_env

    env = SHORT()
    check_env(env, skip_render_check=True)
