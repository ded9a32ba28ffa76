"""The log of one subject: a line of JSON per trial, on the disk before the next trial begins."""

from __future__ import annotations

import fcntl
import json
import os
import warnings
from pathlib import Path
from typing import Any, Mapping

from .. import ArgumentError, Error, PathOrName


class SubjectLog:
    """A file of JSON lines: what the experiment is, then one line per trial.

    Each line is written at once, flushed, and brought to the disk (fsync) before :meth:`write` returns.
    Opened again it goes on; a last line that a crash left half is dropped with a warning. One process
    at a time may hold it. Raises Error, with what to do, if the file is of another experiment, in use
    or damaged.
    """

    def __init__(self, path: PathOrName, about: Mapping[str, Any]) -> None:
        """Open or begin the file; about: the first line, the same each time."""
        self.path = Path(path)
        self.lines: list[dict[str, Any]] = []  #: all trials so far
        wanted = json.loads(line_of(about))
        begins = not self.path.exists()
        try:
            self._file = os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o644)
        except OSError as wrong:
            raise Error(f"{self.path}: cannot be written: {wrong.strerror}.") from wrong
        try:
            self._take(wanted)
            if begins:
                _sync_folder(self.path.parent)
        except BaseException:
            self.close()
            raise

    def write(self, line: Mapping[str, Any]) -> dict[str, Any]:
        """Write a line, and give it as it will be read."""
        if self._file < 0:
            raise Error(f"{self.path}: was closed.")
        text = line_of(line)
        self._append(text)
        self.lines.append(json.loads(text))
        return self.lines[-1]

    def close(self) -> None:
        """Let the file go. Again is nothing."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

    def _take(self, wanted: dict[str, Any]) -> None:
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as wrong:
            raise Error(f"{self.path}: is in use by another process.") from wrong
        lines = self._whole_lines()
        if not lines:
            self._append(line_of(wanted))
            return
        different = [key for key in {**wanted, **lines[0]} if wanted.get(key) != lines[0].get(key)]
        if different:
            raise Error(
                f"{self.path}: is the log of something else (it differs in {', '.join(sorted(different))}); "
                "name another file, or run what it was begun with."
            )
        self.lines = lines[1:]

    def _whole_lines(self) -> list[dict[str, Any]]:
        """Read the file, and cut off what no line of its end is."""
        with open(self.path, "rb") as file:
            *pieces, rest = file.read().split(b"\n")
        lines: list[dict[str, Any]] = []
        keep = 0
        for at, piece in enumerate(pieces):
            line = _line(piece)
            if line is None:
                # After a power loss the last line may have its length but not its content.
                if at + 1 < len(pieces) or rest:
                    raise Error(f"{self.path}:{at + 1}: no line of a log; nothing was changed.")
                rest = piece
                break
            lines.append(line)
            keep += len(piece) + 1
        if rest:
            warnings.warn(
                f"{self.path}: the last line was half written and is dropped; its trial comes again.",
                RuntimeWarning,
                stacklevel=5,
            )
            os.ftruncate(self._file, keep)
            os.fsync(self._file)
        return lines

    def _append(self, text: str) -> None:
        data = (text + "\n").encode()
        while data:  # on a full disk or a signal, write() may write only a part
            data = data[os.write(self._file, data) :]
        os.fsync(self._file)


def line_of(value: Mapping[str, Any]) -> str:
    """Write a line as JSON; numpy's numbers and arrays become Python's own."""
    try:
        return json.dumps(value, allow_nan=False, ensure_ascii=False, default=lambda one: one.tolist())
    except (AttributeError, TypeError, ValueError) as wrong:
        raise ArgumentError(f"A log cannot hold {value!r}: {wrong}.") from wrong


def read_log(path: PathOrName) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Read a log for its evaluation: what was run, and the trials; a half last line is left out."""
    try:
        pieces = Path(path).read_bytes().split(b"\n")
    except OSError as wrong:
        raise Error(f"{path}: cannot be read: {wrong.strerror}.") from wrong
    lines = [_line(piece) for piece in pieces[:-1]]
    if lines and lines[-1] is None:
        lines.pop()
    whole = [line for line in lines if line is not None]
    if not whole or len(whole) != len(lines):
        raise Error(f"{path}: is no log of an experiment.")
    return whole[0], whole[1:]


def _line(piece: bytes) -> Any:
    try:
        line = json.loads(piece)
    except ValueError:
        return None
    return line if isinstance(line, dict) else None


def _sync_folder(folder: Path) -> None:
    number = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        os.fsync(number)
    finally:
        os.close(number)
