"""Scenes in real time."""

from __future__ import annotations

import os
import signal
import threading
from typing import Any, Mapping, Optional, Union

from . import _core
from ._arguments import PathOrName, path_of
from ._core import Error
from ._held import Held, begin, stop_all, stop_at_exit
from ._knobs import Knobs
from ._scene_text import Scene
from ._ticks import Tick, Ticks


class Live(Held):
    """A scene in real time, on a simulated or a real arm (:func:`open`).

    The servo loop runs in C++ on a thread of its own; Python looks on and can end it. Use it in a
    ``with``: at the end of it, at the end of the program, on Ctrl-C and SIGTERM the arm gets zero
    force. After a fault, or when the arm was pulled, the force stays off; open it anew.
    """

    _run: _core.Run

    def __init__(self, run: _core.Run) -> None:
        self._run = run

    def __enter__(self) -> "Live":
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    @property
    def running(self) -> bool:
        """Whether the servo loop runs."""
        return self._run.running

    @property
    def tick(self) -> Optional[Tick]:
        """The newest tick; None before the first. The loop does not wait for who looks."""
        latest = self._run.latest()
        return None if latest is None else Tick(latest)

    @property
    def knobs(self) -> Knobs:
        """The settings that can be turned while it is felt."""
        return Knobs(self._run)

    @property
    def topics(self) -> str:
        """What there is to say of the topics of ROS 2, a line each; "" if there are none."""
        return self._run.topics_report()

    def stop(self) -> None:
        """End the loop with zero force, if it runs, and wait for that. A recording is closed."""
        self._run.stop()

    def ticks(self) -> Ticks:
        """Give all ticks of a run that is over; Error while it goes on."""
        return Ticks(self._run.ticks())


def open(
    scene: Scene,
    device: str = "auto",
    *,
    set: Optional[Mapping[str, Any]] = None,
    agree: bool = False,
    unchecked: bool = False,
    seconds: Optional[float] = None,
    seed: Optional[int] = None,
    arm: Optional[PathOrName] = None,
    quality: str = "normal",
    record: Optional[PathOrName] = None,
    overwrite: bool = False,
    firmware: Optional[PathOrName] = None,
    homed: bool = False,
    hold_to_run: Optional[str] = None,
    no_real_time: bool = False,
    ros2: Union[None, bool, Mapping[str, Any]] = None,
) -> Live:
    """Touch a scene in real time, and begin at once. Other options as of :func:`run`.

    device: "sim" for the simulated arm, a name that :func:`devices` tells, or "auto" for the only arm
    that is plugged in (Error if there is none). agree: **a real arm moves by itself.**
    Keep clear of it, hold its grip, have its switch at hand, and say so with ``agree=True``. unchecked: a
    real arm that has not passed ``thimble feel-check`` gets at most 0.5 N; ``unchecked=True`` gives it
    its whole force all the same. A real arm brings its own arm file; what the scene or ``arm`` say of
    limits may only tighten them, and stderr says what became of it. firmware: image for an arm that
    needs one. homed: a real arm was in its home pose when it got power, so
    that only its workspace is checked before it gets a force. hold_to_run: "button" (or "button2" to
    "button16"): forces come only while that button of the arm is held. no_real_time: use a real arm though
    the loop gets no real-time priority. ros2: publish the run as topics of ROS 2 (package
    thimble-ros2): True, or what ``thimble run --ros2`` takes as a dict, ``{"namespace": "/phantom",
    "names": "omni", "domain": 5, "force": "add", "limit": 1, "stale_ms": 50, "frames":
    "world,tip", "network": False}``, each of them as you like; with ``"network": True`` other
    computers can read the topics and give forces. Raises Error with what to do.
    """
    path_of("device", device, "\"sim\", \"auto\" or a name")
    if device not in ("sim", "auto") and not agree:  # the C++ part asks about the arm that "auto" finds
        raise Error(
            f"{device} would get forces. Keep clear of it, hold its grip, keep its switch at hand, and "
            "say agree=True."
        )
    held = begin(
        scene,
        set=set,
        seconds=seconds,
        seed=seed,
        arm=arm,
        quality=quality,
        record=record,
        overwrite=overwrite,
        device=device,
        agreed=agree,
        unchecked=unchecked,
        real_time=True,
        firmware=firmware,
        homed=homed,
        hold_to_run=hold_to_run,
        no_real_time=no_real_time,
        ros2=dict(ros2) if isinstance(ros2, Mapping) else ros2,
    )
    live = Live(held)
    stop_at_exit(live)
    _stop_on_signals()
    held.start()
    return live


# Signals that would end Python at once and can be caught; SIGINT arrives as KeyboardInterrupt.
_ENDING = ("TERM", "HUP", "QUIT", "USR1", "USR2", "ALRM", "VTALRM", "PROF", "XCPU", "IO", "PWR")


def _stop_on_signals() -> None:
    """Let each signal that would end Python at once leave by zero force first."""
    if threading.current_thread() is not threading.main_thread():
        return

    def leave(number: int, _: Any) -> None:
        stop_all()
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)

    for name in _ENDING:
        number = getattr(signal, "SIG" + name, None)
        # A handler of the caller stays: its exit runs the atexit functions.
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, leave)

