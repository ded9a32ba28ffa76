"""Runs the program and its studies in a separate process."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any, Optional, Sequence

from ._arguments import PathOrName, path_of
from ._core import ArgumentError, Error
from ._ticks import Figure, figure_of


def program() -> str:
    """Return the path of the program: $THIMBLE_PROGRAM, else the one of this package's installation or
    build folder, else the one in $PATH."""
    named = os.environ.get("THIMBLE_PROGRAM")
    if named:
        return named
    for above in Path(__file__).resolve().parents:
        for beside in (above / "bin" / "thimble", above / "app" / "thimble"):
            if beside.is_file() and os.access(beside, os.X_OK):
                return str(beside)
    found = shutil.which("thimble")
    if found is None:
        raise Error("The program thimble was not found. Install it, or set THIMBLE_PROGRAM to its path.")
    return found


BAD_INPUT = 2  # exit code of the program for wrong arguments, scenes, arm files or meshes


def _studies() -> list[str]:
    done = subprocess.run([program(), "study", "--help"], capture_output=True, text=True, check=False)
    names = re.findall(r"^  ([a-z][a-z-]*) ", done.stdout.partition("Subcommands:")[2], re.MULTILINE)
    if not names:
        lacking = subprocess.run([program(), "study"], capture_output=True, text=True, check=False)
        raise Error(f"thimble study: {lacking.stderr.strip() or done.stderr.strip()}")
    return names


def study(
    name: str, *arguments: PathOrName, out: Optional[PathOrName] = None, **options: Any
) -> list[Figure]:
    """Run a study (``thimble study --help`` lists them), and return its figures.

    The study runs in a separate process, because some studies count their own instructions or use all
    cores. Options are those of the command line: ``study("stability", arm="vintage_phantom", coarse=True)``,
    ``study("accuracy", axis=["velocity", "encoder"])``. out: folder for pictures, tables and figures.json;
    "study-NAME" by default. Raises ArgumentError for an unknown study or option, Error with the message of
    the program if the study fails.
    """
    path_of("name", name, "the name of a study")
    names = _studies()
    if name not in names:
        raise ArgumentError(f'name: there is no study "{name}"; there are {", ".join(names)}.')
    folder = Path(path_of("out", out)) if out is not None else Path(f"study-{name}")
    command = [program(), "study", name, *(path_of("arguments", one) for one in arguments), "--output", str(folder)]
    for key, value in options.items():
        if value is None or value is False:
            continue
        command.append("--" + key.replace("_", "-"))
        if value is not True:
            several = isinstance(value, Sequence) and not isinstance(value, str)
            command += [str(one) for one in (value if several else [value])]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        said = (done.stderr.strip() or done.stdout.strip()).removesuffix("\nRun with --help for more information.")
        kind = ArgumentError if done.returncode == BAD_INPUT else Error
        raise kind(f"thimble study {name}: {said}")
    return [figure_of(one) for one in json.loads((folder / "figures.json").read_text())]
