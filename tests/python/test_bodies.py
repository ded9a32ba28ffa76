"""Scenes whose bodies meet: all of them are known to runs, single steps and environments."""

import pickle

import numpy as np
import pytest
import thimble
import thimble.gym

DOMINOES = [f"domino_{i}" for i in range(1, 9)]
HEIGHT = 0.04  # m


def upright(body):
    """Returns the vertical part of an axis that was vertical at first."""
    _, x, y, _ = body.orientation
    return 1 - 2 * (x * x + y * y)


def test_a_run_has_the_poses_of_all_bodies():
    run = thimble.run("dominoes")
    assert list(run.bodies) == DOMINOES
    for name, body in run.bodies.items():
        assert upright(body) < 0.5, name
        assert np.linalg.norm(body.position) > 0.1 * HEIGHT, name


def test_a_body_has_the_pose_of_its_mesh():
    before = thimble.Stepper("dominoes")
    run = thimble.run("dominoes", seconds=2.5)
    for name in DOMINOES:
        w, x, y, z = run.bodies[name].orientation
        u = np.array([x, y, z])
        first = before.mesh(name)[0]
        turned = first + 2 * np.cross(u, np.cross(u, first) + w * first)
        np.testing.assert_allclose(run.mesh(name)[0], run.bodies[name].position + turned, atol=1e-12)


def test_bodies_are_at_rest_before_the_first_tick():
    for name, body in thimble.Stepper("dominoes").bodies.items():
        assert np.array_equal(body.position, [0, 0, 0]), name
        assert np.array_equal(body.orientation, [1, 0, 0, 0]), name


def test_bodies_survive_a_pickle():
    run = thimble.run("dominoes", seconds=2)
    again = pickle.loads(pickle.dumps(run))
    assert list(again.bodies) == DOMINOES
    for name in DOMINOES:
        assert np.array_equal(again.bodies[name].position, run.bodies[name].position)


def test_a_scene_without_bodies_has_none():
    assert thimble.run("box", seconds=0.1).bodies == {}


def test_an_environment_observes_the_bodies_that_it_names():
    env = thimble.gym.TouchEnv("dominoes", seconds=4, bodies=["domino_1", "domino_8"])
    assert env.observation_space.shape == (25,)
    observation, _ = env.reset(seed=1)
    first = observation
    for target in [(-0.06, 0, -0.006)] * 80 + [(-0.042, 0, -0.006)] * 200:
        observation, *_ = env.step(target)
        assert env.observation_space.contains(observation)
    bodies = env.stepper.bodies
    assert list(bodies) == DOMINOES
    for at, name in [(11, "domino_1"), (18, "domino_8")]:
        assert np.array_equal(observation[at : at + 3], bodies[name].position)
        assert np.array_equal(observation[at + 3 : at + 7], bodies[name].orientation)
        assert not np.array_equal(observation[at : at + 7], first[at : at + 7]), name


def test_arms_of_a_vector_environment_observe_their_own_bodies():
    common = {"seconds": 2, "bodies": ["domino_2", "domino_1"]}
    envs = thimble.gym.TouchVectorEnv("dominoes", 2, **common)
    observations, _ = envs.reset(seed=5)
    targets = [(-0.042, 0, -0.006), (-0.09, 0, 0.03)]  # the second arm stays away
    for _ in range(150):
        observations, *_ = envs.step(np.array(targets))
    assert observations.shape == (2, 25)
    env = thimble.gym.TouchEnv("dominoes", **common)
    env.reset(seed=5)
    for _ in range(150):
        alone, *_ = env.step(targets[0])
    assert np.array_equal(observations[0], alone)
    assert not np.array_equal(observations[0, 11:], observations[1, 11:])


@pytest.mark.parametrize("make", [thimble.gym.TouchEnv, lambda *a, **k: thimble.gym.TouchVectorEnv(a[0], 2, **k)])
def test_an_unknown_body_is_refused(make):
    with pytest.raises(thimble.ArgumentError, match='"table" is no object that moves.*domino_1'):
        make("dominoes", bodies=["table"])
