"""Scenes in virtual time: at once, and tick by tick."""

from __future__ import annotations

import inspect
from typing import Any, Callable, Concatenate, Mapping, Optional, ParamSpec

from numpy.typing import ArrayLike

from . import _core
from ._arguments import PathOrName, vector_of
from ._held import Held, OfArm, Past, begin, stop_at_exit
from ._knobs import Knobs
from ._laws import Law
from ._meshes import Meshes
from ._scene_text import Scene
from ._shot import Shot, Touched
from ._ticks import Figure, Tick, Ticks


_Options = ParamSpec("_Options")


def _options_of(
    function: Callable[_Options, Any]
) -> Callable[[Callable[..., None]], Callable[Concatenate[Any, _Options], None]]:
    """Give a method the signature of a function, which lists the options for both."""
    signature = inspect.signature(function)
    own = inspect.Parameter("self", inspect.Parameter.POSITIONAL_OR_KEYWORD)

    def decorate(method: Callable[..., None]) -> Callable[Concatenate[Any, _Options], None]:
        parameters = [own, *signature.parameters.values()]
        setattr(method, "__signature__", signature.replace(parameters=parameters, return_annotation=None))
        return method

    return decorate


class Run(Held, Ticks):
    """A run that is over: its ticks as arrays, and what it was. May be pickled, meshes and all.

    Of a scene with several arms it is what the first of them did; ``arms`` has all of them.
    """

    def __init__(
        self,
        run: Any,
        columns: Any = None,
        arms: Optional[dict[str, "Run"]] = None,
        touched: Optional[Touched] = None,
    ) -> None:
        self._run = run
        self._touched = touched
        self._arms = arms
        Ticks.__init__(self, run.ticks() if columns is None else columns)

    @property
    def arms(self) -> dict[str, "Run"]:
        """The run of each arm by its name in the scene; empty if the scene has one alone."""
        if self._arms is None:
            self._arms = {name: Run(OfArm(self._run, i), None, {}, self._touched) for i, name in enumerate(self._run.arms)}
        return self._arms

    def __reduce__(self) -> tuple[Any, ...]:
        return Run, (Past(self._run), self.columns, self.arms, self._touched)

    def shot(self, at: Optional[float] = None, **options: Any) -> Shot:
        """Draw a moment of it, for a notebook or a file; options as of :func:`shot`.

        at: second; when most was felt if absent. `thimble shot` repeats the run for it, so Error for runs
        that it cannot repeat: with a law of one's own, or another quality than normal.
        """
        assert self._touched is not None
        return self._touched.shot(at=at, **options)

    def _title(self) -> str:
        return f"{self.info['scene']}, {self.info['arm']}"

    def _figures(self) -> list[Figure]:
        return self.figures()


def run(
    scene: Scene,
    *,
    set: Optional[Mapping[str, Any]] = None,
    seconds: Optional[float] = None,
    seed: Optional[int] = None,
    arm: Optional[PathOrName] = None,
    quality: str = "normal",
    record: Optional[PathOrName] = None,
    overwrite: bool = False,
    law: Optional[Law] = None,
    meshes: Optional[Meshes] = None,
) -> Run:
    """Let the simulated hand touch a scene in virtual time, and give what was felt.

    The same to the bit as ``thimble run``, and again each time. Other Python threads go on meanwhile;
    Ctrl-C ends it.

    scene: file, or a name (:func:`scenes`); or the scene itself, as a dict or as YAML text of several
    lines, with files beside the working folder. set: values of it to be others, by where they stand:
    ``{"ball.stiffness": 300, "ball.effects.friction.coefficient": 0.2, "rate": 2000}``. seconds: how long; the scene's own if absent. seed: of
    everything random; the scene's own if absent. arm: file or name in place of the scene's arm.
    quality: "draft", "normal", "reference" or "auto". record: HDF5 file to write every tick into.
    overwrite: let it replace an existing recording; without it that is an Error, and a file of another
    kind is never replaced.

    law: a force law in place of the scene's: ``law(tick)`` is asked in each tick for the force on the
    hand, three numbers (N, in the world), or None for the scene's own, which is
    ``tick.force_wanted``. It goes through the safety gate as any force does. An exception in it is
    zero force, the end of the run, and comes out here. A compiled one (:func:`compiled_law`) runs as fast
    as the scene's.

    meshes: :class:`Meshes` that this run shares with others.

    Raises Error, with what to do, if scene, arm or mesh cannot be had. A fault of the arm is no
    exception: ``end`` is "fault" then, and the last tick names it.
    """
    held = begin(scene, set=set, seconds=seconds, seed=seed, arm=arm, quality=quality, record=record, overwrite=overwrite, law=law, meshes=meshes)
    held.run()
    why_not = "it had a force law of its own" if law is not None else ""
    if quality != "normal":
        why_not = why_not or f"its quality was {quality}"
    return Run(held, touched=Touched(held.info()["scene_file"], arm, seed, why_not))


class Stepper(Held):
    """A scene in virtual time, tick by tick. Options as of :func:`run`.

    ``while stepper.step(): ...`` is the same to the bit as :func:`run`. Use it in a ``with`` if it records:
    at the end of it the run ends and the recording is closed. A Stepper that is dropped, or left at the end
    of the program, does the same.
    """

    _run: _core.Run

    @_options_of(run)
    def __init__(self, *arguments: Any, **options: Any) -> None:
        given = inspect.signature(run).bind(*arguments, **options)
        given.apply_defaults()
        self._run = begin(**given.arguments)
        stop_at_exit(self)

    def __enter__(self) -> "Stepper":
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def step(self, hand: Optional[ArrayLike] = None) -> bool:
        """Run the next tick. False, and nothing runs, if the run is over.

        hand: where the hand is led to from now on, (3,) in the world, m, in place of the scene's way:
        it goes there as a person's would, smoothly and at most with 0.4 m/s. A point outside of the
        arm's workspace is drawn to its box. Raises Error where the arm does not reach it.
        """
        return self._run.step(None if hand is None else vector_of("hand", hand))

    @property
    def knobs(self) -> Knobs:
        """The settings that can be turned between two steps."""
        return Knobs(self._run)

    @property
    def tick(self) -> Optional[Tick]:
        """The tick that ran last; None before the first."""
        latest = self._run.latest()
        return None if latest is None else Tick(latest)

    def stop(self) -> None:
        """End the run now, with zero force; a recording is closed."""
        self._run.stop()

    def ticks(self) -> Ticks:
        """Give all ticks so far."""
        return Ticks(self._run.ticks())
