#!/usr/bin/env python3
"""Reads the guide's pages of additions (app/guide/pages/extending*.md): their blocks are tested.

    extending.py SOURCE                      prints the words that select sections: the last of each heading
    extending.py SOURCE --copy TREE          makes TREE the same but for builds; a file that is the same already is not written
    extending.py SOURCE --apply WORD TREE    does a section in a copy of the tree
    extending.py SOURCE --test WORD          prints the commands of its block "Test:", a line each
    extending.py SOURCE --written WORD       prints the files that these write
    extending.py SOURCE --changed WORD TREE  fails if git of TREE shows other files changed than the section lists
    extending.py SOURCE --files              prints the files of the tree that any section changes
    extending.py SOURCE --check [BUILD [WORD]]  each section fits the tree, lists the files that it changes, and is formatted; with
                                             a build folder that has compile_commands.json, its sources compile

A sentence says where the block below it goes: New file `PATH`: | In `PATH`, after `TEXT`: | In `PATH`, before `TEXT`: |
In `PATH`, instead of `TEXT`: | Test:. TEXT occurs in one line of the file.
"""

import concurrent.futures
import filecmp
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

PAGES = ("app/guide/pages/extending.md", "app/guide/pages/extending_rendering.md")
PLACE = re.compile(r"^(?:New file `(?P<new>[^`]+)`|In `(?P<path>[^`]+)`, (?P<where>after|before|instead of) (?P<text>`.+`)|Test):$")


class Wrong(Exception):
    """A section does not fit the tree or its own list."""


class Section:
    """One addition: its page and heading, the files that its table lists, its blocks."""

    def __init__(self, page, title):
        self.page, self.title = page, title
        self.files, self.written, self.blocks, self.tests = [], [], [], []

    @property
    def word(self):
        return self.title.split()[-1]

    def changed(self):
        return {block["path"] for block in self.blocks} | set(self.written)

    def apply(self, tree):
        """Applies the addition to a tree."""
        for block in self.blocks:
            file = tree / block["path"]
            if block["where"] == "new":
                if file.exists():
                    raise Wrong(f"{self.place(block)}: {block['path']} exists already")
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text("".join(block["lines"]))
                continue
            if not file.is_file():
                raise Wrong(f"{self.place(block)}: there is no file {block['path']}")
            lines = file.read_text().splitlines(keepends=True)
            at = [i for i, line in enumerate(lines) if block["text"] in line]
            if len(at) != 1:
                raise Wrong(f"{self.place(block)}: \"{block['text']}\" is in {len(at)} lines of {block['path']}; expected one")
            begin = at[0] + (block["where"] == "after")
            end = at[0] + 1 if block["where"] == "instead of" else begin
            lines[begin:end] = block["lines"]
            file.write_text("".join(lines))

    def place(self, block):
        return f"{self.page}:{block['line']}"


def read_pages(source):
    """Returns the sections of the pages that have blocks."""
    return [section for page in PAGES for section in read_page(source, page)]


def read_page(source, page):
    sections, section, place, inside = [], None, None, None
    for number, line in enumerate((source / page).read_text().splitlines(keepends=True), 1):
        text = line.rstrip("\n")
        if inside is not None:
            if text == "```":
                inside = None
            else:
                inside.append(line)
        elif text.startswith("```"):
            inside = []
            if place is None or section is None:
                raise Wrong(f"{page}:{number}: no sentence above says where this block goes")
            if text == "```" or text[3:].isalpha():
                if place["kind"] == "test":
                    section.tests = inside
                else:
                    section.blocks.append({**place, "lines": inside, "line": number})
            place = None
        elif text.startswith("## "):
            section = Section(page, text[3:])
            sections.append(section)
        elif found := PLACE.match(text):
            if found["new"]:
                place = {"kind": "edit", "path": found["new"], "where": "new", "text": ""}
            elif found["path"]:
                quoted = found["text"]
                quoted = quoted[3:-3].strip() if quoted.startswith("`` ") else quoted.strip("`")
                place = {"kind": "edit", "path": found["path"], "where": found["where"], "text": quoted}
            else:
                place = {"kind": "test"}
        elif section and (row := re.match(r"^\| `([^`]+)` \| (.*) \|$", text)):
            section.files.append(row[1])
            if row[2].startswith("written by "):
                section.written.append(row[1])
    return [one for one in sections if one.blocks]


