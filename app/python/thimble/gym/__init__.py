"""Scenes as environments with Gymnasium's interface. Gymnasium itself is not required.

    import thimble.gym
    env = thimble.gym.TouchEnv("rubber", reward=lambda tick, action: -abs(float(tick.force[2]) - 1.0))
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step((0.0, 0.0, 0.01))
    envs = thimble.gym.TouchVectorEnv("rubber", 1000)       # in this process, stepped by one call
"""

from .environment import TouchEnv
from .touch_vector import TouchVectorEnv
from .vector import VectorEnv

__all__ = ["TouchEnv", "TouchVectorEnv", "VectorEnv"]
