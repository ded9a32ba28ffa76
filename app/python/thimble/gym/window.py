"""A window that shows frames, by Tk of Python's standard library."""

from __future__ import annotations

import time
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from .. import Error

_PERIOD = 1.0 / 30.0  # s between two frames of the window [chosen: as fluent as a film]


class Window:
    """Shows frames. If its user closes it, the run continues without it."""

    def __init__(self, title: str, width: int, height: int) -> None:
        try:
            import tkinter
        except ImportError as missing:
            raise Error(
                'render_mode "human" needs Tk: install python3-tk, or use render_mode="rgb_array".'
            ) from missing
        self._tk = tkinter
        try:
            self._root: Optional[Any] = tkinter.Tk(className="Thimble")
        except tkinter.TclError as wrong:
            raise Error(
                f'render_mode "human" needs a display: {wrong}. Use render_mode="rgb_array".'
            ) from None
        self._root.title(title)
        self._root.resizable(False, False)
        self._root.protocol("WM_DELETE_WINDOW", self.close)
        self._label = tkinter.Label(self._root, width=width, height=height, borderwidth=0)
        self._label.pack()
        self._image: Any = None
        self._begin: Optional[float] = None
        self._shown = 0.0

    @property
    def is_open(self) -> bool:
        """Whether neither the user nor the program closed it."""
        return self._root is not None

    def is_due(self, virtual: float, new_episode: bool) -> bool:
        """Return whether a frame is to be shown at this virtual time (s) of the episode, after waiting for that time."""
        if self._root is None:
            return False
        if new_episode or self._begin is None:
            self._begin, self._shown = time.monotonic() - virtual, virtual
            return True
        if virtual - self._shown < _PERIOD:
            return False
        self._shown = virtual
        time.sleep(max(0.0, self._begin + virtual - time.monotonic()))
        return True

    def show(self, frame: NDArray[np.uint8]) -> None:
        """Show a frame (height, width, 3)."""
        if self._root is None:
            return
        height, width, _ = frame.shape
        data = b"P6 %d %d 255 " % (width, height) + frame.tobytes()
        self._image = self._tk.PhotoImage(master=self._root, data=data, format="PPM")
        self._label.configure(image=self._image)
        self._root.update()

    def close(self) -> None:
        """Close the window. Repeated calls do nothing."""
        if self._root is not None:
            self._root.destroy()
            self._root = None
