"""Actions of an agent, and the targets of the hand that they stand for."""

from __future__ import annotations

from typing import Any, Mapping, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import ArgumentError, Error, Simulator
from .spaces import Box

Vector = NDArray[np.float64]

KINDS = ("world", "unit", "move")

# Fastest motion of the simulated hand towards a target, m/s (`hand=` of Stepper.step).
_HAND_SPEED = 0.4


class Actions:
    """Converts actions into targets of the hand, for one arm, (3,), or for n arms, (n, 3).

    world: the target itself, m. unit: the workspace box, scaled to -1 to 1. move: displacement of the present
    target, where 1 is the distance that the hand can cover in one step; the target stays in the box.
    """

    def __init__(self, kind: str, low: Vector, high: Vector, seconds_per_step: float) -> None:
        if kind not in KINDS:
            raise ArgumentError(f'actions: expected "world", "unit" or "move", found {kind!r}.')
        self.kind = kind
        self.low, self.high = low, high
        self.reach = _HAND_SPEED * seconds_per_step
        one = np.ones(3)
        self.space = Box(low, high, dtype=np.float64) if kind == "world" else Box(-one, one, dtype=np.float64)

    def targets(self, actions: Vector, present: Vector) -> Vector:
        """Return the new targets for actions and present targets of the same shape."""
        if self.kind == "world":
            return actions
        inside = np.clip(actions, -1.0, 1.0)
        if self.kind == "unit":
            return self.low + 0.5 * (inside + 1.0) * (self.high - self.low)
        return np.clip(present + self.reach * inside, self.low, self.high)


def workspace_of(info: Mapping[str, Any], workspace: Optional[tuple[ArrayLike, ArrayLike]]) -> tuple[Vector, Vector]:
    """Return lower and upper corner of the box of targets: the given one, or that of the arm of a run."""
    if workspace is None:
        try:
            return Simulator(info["arm_file"]).workspace
        except Error as wrong:
            raise ArgumentError(
                f"workspace: pass ((x, y, z), (x, y, z)), m, because that of {info['arm']} is unknown: "
                f"{wrong}"
            ) from wrong
    try:
        low, high = (np.array(one, np.float64) for one in workspace)
    except (TypeError, ValueError):
        low = high = np.empty(0)
    if low.shape != (3,) or high.shape != (3,) or not (np.isfinite(low) & np.isfinite(high) & (low < high)).all():
        raise ArgumentError(
            f"workspace: expected a lower and a larger upper corner, three numbers each (m), found {workspace!r}."
        )
    return low, high
