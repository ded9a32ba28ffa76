"""One subject's trials, from the first or from where a crash left them."""

from __future__ import annotations

import json
from typing import Any, Callable, Mapping, NamedTuple, Optional, Protocol, Union

import numpy as np

from .. import ArgumentError, Error, PathOrName
from .subject_log import SubjectLog, line_of


class Procedure(Protocol):
    """What decides which trial comes next: Trials, Staircase, ConstantStimuli, Interleaved, or one's own.

    It may depend on nothing but its plan and the answers, so that a session can go on after a crash.
    """

    def condition(self) -> Optional[dict[str, Any]]:
        """Give the next trial's condition; None after the last. Asked again it is the same."""

    def take(self, answer: Mapping[str, Any]) -> None:
        """Take the answer to that trial."""

    def plan(self) -> dict[str, Any]:
        """Tell all that decides which trials come, as JSON can hold it."""


def _check(procedure: Procedure, answer: Mapping[str, Any]) -> None:
    """Let a procedure refuse an answer before it is logged, if it has a word to say (``check``)."""
    check = getattr(procedure, "check", None)
    if check is not None:
        check(answer)


class Trial(NamedTuple):
    """A trial that is to be presented."""

    number: int  #: number of the trial, from 0 on
    condition: dict[str, Any]
    random: np.random.Generator  #: seed of this trial, from the session's seed and the trial's number


Answer = Union[bool, Mapping[str, Any]]


class Interleaved:
    """Several procedures in one session, in turn at random; ``condition["track"]`` names whose trial it is."""

    def __init__(self, tracks: Mapping[str, Procedure], *, seed: int = 0) -> None:
        """Take the procedures by their names; seed: of whose turn it is."""
        if not tracks:
            raise ArgumentError("tracks: expected at least one procedure.")
        self.tracks = dict(tracks)
        self._seed = int(seed)
        self._taken = 0

    def condition(self) -> Optional[dict[str, Any]]:
        """Give the condition of one that is not over; None if all are."""
        name = self._turn()
        return None if name is None else {"track": name, **(self.tracks[name].condition() or {})}

    def check(self, answer: Mapping[str, Any]) -> None:
        """Let the one whose turn it is refuse an answer."""
        name = self._turn()
        if name is not None:
            _check(self.tracks[name], answer)

    def take(self, answer: Mapping[str, Any]) -> None:
        """Hand the answer to whose turn it was."""
        name = self._turn()
        if name is not None:
            self.tracks[name].take(answer)
        self._taken += 1

    def plan(self) -> dict[str, Any]:
        """Tell the plans of all, and the seed."""
        return {"tracks": {name: one.plan() for name, one in self.tracks.items()}, "turns": self._seed}

    def _turn(self) -> Optional[str]:
        left = [name for name, one in self.tracks.items() if one.condition() is not None]
        if not left:
            return None
        return left[int(np.random.default_rng([self._seed, self._taken]).integers(len(left)))]


class Session:
    """The trials of one subject, with a log that survives the program.

    If the log is there, its answers are taken in their order, and the session goes on with the next
    trial: the same one, with the same random numbers, as without the interruption.
    """

    def __init__(
        self,
        log: PathOrName,
        procedure: Procedure,
        *,
        seed: int = 0,
        about: Optional[Mapping[str, Any]] = None,
    ) -> None:
        """Open or begin the log.

        seed: of the trials' random numbers. about: what else the log's first line shall say (subject,
        arm, day ...); the same each time. Raises Error if the log is of another plan, seed or subject.
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
        """Log the answer to the trial, on the disk before this returns, and go on to the next.

        answer: whether it was correct, or a mapping of whatever JSON can hold (``correct`` among it for
        a staircase).
        """
        condition = self.procedure.condition()
        if condition is None:
            raise Error("The session is over: there is no trial to answer.")
        told = {"correct": bool(answer)} if isinstance(answer, (bool, np.bool_)) else dict(answer)
        line = {"trial": self._number, "condition": condition, "answer": told}
        _check(self.procedure, json.loads(line_of(line))["answer"])
        self._take(self._log.write(line))

    def run(self, present: Callable[[Trial], Answer]) -> list[dict[str, Any]]:
        """Present all trials that are left, and give the lines of all.

        present: shows the trial to the subject, and gives the answer. What it raises ends the session;
        the trial is not logged and comes again next time.
        """
        while (trial := self.trial) is not None:
            self.answer(present(trial))
        return self.lines

    @property
    def lines(self) -> list[dict[str, Any]]:
        """What the log has of the trials: trial, condition, answer."""
        return [dict(line) for line in self._log.lines]

    def close(self) -> None:
        """Let the log go."""
        self._log.close()

    def _take(self, line: Mapping[str, Any]) -> None:
        condition = self.procedure.condition()
        if line.get("trial") != self._number or line.get("condition") != json.loads(line_of(condition or {})):
            raise Error(f"{self._log.path}: trial {self._number} is not the one that this plan has there.")
        self.procedure.take(line["answer"])
        self._number += 1
