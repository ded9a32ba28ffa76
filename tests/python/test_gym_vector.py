"""Many arms of one scene in one process: bit-identical to single environments, with shared meshes."""

import functools
import pickle

import numpy as np
import pytest
import thimble
import thimble.gym

COUNT = 5


def lightly(tick, action):
    return -abs(float(np.linalg.norm(tick.force)) - 1.0) - float(np.linalg.norm(action - tick.tip))


def lightly_all(ticks, actions):
    return [lightly(ticks[i], actions[i]) for i in range(len(ticks))]


def deep(tick, action):
    return float(tick.depth) > 0.001


def deep_all(ticks, actions):
    return ticks.depth > 0.001


def ones(ticks, actions):
    return np.ones(len(ticks))


def into(k, i):
    """Returns a target in the object. The first arm stays above it, so that time ends its episodes."""
    return np.array([0.002 * np.sin(k), 0.001 * i, 0.01 - 0.0015 * k if i > 0 else 0.03])


def of(infos, i):
    return {key: infos[key][i] for key in infos if not key.startswith("_") and infos["_" + key][i]}


def results_of_single(env, number, seed, steps):
    """Returns all results of one environment over several episodes."""
    observation, info = env.reset(seed=seed)
    results, over = [observation.tobytes(), info], False
    for k in range(steps):
        if over:
            observation, info = env.reset()
            results += [observation.tobytes(), 0.0, False, False, info]
            over = False
        else:
            observation, *rest = env.step(into(k, number))
            results += [observation.tobytes(), *rest]
            over = rest[1] or rest[2]
    return results


def results_of_vector(envs, seed, steps):
    """Returns the same results of each arm of a vector environment."""
    observations, infos = envs.reset(seed=seed)
    results = [[observations[i].tobytes(), of(infos, i)] for i in range(COUNT)]
    for k in range(steps):
        observations, *rest, infos = envs.step(np.array([into(k, i) for i in range(COUNT)]))
        for i in range(COUNT):
            results[i] += [observations[i].tobytes(), *(one[i] for one in rest), of(infos, i)]
    return results


@pytest.mark.parametrize("scene", ["rubber", "clay"])
def test_each_arm_is_bit_identical_to_a_single_environment(scene):
    steps = 45
    common = {"seconds": 0.305, "frame_skip": 10}
    alone = [
        results_of_single(thimble.gym.TouchEnv(scene, lightly, terminated=deep, **common), i, 20 + i, steps)
        for i in range(COUNT)
    ]
    envs = thimble.gym.TouchVectorEnv(scene, COUNT, lightly_all, terminated=deep_all, **common)
    together = results_of_vector(envs, 20, steps)
    assert together == alone
    assert any(True in one[4::5] for one in alone) and any(True in one[5::5] for one in alone)  # both kinds of ends
    assert results_of_vector(envs, 20, steps) == alone  # and again


def test_results_equal_those_of_vector_env():
    make = functools.partial(thimble.gym.TouchEnv, "rubber", seconds=0.1, meshes=thimble.Meshes())
    envs = thimble.gym.TouchVectorEnv("rubber", COUNT, seconds=0.1)
    with thimble.gym.VectorEnv(make, COUNT, workers=1) as others:
        for space in ("action_space", "observation_space", "single_action_space", "single_observation_space"):
            mine, theirs = getattr(envs, space), getattr(others, space)
            assert mine.shape == theirs.shape and (mine.low == theirs.low).all() and (mine.high == theirs.high).all()
        assert envs.metadata == others.metadata and envs.num_envs == others.num_envs
        results = [(one.reset(seed=[1, 2, 3, 4, 5]), *[one.step(np.zeros((COUNT, 3))) for _ in range(12)]) for one in (envs, others)]
    for mine, theirs in zip(*results):
        for a, b in zip(mine[:-1], theirs[:-1]):
            assert a.dtype == b.dtype and a.tobytes() == b.tobytes()
        assert set(mine[-1]) == set(theirs[-1])
        for key in mine[-1]:
            assert (mine[-1][key] == theirs[-1][key]).all() and mine[-1][key].dtype == theirs[-1][key].dtype, key


def test_unreachable_target_affects_only_its_own_arm():
    envs = thimble.gym.TouchVectorEnv("rubber", 2)
    envs.reset(seed=0)
    *_, infos = envs.step([(0.1, 0.1, 0.1), (0.0, 0.0, 0.02)])
    assert infos["reached"].tolist() == [False, True]
    assert envs.ticks.tip.shape == (2, 3) and envs.seconds_per_step == pytest.approx(0.01)


def test_step_that_begins_an_episode_ignores_action_and_reward():
    envs = thimble.gym.TouchVectorEnv("rubber", 2, ones, seconds=0.02, frame_skip=10)
    envs.reset(seed=0)
    goals = np.zeros((2, 3))
    assert envs.step(goals)[1].tolist() == [1, 1]
    assert envs.step(goals)[3].tolist() == [True, True]
    observations, rewards, _, truncated, infos = envs.step(np.full((2, 3), np.nan))
    assert rewards.tolist() == [0, 0] and not truncated.any() and infos["_seed"].all()
    assert envs.observation_space.contains(observations)


def test_wrong_arguments_raise_a_clear_error():
    make = functools.partial(thimble.gym.TouchVectorEnv, "rubber", 2)
    for wrong, message in (
        (lambda: thimble.gym.TouchVectorEnv("no_such", 2), "Known by name"),
        (lambda: thimble.gym.TouchVectorEnv("rubber", 0), "count"),
        (lambda: thimble.gym.TouchVectorEnv("two_hands", 2), "arms"),
        (lambda: make(frame_skip=0), "frame_skip"),
        (lambda: make(quality="best"), "quality"),
        (lambda: make().step(np.zeros((2, 3))), r"reset\(\)"),
        (lambda: make().reset(seed=[1]), "2 seeds"),
    ):
        with pytest.raises(thimble.Error, match=message):
            wrong()
    with pytest.raises(TypeError, match="Meshes"):
        make(meshes=3)
    envs = make(lambda ticks, actions: 1.0)
    envs.reset(seed=0)
    for actions, message in ((np.zeros(3), "shape"), (np.full((2, 3), np.inf), "three numbers"), (np.zeros((2, 3)), "reward")):
        with pytest.raises(thimble.ArgumentError, match=message):
            envs.step(actions)
    envs.close()
    envs.close()
    with pytest.raises(thimble.Error):
        envs.reset(seed=0)


def test_shared_meshes_are_loaded_once_without_other_results():
    meshes = thimble.Meshes()
    alone = thimble.run("clay", seconds=1.2)
    shared = [thimble.run("clay", seconds=1.2, meshes=meshes) for _ in range(2)]
    stiffer = thimble.run("clay", set={"ball.stiffness": 500}, seconds=0.1, meshes=meshes)
    assert len(meshes) == 1 and stiffer.mesh("ball")[0].shape == alone.mesh("ball")[0].shape
    for run in shared:
        assert run.columns.tobytes() == alone.columns.tobytes()
        assert (run.mesh("ball")[0] == alone.mesh("ball")[0]).all()
    assert len(pickle.loads(pickle.dumps(meshes))) == 0
    several = pickle.loads(pickle.dumps([functools.partial(thimble.run, meshes=meshes)] * 2))
    assert several[0].keywords["meshes"] is several[1].keywords["meshes"]
    del run, shared, stiffer
    meshes.drop_unused()
    assert len(meshes) == 0 and "0 meshes" in repr(meshes)
