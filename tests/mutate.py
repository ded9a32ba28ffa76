#!/usr/bin/env python3
"""Mutants of driver and render: made, built, tried against the tests, and told in a table.

Called by tests/mutate.sh, which says how; works in a built copy of the sources.
"""
import argparse
import dataclasses
import hashlib
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import time

# Each library, its sources, and the programs that test it: the quick ones first.
LIBRARIES = {
    "driver": ["test_driver", "test_wires", "test_device_sim"],
    "render": ["test_packed", "test_surface", "test_render", "test_body", "test_render_threads"],
}
LIMIT_SHARE, LIMIT_MORE = 6, 20  # a program that takes so many times as long, and so many s, hangs


@dataclasses.dataclass(frozen=True)
class Mutant:
    """One place of a source with another text."""

    file: str
    line: int  # from 0
    kind: str
    old: str
    new: str

    def title(self):
        return f"{self.file}: `{self.old.strip()}` -> `{self.new.strip()}`"


def code_of(line):
    """Returns a line with strings and comments blanked, so that places in it stay the same."""
    line = re.sub(r'"(?:\\.|[^"\\])*"', lambda m: "~" * len(m.group()), line)
    line = re.sub(r"'(?:\\.|[^'\\])'", lambda m: "~" * len(m.group()), line)
    return re.sub(r"//.*", lambda m: " " * len(m.group()), line)


def flipped(pairs):
    return {**dict(pairs), **{b: a for a, b in pairs}}


RELATIONS = {" < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > ", " == ": " != ", " != ": " == "}
SUMS = flipped([(" + ", " - "), (" * ", " / "), (" += ", " -= "), (" && ", " || ")])
NUMBER = re.compile(r"(?<![\w.~'])(\d+\.?\d*(?:[eE][-+]?\d+)?)(?![\w.'])")
STATEMENT = re.compile(r"^\s+(?:\+\+|--)?[a-z][\w.>\[\]-]*(?:\(.*\)| (?:[-+*/|&]?=) .*)?;$")
CONDITION = re.compile(r"(?<=\b(?:if) \()([^;{}]+)(?=\) (?:\{|return|continue|break|\w+))")
MINUS = re.compile(r"(?:(?<=[=,] )|(?<=return )|(?<=\())-(?=[a-zA-Z_(])")
ARGUMENTS = re.compile(r"(?<=\w\()([a-zA-Z_]\w*), ([a-zA-Z_]\w*)(?=[,)])")


def places_of(code):
    """Yields (kind, begin, end, text) for each change that a line of code allows."""
    for table, kind in ((RELATIONS, "relation"), (SUMS, "operator")):
        for old, new in table.items():
            for m in re.finditer(re.escape(old), code):
                yield kind, m.start(), m.end(), new
    for m in NUMBER.finditer(code):
        text = m.group(1)
        real = "." in text or "e" in text.lower()
        yield "constant", m.start(), m.end(), f"{float(text) * 1.5 + 0.5:g}" if real else str(int(text) + 1)
    for m in CONDITION.finditer(code):
        if m.group(1).count("(") == m.group(1).count(")"):
            yield "negated", m.start(1), m.end(1), f"!({m.group(1)})"
    for m in MINUS.finditer(code):
        yield "sign", m.start(), m.end(), ""
    for m in ARGUMENTS.finditer(code):
        yield "swapped", m.start(), m.end(), f"{m.group(2)}, {m.group(1)}"
    words = code.split()
    if STATEMENT.match(code) and code.count("(") == code.count(")") and words[0] not in (
            "return", "break;", "continue;", "using", "const", "constexpr", "case", "default", "delete"):
        yield "removed", len(code) - len(code.lstrip()), len(code), ";"


def mutants_of(root, library):
    """Lists every mutant of a library's sources."""
    found = []
    for path in sorted((root / library / "src").rglob("*.cpp")):
        name = str(path.relative_to(root))
        for number, line in enumerate(path.read_text().splitlines()):
            code = code_of(line)
            if not code.startswith("  ") or "static_assert" in code or "constexpr" in code:
                continue  # what no function does, and what the compiler itself would notice
            for kind, begin, end, text in places_of(code):
                new = line[:begin] + text + line[end:]
                if kind == "negated":  # the words between are the line's own
                    new = line[:begin] + "!(" + line[begin:end] + ")" + line[end:]
                found.append(Mutant(name, number, kind, line, new))
    return found


class Built:
    """The copy of the sources, and what is built of them."""

    def __init__(self, copy):
        self.copy = copy
        self.build = copy / "build" / "mutants"
        self.seconds = {}

    def run(self, command, limit=None):
        """Runs a command; returns its exit code, or none if it was ended for its time."""
        child = subprocess.Popen(command, cwd=self.build, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL, start_new_session=True)
        try:
            return child.wait(limit)
        except subprocess.TimeoutExpired:
            return None
        finally:
            if child.poll() is None:
                os.killpg(child.pid, signal.SIGKILL)
                child.wait()

    def make(self, library):
        return self.run(["cmake", "--build", ".", "--target", f"thimble_{library}"], 600) == 0

    def object_of(self, mutant):
        """Tells a fingerprint of the machine's code of a source."""
        library, rest = mutant.file.split("/", 1)
        path = self.build / library / "CMakeFiles" / f"thimble_{library}.dir" / f"{rest}.o"
        return hashlib.sha256(path.read_bytes()).hexdigest()

    def program(self, name):
        return next(p for p in self.build.glob(f"tests/unit/*/{name}") if p.is_file())

    def measure(self, library):
        """Notes how long each program takes; ends if one fails before anything is broken."""
        for name in LIBRARIES[library]:
            begin = time.monotonic()
            if self.run([str(self.program(name)), "--gtest_brief=1"]) != 0:
                sys.exit(f"{name} fails without any mutant: mend it first.")
            self.seconds[name] = time.monotonic() - begin

    def killer(self, library):
        """Tells which program notices, and how; empty if none does."""
        for name in LIBRARIES[library]:
            limit = LIMIT_SHARE * self.seconds[name] + LIMIT_MORE
            command = [str(self.program(name)), "--gtest_brief=1", "--gtest_fail_fast"]
            code = self.run(command, limit)
            if code is None:  # or the machine had something else to do
                code = self.run(command, 2 * limit)
            if code != 0:
                return f"{name} {'hangs' if code is None else 'crashes' if code < 0 else 'fails'}"
        return ""


