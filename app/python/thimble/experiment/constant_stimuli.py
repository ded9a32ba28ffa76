"""The method of constant stimuli: levels chosen before, each presented equally often."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from .. import ArgumentError
from .order import Trials
from .psychometric import Array, Psychometric, count, fit


class ConstantStimuli(Trials):
    """Levels in a shuffled order; trials tell theirs as ``condition["level"]``, answers tell `says`."""

    def __init__(
        self,
        levels: Sequence[float],
        repeats: int,
        *,
        says: str = "correct",
        order: str = "blocks",
        seed: int = 0,
        subject: Optional[int] = None,
    ) -> None:
        """Take the levels, in whatever unit; says: the answer's key, True or False, that rises with the level.

        order, seed and subject: as of :class:`Trials`; "balanced" needs the subject.
        """
        each = {"level": [float(one) for one in levels]}
        super().__init__(each, repeats=repeats, order=order, seed=seed, subject=subject)
        self.says = says
        self._levels: list[float] = []
        self._answers: list[bool] = []

    def check(self, answer: Mapping[str, Any]) -> None:
        """Refuse an answer without the key."""
        if not isinstance(answer.get(self.says), (bool, np.bool_)):
            raise ArgumentError(f"An answer says {self.says}=True or False, found {dict(answer)!r}.")

    def take(self, answer: Mapping[str, Any]) -> None:
        """Take the answer to the trial."""
        self.check(answer)
        self._levels.append(self.conditions[self._next]["level"])
        self._answers.append(bool(answer[self.says]))
        super().take(answer)

    def plan(self) -> dict[str, Any]:
        """Tell all that decides which trials come, for the log."""
        return {"levels": [one["level"] for one in self.conditions], "says": self.says}

    def counts(self) -> tuple[Array, Array, Array]:
        """Give levels that differ, how many answers said so, and how many there are, of the trials so far."""
        return count(self._levels, self._answers)

    def fit(
        self, *, shape: str = "logistic", guess: float = 0.0, lapse: Union[float, str] = 0.0
    ) -> Psychometric:
        """Fit a psychometric function to the answers so far (:func:`thimble.experiment.fit`)."""
        return fit(*self.counts(), shape=shape, guess=guess, lapse=lapse)