def choose(sections, word):
    chosen = [one for one in sections if one.word == word]
    if not chosen:
        raise Wrong(f"app/guide/pages/extending*.md have no section {word}; known: {' '.join(one.word for one in sections)}")
    return chosen[0]


def copy_tree(source, tree):
    """Makes a tree equal to the sources; unchanged files keep their times."""
    def files_of(folder):
        for root, folders, names in os.walk(folder):
            folders[:] = [name for name in folders if name not in (".git", "__pycache__", "build")]
            yield from (pathlib.Path(root, name).relative_to(folder) for name in names)

    wanted = set(files_of(source))
    for path in set(files_of(tree)) - wanted:
        (tree / path).unlink()
    for path in wanted:
        if not (tree / path).exists() or not filecmp.cmp(source / path, tree / path, shallow=False):
            (tree / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source / path, tree / path)
            shutil.copymode(source / path, tree / path)


def compile_commands(build):
    """Returns, for each folder of sources, the words of a compiler call there."""
    calls = {}
    for one in json.loads((build / "compile_commands.json").read_text()):
        words = shlex.split(one["command"])
        folder = one["output"] if "output" in one else words[words.index("-o") + 1]
        calls.setdefault(folder.split("/CMakeFiles/")[0], words)
    return calls


def user_of(source, path):
    """Returns the smallest source that includes a header of a library's src; None if there is none, or for another file."""
    library, found, name = path.partition("/src/")
    if not found or not path.endswith(".h") or not (source / path).exists():
        return None
    users = [file for file in (source / library / "src").rglob("*.cpp") if f'"{name}"' in file.read_text()]
    return str(min(users, key=lambda file: file.stat().st_size).relative_to(source)) if users else None


def compiles(calls, build, tree, path):
    """Compiles a source of `tree`, which has only changed files, without output files; returns the compiler's errors."""
    home = re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", (build / "CMakeCache.txt").read_text(), re.M)[1]
    folders = [folder for folder in calls if path.startswith(folder + "/")]
    if not folders:
        return ""
    words, call, skip = calls[max(folders, key=len)], [], False
    for word in words:
        if skip:
            skip = False
        elif word in ("-o", "-c", "-include"):
            skip = True  # the precompiled headers belong to the unchanged tree
        elif not word.startswith("-O"):
            if word.startswith(f"-I{home}") and not word.startswith(f"-I{build}"):
                call.append(word.replace(home, str(tree), 1))
            call.append(word)
    ended = subprocess.run([*call, "-O0", "-fsyntax-only", str(tree / path)], capture_output=True, text=True, cwd=build)
    return "" if ended.returncode == 0 else ended.stderr[:3000]


def check_list(source, section, faults):
    """Compares a section's table, and its row in the table at the top, with the files that it changes."""
    listed, changed = set(section.files), section.changed()
    if listed != changed:
        faults.append(f"{section.page}: {section.title}: the table must not list {' '.join(sorted(listed - changed)) or '-'}, "
                      f"must list {' '.join(sorted(changed - listed)) or '-'}")
    if not section.tests:
        faults.append(f'{section.page}: {section.title}: no block "Test:"')
    faults += [f"{section.page}: {section.title}: there is no file {path}" for path in section.written if not (source / path).exists()]
    counts = (len(section.files), len(section.files) - len(section.written))
    title = section.title[0].lower() + section.title[1:]
    row = re.search(rf"^\| \[{title}\].*?\| (\d+) \| (\d+) \|$", (source / section.page).read_text(), re.M)
    if not row or (int(row[1]), int(row[2])) != counts:
        faults.append(f"{section.page}: {section.title}: the table at the top must say {counts[0]} and {counts[1]} files")