def try_one(built, mutant):
    """Returns what became of a mutant: uncompilable, equivalent, survived, or who killed it."""
    path = built.copy / mutant.file
    whole = path.read_text()
    library = mutant.file.split("/")[0]
    before = built.object_of(mutant)
    lines = whole.splitlines(keepends=True)
    assert lines[mutant.line].rstrip("\n") == mutant.old
    lines[mutant.line] = mutant.new + "\n"
    try:
        path.write_text("".join(lines))
        if not built.make(library):
            return "uncompilable"
        if built.object_of(mutant) == before:
            return "equivalent"
        return built.killer(library) or "survived"
    finally:
        path.write_text(whole)


def reasons_in(table):
    """Returns the reasons that a table gives for survivors, by their titles."""
    reasons = {}
    if not table.exists():
        return reasons
    for line in table.read_text().splitlines():
        m = re.match(r"\| (.+: `.+` -> `.*`) \| (\w+) \| (.*) \|$", line)
        if m:
            reasons[m.group(1)] = m.group(3)
    return reasons


def write_table(table, results, seed):
    """Writes what became of all; reasons that were written in by hand stay."""
    reasons = reasons_in(table)
    counted = {}
    for mutant, end in results:
        row = counted.setdefault(mutant.file.split("/")[0], {})
        kind = end if end in ("uncompilable", "equivalent", "survived") else "killed"
        row[kind] = row.get(kind, 0) + 1
    lines = [
        "# Mutants", "",
        "Made by `tests/mutate.sh`: one place of a source is broken at a time (relation, operator, constant, sign,",
        "negated condition, swapped arguments, removed statement), and the unit tests of its library run until one",
        "fails. *Equivalent*: the compiler makes the same code of it. Headers are not mutated. Edit the reasons of",
        "survivors alone: the script keeps them.", "",
        f"{len(results)} mutants of seed {seed}.", "",
        "| library | killed | survived | killed of both | equivalent | uncompilable |",
        "|---|---|---|---|---|---|"]
    killed_all = lived_all = 0
    for library, row in sorted(counted.items()):
        killed, lived = row.get("killed", 0), row.get("survived", 0)
        killed_all, lived_all = killed_all + killed, lived_all + lived
        lines.append(f"| {library} | {killed} | {lived} | {100 * killed / max(1, killed + lived):.0f} % | "
                     f"{row.get('equivalent', 0)} | {row.get('uncompilable', 0)} |")
    lines += ["", "## Survivors", "", "| place | kind | why no test fails |", "|---|---|---|"]
    for mutant, end in results:
        if end == "survived":
            title = mutant.title().replace("|", "¦")
            lines.append(f"| {title} | {mutant.kind} | {reasons.get(title, 'not looked at yet')} |")
    table.write_text("\n".join(lines) + "\n")
    return killed_all, lived_all


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--copy", type=pathlib.Path, required=True)
    parser.add_argument("--table", type=pathlib.Path, required=True)
    parser.add_argument("--short", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--library", choices=LIBRARIES, action="append")
    parser.add_argument("--again", action="append", default=[])
    options = parser.parse_args()
    built = Built(options.copy)
    libraries = options.library or list(LIBRARIES)
    chosen = []
    for library in libraries:
        everyone = mutants_of(options.copy, library)
        print(f"{library}: {len(everyone)} mutants can be made", flush=True)
        if options.again:
            chosen += [m for m in everyone if f"{m.file}:{m.line + 1}" in options.again]
        else:
            draw = random.Random(f"{options.seed} {library}")
            count = min(len(everyone), options.short // len(libraries))
            chosen += sorted(draw.sample(everyone, count), key=lambda m: (m.file, m.line))
    for library in {m.file.split("/")[0] for m in chosen}:
        built.measure(library)
        print("; ".join(f"{n} {built.seconds[n]:.1f} s" for n in LIBRARIES[library]), flush=True)
    results = []
    for number, mutant in enumerate(chosen):
        end = try_one(built, mutant)
        results.append((mutant, end))
        print(f"{number + 1}/{len(chosen)} {end}: {mutant.file}:{mutant.line + 1} {mutant.kind}\n"
              f"    - {mutant.old.strip()}\n    + {mutant.new.strip()}", flush=True)
    for library in libraries:
        built.make(library)
    if options.again:
        return 0
    killed, lived = write_table(options.table, results, options.seed)
    share = killed / max(1, killed + lived)
    print(f"{killed} killed, {lived} survived: {100 * share:.0f} % (at least 90 % must be killed)")
    return 0 if share >= 0.9 else 1


if __name__ == "__main__":
    sys.exit(main())
