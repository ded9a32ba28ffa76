"""The method of constant stimuli: fixed levels, each presented equally often."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from .. import ArgumentError
from .._arguments import renamed, warn_renamed
from .order import Trials
from .psychometric import Array, Psychometric, count, fit


class ConstantStimuli(Trials):
    """Levels in a shuffled order. A trial has ``condition["level"]``, its answer has the key `answer_key`."""

    def __init__(
        self,
        levels: Sequence[float],
        repeats: int,
        *,
        answer_key: str = "correct",
        order: str = "blocks",
        seed: int = 0,
        subject: Optional[int] = None,
        says: Optional[str] = None,
    ) -> None:
        """Create the trials.

        levels: in any unit. repeats: trials of each level.
        answer_key: key of the answer whose value is True or False; True is more frequent at higher levels.
        order, seed, subject: as in :class:`Trials`; "balanced" needs the subject.
        says: deprecated; former name of answer_key.
        """
        answer_key = renamed("says", says, "answer_key", answer_key, "correct")
        each = {"level": [float(one) for one in levels]}
        super().__init__(each, repeats=repeats, order=order, seed=seed, subject=subject)
        self.answer_key = answer_key
        self._levels: list[float] = []
        self._answers: list[bool] = []

    @property
    def says(self) -> str:
        """Former name of `answer_key`; deprecated."""
        warn_renamed("ConstantStimuli.says", "ConstantStimuli.answer_key")
        return self.answer_key

    def check(self, answer: Mapping[str, Any]) -> None:
        """Raise ArgumentError if an answer lacks the key."""
        if not isinstance(answer.get(self.answer_key), (bool, np.bool_)):
            raise ArgumentError(f"answer: expected {self.answer_key}=True or False, found {dict(answer)!r}.")

    def take(self, answer: Mapping[str, Any]) -> None:
        """Store the answer to the present trial."""
        self.check(answer)
        self._levels.append(self.conditions[self._next]["level"])
        self._answers.append(bool(answer[self.answer_key]))
        super().take(answer)

    def plan(self) -> dict[str, Any]:
        """Return everything that determines the trials, for the log."""
        return {"levels": [one["level"] for one in self.conditions], "says": self.answer_key}

    def counts(self) -> tuple[Array, Array, Array]:
        """Return the distinct levels, their numbers of True answers and their numbers of trials so far."""
        return count(self._levels, self._answers)

    def fit(
        self, *, shape: str = "logistic", guess: float = 0.0, lapse: Union[float, str] = 0.0
    ) -> Psychometric:
        """Fit a psychometric function to the answers so far (:func:`thimble.experiment.fit`)."""
        return fit(*self.counts(), shape=shape, guess=guess, lapse=lapse)