def check(source, build, only):
    """Prints the faults and returns their number. `only`: compiles the sources of the section of this word; all if empty."""
    faults, compiled, sections = [], [], read_pages(source)
    if len(sections) < 7:
        faults.append(f"{' '.join(PAGES)}: {len(sections)} sections; expected 7")

    def take(section, tree):
        for path in section.changed():
            if (source / path).exists() and not (tree / path).exists():
                (tree / path).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(source / path, tree / path)

    with tempfile.TemporaryDirectory() as folder:
        tree = pathlib.Path(folder) / "all"  # with all additions together
        for section in sections:
            check_list(source, section, faults)
            try:
                alone = pathlib.Path(folder) / section.word
                take(section, alone)
                section.apply(alone)
                take(section, tree)
                section.apply(tree)
            except Wrong as wrong:
                faults.append(str(wrong))
        shutil.copy(source / ".clang-format", tree)
        sources = [path for section in sections for path in sorted(section.changed())
                   if path.endswith((".h", ".cpp")) and (tree / path).exists()]
        if shutil.which("clang-format-14"):
            for path in dict.fromkeys(sources):
                ended = subprocess.run(["clang-format-14", "--dry-run", "--Werror", path], capture_output=True, text=True, cwd=tree)
                if ended.returncode:
                    faults.append(ended.stderr[:1500])
        if build and not (build / "compile_commands.json").exists():
            print(f"NOT TESTED: that the examples compile; {build} has no compile_commands.json.")
        elif build and not faults:
            calls = compile_commands(build)
            for section in sections:
                if only in ("", section.word):
                    for path in sorted(section.changed()):
                        path = path if path.endswith(".cpp") else user_of(source, path)
                        if path and path not in compiled:
                            compiled.append(path)
                            if not (tree / path).exists():
                                (tree / path).parent.mkdir(parents=True, exist_ok=True)
                                shutil.copy(source / path, tree / path)
            with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as threads:
                for path, said in zip(compiled, threads.map(lambda path: compiles(calls, build, tree, path), compiled)):
                    if said:
                        faults.append(f"{path} does not compile:\n{said}")
    print("\n".join(f"FAILED: {fault}" for fault in faults) or
          f"{len(sections)} additions, {sum(len(one.blocks) for one in sections)} blocks; {len(compiled)} sources compile.")
    return len(faults)


def main():
    source, mode = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:3]
    sections = read_pages(source)
    if not mode:
        print("\n".join(one.word for one in sections))
    elif mode == ["--copy"]:
        copy_tree(source, pathlib.Path(sys.argv[3]))
    elif mode == ["--apply"]:
        choose(sections, sys.argv[3]).apply(pathlib.Path(sys.argv[4]))
    elif mode == ["--test"]:
        print("".join(choose(sections, sys.argv[3]).tests), end="")
    elif mode == ["--written"]:
        print("\n".join(choose(sections, sys.argv[3]).written))
    elif mode == ["--changed"]:
        said = subprocess.run(["git", "-C", sys.argv[4], "status", "--porcelain", "--untracked-files=all"],
                              capture_output=True, text=True, check=True).stdout
        changed = {line[3:] for line in said.splitlines()}
        listed = set(choose(sections, sys.argv[3]).files)
        if changed != listed:
            raise Wrong(f"{sys.argv[3]}: changed but not listed: {' '.join(sorted(changed - listed)) or 'none'}; "
                        f"listed but not changed: {' '.join(sorted(listed - changed)) or 'none'}")
    elif mode == ["--check"]:
        build = pathlib.Path(sys.argv[3]).resolve() if sys.argv[3:] else None
        sys.exit(1 if check(source, build, "".join(sys.argv[4:5])) else 0)
    elif mode == ["--files"]:
        print("\n".join(sorted({path for one in sections for path in one.changed() if (source / path).exists()})))
    else:
        sys.exit(__doc__)


try:
    main()
except Wrong as wrong:
    sys.exit(f"FAILED: {wrong}")
