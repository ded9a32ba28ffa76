"""Ticks as pandas tables, matplotlib pictures (if installed), and HTML for notebooks."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any, Sequence

import numpy as np

from . import _core

if TYPE_CHECKING:
    from . import Figure, Ticks

_AXES = "xyz"
_WIDTH, _HEIGHT = 560, 90  # size of one curve in HTML, in pixels


def to_pandas(ticks: Ticks) -> Any:
    """Return ticks as a pandas DataFrame (see ``Ticks.to_pandas``)."""
    try:
        import pandas
    except ImportError as missing:
        raise ImportError("to_pandas() needs pandas: install python3-pandas, or `pip install pandas`.") from missing
    columns = {}
    by_axis = _core.columns_by_axis()
    for name in ticks.columns.dtype.names:
        values = ticks.columns[name]
        if values.ndim == 1:
            columns[name] = values.copy()
            continue
        for k in range(values.shape[1]):
            part = _AXES[k] if values.shape[1] == 3 and name not in by_axis else str(k)
            columns[f"{name}_{part}"] = values[:, k].copy()
    return pandas.DataFrame(columns, index=pandas.Index(ticks.time, name="seconds"))


def plot(ticks: Ticks, title: str) -> Any:
    """Draw force and depth over time with matplotlib (see ``Ticks.plot``)."""
    try:
        from matplotlib import pyplot
    except ImportError as missing:
        raise ImportError("plot() needs matplotlib: install python3-matplotlib, or `pip install matplotlib`.") from missing
    figure, (force, depth) = pyplot.subplots(2, 1, sharex=True, constrained_layout=True)
    for k, axis in enumerate(_AXES):
        force.plot(ticks.time, ticks.force[:, k], label=axis, linewidth=0.8)
    force.plot(ticks.time, np.linalg.norm(ticks.force, axis=1), label="size", color="black")
    force.set_ylabel("force on the hand (N)")
    force.legend(loc="upper right", ncols=4)
    depth.plot(ticks.time, 1e3 * ticks.depth, color="black")
    depth.set_ylabel("depth (mm)")
    depth.set_xlabel("time (s)")
    figure.suptitle(title)
    return figure


def curve(values: Any, unit: str) -> str:
    """Draw one curve as SVG: minimum and maximum of each column of pixels."""
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 0.0)
    span = high - low or 1.0
    points = []
    for x, part in enumerate(np.array_split(values, min(len(values), _WIDTH)) if len(values) else []):
        for value in (part.min(), part.max()):
            points.append(f"{x},{_HEIGHT - (value - low) / span * _HEIGHT:.1f}")
    return (
        f'<svg width="{_WIDTH}" height="{_HEIGHT + 4}" viewBox="0 -2 {_WIDTH} {_HEIGHT + 4}">'
        f'<polyline fill="none" stroke="currentColor" points="{" ".join(points)}"/></svg>'
        f"<br><small>{escape(unit)}: {low:.4g} to {high:.4g}</small>"
    )


def html(title: str, ticks: Ticks, figures: Sequence[Figure]) -> str:
    """Return ticks as HTML: two curves and the figures. It loads no other files."""
    span = f"{ticks.time[0]:.3f} to {ticks.time[-1]:.3f} s" if len(ticks) else "none"
    rows = "".join(
        f"<tr><td>{escape(one.name)}</td><td>{one.value:.6g}</td><td>{escape(one.unit)}</td>"
        f"<td>{escape(one.goal)}{'' if one.met else ' (missed)'}</td></tr>"
        for one in figures
    )
    table = f"<table><tr><th>figure</th><th>value</th><th>unit</th><th>goal</th></tr>{rows}</table>" if rows else ""
    return (
        f"<div><b>{escape(title)}</b>, {len(ticks)} ticks, {span}<br>"
        f"{curve(np.linalg.norm(ticks.force, axis=1), 'force on the hand, N')}<br>"
        f"{curve(1e3 * ticks.depth, 'depth, mm')}{table}</div>"
    )
