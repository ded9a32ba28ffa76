"""Observations of an agent: their order, their bounds, and how they are made from ticks."""

from __future__ import annotations

import re
from typing import Any, Mapping, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from .. import ArgumentError, Error, Simulator, Tick, Ticks
from .spaces import Box

Vector = NDArray[np.float64]

# A tip is stopped by the arm itself. The box is enlarged by half its size for overshoot, and by 10 mm at least, because
# arms that move in a plane have a box without thickness. [chosen]
_OVERSHOOT, _MIN_MARGIN = 0.5, 0.01
# If the arm file does not have them: faster than a hand and stronger than a desktop arm. [chosen]
_SPEED, _FORCE = 10.0, 100.0
# Objects farther away are out of the reach of desktop arms; one that falls off a table is at this bound, m. [chosen]
_FAR = 1.0


def observation_space(info: Mapping[str, Any], low: Vector, high: Vector, bodies: int) -> Any:
    """Return the finite space of observations: tip, velocity, force, depth, contact, poses of bodies.

    info: description of the run, which has the arm. low, high: corners of the box of targets.
    """
    force = _FORCE
    try:
        arm = Simulator(info["arm_file"])
        low, high, force = np.minimum(low, arm.workspace[0]), np.maximum(high, arm.workspace[1]), arm.force_max
    except Error:  # the arm has no simulation: the caller gave a workspace
        pass
    speed = re.search(r"^\s*speed_max:\s*([0-9.eE+-]+)", info.get("arm_text", ""), re.MULTILINE)
    fastest = np.full(3, float(speed[1]) if speed else _SPEED)
    margin = np.maximum(_OVERSHOOT * (high - low), _MIN_MARGIN)
    pose = np.concatenate([np.full(3, _FAR), np.ones(4)])
    poses = np.tile(pose, bodies)
    highest = np.concatenate([high + margin, fastest, np.full(3, force), [np.linalg.norm(high - low), 1.0], poses])
    lowest = np.concatenate([low - margin, -fastest, np.full(3, -force), [0.0, 0.0], -poses])
    return Box(lowest, highest, dtype=np.float64)


def observed(ticks: Union[Tick, Ticks], poses: Sequence[Any], space: Any) -> Vector:
    """Return the observation of a tick, or of one tick for each arm. A value outside the space is set to its bound."""
    parts = [ticks.tip, ticks.velocity, ticks.force, np.asarray(ticks.depth)[..., np.newaxis]]
    parts += [np.asarray(ticks.in_contact, np.float64)[..., np.newaxis], *poses]
    return np.clip(np.concatenate(parts, axis=-1), space.low, space.high)


def checked_bodies(bodies: Sequence[str], moving: Sequence[str]) -> list[str]:
    """Return the names of observed bodies. Raises ArgumentError for one that is not among those that move."""
    names = [bodies] if isinstance(bodies, str) else list(bodies)
    for name in names:
        if name not in moving:
            known = ", ".join(moving) or "none"
            raise ArgumentError(f'bodies: "{name}" is no object that moves. Objects of the scene that move: {known}.')
    return names
