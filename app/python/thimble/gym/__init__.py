"""Scenes as environments with Gymnasium's interface. Gymnasium itself is not required.

    import thimble.gym
    env = thimble.gym.TouchEnv("rubber", reward=lambda tick, action: -abs(float(tick.force[2]) - 1.0))
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step((0.0, 0.0, 0.01))
    envs = thimble.gym.TouchVectorEnv("rubber", 1000)       # in this process, stepped by one call

The import registers the tasks of :func:`ids` with Gymnasium, if it is installed:

    import gymnasium, thimble.gym
    env = gymnasium.make("thimble/Touch-v0", render_mode="human")       # without it: thimble.gym.make(...)
"""

from .environment import TouchEnv
from .registration import ids, make, make_vec, register_with_gymnasium
from .tasks import ContourTask, TouchTask
from .touch_vector import TouchVectorEnv
from .vector import VectorEnv

__all__ = ["ContourTask", "TouchEnv", "TouchTask", "TouchVectorEnv", "VectorEnv", "ids", "make", "make_vec"]

register_with_gymnasium()
