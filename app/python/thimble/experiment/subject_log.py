"""The log of one subject: a line of JSON per trial, on disk before the next trial begins."""

from __future__ import annotations

import fcntl
import json
import os
import warnings
from pathlib import Path
from typing import Any, Mapping

from .. import ArgumentError, Error, PathOrName


class SubjectLog:
    """A file of JSON lines: a description of the experiment, then one line per trial.

    Each line is on disk (fsync) before :meth:`write` returns. A log that is opened again is continued; a
    last line that a crash left incomplete is dropped with a warning. Only one process at a time may use
    it. Raises Error, with the remedy, if the file belongs to another experiment, is in use or is damaged.
    """

    def __init__(self, path: PathOrName, about: Mapping[str, Any]) -> None:
        """Open or create the file. about: content of the first line, the same each time."""
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

    def __repr__(self) -> str:
        return f"SubjectLog({self.path.name}: {len(self.lines)} trials{', closed' if self._file < 0 else ''})"

    def write(self, line: Mapping[str, Any]) -> dict[str, Any]:
        """Write a line, and return it as it will be read back."""
        if self._file < 0:
            raise Error(f"{self.path}: the log is closed.")
        text = line_of(line)
        self._append(text)
        self.lines.append(json.loads(text))
        return self.lines[-1]

    def close(self) -> None:
        """Close the file. Repeated calls do nothing."""
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
                f"{self.path}: is the log of another experiment (different {', '.join(sorted(different))}). "
                "Use another file, or continue the experiment of this log."
            )
        self.lines = lines[1:]

    def _whole_lines(self) -> list[dict[str, Any]]:
        """Read the lines of the file, and cut off an incomplete last line."""
        with open(self.path, "rb") as file:
            *pieces, rest = file.read().split(b"\n")
        lines: list[dict[str, Any]] = []
        keep = 0
        for at, piece in enumerate(pieces):
            line = _line(piece)
            if line is None:
                # After a power loss the last line may have its length but not its content.
                if at + 1 < len(pieces) or rest:
                    raise Error(f"{self.path}:{at + 1}: not a line of a log. The file was not changed.")
                rest = piece
                break
            lines.append(line)
            keep += len(piece) + 1
        if rest:
            warnings.warn(
                f"{self.path}: the last line was incomplete and is dropped; its trial is repeated.",
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
    """Return a line as JSON. numpy numbers and arrays become Python's."""
    try:
        return json.dumps(value, allow_nan=False, ensure_ascii=False, default=lambda one: one.tolist())
    except (AttributeError, TypeError, ValueError) as wrong:
        raise ArgumentError(f"A log cannot hold {value!r}: {wrong}.") from wrong


def read_log(path: PathOrName) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Read a log for evaluation. Returns its first line and its trials, without an incomplete last line."""
    try:
        pieces = Path(path).read_bytes().split(b"\n")
    except OSError as wrong:
        raise Error(f"{path}: cannot be read: {wrong.strerror}.") from wrong
    lines = [_line(piece) for piece in pieces[:-1]]
    if lines and lines[-1] is None:
        lines.pop()
    whole = [line for line in lines if line is not None]
    if not whole or len(whole) != len(lines):
        raise Error(f"{path}: is not the log of an experiment.")
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
