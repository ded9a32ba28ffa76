#!/usr/bin/env python3
"""Checks the maps of files in READMEs: every file that a table names exists. Every source of the modules and of app
whose folder has a table `| files | ...` in its README is named there, alone or by a pattern such as `command_*.cpp`.

readme_files.py SOURCES
"""
import fnmatch
import pathlib
import re
import shutil
import subprocess
import sys

HEADER = re.compile(r"^\| *(files?|folder) *\|")
SOURCES = {".cpp", ".h", ".inc", ".py", ".pyi", ".sh"}


def rows_of(lines):
    """Yields (number, first cell, whole row, kind) of the rows of all maps."""
    kind = None
    for number, line in enumerate(lines, 1):
        if not line.startswith("|"):
            kind = None
            continue
        begin = HEADER.match(line)
        if begin:
            kind = begin.group(1)
        elif kind and not line.startswith("|--"):
            yield number, line.split("|")[1], line, kind


def exists(folder, name):
    """Whether a name of a map is a file or folder; without an extension it stands for `name.*`."""
    name = name.rstrip("/")
    if not folder.is_dir():
        return False
    if any(folder.glob(name)) if "*" in name else (folder / name).exists():
        return True
    return any(folder.glob(name + ".*")) or any(folder.glob(name + "_*"))


def public_headers(folder, root, tracked):
    """The installed headers of the module with this folder."""
    parts = folder.relative_to(root).parts
    module = root.joinpath(*parts[:2 if parts and parts[0] == "app" else 1])
    return [file for file in tracked if module / "include" in file.parents]


def mistakes_of(readme, root, tracked):
    folder = readme.parent
    shown = readme.relative_to(root)
    lines = readme.read_text().splitlines()
    rows = list(rows_of(lines))
    found = []
    last = folder
    for number, cell, _, _ in rows:
        names = re.findall(r"`([^`]+)`", cell) + re.findall(r"\]\(([^)]+)\)", cell)
        for name in names:
            # A further name of a row is in the folder of the first one: `thimble/_a.py`, `_b.py`.
            places = [folder, last, folder / "src"]
            if not any(exists(place, name) for place in places) and not any(
                    file.name == name for file in public_headers(folder, root, tracked)):
                found.append(f"{shown}:{number}: {name} does not exist. Give the present name.")
            elif "/" in name:
                last = (folder / name).parent
    if not any(kind.startswith("file") for *_, kind in rows):
        return found
    if shown.parts[0] == "tests":  # their names say what they test
        return found
    text = "\n".join(lines)
    patterns = [word for word in re.findall(r"`([^`\n]+)`", text) if "*" in word]
    for file in tracked:
        if file.parent != folder or file.suffix not in SOURCES:
            continue
        stem = file.name.split(".")[0]
        named = re.search(r"(?<![a-z0-9_])" + re.escape(stem) + r"(?![a-z0-9_])", text)
        if not named and not any(fnmatch.fnmatch(file.name, p) or fnmatch.fnmatch(stem, p) for p in patterns):
            found.append(f"{shown}: the map of files lacks {file.name}. Add it.")
    return found


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    listed = subprocess.run(["git", "-C", root, "ls-files"], capture_output=True, text=True) if shutil.which("git") else None
    if listed is None or listed.returncode != 0:
        print("This is not a git checkout, so the files of the tree are unknown.")
        return 77
    tracked = [root / name for name in listed.stdout.splitlines()]
    readmes = [file for file in tracked if file.name == "README.md" and file.exists()]
    found = [one for readme in readmes for one in mistakes_of(readme, root, tracked)]
    print("\n".join(found) if found else f"{len(readmes)} READMEs name only files that exist.")
    return 1 if found else 0


sys.exit(main())
