"""Order of conditions: all combinations, shuffled from a seed or balanced over subjects."""

from __future__ import annotations

import itertools
from typing import Any, Mapping, Optional, Sequence

import numpy as np

from .. import ArgumentError
from .._arguments import whole_of

ORDERS = ("given", "random", "blocks", "balanced")


def combinations(factors: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    """Return every combination of the factors' values. The last factor changes fastest."""
    names = list(factors)
    return [dict(zip(names, values)) for values in itertools.product(*factors.values())]


def balanced_row(count: int, subject: int) -> list[int]:
    """Return the order of `count` conditions for one subject: a row of a Williams design.

    Over `count` subjects (2 `count` if it is odd), each condition occurs at each position equally often,
    and follows each other condition equally often.
    """
    row = subject % count
    order = [(row + (at + 1) // 2 if at % 2 else row - at // 2) % count for at in range(count)]
    backwards = count % 2 == 1 and (subject // count) % 2 == 1
    return order[::-1] if backwards else order


class Trials:
    """Conditions in an order that is fixed before the first trial.

    conditions: values by the name of each factor (all combinations are used), or a list of dicts.
    repeats: trials of each condition. order: "given"; "random", all shuffled; "blocks", each block has
    every condition once, shuffled; "balanced", block k of subject s is row s + k of a Williams design.
    seed: seed of the shuffling. subject: number from 0; each subject has another order. "balanced"
    requires it, because it balances over subjects.
    """

    def __init__(
        self,
        conditions: Any,
        *,
        repeats: int = 1,
        order: str = "random",
        seed: int = 0,
        subject: Optional[int] = None,
    ) -> None:
        each = combinations(conditions) if isinstance(conditions, Mapping) else [dict(one) for one in conditions]
        if not each or repeats < 1:
            raise ArgumentError("conditions, repeats: expected at least one condition and one repeat.")
        if order not in ORDERS:
            raise ArgumentError(f"order: expected {', '.join(ORDERS)}, found {order!r}.")
        if order == "balanced" and subject is None:
            raise ArgumentError('subject: order="balanced" requires the number of the subject, from 0.')
        subject = whole_of("subject", subject or 0)
        random = np.random.default_rng([seed, subject])
        places = [list(range(len(each))) for _ in range(repeats)]
        if order == "balanced":
            places = [balanced_row(len(each), subject + block) for block in range(repeats)]
        elif order == "blocks":
            places = [random.permutation(len(each)).tolist() for _ in range(repeats)]
        row = list(itertools.chain.from_iterable(places))
        if order == "random":
            row = random.permutation(row).tolist()
        self.conditions = [each[at] for at in row]  #: conditions of all trials, in order
        self._next = 0

    def __repr__(self) -> str:
        return f"{type(self).__name__}({len(self.conditions)} trials, {self._next} done)"

    def condition(self) -> Optional[dict[str, Any]]:
        """Return the condition of the next trial; None after the last."""
        return dict(self.conditions[self._next]) if self._next < len(self.conditions) else None

    def take(self, answer: Mapping[str, Any]) -> None:
        """Take the answer to that trial, and continue with the next."""
        self._next += 1

    def plan(self) -> dict[str, Any]:
        """Return everything that determines the trials, for the log."""
        return {"trials": self.conditions}
