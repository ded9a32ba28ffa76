#!/usr/bin/env python3
"""Counts expectations of shell tests that depend on the wording of the program's output.

   prose.py SOURCE_DIR [--list]

A pattern of two or more plain words counts. Names of commands, options, keys, scenes and arms, values, rows and files do
not count, and one key word is allowed. The number may only fall: it must equal CEILING. The remaining ones are notes about
missing parts of a build or machine, states of a viewed run, and the end of an arm or program, which are in no file. A test
should expect exit codes, report.json and structured output, and of a sentence only the names that a user needs
(tests/program/expect.sh: expect_report, expect_json, expect_words)."""
import pathlib
import re
import sys

CEILING = 14
# Files whose patterns are the text of other programs: compilers, doxygen, lintian, QEMU, dpkg.
OTHER_PROGRAMS = {"tests/tidy.sh", "tests/program/symbols_test.sh", "tests/program/headers_test.sh", "tests/program/reference_test.sh",
                  "tests/usb/virtual_machine.sh", "tests/program/package_test.sh", "tests/core.sh"}
# Terms that messages need, and that the guide uses with one meaning only.
TERMS = {"empty", "missing", "folder", "recording", "terminal", "damaged", "tab", "simulated", "window", "screen", "unit", "scene"}
# Values of options, states, levels of the log, and commands of the system, which messages name.
VALUES = {"virtual", "paced", "draft", "normal", "reference", "auto", "quick", "full", "apt", "install", "sudo", "modprobe", "usbhid",
          "unplug", "lost", "ms", "ready", "running", "paused", "info", "error", "tick"}
# Commands of the system, whose output is not the program's text.
OTHERS = {"awk", "stat", "wc", "echo", "ls", "cmp", "test", "sha256sum", "ffprobe", "ps", "id", "mkdir", "rm", "[", "git", "lasts", "differ", "gain"}
STRUCTURED = (".json", ".csv", ".yaml", ".xml", ".svg", ".db3", ".jsonl", ".png", ".gif", ".off", ".h5", ".pages", ".gp",
              "CMakeLists.txt", ".cff", ".pc", "CPackConfig.cmake")


def words(text, at):
    """Returns the words of the shell command that begins at text[at], and whether each was quoted by '' only."""
    found, word, inside = [], None, None
    while at < len(text):
        c = text[at]
        if inside:
            if c == inside:
                inside = None
            elif c == "\\" and inside == '"' and text[at + 1] in '"\\$`':
                at += 1
                word += text[at]
            else:
                word += c
        elif c in "'\"":
            inside, word = c, word or ""
        elif c == "\\" and text[at + 1:at + 2] == "\n":
            at += 1
        elif c == "\\":
            at += 1
            word = (word or "") + text[at]
        elif c in " \t":
            if word is not None:
                found.append(word)
            word = None
        elif c in "\n;)" or (c in "&|" and (word is None)):
            break
        else:
            word = (word or "") + c
        at += 1
    if word is not None:
        found.append(word)
    return found


def interface(source):
    """Returns the words that are names of commands, keys, values, arms and scenes."""
    names = TERMS | VALUES | {one.stem for folder in ("scenes", "arms") for one in (source / "app" / folder).glob("*.yaml")}
    for page in ("keys.md", "commands.md", "viewer.md"):
        text = (source / "app/guide/pages" / page).read_text()
        for code in re.findall(r"`([^`\n]+)`", text):
            names.update(re.findall(r"[A-Za-z_]+", code) if len(code.split()) <= 2 else [])
    return names


def prose(pattern, names):
    text = re.sub(r"\$\{?\w+[^ }]*\}?", "0", pattern)
    text = re.sub(r"\[[^]]*\][+*?]?(\{[0-9,]+\})?", "0", text)
    text = re.sub(r"\.[*+]", " ", text)
    text = re.sub(r"\\[.(){}^$+?|\[\]]", ".", text)
    plain = set()
    text = re.sub(r"\^[A-Za-z]+\b", "", text)  # the name of a row
    for token in re.split(r"[\s|()^$+?*]+", text):
        if re.match(r"[-.\"']", token):  # an option, a file ending, a value from the user
            continue
        token = token.strip(".,;:!`'\"\\-{}")
        if re.fullmatch(r"[A-Za-z]{2,}('s)?", token) and token not in names and not token.isupper():
            plain.add(token)
    return len(plain) > 1


def expectations(path, names):
    text = re.sub(r"(?m)^\s*#.*$", "", path.read_text())
    for match in re.finditer(r"(?<![\w./$-])(expect|expect_words|expect_error|grep)\s+(?=\S)", text):
        line = text.count("\n", 0, match.start()) + 1
        found = words(text, match.end())
        kind = match.group(1)
        if kind == "grep":
            options = [one for one in found if one.startswith("-")]
            rest = [one for one in found if not one.startswith("-")]
            before = text[text.rfind("\n", 0, match.start()) + 1:match.start()]
            if not rest or re.search(r"expect\S* [^;]*$", before):
                continue
            if len(rest) > 1 and rest[1].endswith(STRUCTURED) or not any("q" in one or "c" in one for one in options):
                continue
            if prose(rest[0], names):
                yield line, " ".join(found)
        elif len(found) >= 3:
            pattern, command = found[1], found[2:]
            if kind in ("expect_words", "expect_error") or not (
                    command[0] in OTHERS or "python" in command[0] or
                    command[0] in ("cat", "head", "tail", "grep", "sed") and any(one.endswith(STRUCTURED) for one in command)):
                subject = pattern if command[0] != "grep" else " ".join(one for one in command[1:-1])
                said = set(re.findall(r"[A-Za-z]+", " ".join(command))) if kind != "expect" else set()
                if prose(subject, names | said):
                    yield line, " ".join(found)[:160]


# Patterns that must count as wording (True) and that must not (False).
PLANTED = [("^Loop +200 ticks per second", True), ("there is no such file", True), ("--rate 100 50000 \"five\"", False),
           ("changed.yaml:# stiffness N/m", False), ("^NOT MET: .*margin", False), ("ticks .* published", True)]


def main():
    source = pathlib.Path(sys.argv[1])
    names = interface(source)
    for pattern, wanted in PLANTED:
        if prose(pattern, names) != wanted:
            sys.exit(f"FAILED: this check counts {pattern!r} as {'no ' if wanted else ''}wording")
    total, files = 0, {}
    for path in sorted((source / "tests").rglob("*.sh")):
        name = str(path.relative_to(source))
        if name == "tests/program/expect.sh" or name.startswith(("tests/arch/", "tests/mutate/")) or name in OTHER_PROGRAMS:
            continue
        for line, what in expectations(path, names):
            total += 1
            files[name] = files.get(name, 0) + 1
            if "--list" in sys.argv:
                print(f"{name}:{line}: {what}")
    for name, count in sorted(files.items(), key=lambda one: -one[1]):
        print(f"{count:5} {name}")
    print(f"{total} expectations on the wording of the program's output")
    if total != CEILING:
        sys.exit(f"FAILED: {CEILING} are allowed. " + (
            "Expect names, values and JSON (tests/program/README.md); --list shows all." if total > CEILING else
            f"Set CEILING in tests/arch/prose.py to {total}, so that the number only falls."))


main()
