"""Simulated arms without a scene."""

from __future__ import annotations

from typing import Any, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arguments import PathOrName, Vector, number_of, path_of, rows_of, vector_of, whole_of
from ._core import ArgumentError
from ._ticks import Tick, Ticks

_MAX_ARMS = 1_000_000  # 10 GB and more; [chosen] to detect a wrong unit


class Simulator:
    """A simulated arm without a scene, in virtual time: the caller computes the forces.

    arm: arm file, or name (:func:`arms`). hand: position at which the hand holds the tip, (3,) in the
    world, m. rate: ticks per second, Hz. seed: seed of the hand's tremor. Forces pass the same safety gate
    and the same byte protocol as those to a real arm.
    """

    def __init__(
        self,
        arm: PathOrName = "vintage_phantom",
        *,
        hand: ArrayLike = (0.0, 0.0, 0.0),
        rate: float = 1000,
        seed: int = 0,
    ) -> None:
        self._arm = _core.SimulatorSession(
            path_of("arm", arm), vector_of("hand", hand), number_of("rate", rate), whole_of("seed", seed)
        )

    def __repr__(self) -> str:
        fault = ", in fault: activate() allows forces again" if self._arm.in_fault else ""
        return f"Simulator({self.name}, force up to {self.force_max:g} N{fault})"

    def step(self, force: ArrayLike = (0.0, 0.0, 0.0), hand: Optional[ArrayLike] = None) -> Tick:
        """Run one tick with a force on the hand, (3,) in the world, N, and return the tick.

        The tip in the tick was read at its start, before this force acted. hand: new target of the hand,
        as in :meth:`Stepper.step`. After a fault (``tick.fault``) the force stays off until
        :meth:`activate`.
        """
        goal = None if hand is None else vector_of("hand", hand)
        return Tick(self._arm.step(vector_of("force", force, finite=False), goal))

    def activate(self) -> None:
        """Allow forces again after a fault, with a soft start."""
        self._arm.activate()

    @property
    def name(self) -> str:
        """Name of the arm."""
        return self._arm.name

    @property
    def true_force(self) -> Vector:
        """Force that the motors exert on the tip now, (3,) in the world, N. No driver can measure it."""
        return self._arm.true_force

    @property
    def force_max(self) -> float:
        """Limit of the safety gate, N."""
        return self._arm.force_max

    @property
    def workspace(self) -> tuple[Vector, Vector]:
        """Lower and upper corner of the workspace box of the tip, (3,) in the world, m."""
        return self._arm.workspace


class Simulators:
    """Many simulated arms without a scene, stepped by one call. Each is bit-identical to a :class:`Simulator`.

    The caller computes the forces of all arms with numpy::

        arms = thimble.Simulators(1000, hand=(0, 0, 0))
        ticks = arms.step()
        for _ in range(1000):
            ticks = arms.step(-300 * ticks.tip - 1 * ticks.velocity)        # N, (1000, 3)

    count: number of arms. arm: arm file, or name (:func:`arms`). hand: positions at which the hands hold the
    tips, (count, 3) in the world, m, or (3,) for all. rate: ticks per second, Hz. seed: seed s of the
    hands' tremor, which gives s, s + 1, s + 2 and so on; or a sequence of count seeds.
    """

    def __init__(
        self,
        count: int,
        arm: PathOrName = "vintage_phantom",
        *,
        hand: ArrayLike = (0.0, 0.0, 0.0),
        rate: float = 1000,
        seed: Union[int, Sequence[int], NDArray[np.integer[Any]]] = 0,
    ) -> None:
        count = whole_of("count", count, 1, _MAX_ARMS)
        hands = rows_of("hand", hand, count)
        if not isinstance(seed, (Sequence, np.ndarray)):
            first = whole_of("seed", seed)
            seed = range(first, first + count)
        seeds = [whole_of("seed", one) for one in seed]
        if len(seeds) != count:
            raise ArgumentError(f"seed: expected {count} seeds, found {len(seeds)}.")
        file, rate = path_of("arm", arm), number_of("rate", rate)
        self._arms = [_core.SimulatorSession(file, *one) for one in zip(hands, [rate] * count, seeds)]

    def __len__(self) -> int:
        return len(self._arms)

    def __repr__(self) -> str:
        faults = sum(arm.in_fault for arm in self._arms)
        return f"Simulators({len(self)} times {self.name}, force up to {self.force_max:g} N, {faults} in fault)"

    def step(self, force: ArrayLike = (0.0, 0.0, 0.0), hand: Optional[ArrayLike] = None) -> Ticks:
        """Run one tick of each arm, and return them: ``ticks.tip`` is (count, 3), a row for each arm.

        force: force on each hand, (count, 3) in the world, N, or (3,) for all. A force that is not finite
        switches off only its own arm. hand: new targets of the hands, (count, 3) or (3,), m. Raises
        ArgumentError, and steps no arm, if an arm cannot reach its target. Otherwise as
        :meth:`Simulator.step`.
        """
        count = len(self)
        hands = None if hand is None else rows_of("hand", hand, count)
        return Ticks(_core.step_all(self._arms, rows_of("force", force, count, finite=False), hands))

    def activate(self) -> None:
        """Allow forces again on arms in fault, with a soft start. Other arms continue unchanged."""
        for arm in self._arms:
            if arm.in_fault:
                arm.activate()

    @property
    def name(self) -> str:
        """Name of the arm."""
        return self._arms[0].name

    @property
    def true_force(self) -> Vector:
        """Force that the motors exert on each tip now, (count, 3) in the world, N."""
        return np.stack([arm.true_force for arm in self._arms])

    @property
    def force_max(self) -> float:
        """Limit of the safety gate, N."""
        return self._arms[0].force_max

    @property
    def workspace(self) -> tuple[Vector, Vector]:
        """Lower and upper corner of the workspace box of each tip, (3,) in the world, m."""
        return self._arms[0].workspace
