"""Adaptive staircases: earlier answers determine the level of a trial."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from .. import ArgumentError
from .._arguments import renamed


class Staircase:
    """An n-down m-up staircase with added or multiplied steps.

    After `down` consecutive correct answers the level decreases by a step; after `up` consecutive wrong
    answers it increases by a step. A trial has its level as ``condition["level"]``, an answer has the key
    ``correct``.
    """

    def __init__(
        self,
        start: float,
        step: Union[float, Sequence[float]],
        *,
        down: int = 3,
        up: int = 1,
        up_ratio: float = 1.0,
        multiply: bool = False,
        lowest: float = -np.inf,
        highest: float = np.inf,
        reversals: int = 12,
        last: int = 8,
        max_trials: int = 400,
        trials_most: Optional[int] = None,
    ) -> None:
        """Create a staircase at its first level.

        start: first level, in any unit. step: size of a step, or a list of sizes; each reversal selects
        the next size, and the last size remains. multiply: a step multiplies or divides by its size
        (above 1), and averages are those of logarithms. up_ratio: size of a step up, in steps down.
        lowest, highest: bounds of the level. reversals, max_trials: the staircase ends after this number
        of reversals or of trials. last: number of last reversals whose mean is the threshold.
        trials_most: deprecated; former name of max_trials.
        """
        max_trials = renamed("trials_most", trials_most, "max_trials", max_trials, 400)
        self._steps = [float(one) for one in np.atleast_1d(np.asarray(step, dtype=np.float64))]
        smallest = 1.0 if multiply else 0.0
        if not self._steps or not all(np.isfinite(one) and one > smallest for one in self._steps):
            raise ArgumentError(f"step: expected numbers above {smallest:g}, found {step!r}.")
        if down < 1 or up < 1 or not up_ratio > 0:
            raise ArgumentError("down, up: expected 1 or more; up_ratio: above 0.")
        if not 1 <= last <= reversals or max_trials < 1:
            raise ArgumentError(f"last: expected 1 to reversals ({reversals}), found {last}.")
        if not lowest <= start <= highest or (multiply and not start > 0):
            raise ArgumentError(f"start: expected a level between the bounds, found {start}.")
        self.down, self.up, self.multiply = int(down), int(up), bool(multiply)
        self._start, self._up_ratio = float(start), float(up_ratio)
        self._lowest, self._highest = float(lowest), float(highest)
        self._max_reversals, self._last, self._max_trials = int(reversals), int(last), int(max_trials)
        self.level = float(start)  #: level of the next trial
        self.levels: list[float] = []  #: levels of all trials so far
        self.answers: list[bool] = []  #: answers to them, whether correct
        self.reversals: list[float] = []  #: levels at which the direction changed
        self._right = self._wrong = 0  # answers of each kind in a row
        self._heading = 0  # direction: -1 downwards, 1 upwards

    def __repr__(self) -> str:
        result = f"threshold {self.threshold:.4g}" if self.over else f"level {self.level:.4g}"
        return (
            f"Staircase({self.down} down, {self.up} up: {result}, {len(self.levels)} trials, "
            f"{len(self.reversals)} of {self._max_reversals} reversals)"
        )

    @property
    def over(self) -> bool:
        """Whether there are enough reversals or trials."""
        return len(self.reversals) >= self._max_reversals or len(self.levels) >= self._max_trials

    def condition(self) -> Optional[dict[str, Any]]:
        """Return the condition of the next trial, ``{"level": ...}``; None after the last."""
        return None if self.over else {"level": self.level}

    def check(self, answer: Mapping[str, Any]) -> None:
        """Raise ArgumentError if an answer lacks the key ``correct``."""
        if not isinstance(answer.get("correct"), (bool, np.bool_)):
            raise ArgumentError(f"answer: expected correct=True or False, found {dict(answer)!r}.")

    def take(self, answer: Mapping[str, Any]) -> None:
        """Take the answer to the present trial. It needs the key ``correct`` and may have others."""
        self.check(answer)
        correct = bool(answer["correct"])
        self.levels.append(self.level)
        self.answers.append(correct)
        self._right, self._wrong = (self._right + 1, 0) if correct else (0, self._wrong + 1)
        if self._right == self.down:
            self._go(-1)
        elif self._wrong == self.up:
            self._go(1)

    @property
    def target(self) -> float:
        """Probability of a correct answer at the level to which the staircase converges.

        There, steps down and up balance: p^n = 1/2 for n down, 1 up and equal steps (79.4 % for 3).
        """
        low, high = 0.0, 1.0
        for _ in range(60):
            p = (low + high) / 2
            wanders_up = _down_first(p, self.down, self.up) * (1 + self._up_ratio) < self._up_ratio
            low, high = (p, high) if wanders_up else (low, p)
        return (low + high) / 2

    @property
    def threshold(self) -> float:
        """Mean level of the last reversals (geometric mean if steps multiply); NaN if there are too few."""
        if len(self.reversals) < self._last:
            return float("nan")
        return float(self._back(np.mean(self._last_reversals())))

    @property
    def spread(self) -> float:
        """Standard deviation of those levels, in the level's unit; as a factor if steps multiply."""
        if len(self.reversals) < max(2, self._last):
            return float("nan")
        return float(self._back(np.std(self._last_reversals(), ddof=1)))

    def plan(self) -> dict[str, Any]:
        """Return everything that determines the trials, for the log."""
        bounds = [None if np.isinf(one) else one for one in (self._lowest, self._highest)]
        return {
            "staircase": {
                "start": self._start,
                "step": self._steps,
                "down": self.down,
                "up": self.up,
                "up_ratio": self._up_ratio,
                "multiply": self.multiply,
                "bounds": bounds,
                "reversals": self._max_reversals,
                "trials_most": self._max_trials,
            }
        }

    def _last_reversals(self) -> Any:
        levels = np.array(self.reversals[-self._last :])
        return np.log(levels) if self.multiply else levels

    def _back(self, value: Any) -> Any:
        return np.exp(value) if self.multiply else value

    def _go(self, heading: int) -> None:
        self._right = self._wrong = 0
        if self._heading == -heading:
            self.reversals.append(self.level)
        self._heading = heading
        step = self._steps[min(len(self.reversals), len(self._steps) - 1)]
        size = self._up_ratio if heading > 0 else 1.0
        level = self.level * step ** (heading * size) if self.multiply else self.level + heading * size * step
        self.level = float(min(max(level, self._lowest), self._highest))


def _down_first(p: float, down: int, up: int) -> float:
    """Return the probability that `down` consecutive successes occur before `up` consecutive failures."""
    q = 1 - p
    right, wrong = p ** (down - 1), q ** (up - 1)
    return right * (1 - q**up) / (right + wrong - right * wrong)
