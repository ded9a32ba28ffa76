"""Psychometric functions (logistic or probit) of answers over level, fitted by maximum likelihood."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import ArgumentError

Array = NDArray[np.float64]

_QUARTILE = {"logistic": math.log(3.0), "probit": 0.6744897501960817}  # distance from the middle to 75 %, in widths
_LAPSES = np.linspace(0.0, 0.06, 13)  # upper bound of the search with lapse="fit"; more would be no lapse [chosen]
# Size of the initial grid over the levels' span, and number of its minima that are refined.
_MIDDLES = np.linspace(-0.5, 1.5, 41)
_LOG_WIDTHS = np.linspace(math.log(0.005), math.log(4.0), 14)
_MAX_STARTS = 8
_MAX_STEPS = 100
_NARROWEST = 1e-3  # width relative to the levels' span; the data cannot distinguish a narrower one from a step


def rising(shape: str, z: ArrayLike) -> Array:
    """Return the curve from 0 to 1, at z widths from its middle. shape: "logistic" or "probit"."""
    z = np.asarray(z, dtype=np.float64)
    if shape == "logistic":
        return 0.5 * (1.0 + np.tanh(0.5 * z))
    if shape == "probit":
        each = [0.5 * math.erfc(-one / math.sqrt(2.0)) for one in z.ravel().tolist()]
        return np.array(each, dtype=np.float64).reshape(z.shape)
    raise ArgumentError(f'shape: expected "logistic" or "probit", found {shape!r}.')


def _slope(shape: str, z: Array) -> Array:
    if shape == "logistic":
        f = rising(shape, z)
        return f * (1.0 - f)
    return np.exp(-0.5 * z * z) / math.sqrt(2.0 * math.pi)


@dataclass(frozen=True)
class Psychometric:
    """p(x) = guess + (1 - guess - lapse) F((x - middle) / width), F from 0 to 1 with F(0) = 1/2.

    ``middle_error`` and ``width_error`` are standard errors from the Fisher information. They are NaN if
    the answers do not determine the value (all levels right or wrong). ``deviance`` is twice the
    difference in log likelihood to the observed rates. For a model that fits, it is about the number of
    levels minus 2.
    """

    shape: str
    middle: float
    width: float
    guess: float
    lapse: float
    middle_error: float
    width_error: float
    deviance: float

    def __call__(self, level: ArrayLike) -> Array:
        """Return the probability at a level."""
        z = (np.asarray(level, dtype=np.float64) - self.middle) / self.width
        return self.guess + (1.0 - self.guess - self.lapse) * rising(self.shape, z)

    def level(self, probability: float) -> float:
        """Return the level of a probability between guess and 1 - lapse, e.g. 0.75 for a forced-choice threshold."""
        part = (probability - self.guess) / (1.0 - self.guess - self.lapse)
        if not 0.0 < part < 1.0:
            raise ArgumentError(f"probability: the curve does not reach {probability}.")
        if self.shape == "logistic":
            return self.middle + self.width * math.log(part / (1.0 - part))
        low, high = -40.0, 40.0
        for _ in range(80):
            z = (low + high) / 2
            low, high = (z, high) if rising(self.shape, z) < part else (low, z)
        return self.middle + self.width * (low + high) / 2

    @property
    def jnd(self) -> float:
        """Half the distance in level from F = 25 % to 75 %. It is the just noticeable difference if the answer
        is whether a comparison stimulus is "more"."""
        return _QUARTILE[self.shape] * self.width


def fit(
    levels: ArrayLike,
    successes: ArrayLike,
    totals: ArrayLike = 1,
    *,
    shape: str = "logistic",
    guess: float = 0.0,
    lapse: Union[float, str] = 0.0,
) -> Psychometric:
    """Fit a rising psychometric function by maximum likelihood.

    levels: (n,); equal levels may repeat. successes: (n,), number of `totals` trials that were answered
    "yes", "more" or correctly; without totals each is a single trial, 0 or 1. guess: probability without
    a stimulus, 0.5 for a choice of two. lapse: probability of a lapse (an answer that does not depend on
    the stimulus); "fit" selects the most likely value up to 0.06. Warns, and sets the errors to NaN, if
    the answers do not determine the width. Raises ArgumentError for fewer than two levels, or if the
    answers do not rise with the level.
    """
    x, k, n = _counted(levels, successes, totals)
    if len(x) < 2:
        raise ArgumentError("levels: expected two or more different levels.")
    if lapse == "fit":
        curves = [_fitted(x, k, n, shape, guess, float(one)) for one in _LAPSES]
        curve, determined = min(curves, key=lambda one: one[0].deviance)
    elif isinstance(lapse, str) or not 0.0 <= lapse < 1.0 - guess:
        raise ArgumentError(f'lapse: expected "fit" or 0 to {1.0 - guess:g}, found {lapse!r}.')
    else:
        curve, determined = _fitted(x, k, n, shape, guess, float(lapse))
    if not determined:
        warnings.warn(
            "The answers do not determine the width of the curve. Use levels closer to the threshold, or more trials.",
            RuntimeWarning,
            stacklevel=2,
        )
    return curve


def _counted(levels: ArrayLike, successes: ArrayLike, totals: ArrayLike) -> tuple[Array, Array, Array]:
    x, k, n = np.broadcast_arrays(*(np.asarray(one, dtype=np.float64) for one in (levels, successes, totals)))
    good = np.isfinite(x) & (k >= 0) & (k <= n)
    if x.ndim != 1 or not good.all():
        raise ArgumentError("levels, successes, totals: expected arrays of equal length, successes 0 to totals.")
    different, which = np.unique(x, return_inverse=True)
    counts = [np.asarray(np.bincount(which, one), np.float64) for one in (k, n)]
    return different, counts[0], counts[1]


def _loss(p: Array, k: Array, n: Array) -> float:
    with np.errstate(divide="ignore", invalid="ignore"):
        said = np.where(k > 0, k * np.log(p), 0.0) + np.where(n - k > 0, (n - k) * np.log(1.0 - p), 0.0)
    return -float(said.sum()) if np.isfinite(said).all() else math.inf


def _fitted(
    x: Array, k: Array, n: Array, shape: str, guess: float, lapse: float
) -> tuple[Psychometric, bool]:
    """Fit middle and log width by Fisher scoring with step halving, from each of several start points."""
    first, span = float(x[0]), float(x[-1] - x[0])
    x = (x - first) / span  # level scaled to 0 to 1
    range_ = 1.0 - guess - lapse
    narrowest = math.log(_NARROWEST)

    def at(values: Array) -> tuple[Array, Array]:
        z = (x - values[0]) / math.exp(values[1])
        return np.clip(guess + range_ * rising(shape, z), 1e-12, 1.0 - 1e-12), z

    def information(values: Array) -> tuple[Array, Array]:
        p, z = at(values)
        steep = range_ * _slope(shape, z)
        by = np.stack([-steep / math.exp(values[1]), -steep * z])  # derivatives of p by middle and log width
        weight = 1.0 / (p * (1.0 - p))
        return (by * weight * n) @ by.T, by @ (weight * (k - n * p))

    def nearer(values: Array, step: Array, loss: float) -> tuple[float, Array]:
        step = step * min(1.0, 1.0 / max(np.abs(step).max(), 1e-300))
        for halved in range(30):
            tried = values + step * 0.5**halved
            tried[1] = min(max(tried[1], narrowest), narrowest + 14.0)
            there = _loss(at(tried)[0], k, n)
            if there < loss:
                return there, tried
        return loss, values

    def improved(values: Array) -> tuple[float, Array]:
        loss = _loss(at(values)[0], k, n)
        for _ in range(_MAX_STEPS):
            matrix, ascent = information(values)
            # If one level dominates, the matrix is nearly singular, and damped steps converge better.
            there, tried = loss, values
            for damping in (1e-9, 1e-3, 1.0):
                damped = matrix + (damping * np.trace(matrix) + 1e-300) * np.eye(2)
                there, tried = min(
                    (there, tried), nearer(values, np.linalg.solve(damped, ascent), loss), key=lambda one: one[0]
                )
            if not there < loss:
                return loss, values
            gained, loss, values = loss - there, there, tried
            if gained < 1e-12 * (1.0 + loss):
                return loss, values
        return loss, values

    loss, best = min((improved(one) for one in _start_points(x, k, n, shape, guess, lapse)), key=lambda one: one[0])
    _refuse_flat(k, n, loss)
    matrix, _ = information(best)
    errors = np.full(2, math.nan)
    determined = narrowest + 1e-6 < best[1] < narrowest + 13.9 and bool(np.linalg.cond(matrix) < 1e12)
    if determined:
        deviations = np.sqrt(np.diag(np.linalg.inv(matrix)))
        determined = bool(deviations[1] < 1.0)  # the standard error of the log width is below 1
        errors = deviations if determined else errors
    own = _loss(k / n, k, n)
    width = span * math.exp(best[1])
    curve = Psychometric(
        shape=shape,
        middle=first + span * float(best[0]),
        width=width,
        guess=guess,
        lapse=lapse,
        middle_error=span * float(errors[0]),
        width_error=float(errors[1]) * width,
        deviance=max(0.0, 2.0 * (loss - own)),
    )
    return curve, determined


def _start_points(x: Array, k: Array, n: Array, shape: str, guess: float, lapse: float) -> list[Array]:
    """Return the start points of the search: separate local minima of a grid over middle and log width, best first.

    The loss has several minima, especially with guess > 0, and the best grid point is not always near the
    global minimum. x: the levels, scaled to 0 to 1.
    """
    z = (x - _MIDDLES[:, None, None]) / np.exp(_LOG_WIDTHS)[None, :, None]
    p = np.clip(guess + (1.0 - guess - lapse) * rising(shape, z), 1e-12, 1.0 - 1e-12)
    grid = -(k * np.log(p) + (n - k) * np.log(1.0 - p)).sum(axis=2)
    around = np.pad(grid, 1, constant_values=math.inf)
    rows, columns = grid.shape
    near = [around[1 + i : 1 + i + rows, 1 + j : 1 + j + columns] for i in (-1, 0, 1) for j in (-1, 0, 1)]
    valleys = np.argwhere(grid <= np.min(near, axis=0)).tolist()
    chosen: list[list[int]] = []
    for valley in sorted(valleys, key=lambda one: float(grid[one[0], one[1]])):
        # Start points of one flat region lead to the same minimum.
        if all(max(abs(valley[0] - one[0]), abs(valley[1] - one[1])) > 2 for one in chosen):
            chosen.append(valley)
        if len(chosen) == _MAX_STARTS:
            break
    return [np.array([_MIDDLES[i], _LOG_WIDTHS[j]]) for i, j in chosen]


def _refuse_flat(k: Array, n: Array, loss: float) -> None:
    flat = _loss(np.full(len(k), k.sum() / n.sum()), k, n)
    if not loss < flat - 1e-9:
        raise ArgumentError("The answers do not rise with the level, so they have no threshold.")


def count(levels: Any, answers: Any) -> tuple[Array, Array, Array]:
    """Return the distinct levels of single answers, with successes and totals of each."""
    return _counted(levels, np.asarray(answers, dtype=np.float64), 1)
