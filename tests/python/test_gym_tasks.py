"""Tasks with an id: Gymnasium's checks of environments, finite spaces, actions, copies, learning."""

import copy
import importlib.util
import inspect
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest
import thimble
import thimble.gym

IDS = thimble.gym.ids()


def checks(env):
    """Raises AssertionError where gymnasium.utils.env_checker (version 1) would raise or warn, except for pictures."""
    actions, observations = env.action_space, env.observation_space
    for space in (actions, observations):
        assert space.low.shape == space.high.shape == space.shape and (space.low < space.high).all()
        assert np.isfinite(space.low).all() and np.isfinite(space.high).all()
    assert (actions.low == -actions.high).all() and (actions.high <= 1).all()
    assert env.unwrapped is env and not callable(getattr(env, "seed", None))
    arguments = inspect.signature(env.reset).parameters
    assert arguments["seed"].default is None and arguments["options"].default is None

    def fits(observation):
        assert isinstance(observation, np.ndarray) and observation.dtype == observations.dtype
        assert observations.contains(observation)

    states, firsts = [], []
    for seed in (123, 123, 456):
        observation, info = env.reset(seed=seed)
        fits(observation)
        assert isinstance(info, dict)
        states.append(copy.deepcopy(env.np_random.bit_generator.state))
        firsts.append(observation)
    assert states[0] == states[1] != states[2] and (firsts[0] == firsts[1]).all()
    env.reset(options={})
    actions.seed(1)
    for _ in range(30):
        observation, reward, terminated, truncated, info = env.step(actions.sample())
        fits(observation)
        assert np.issubdtype(type(reward), np.floating) and np.isfinite(reward)
        assert isinstance(terminated, bool) and isinstance(truncated, bool) and isinstance(info, dict)
        if terminated or truncated:
            env.reset()
    assert isinstance(env.metadata["render_modes"], list) and env.metadata["render_fps"] > 0
    env.close()
    env.close()


@pytest.mark.parametrize("id", IDS)
def test_task_passes_the_checks_of_gymnasium(id):
    checks(thimble.gym.make(id))


def test_checks_find_infinite_and_asymmetric_spaces():
    env = thimble.gym.make("thimble/Touch-v0")
    env.observation_space.high[3] = np.inf
    with pytest.raises(AssertionError):
        checks(env)
    with pytest.raises(AssertionError):
        checks(thimble.gym.TouchEnv("rubber", workspace=((-0.05, -0.05, 0), (0.05, 0.05, 0.1))))


def test_installed_gymnasium_makes_and_checks_each_id():
    gymnasium = pytest.importorskip("gymnasium")
    from gymnasium.utils.env_checker import check_env

    for id in IDS:
        with gymnasium.make(id, render_mode="rgb_array") as env:
            check_env(env.unwrapped, skip_render_check="DISPLAY" not in os.environ)  # it opens a window, too
        envs = gymnasium.make_vec(id, num_envs=3, vectorization_mode="vector_entry_point")
        assert envs.reset(seed=1)[0].shape == (3, 11)


