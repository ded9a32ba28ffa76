"""Learns to follow a contour by touch, with a few lines of numpy: the cross-entropy method.

    python3 12_learn_a_contour.py [PICTURE.png]         the picture needs python3-matplotlib

64 arms touch at once, each with its own policy: the target of the hand moves by `0.2 tanh(weights @ features)` of the
distance that a hand can cover in one step. After each round, new policies are drawn around the best eight. An episode
that follows the whole contour with 0.8 N at 50 mm/s has a return of 120.
"""

import sys
import time

import numpy as np

import thimble.gym

ARMS, BEST, ROUNDS = 64, 8, 20


def act(weights, observation):
    """Returns actions, (n, 3): nothing across, and a motion along y and z from the force along y and z, and contact."""
    features = np.stack([observation[:, 7], observation[:, 8], observation[:, 10], np.ones(len(observation))], axis=1)
    return np.pad(0.2 * np.tanh(np.einsum("nij,nj->ni", weights, features)), ((0, 0), (1, 0)))


def episodes(envs, weights, seed):
    """Returns the return of each policy, and the number of steps of all."""
    observation, _ = envs.reset(seed=seed)
    total, running, steps = np.zeros(len(weights)), np.ones(len(weights), bool), 0
    while running.any():
        observation, reward, terminated, truncated, _ = envs.step(act(weights, observation))
        total += np.where(running, reward, 0.0)
        steps += int(running.sum())
        running &= ~(terminated | truncated)
    return total, steps


def learn(envs, rounds=ROUNDS, seed=1):
    """Returns the mean of the best policies, (2, 4), and the mean return of each round."""
    random = np.random.default_rng(seed)
    mean, spread, curve, steps, begin = np.zeros((2, 4)), np.ones((2, 4)), [], 0, time.perf_counter()
    for k in range(rounds):
        weights = mean + spread * random.normal(size=(envs.num_envs, 2, 4))
        score, count = episodes(envs, weights, seed=k)
        best = weights[np.argsort(score)[-BEST:]]
        mean, spread = best.mean(axis=0), best.std(axis=0) + 0.02
        curve.append(score.mean())
        steps += count
        print(f"round {k + 1:2}: mean return {curve[-1]:6.1f}, best {score.max():6.1f}")
    seconds = time.perf_counter() - begin
    print(f"{steps} steps in {seconds:.1f} s: {steps / seconds:.0f} steps per second, learning included")
    return mean, curve


def main():
    weights, curve = learn(thimble.gym.make_vec("thimble/Contour-v0", ARMS))

    env = thimble.gym.make("thimble/Contour-v0", render_mode="rgb_array")
    observation, _ = env.reset(seed=100)
    over, total = False, 0.0
    while not over:
        observation, reward, terminated, truncated, _ = env.step(act(weights[None], observation[None])[0])
        over, total = terminated or truncated, total + reward
    touch = env.stepper.ticks()
    force = np.linalg.norm(touch.force[touch.in_contact], axis=1)
    print(f"Learned policy: return {total:.1f}, force {force.mean():.2f} +- {force.std():.2f} N, "
          f"in contact {100 * touch.in_contact.mean():.0f} % of {touch.time[-1]:.1f} s.")

    if len(sys.argv) > 1:
        try:
            import matplotlib

            matplotlib.use("Agg")
            from matplotlib import pyplot
        except ImportError:
            sys.exit("Without python3-matplotlib there is no picture.")
        figure, (left, middle, right) = pyplot.subplots(1, 3, figsize=(12, 3.4), layout="constrained")
        left.plot(range(1, len(curve) + 1), curve)
        left.set(xlabel="round", ylabel="mean return", title="Learning")
        middle.plot(1e3 * touch.tip[:, 1], 1e3 * touch.tip[:, 2])
        middle.set(xlabel="y, mm", ylabel="z, mm", aspect="equal", title="Path of the tip")
        right.imshow(env.render())
        right.set_axis_off()
        figure.savefig(sys.argv[1], dpi=110)


if __name__ == "__main__":
    main()
