"""Runs in virtual time: whole, or tick by tick."""

from __future__ import annotations

import inspect
from typing import Any, Callable, Concatenate, Mapping, Optional, ParamSpec

from numpy.typing import ArrayLike

from . import _core
from ._arguments import PathOrName, vector_of
from ._run_base import ButtonRun, RunBase, ArmView, FinishedRun, open_run, stop_at_exit
from ._knobs import Knobs
from ._laws import Law
from ._meshes import Meshes
from ._scene_text import Scene
from ._shot import Shot, ShotSource
from ._ticks import Figure, Tick, Ticks


_Options = ParamSpec("_Options")


def _options_of(
    function: Callable[_Options, Any]
) -> Callable[[Callable[..., None]], Callable[Concatenate[Any, _Options], None]]:
    """Return a decorator that gives a method the signature of `function`, so that options are listed once."""
    signature = inspect.signature(function)
    own = inspect.Parameter("self", inspect.Parameter.POSITIONAL_OR_KEYWORD)

    def decorate(method: Callable[..., None]) -> Callable[Concatenate[Any, _Options], None]:
        parameters = [own, *signature.parameters.values()]
        setattr(method, "__signature__", signature.replace(parameters=parameters, return_annotation=None))
        return method

    return decorate


class Run(RunBase, Ticks):
    """A finished run: its ticks as arrays, its description and its results. It can be pickled, with its meshes.

    If the scene has several arms, the ticks are those of the first arm; ``arms`` has all of them.
    """

    def __init__(
        self,
        run: Any,
        columns: Any = None,
        arms: Optional[dict[str, "Run"]] = None,
        shot_source: Optional[ShotSource] = None,
    ) -> None:
        self._run = run
        self._shot_source = shot_source
        self._arms = arms
        super().__init__(run.ticks() if columns is None else columns)

    @property
    def arms(self) -> dict[str, "Run"]:
        """The run of each arm by its name in the scene; empty if the scene has one arm."""
        if self._arms is None:
            self._arms = {
                name: Run(ArmView(self._run, i), None, {}, self._shot_source) for i, name in enumerate(self._run.arms)
            }
        return self._arms

    def __reduce__(self) -> tuple[Any, ...]:
        return Run, (FinishedRun(self._run), self.columns, self.arms, self._shot_source)

    def shot(self, at: Optional[float] = None, **options: Any) -> Shot:
        """Draw a moment of the run, for a notebook or a file. The other options are those of :func:`shot`.

        at: time, s; by default the moment of the largest force. `thimble shot` repeats the run to draw it.
        Raises Error for runs that it cannot repeat: those with a custom force law, or with a quality
        other than normal.
        """
        assert self._shot_source is not None
        return self._shot_source.shot(at=at, **options)

    def __repr__(self) -> str:
        arms = f", arms {', '.join(self.arms)}" if self.arms else ""
        return f"Run({self._name()}: {self.end}, {self._contents()}{arms})"

    def _title(self) -> str:
        return self._name()

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
    """Run a scene with the simulated hand in virtual time, and return the finished run.

    Bit-identical to ``thimble run``, and repeatable. Other Python threads continue meanwhile; Ctrl-C ends
    the run.

    scene: file, or name (:func:`scenes`); or the scene itself, as a dict or as YAML text of several
    lines, with file names relative to the working folder. set: changes of the scene, by path:
    ``{"ball.stiffness": 300, "ball.effects.friction.coefficient": 0.2, "rate": 2000}``. seconds: duration,
    s. seed: seed of all random numbers. arm: file or name. By default all three are those of the scene.
    quality: "draft", "normal", "reference" or "auto". record: HDF5 file for every tick. overwrite: replace
    an existing recording; without it an existing file raises Error. A file of another kind is never
    replaced.

    law: a force law instead of the scene's. ``law(tick)`` is called in each tick and returns the force on
    the hand, three numbers (N, in the world), or None for the force of the scene, which is
    ``tick.force_wanted``. The force goes through the safety gate like any other. If the law raises an
    exception, the force is zero, the run ends, and the exception is raised here. A compiled law
    (:func:`compiled_law`) is as fast as the scene's.

    meshes: :class:`Meshes` that this run shares with others.

    Raises Error, with the remedy, if scene, arm or mesh cannot be loaded. A fault of the arm raises
    nothing: ``end`` is "fault" then, and the last tick names the fault.
    """
    held = open_run(scene, set=set, seconds=seconds, seed=seed, arm=arm, quality=quality, record=record,
                 overwrite=overwrite, law=law, meshes=meshes)
    held.run()
    why_not = "it had a custom force law" if law is not None else ""
    if quality != "normal":
        why_not = why_not or f"its quality was {quality}"
    return Run(held, shot_source=ShotSource(held.info()["scene_file"], arm, seed, why_not))


class Stepper(ButtonRun):
    """A run in virtual time, tick by tick. The options are those of :func:`run`.

    ``while stepper.step(): ...`` is bit-identical to :func:`run`. Use it in a ``with`` block if it records:
    the end of the block ends the run and closes the recording. So does the deletion of the Stepper, or
    the end of the program.
    """

    _run: _core.Run

    @_options_of(run)
    def __init__(self, *arguments: Any, **options: Any) -> None:
        given = inspect.signature(run).bind(*arguments, **options)
        given.apply_defaults()
        self._run = open_run(**given.arguments)
        stop_at_exit(self)

    def __enter__(self) -> "Stepper":
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def __repr__(self) -> str:
        tick = self.tick
        return f"Stepper({self._name()}: {self.end or ('not begun' if tick is None else f'at {tick.time:.3f} s')})"

    def step(self, hand: Optional[ArrayLike] = None) -> bool:
        """Run the next tick. Returns False, and runs nothing, if the run is over.

        hand: new target of the hand, (3,) in the world, m, instead of the path in the scene. The hand moves
        there smoothly like a person's, with at most 0.4 m/s. A point outside the arm's workspace is moved
        to the nearest point of its box. Raises Error if the arm cannot reach it.
        """
        return self._run.step(None if hand is None else vector_of("hand", hand))

    @property
    def knobs(self) -> Knobs:
        """The settings that can be changed between two steps."""
        return Knobs(self._run)

    @property
    def tick(self) -> Optional[Tick]:
        """The newest tick; None before the first."""
        latest = self._run.latest()
        return None if latest is None else Tick(latest)

    def stop(self) -> None:
        """End the run now, with zero force. Closes the recording."""
        self._run.stop()

    def ticks(self) -> Ticks:
        """Return all ticks so far."""
        return Ticks(self._run.ticks())
