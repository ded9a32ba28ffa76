"""Runs in real time."""

from __future__ import annotations

import os
import signal
import threading
from typing import Any, Mapping, Optional, Union

from . import _core
from ._arguments import PathOrName, path_of
from ._core import Error
from ._run_base import ButtonRun, open_run, stop_all, stop_at_exit
from ._knobs import Knobs
from ._scene_text import Scene
from ._ticks import Tick, Ticks


class Live(ButtonRun):
    """A scene in real time, on a simulated or a real arm (:func:`open`).

    The servo loop runs in C++ on its own thread; Python observes it and can end it. Use it in a ``with``
    block. At the end of the block, at the end of the program, on Ctrl-C and on SIGTERM the arm gets zero
    force. After a fault, or if the arm was unplugged, the force stays off; call :func:`open` again.
    """

    _run: _core.Run

    def __init__(self, run: _core.Run) -> None:
        self._run = run

    def __enter__(self) -> "Live":
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def __repr__(self) -> str:
        tick = self.tick
        state = "running" if self.running else self.end or "not begun"
        return f"Live({self._name()}, device {self.info['device']}: {state}{'' if tick is None else f', at {tick.time:.3f} s'})"

    @property
    def running(self) -> bool:
        """Whether the servo loop runs."""
        return self._run.running

    @property
    def tick(self) -> Optional[Tick]:
        """The newest tick; None before the first. The loop never waits for a reader."""
        latest = self._run.latest()
        return None if latest is None else Tick(latest)

    @property
    def knobs(self) -> Knobs:
        """The settings that can be changed during the run."""
        return Knobs(self._run)

    @property
    def topics(self) -> str:
        """Report of the ROS 2 topics, one fact per line; "" if there are none."""
        return self._run.topics_report()

    def stop(self) -> None:
        """End the loop with zero force, if it runs, and wait for its end. Closes the recording."""
        self._run.stop()

    def ticks(self) -> Ticks:
        """Return all ticks of a finished run. Raises Error before its end."""
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
    """Run a scene in real time; it starts at once. The other options are those of :func:`run`.

    device: "sim" for the simulated arm, a name from :func:`devices`, or "auto" for the only connected
    arm. Raises Error, with the remedy, if it cannot be used.

    agree: **a real arm moves by itself.** Keep clear of it, hold its grip, keep its switch within reach,
    and confirm this with ``agree=True``.

    unchecked: a real arm that has not passed ``thimble feel-check`` gets at most 0.5 N. With
    ``unchecked=True`` it gets its full force nevertheless. A real arm uses its own arm file. Limits in
    the scene or in ``arm`` can only tighten those limits; the result is printed to stderr.

    firmware: image for an arm that needs one. homed: the real arm was in its home pose at power-up, so
    only its workspace is checked before it gets a force. hold_to_run: "button" (or "button2" to
    "button16"): the arm gives forces only while that button is held. no_real_time: use a real arm even
    if the loop gets no real-time priority.

    ros2: publish the run as ROS 2 topics (package thimble-ros2): True, or a dict with any of the options
    of ``thimble run --ros2``: ``{"namespace": "/phantom", "names": "omni", "domain": 5, "force": "add",
    "limit": 1, "stale_ms": 50, "frames": "world,tip", "network": False}``. With ``"network": True`` other
    computers can read the topics and send forces.
    """
    path_of("device", device, "\"sim\", \"auto\" or a name")
    if device not in ("sim", "auto") and not agree:  # the C++ part asks about the arm that "auto" finds
        raise Error(
            f"{device} will move by itself. Keep clear of it, hold its grip, keep its switch within reach, "
            "and pass agree=True."
        )
    held = open_run(
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
    """Send zero force before each signal that would end Python at once."""
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

