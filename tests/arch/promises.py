#!/usr/bin/env python3
"""Writes the guide's pages of guarantees from one table, and checks the coverage of each sentence.

    promises.py SOURCE BUILD           fails if a test covers less than its row promises, or a page is not current
    promises.py SOURCE BUILD --write   checks the same, and writes the pages
    promises.py SOURCE BUILD --page    writes them without running tests; needs the program only

The table is app/guide/guarantees.list; the line `page:` below a title names the file in app/guide/pages. For each row with `covers`, the items that its tests recorded with
`support::Covered` are compared with all items: scenes and arms in app/, trackers in `thimble help scene tracker`. A sentence with
"every", "each", "all" or "any" of these must have `covers`.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

PAGES = "app/guide/pages"
TABLE = "app/guide/guarantees.list"
KINDS = {"scene": "scenes", "tracker": "trackers", "arm": "arms"}
WIRE = ("hfab_14_byte", "woody_8_byte", "text_lines", "falcon_packet")


def fail(text):
    print(f"FAILED: {text}")
    fail.count += 1


fail.count = 0


def read_table(path):
    """Returns [(file name, heading lines, [(section title, [row])])]; a row has says, tests, covers, line."""
    pages, sections, row = [], [], None
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if line.startswith("# "):
            head, sections, row = [line], [], None
        elif line.startswith("page: ") and not sections:
            pages.append((line[6:], head, sections))
        elif line.startswith("## "):
            sections.append((line[3:], []))
            row = None
        elif not sections:
            head.append(line)
        elif line.startswith("- "):
            row = {"says": line[2:], "tests": "", "covers": [], "line": number}
            sections[-1][1].append(row)
        elif line.startswith("  tests: ") and row:
            row["tests"] = line[9:]
        elif line.startswith("  covers: ") and row:
            row["covers"] = [one.strip() for one in line[10:].split(",")]
        elif line.strip():
            sys.exit(f"{path}:{number}: expected a section, a row (- ), tests: or covers:")
    for one in rows_of(pages):
        if not one["tests"]:
            sys.exit(f"{path}:{one['line']}: the row names no tests")
    return pages


def rows_of(pages):
    return [row for _, _, sections in pages for _, rows in sections for row in rows]


def all_there_is(source, build):
    """Returns, for each kind, the set of all names."""
    arms = {file.stem: re.search(r"^protocol: *(\w+)", file.read_text(), re.M)[1]
            for file in (source / "app/arms").glob("*.yaml")}
    said = subprocess.run([build / "app/thimble", "help", "scene", "tracker"], capture_output=True, text=True,
                          check=True).stdout
    trackers = re.search(r"^ *tracker +(.*?);", said, re.M)[1]
    return {
        "scenes": {file.stem for file in (source / "app/scenes").glob("*.yaml")},
        "arms": set(arms),
        "arms on USB": {name for name, protocol in arms.items() if protocol in WIRE},
        "trackers": set(re.split(r", | or ", trackers)) - {"auto"},  # chooses one of the others
    }


def commands(build):
    """Returns the name of each test of GoogleTest in CTest, and its program."""
    # Listed from another folder: a ctest that lists tests truncates the log of the ctest that runs in the same folder.
    with tempfile.TemporaryDirectory() as lister:
        pathlib.Path(lister, "CTestTestfile.cmake").write_text(f'subdirs("{build}")\n')
        said = subprocess.run(["ctest", "--test-dir", lister, "--show-only=json-v1"], capture_output=True, text=True,
                              check=True)
    prefix = "--gtest_filter="
    return [(argument[len(prefix):], test["command"][0]) for test in json.loads(said.stdout)["tests"]
            for argument in test.get("command", []) if argument.startswith(prefix)]


def covered(row, build, tests):
    """Returns, for each kind, the names that the tests of a row recorded; runs tests whose records are older than their program."""
    found, again = {}, {}
    for name in re.findall(r"`(\w+\.[\w*]+)`", row["tests"]):
        pattern = re.compile(r"(?:\w+/)?" + re.escape(name).replace(r"\*", r"\w+") + r"(?:/\w+)?")
        mine = [(test, program) for test, program in tests if pattern.fullmatch(test)]
        if not mine:
            fail(f"{TABLE}:{row['line']}: CTest has no test {name}")
        built = max((pathlib.Path(program).stat().st_mtime for _, program in mine), default=0)
        notes = notes_of(build, mine)
        if not notes or min(note.stat().st_mtime for note in notes) < built:
            for test, program in mine:
                again.setdefault(program, []).append(test)
    for program, names in again.items():
        chosen = ":".join(names)
        ended = subprocess.run([program, f"--gtest_filter={chosen}"], capture_output=True, text=True)
        if ended.returncode:
            fail(f"{TABLE}:{row['line']}: {chosen} failed\n{ended.stdout[-2000:]}")
    for name in re.findall(r"`(\w+\.[\w*]+)`", row["tests"]):
        pattern = re.compile(r"(?:\w+/)?" + re.escape(name).replace(r"\*", r"\w+") + r"(?:/\w+)?")
        for note in notes_of(build, [one for one in tests if pattern.fullmatch(one[0])]):
            found.setdefault(note.suffix[1:].replace("_", " "), set()).update(note.read_text().split())
    return found


def notes_of(build, tests):
    """Returns the files in which tests recorded the items that they cover."""
    names = {name.replace("/", "-") for name, _ in tests}
    return [file for file in (build / "covered").glob("*") if file.stem in names]


def check(row, build, there, tests):
    """Checks a row; returns the text of its third column."""
    for word, kind in KINDS.items():
        broad = re.search(rf"\b([Ee]very|[Ee]ach|[Aa]ll|[Aa]ny)\b[\w ]{{0,12}}\b{word}s?\b", row["says"])
        if broad and not any(kind in tag for tag in row["covers"]):
            fail(f'{TABLE}:{row["line"]}: "{broad[0]}" needs `covers: all {kind}`, or other words')
    if not row["covers"]:
        return ""
    found, texts = covered(row, build, tests) if tests is not None else None, []
    for tag in row["covers"]:
        parts = re.fullmatch(r"all ([\w ]+?)(?: but ([\w ]+))?", tag)
        if not parts or parts[1] not in there:
            fail(f"{TABLE}:{row['line']}: {tag} is not a valid value; expected all {', all '.join(there)}")
            continue
        kind, left_out = parts[1], set((parts[2] or "").split())
        wanted = there[kind] - left_out
        # An arm on USB is an arm.
        have = wanted if found is None else found.get(kind, set()) | found.get(kind.split(" on ")[0], set())
        if left_out - there[kind]:
            fail(f"{TABLE}:{row['line']}: {tag}: there is no {' '.join(left_out - there[kind])}")
        if wanted - have:
            fail(f"{TABLE}:{row['line']}: {tag}: the tests did not cover {' '.join(sorted(wanted - have))}")
        texts.append(f"{len(wanted)} {kind}" + (f" (all but {', '.join(sorted(left_out))})" if left_out else " (all)"))
    return ", ".join(texts)


def main():
    source, build = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    pages = read_table(source / TABLE)
    there, tests = all_there_is(source, build), None if "--page" in sys.argv else commands(build)
    for name, head, sections in pages:
        lines = list(head)
        for title, rows in sections:
            lines += [f"## {title}", "", "| guarantee | test | covers |", "|---|---|---|"]
            lines += [f"| {row['says']} | {row['tests']} | {check(row, build, there, tests)} |" for row in rows]
            lines.append("")
        text = "\n".join(lines)
        page = source / PAGES / name
        if "--write" in sys.argv or "--page" in sys.argv:
            page.write_text(text)
        elif not page.exists() or page.read_text() != text:
            fail(f"{PAGES}/{name} differs from {TABLE}; run tests/acceptance/promises.sh")
    rows = rows_of(pages)
    print(f"{len(rows)} guarantees, {sum(bool(row['covers']) for row in rows)} whose coverage was checked.")
    sys.exit(1 if fail.count else 0)


main()
