"""Ids of environments, for Gymnasium if it is installed, and without it."""

from __future__ import annotations

from typing import Any, Callable

from .. import ArgumentError
from . import tasks
from .environment import TouchEnv
from .touch_vector import TouchVectorEnv

# id: the class of one environment, and the function for many
_IDS: dict[str, tuple[type[TouchEnv], Callable[..., TouchVectorEnv]]] = {
    "thimble/Touch-v0": (tasks.TouchTask, tasks.touch_vector),
    "thimble/Contour-v0": (tasks.ContourTask, tasks.contour_vector),
}


def ids() -> list[str]:
    """Return the ids for :func:`make` and ``gymnasium.make``."""
    return list(_IDS)


def make(id: str, **options: Any) -> TouchEnv:
    """Create the environment of an id, without Gymnasium and its wrappers. The options are those of its class."""
    return _known(id)[0](**options)


def make_vec(id: str, num_envs: int = 1, **options: Any) -> TouchVectorEnv:
    """Create many environments of an id in this process (:class:`TouchVectorEnv`), without Gymnasium."""
    return _known(id)[1](num_envs, **options)


def _known(id: str) -> tuple[type[TouchEnv], Callable[..., TouchVectorEnv]]:
    if id not in _IDS:
        raise ArgumentError(f"id: there is no environment {id!r}; there are {', '.join(_IDS)}.")
    return _IDS[id]


def register_with_gymnasium() -> None:
    """Register the ids, if Gymnasium is installed. The import of ``thimble.gym`` calls this."""
    try:
        import gymnasium
    except ImportError:
        return
    register = getattr(gymnasium, "register", None)
    if register is None:  # a module of this name that is not Gymnasium
        return
    for id, (one, many) in _IDS.items():
        if id not in gymnasium.registry:
            register(
                id=id,
                entry_point=f"{one.__module__}:{one.__name__}",
                vector_entry_point=f"{many.__module__}:{many.__name__}",
            )
