"""Several runs, recordings and the caller's own signals on one time axis."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arguments import PathOrName, number_of, path_of
from ._core import ArgumentError
from ._page import Page

if TYPE_CHECKING:
    from ._ticks import Ticks

# Rows that a run can have: name, property of Ticks, factor, unit. Vectors are drawn by their length.
_ROWS = {
    "force": ("force on the hand", "force", 1.0, "N"),
    "force_wanted": ("wanted force", "force_wanted", 1.0, "N"),
    "depth": ("depth", "depth", 1e3, "mm"),
    "speed": ("speed of the tip", "velocity", 1e3, "mm/s"),
    "gripper": ("gripper", "gripper", 1e3, "mm"),
}
_AXES = "xyz"
# Columns in which a longer curve keeps minimum and maximum: more than a screen has pixels [chosen]
_COLUMNS = 10_000


class _Curve(NamedTuple):
    row: str
    unit: str
    name: str
    time: NDArray[np.float64]
    values: NDArray[np.float64]


class Timeline:
    """Several runs, recordings and own signals on one time axis: as a page, in a notebook, or with matplotlib.

        timeline = thimble.Timeline({"stiff": stiff, "soft": soft})
        timeline.add("muscle", time, millivolts, unit="mV")        # a signal of your own
        timeline.save("timeline.html")                             # or `timeline` as the last line of a cell

    runs: runs or recordings by name, or a list of them. rows: values of a run that have a row: "force",
    "force_wanted", "depth", "speed", "gripper", or one axis of a vector, such as "force_z" and "tip_x".
    The page needs no network. Dragging selects a span of time, a double click shows all.
    """

    def __init__(
        self,
        runs: Union[Mapping[str, Ticks], Sequence[Ticks]] = (),
        *,
        rows: Sequence[str] = ("force", "depth", "speed"),
        title: str = "Timeline",
    ) -> None:
        self.title = title
        self._rows = [rows] if isinstance(rows, str) else list(rows)
        for row in self._rows:
            _row(row)
        self._curves: list[_Curve] = []
        self._names: list[str] = []
        named = runs if isinstance(runs, Mapping) else _by_title(list(runs))
        for name, run in named.items():
            self.add_run(name, run)

    def add_run(self, name: str, run: Ticks, *, shift: float = 0.0) -> "Timeline":
        """Add a run or a recording. shift: seconds by which it is later on this time line. Returns the timeline."""
        if not hasattr(run, "in_contact") or not hasattr(run, "columns"):
            raise TypeError(f"run: expected a run, a recording or ticks, found {run!r}.")
        time = run.time + number_of("shift", shift)
        self._names.append(str(name))
        for row in self._rows:
            label, attribute, axis, factor, unit = _row(row)
            values = np.asarray(getattr(run, attribute), np.float64)
            if axis is not None:
                values = values[:, axis]
            elif values.ndim == 2:
                values = np.linalg.norm(values, axis=1)
            self._curves.append(_Curve(label, unit, str(name), time, factor * values))
        return self

    def add(
        self,
        name: str,
        time: ArrayLike,
        values: ArrayLike,
        *,
        unit: str = "",
        row: Optional[str] = None,
        shift: float = 0.0,
    ) -> "Timeline":
        """Add a signal of your own. Returns the timeline.

        time: (n,), s, not decreasing; the same zero as the runs, or with shift, the seconds by which it is later.
        values: (n,), or (n, k) for k curves. NaN leaves a gap. row: name of the row, to draw several signals in one;
        by default a separate row.
        """
        moments, numbers = _numbers("time", time), _numbers("values", values)
        if moments.ndim != 1 or len(moments) < 1 or not np.isfinite(moments).all() or (np.diff(moments) < 0).any():
            raise ArgumentError("time: expected one or more finite numbers that do not decrease, (n,).")
        if numbers.ndim not in (1, 2) or len(numbers) != len(moments):
            raise ArgumentError(f"values: expected the shape ({len(moments)},) or ({len(moments)}, k), found {numbers.shape}.")
        moments = moments + number_of("shift", shift)
        each = [numbers] if numbers.ndim == 1 else list(numbers.T)
        for k, one in enumerate(each):
            own = name if len(each) == 1 else f"{name} {_AXES[k] if len(each) == 3 else k}"
            self._curves.append(_Curve(row or name, unit, own, moments, one))
        self._names.append(str(name))
        return self

    @property
    def rows(self) -> list[str]:
        """Names of the rows, from top to bottom."""
        return list(dict.fromkeys(curve.row for curve in self._curves))

    def page(self) -> Page:
        """Return the page. It needs no network."""
        return Page(self._html(), height=120 + 130 * max(1, len(self.rows)))

    def save(self, path: PathOrName) -> None:
        """Write the page as an HTML file."""
        self.page().save(path_of("path", path))

    def plot(self) -> Any:
        """Draw all rows with matplotlib, and return the figure. Raises ImportError without matplotlib."""
        try:
            from matplotlib import pyplot
        except ImportError as missing:
            raise ImportError("plot() needs matplotlib: install python3-matplotlib, or `pip install matplotlib`.") from missing
        rows = self.rows
        figure, axes = pyplot.subplots(
            max(1, len(rows)), 1, sharex=True, squeeze=False, constrained_layout=True, figsize=(9, 1 + 1.7 * max(1, len(rows)))
        )
        for axis, row in zip(axes[:, 0], rows):
            curves = [curve for curve in self._curves if curve.row == row]
            for curve in curves:
                axis.plot(curve.time, curve.values, label=curve.name, linewidth=0.9)
            axis.set_ylabel(f"{row} ({curves[0].unit})" if curves[0].unit else row)
            axis.legend(loc="upper right", ncols=4, frameon=False)
        axes[-1, 0].set_xlabel("time (s)")
        figure.suptitle(self.title)
        return figure

    def __repr__(self) -> str:
        return f"Timeline({', '.join(self._names) or 'empty'}; rows {', '.join(self.rows) or 'none'})"

    def _repr_html_(self) -> str:
        return self.page()._repr_html_()

    def _html(self) -> str:
        rows = []
        for row in self.rows:
            curves = [curve for curve in self._curves if curve.row == row]
            rows.append({
                "name": row,
                "unit": curves[0].unit,
                "curves": [{"name": one.name, **_packed(one)} for one in curves],
            })
        data = json.dumps({"title": self.title, "rows": rows}).replace("<", "\\u003c")
        template = Path(__file__).with_name("timeline.html").read_text(encoding="utf-8")
        return template.replace("/*DATA*/null", data)


def _row(name: str) -> tuple[str, str, Optional[int], float, str]:
    """Return label, property of Ticks, axis, factor and unit of a row."""
    if name in _ROWS:
        label, attribute, factor, unit = _ROWS[name]
        return label, attribute, None, factor, unit
    vector, _, axis = name.rpartition("_")
    units = {"force": (1.0, "N"), "force_wanted": (1.0, "N"), "tip": (1e3, "mm"), "velocity": (1e3, "mm/s"), "proxy": (1e3, "mm")}
    if vector not in units or axis not in tuple(_AXES):
        known = ", ".join([*_ROWS, *(f"{one}_x" for one in units)])
        raise ArgumentError(f'rows: there is no row "{name}"; there are {known} (and _y, _z).')
    return f"{vector} {axis}", vector, _AXES.index(axis), *units[vector]


def _by_title(runs: list[Any]) -> dict[str, Any]:
    """Return runs by their titles, numbered if a title is there more than once."""
    titles = [run._title() if hasattr(run, "_title") else str(k + 1) for k, run in enumerate(runs)]
    return {
        title if titles.count(title) == 1 else f"{title} {titles[: k + 1].count(title)}": run
        for k, (title, run) in enumerate(zip(titles, runs))
    }


def _numbers(name: str, values: ArrayLike) -> NDArray[np.float64]:
    try:
        return np.asarray(values, np.float64)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name}: expected numbers, found {values!r}.") from None


def _packed(curve: _Curve) -> dict[str, Any]:
    """Return times and values as base64. A long curve keeps first, minimum, maximum and last of each column."""
    time, values = curve.time, curve.values
    if len(values) > 4 * _COLUMNS:
        kept = []
        for part in np.array_split(np.arange(len(values)), _COLUMNS):
            inside = values[part]
            known = np.where(np.isnan(inside), np.inf, inside), np.where(np.isnan(inside), -np.inf, inside)
            gap = part[np.flatnonzero(np.isnan(inside))[:1]]
            kept += [part[0], part[known[0].argmin()], part[known[1].argmax()], *gap, part[-1]]
        chosen = np.unique(kept)
        time, values = time[chosen], values[chosen]
    begin = float(time[0])
    return {
        "begin": begin,
        "n": len(time),
        "time": base64.b64encode((time - begin).astype("<f4").tobytes()).decode(),
        "values": base64.b64encode(values.astype("<f4").tobytes()).decode(),
    }
