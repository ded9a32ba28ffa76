"""Writes scenes that are given as a dict or text, or with changes, into files for the program."""

from __future__ import annotations

import atexit
import functools
import json
import os
import re
import shutil
import tempfile
from pathlib import Path
from typing import Any, Mapping, Optional, Union

from . import _core
from ._arguments import PathOrName, path_of
from ._core import ArgumentError, Error

Scene = Union[PathOrName, Mapping[str, Any]]


def as_yaml(value: Any) -> str:
    """Return a value as JSON, which is also YAML. numpy values become Python's, paths become text."""
    try:
        # Keeps emoji: JSON would escape them as surrogate pairs, which YAML does not have.
        text = json.dumps(value, allow_nan=False, ensure_ascii=False, default=_plain)
        text.encode("utf-8")
    except (AttributeError, TypeError, ValueError) as wrong:
        raise ArgumentError(f"A scene cannot hold {value!r}: {wrong}.") from wrong
    # Characters that end a line in YAML or that YAML refuses, although JSON accepts them.
    return _UNPRINTABLE.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


# C1 controls, DEL, line and paragraph separators, byte order mark [YAML 1.2, 5.1 and 5.4].
_UNPRINTABLE = re.compile("[\x7f-\x9f\u2028\u2029\ufeff]")


def _plain(value: Any) -> Any:
    """Convert a path, numpy array or numpy number to a type that JSON has."""
    return os.fsdecode(value) if isinstance(value, os.PathLike) else value.tolist()


def scene_file(scene: Scene, changes: Optional[Mapping[str, Any]], keep: bool) -> str:
    """Return the file of a scene. Writes a new one if the scene has no file or has changes.

    keep: write it into the user's state folder, where the replay of a recording finds it. Otherwise it
    exists only as long as this process.
    """
    if changes is not None and not isinstance(changes, Mapping):
        raise TypeError(f"set: expected a dict of paths and values, found {changes!r}.")
    beside = Path.cwd()
    if isinstance(scene, Mapping):
        text = as_yaml(scene)
    elif isinstance(scene, str) and "\n" in scene:
        text = scene
    elif changes:
        file = Path(_core.find_scene(path_of("scene", scene, "a file, a name, a dict or YAML text")))
        try:
            text, beside = file.read_text(encoding="utf-8"), file.parent
        except (OSError, UnicodeDecodeError) as wrong:
            raise Error(f"{file}: cannot be read: {wrong}.") from wrong
    else:
        return path_of("scene", scene, "a file, a name, a dict or YAML text")
    into = "" if keep else str(_scratch())
    values = {path_of("set", place, "paths as text"): as_yaml(value) for place, value in (changes or {}).items()}
    return _core.keep_scene(text, values, str(beside), into)


@functools.lru_cache(maxsize=1)
def _scratch() -> Path:
    folder = tempfile.mkdtemp(prefix="thimble-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)
