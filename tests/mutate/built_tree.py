"""A copy of the project with mutants in it, and its build."""
import json
import re
import shutil
import subprocess
import sys

from places import Mutant
from schemata import with_mutants

ROUNDS = 8  # of removing mutants that do not compile


class BuiltTree:
    """The copy and its build. Unchanged sources keep their times."""

    def __init__(self, root, copy, plan):
        self.root, self.copy, self.plan = root, copy, plan
        self.build = copy / plan["build"]
        self.dropped_file = copy.parent / "uncompilable.json"
        self.dropped = set(json.loads(self.dropped_file.read_text())) if self.dropped_file.exists() else set()
        self.lines = {}  # per mutated file: line -> ids

    def write(self, chosen: dict[int, Mutant]):
        """Makes the copy equal to the project, except for the mutants."""
        names = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "."], cwd=self.root, check=True,
                               capture_output=True, text=True).stdout.splitlines()
        by_file = {}
        for ident, mutant in chosen.items():
            by_file.setdefault(mutant.file, []).append((ident, mutant))
        self.lines = {}
        for name in names:
            source, target = self.root / name, self.copy / name
            if not source.is_file():
                continue
            content = source.read_bytes()
            if name in by_file:
                text, self.lines[name] = with_mutants(content.decode(), by_file[name])
                content = text.encode()
            if not target.exists() or target.read_bytes() != content:
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content)
                shutil.copymode(source, target)
        for old in set(self.files_of_copy()) - set(names):
            (self.copy / old).unlink()

    def files_of_copy(self):
        for path in self.copy.rglob("*"):
            name = path.relative_to(self.copy)
            if path.is_file() and name.parts[0] != "build":
                yield str(name)

    def configure(self):
        self.run(self.plan["configure"], "configured")

    def run(self, command, what):
        command = [part.replace("@ROOT@", str(self.root)) for part in command]
        done = subprocess.run(command, cwd=self.copy, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            sys.exit(f"{done.stdout[-6000:]}\nThe copy in {self.copy} could not be {what}.")

    def build_without(self, chosen):
        """Builds the copy, removes mutants that do not compile from `chosen`, and returns their number."""
        chosen_first = len(chosen)
        for ident in [ident for ident, mutant in chosen.items() if mutant.title() in self.dropped]:
            del chosen[ident]
        for _ in range(ROUNDS):
            self.write(chosen)
            if not (self.build / "CMakeCache.txt").exists():
                self.configure()
            for targets in self.plan["targets"]:
                done = subprocess.run(["cmake", "--build", str(self.build), "--target", *targets, "--", "-k", "0"],
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
                if done.returncode != 0:
                    break
            if done.returncode == 0:
                return chosen_first - len(chosen)
            guilty = self.guilty(done.stdout) & set(chosen)
            if not guilty:
                sys.exit(f"{done.stdout[-6000:]}\nThe copy in {self.copy} cannot be built, for another reason than its mutants.")
            print(f"{len(guilty)} mutants do not compile", flush=True)
            for ident in guilty:
                self.dropped.add(chosen.pop(ident).title())
            self.dropped_file.write_text(json.dumps(sorted(self.dropped)))
        sys.exit(f"After {ROUNDS} rounds there are still mutants that do not compile.")

    def guilty(self, log):
        """Returns the ids of the mutants that cause the compiler's errors: those of the line in error, or else of the
        lines that led to it."""
        found = set()
        for error in re.split(r"\n(?=In file included from |[^\n:]+: In |FAILED)", log):
            places = re.findall(r"([^\s:]+\.(?:cpp|h|inc)):(\d+)(?=[:,](.*))", error)
            exact = [self.ids_at(name, line) for name, line, rest in places if "error: " in rest[:20]]
            if exact:
                found |= set().union(*exact) or set().union(*(self.ids_at(name, line) for name, line, _ in places))
        return found

    def ids_at(self, name, line):
        return self.lines.get(name.removeprefix(str(self.copy) + "/"), {}).get(int(line), set())
