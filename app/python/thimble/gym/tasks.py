"""The tasks that have an id: scene, reward and end of an episode, for one arm or many."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np
from numpy.typing import NDArray

from .. import ArgumentError, Scene
from .._arguments import number_of
from .environment import TouchEnv
from .touch_vector import TouchVectorEnv

Vector = NDArray[np.float64]


def contour() -> dict[str, Any]:
    """Return the scene of the task Contour: a bump and a groove along y, 0.12 m long, on a plate."""
    bar = {"stiffness": 500, "damping": 2, "rotate_degrees": [["y", 90]]}
    return {
        "name": "contour", "arm": "vintage_phantom", "duration": 4,
        "objects": [
            {"name": "plate", "box": {"sides": [0.08, 0.16, 0.02]}, "position": [0, 0, -0.03], "stiffness": 500,
             "damping": 2},
            {"name": "bump", "cylinder": {"radius": 0.025, "height": 0.07}, "position": [0, -0.016, -0.03], **bar},
            {"name": "ridge", "cylinder": {"radius": 0.02, "height": 0.07}, "position": [0, 0.028, -0.028], **bar},
        ],
        "hand": {"path": [{"t": 0, "at": [0, -0.06, -0.01]}, {"t": 4, "at": [0, -0.06, -0.01]}]},
    }


class HoldForce:
    """Reward of the task Touch: 1 for the wanted force on the hand, less by the relative error, -1 or more."""

    def __init__(self, force: float) -> None:
        self.force = number_of("force", force)
        if not self.force > 0.0:
            raise ArgumentError(f"force: expected more than 0 N, found {force!r}.")

    def __call__(self, ticks: Any, actions: Any) -> Any:
        strength = np.linalg.norm(ticks.force, axis=-1)
        return np.maximum(1.0 - np.abs(strength - self.force) / self.force, -1.0)


class FollowContour(HoldForce):
    """Reward of the task Contour: speed along y relative to the wanted one, -1 to 1, times the reward for the force.

    A force that is off by its whole amount or more is worth nothing, so only a touch earns a reward.
    """

    def __init__(self, force: float, speed: float) -> None:
        super().__init__(force)
        self.speed = number_of("speed", speed)
        if not self.speed > 0.0:
            raise ArgumentError(f"speed: expected more than 0 m/s, found {speed!r}.")

    def __call__(self, ticks: Any, actions: Any) -> Any:
        along = np.clip(ticks.velocity[..., 1] / self.speed, -1.0, 1.0)
        return np.maximum(super().__call__(ticks, actions), 0.0) * along


class AtTheEnd:
    """End of the task Contour: the tip has passed the last ridge."""

    def __init__(self, y: float = 0.06) -> None:
        self.y = y

    def __call__(self, ticks: Any, actions: Any) -> Any:
        return ticks.tip[..., 1] > self.y


def _touch(scene: Scene, force: float, options: Mapping[str, Any]) -> dict[str, Any]:
    return {"scene": scene, "reward": HoldForce(force), "actions": "move", "seconds": 2.0, **options}


def _contour(force: float, speed: float, options: Mapping[str, Any]) -> dict[str, Any]:
    given = {"scene": contour(), "reward": FollowContour(force, speed), "terminated": AtTheEnd(), "actions": "move"}
    return {**given, "seconds": 4.0, "frame_skip": 20, **options}


class TouchTask(TouchEnv):
    """The task ``thimble/Touch-v0``: find the object and hold a force on its surface.

    scene: any scene; its hand begins where the path of the scene begins. force: wanted force on the hand, N. The
    reward of a step is 1 for this force, and less by the relative error. The other options are those of
    :class:`TouchEnv`; actions move the target by default, and an episode lasts 2 s.
    """

    def __init__(self, scene: Scene = "rubber", *, force: float = 1.0, **options: Any) -> None:
        super().__init__(**_touch(scene, force, options))


class ContourTask(TouchEnv):
    """The task ``thimble/Contour-v0``: follow a bump and a ridge along y, with a constant force.

    force: wanted force on the hand, N. speed: wanted speed along y, m/s. The reward of a step is the speed along y
    relative to the wanted one (-1 to 1), times 1 for the wanted force, less by the relative error, 0 or more. The
    episode ends behind the ridge: its return is at most 120 at the default speed. A step has 20 ticks; actions move
    the target by default, and an episode lasts at most 4 s.
    """

    def __init__(self, *, force: float = 0.8, speed: float = 0.05, **options: Any) -> None:
        super().__init__(**_contour(force, speed, options))


def touch_vector(num_envs: int, scene: Scene = "rubber", *, force: float = 1.0, **options: Any) -> TouchVectorEnv:
    """Return :class:`TouchTask` for many arms in this process."""
    return TouchVectorEnv(count=num_envs, **_touch(scene, force, options))


def contour_vector(num_envs: int, *, force: float = 0.8, speed: float = 0.05, **options: Any) -> TouchVectorEnv:
    """Return :class:`ContourTask` for many arms in this process."""
    return TouchVectorEnv(count=num_envs, **_contour(force, speed, options))