def test_ids_are_registered_with_gymnasium(tmp_path):
    """Uses a minimal module, because Gymnasium itself may be missing."""
    (tmp_path / "gymnasium").mkdir()
    (tmp_path / "gymnasium/__init__.py").write_text("registry = {}\ndef register(id, **entries): registry[id] = entries\n")
    script = """
import importlib, gymnasium, thimble.gym
for id in thimble.gym.ids():
    for key, arguments in (("entry_point", {}), ("vector_entry_point", {"num_envs": 2})):
        module, _, name = gymnasium.registry[id][key].partition(":")
        env = getattr(importlib.import_module(module), name)(**arguments)
        print(id, key, env.reset(seed=3)[0].shape)
"""
    paths = os.pathsep.join([str(tmp_path), os.environ["PYTHONPATH"]])
    done = subprocess.run(
        [sys.executable, "-B", "-c", script], env={**os.environ, "PYTHONPATH": paths}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    expected = [f"{id} {key} {shape}" for id in IDS for key, shape in (("entry_point", (11,)), ("vector_entry_point", (2, 11)))]
    assert done.stdout.splitlines() == expected


def test_unknown_ids_and_options_are_refused():
    with pytest.raises(thimble.ArgumentError, match="no environment 'thimble/Tuch-v0'; there are thimble/Touch-v0"):
        thimble.gym.make("thimble/Tuch-v0")
    with pytest.raises(thimble.ArgumentError, match='actions: expected "world", "unit" or "move", found \'turn\''):
        thimble.gym.TouchEnv("rubber", actions="turn")
    with pytest.raises(thimble.ArgumentError, match="render_mode: expected"):
        thimble.gym.TouchEnv("rubber", render_mode="ansi")
    with pytest.raises(thimble.ArgumentError, match="force: expected more than 0 N"):
        thimble.gym.make("thimble/Touch-v0", force=0)
    with pytest.raises(thimble.ArgumentError, match="workspace: expected a lower"):
        thimble.gym.TouchEnv("rubber", workspace=((0, 0, 0), (0, 1, 1)))
    with pytest.raises(thimble.ArgumentError, match="render_mode: many arms"):
        thimble.gym.make_vec("thimble/Touch-v0", 2, render_mode="rgb_array")


@pytest.mark.parametrize("kind", ["unit", "move"])
def test_many_arms_are_bit_identical_to_one_for_scaled_actions(kind):
    options = {"actions": kind, "seconds": 0.4}
    envs = thimble.gym.make_vec("thimble/Touch-v0", 3, **options)
    random = np.random.default_rng(1)
    actions = random.uniform(-1, 1, (60, 3, 3))  # longer than an episode
    together = [envs.reset(seed=7)[0]]
    rewards = []
    for each in actions:
        observations, reward, *_ = envs.step(each)
        together.append(observations)
        rewards.append(reward)
    for i in range(3):
        env = thimble.gym.make("thimble/Touch-v0", **options)
        assert env.reset(seed=7 + i)[0].tobytes() == together[0][i].tobytes()
        over = False
        for k, each in enumerate(actions):
            if over:
                observation, reward, over = env.reset()[0], 0.0, False
            else:
                observation, reward, terminated, truncated, _ = env.step(each[i])
                over = terminated or truncated
            assert observation.tobytes() == together[k + 1][i].tobytes() and reward == rewards[k][i]


def test_unit_actions_span_the_workspace():
    box = ((-0.02, -0.03, 0.02), (0.02, 0.03, 0.05))
    unit = thimble.gym.TouchEnv("rubber", actions="unit", workspace=box)
    world = thimble.gym.TouchEnv("rubber", workspace=box)
    for one, other in (((-1, -1, -1), box[0]), ((1, 1, 1), box[1]), ((0, 0, 0), (0, 0, 0.035)), ((5, 0, 0), (0.02, 0, 0.035))):
        unit.reset(seed=1)
        world.reset(seed=1)
        for _ in range(20):
            mine, its = unit.step(one)[0], world.step(other)[0]
        np.testing.assert_allclose(mine, its, atol=1e-9)


def test_move_actions_displace_the_target_by_what_a_hand_covers():
    env = thimble.gym.TouchEnv("rubber", actions="move")
    observation, _ = env.reset(seed=1)
    begin = observation[:3]
    for _ in range(10):
        env.step((0.0, 0.5, 0.0))
    for _ in range(60):
        observation, *_ = env.step((0.0, 0.0, 0.0))
    way = observation[:3] - begin
    assert way[1] == pytest.approx(10 * 0.5 * 0.4 * env.seconds_per_step, abs=5e-4) and abs(way[0]) < 5e-4


def test_objects_far_away_are_observed_at_the_bound():
    fallen = {
        "name": "fall", "arm": "vintage_phantom", "duration": 3,
        "objects": [{"name": "ball", "sphere": {"radius": 0.01}, "position": [0.05, 0, 0], "stiffness": 300,
                     "body": {"motion": {"mass": 0.05}}}],
        "gravity": [0, 0, -9.81],
        "hand": {"path": [{"t": 0, "at": [0, 0, 0]}, {"t": 3, "at": [0, 0, 0]}]},
    }
    env = thimble.gym.TouchEnv(fallen, bodies=["ball"], frame_skip=100, seconds=3)
    env.reset(seed=1)
    over = False
    while not over:
        observation, _, terminated, over, _ = env.step((0.001, 0, 0))
    assert env.stepper.bodies["ball"].position[2] < -2 and observation[13] == -1.0
    assert env.observation_space.contains(observation)


def test_an_arm_in_a_plane_has_a_space_with_thickness():
    low, high = np.array([0, -0.05, -0.035]), np.array([0, 0.05, 0.04])
    space = thimble.gym.observations.observation_space({"arm_file": "unknown"}, low, high, 0)
    assert (space.low < space.high).all() and space.contains(np.array([0, 0.06, 0, 9, 0, 0, 99, 0, 0, 0.1, 1.0]))


def test_copies_and_pickles_have_the_options_and_no_episode():
    env = thimble.gym.make("thimble/Contour-v0", force=0.7, seconds=1)
    first = env.reset(seed=5)[0]
    for other in (pickle.loads(pickle.dumps(env)), copy.deepcopy(env)):
        assert type(other) is type(env) and "no episode" in repr(other)
        assert other.reset(seed=5)[0].tobytes() == first.tobytes()
        rewards = [env.step((0, 0.1, -0.1))[1] for _ in range(25)]
        assert max(rewards) > 0.1 and [other.step((0, 0.1, -0.1))[1] for _ in range(25)] == rewards
        env.reset(seed=5)


class Wrapped:
    """A wrapper as those of Gymnasium: it forwards what it does not change."""

    def __init__(self, env):
        self.env = env

    def __getattr__(self, name):
        return getattr(self.env, name)

    def step(self, action):
        observation, reward, *rest = self.env.step(np.asarray(action) * [0, 1, 1])
        return observation.astype(np.float32), 2 * reward, *rest


def test_a_wrapper_changes_actions_and_rewards():
    wrapped, plain = Wrapped(thimble.gym.make("thimble/Touch-v0")), thimble.gym.make("thimble/Touch-v0")
    wrapped.reset(seed=2)
    plain.reset(seed=2)
    assert wrapped.unwrapped is wrapped.env and wrapped.action_space.shape == (3,)
    for _ in range(30):
        observation, reward, *_ = wrapped.step((0.9, 0.1, -0.3))
        its, its_reward, *_ = plain.step((0.0, 0.1, -0.3))
        assert (observation == its.astype(np.float32)).all() and reward == 2 * its_reward


def test_reward_of_touch_is_1_at_the_wanted_force():
    reward = thimble.gym.make("thimble/Touch-v0", force=0.5)._reward
    tick = type("", (), {"force": np.array([[0.3, 0, 0.4], [0, 0, 0.25], [0, 0, 0], [0, 3, 0]])})
    np.testing.assert_allclose(reward(tick, None), [1.0, 0.5, 0.0, -1.0])


def test_reward_of_contour_needs_touch_and_speed():
    reward = thimble.gym.make("thimble/Contour-v0", force=0.5, speed=0.1)._reward
    tick = type("", (), {"force": np.array([[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0.0], [0, 0, 0.25], [0, 0, 0.5]]),
                         "velocity": np.array([[0, 0.1, 0], [0, -0.05, 0], [0, 0.1, 0], [0, 0.1, 0], [0, 0.9, 0]])})
    np.testing.assert_allclose(reward(tick, None), [1.0, -0.5, 0.0, 0.5, 1.0])


def test_contour_ends_behind_the_ridge():
    env = thimble.gym.make("thimble/Contour-v0", seconds=60)
    observation, _ = env.reset(seed=1)
    terminated = False
    for k in range(400):
        assert observation[1] <= 0.06
        observation, _, terminated, _, info = env.step((0, 0.2, 0.3 if observation[10] else 0))
        if terminated:
            break
    assert terminated and info["fault"] == "" and observation[1] > 0.06


def test_example_learns_to_follow_the_contour(source):
    spec = importlib.util.spec_from_file_location("learn", source / "app/examples/12_learn_a_contour.py")
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    envs = thimble.gym.make_vec("thimble/Contour-v0", 64)
    _, curve = example.learn(envs, rounds=10)  # seeded: the same curve in each run
    assert curve[0] < 5 and curve[-1] > 50
