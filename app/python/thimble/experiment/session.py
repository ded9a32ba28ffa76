"""The session of one subject. It can be continued after a crash."""

from __future__ import annotations

import json
from typing import Any, Callable, Mapping, NamedTuple, Optional, Protocol, Union

import numpy as np

from .. import ArgumentError, Error, PathOrName
from .subject_log import SubjectLog, line_of


class Procedure(Protocol):
    """Chooses the next trial: Trials, Staircase, ConstantStimuli, Interleaved, or a class of yours.

    It must depend only on its plan and the answers, so that a session can continue after a crash.
    """

    def condition(self) -> Optional[dict[str, Any]]:
        """Return the condition of the next trial; None after the last. Calls without an answer in between
        return the same condition."""

    def take(self, answer: Mapping[str, Any]) -> None:
        """Take the answer to that trial."""

    def plan(self) -> dict[str, Any]:
        """Return everything that determines the trials, as values that JSON can hold."""


def _check(procedure: Procedure, answer: Mapping[str, Any]) -> None:
    """Call the procedure's ``check``, if it has one, which may refuse an answer before it is logged."""
    check = getattr(procedure, "check", None)
    if check is not None:
        check(answer)


class Trial(NamedTuple):
    """A trial to present."""

    number: int  #: number of the trial, from 0
    condition: dict[str, Any]
    random: np.random.Generator  #: generator of this trial, seeded by the session's seed and the trial's number


Answer = Union[bool, Mapping[str, Any]]


class Interleaved:
    """Several procedures in one session, in random order. ``condition["track"]`` names the trial's procedure."""

    def __init__(self, tracks: Mapping[str, Procedure], *, seed: int = 0) -> None:
        """Combine procedures, given by name. seed: seed of their random order."""
        if not tracks:
            raise ArgumentError("tracks: expected at least one procedure.")
        self.tracks = dict(tracks)
        self._seed = int(seed)
        self._taken = 0

    def __repr__(self) -> str:
        return f"Interleaved({', '.join(f'{name}: {one!r}' for name, one in self.tracks.items())})"

    def condition(self) -> Optional[dict[str, Any]]:
        """Return the next condition of a procedure that is not over; None if all are over."""
        name = self._turn()
        return None if name is None else {"track": name, **(self.tracks[name].condition() or {})}

    def check(self, answer: Mapping[str, Any]) -> None:
        """Let the procedure of the present trial check an answer."""
        name = self._turn()
        if name is not None:
            _check(self.tracks[name], answer)

    def take(self, answer: Mapping[str, Any]) -> None:
        """Pass the answer to the procedure of the present trial."""
        name = self._turn()
        if name is not None:
            self.tracks[name].take(answer)
        self._taken += 1

    def plan(self) -> dict[str, Any]:
        """Return the plans of all procedures, and the seed."""
        return {"tracks": {name: one.plan() for name, one in self.tracks.items()}, "turns": self._seed}

    def _turn(self) -> Optional[str]:
        left = [name for name, one in self.tracks.items() if one.condition() is not None]
        if not left:
            return None
        return left[int(np.random.default_rng([self._seed, self._taken]).integers(len(left)))]


class Session:
    """The trials of one subject, with a log on disk.

    If the log exists, its answers are read in their order, and the session continues with the next
    trial. That trial and its random numbers are the same as without the interruption.
    """

    def __init__(
        self,
        log: PathOrName,
        procedure: Procedure,
        *,
        seed: int = 0,
        about: Optional[Mapping[str, Any]] = None,
    ) -> None:
        """Open or create the log.

        seed: seed of the trials' random numbers. about: additional values for the first line of the log
        (subject, arm, day ...), which must be the same each time. Raises Error if the log has another
        plan, seed or `about`.
        """
        self.procedure = procedure
        self._seed = int(seed)
        self._log = SubjectLog(log, {"seed": self._seed, "about": dict(about or {}), "plan": procedure.plan()})
        self.resumed = len(self._log.lines)  #: number of trials that were already in the log
        self._number = 0
        try:
            for line in self._log.lines:
                self._take(line)
        except BaseException:
            self.close()
            raise

    def __repr__(self) -> str:
        return f"Session({self._log.path.name}: {self._number} trials done, {self.procedure!r})"

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def trial(self) -> Optional[Trial]:
        """The next trial; None after the last."""
        condition = self.procedure.condition()
        if condition is None:
            return None
        return Trial(self._number, condition, np.random.default_rng([self._seed, self._number]))

    def answer(self, answer: Answer) -> None:
        """Log the answer to the trial, and continue with the next. The answer is on disk when this returns.

        answer: whether it was correct, or a mapping of values that JSON can hold. A staircase needs its
        key ``correct``.
        """
        condition = self.procedure.condition()
        if condition is None:
            raise Error("The session is over: there is no trial to answer.")
        entry = {"correct": bool(answer)} if isinstance(answer, (bool, np.bool_)) else dict(answer)
        line = {"trial": self._number, "condition": condition, "answer": entry}
        _check(self.procedure, json.loads(line_of(line))["answer"])
        self._take(self._log.write(line))

    def run(self, present: Callable[[Trial], Answer]) -> list[dict[str, Any]]:
        """Present all remaining trials, and return the log lines of all trials.

        present: function that presents the trial to the subject and returns the answer. An exception in
        it ends the session; the trial is not logged and is presented again next time.
        """
        while (trial := self.trial) is not None:
            self.answer(present(trial))
        return self.lines

    @property
    def lines(self) -> list[dict[str, Any]]:
        """Lines of the log, one per trial: trial, condition, answer."""
        return [dict(line) for line in self._log.lines]

    def close(self) -> None:
        """Close the log."""
        self._log.close()

    def _take(self, line: Mapping[str, Any]) -> None:
        condition = self.procedure.condition()
        if line.get("trial") != self._number or line.get("condition") != json.loads(line_of(condition or {})):
            raise Error(f"{self._log.path}: trial {self._number} is not the one of this plan.")
        self.procedure.take(line["answer"])
        self._number += 1
