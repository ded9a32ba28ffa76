"""Runs tests, to find which mutants each test reaches and which mutants it detects."""
import concurrent.futures
import dataclasses
import hashlib
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time

MUTANTS_MAX = 65536  # kMax of mutant.h
QUICK = 0.25  # s of processor time: tests of a program below it run together
LIMIT_TIMES, LIMIT_MORE = 8, 5  # a run hangs after LIMIT_TIMES its usual time plus LIMIT_MORE s
MEMORY = 6 << 30


@dataclasses.dataclass(frozen=True)
class Test:
    program: str
    name: str
    seconds: float
    reached: frozenset


class Trials:
    """The test programs of a build."""

    def __init__(self, build, programs, jobs, budget):
        self.jobs = jobs
        self.budget = budget
        self.programs = {name: next(p for p in build.rglob(name) if p.is_file() and os.access(p, os.X_OK))
                         for name in programs}
        self.tests = []

    def run(self, program, tests, variables, limit):
        """Runs some tests of a program. Returns its exit code (None if it was ended at the time limit), its output
        and its seconds of processor time."""
        def bounds():
            resource.setrlimit(resource.RLIMIT_CPU, (int(limit) + 1, int(limit) + 2))
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

        with tempfile.TemporaryDirectory() as scratch, tempfile.TemporaryFile() as log:
            environment = {**os.environ, "TMPDIR": scratch, **variables}
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            child = subprocess.Popen(
                [str(self.programs[program]), "--gtest_brief=1", "--gtest_fail_fast", "--gtest_filter=" + ":".join(tests)],
                cwd=scratch, env=environment, stdout=log, stderr=log, start_new_session=True, preexec_fn=bounds)
            begin = time.monotonic()
            try:
                code = child.wait(10 * limit)  # the machine may be busy
            except subprocess.TimeoutExpired:
                code = None
            seconds = time.monotonic() - begin
            try:
                os.killpg(child.pid, signal.SIGKILL)  # and its child processes
            except ProcessLookupError:
                pass
            child.wait()
            log.seek(0)
            output = log.read().decode(errors="replace")
        if code in (-signal.SIGXCPU, -signal.SIGKILL):
            code = None
        return code, output, seconds

    def names_of(self, program):
        listed = subprocess.run([str(self.programs[program]), "--gtest_list_tests"], check=True, capture_output=True,
                                text=True).stdout
        suite = ""
        for line in listed.splitlines():
            line = re.sub(r"\s*#.*", "", line)
            if line.startswith("  "):
                if not re.search(r"(^|/|\.)DISABLED_", suite + line.strip()):
                    yield suite + line.strip()
            elif line.endswith("."):
                suite = line

    def measure(self, store):
        """Runs every test without a mutant and records the mutants that it reaches; exits if one fails. Reads the
        result from the file `store` instead if the programs are those for which it was written."""
        built = hashlib.sha256()
        for path in self.programs.values():
            built.update(path.read_bytes())
        if store.exists():
            known = json.loads(store.read_text())
            if known["programs"] == built.hexdigest():
                self.tests = [Test(program, name, seconds, frozenset(reached))
                              for program, name, seconds, reached in known["tests"]]
                return self.tests
        every = [(program, name) for program in self.programs for name in self.names_of(program)]
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            self.tests = list(pool.map(lambda one: self.measure_one(*one), every))
        if None in self.tests:
            sys.exit("Tests fail without any mutant. Fix them first.")
        store.write_text(json.dumps({"programs": built.hexdigest(),
                                     "tests": [[t.program, t.name, t.seconds, sorted(t.reached)] for t in self.tests]}))
        return self.tests

    def measure_one(self, program, name):
        for attempt in range(3):
            with tempfile.NamedTemporaryFile() as reached:
                reached.truncate(MUTANTS_MAX)
                code, output, seconds = self.run(program, [name], {"THIMBLE_MUTANTS_REACHED": reached.name}, 600)
                content = pathlib.Path(reached.name).read_bytes()
            if code == 0:
                return Test(program, name, seconds, frozenset(i for i, byte in enumerate(content) if byte))
        print(f"{output}\n{program} fails in {name} without any mutant", flush=True)
        return None

    def killer_of(self, ident):
        """Returns how a mutant was detected and in which run; an empty text if no test detects or reaches it. Tests
        that take more than the budget together are not run, so a mutant in code that all tests reach may count as
        a survivor although a slow test would detect it."""
        own = sorted((test for test in self.tests if ident in test.reached), key=lambda test: test.seconds)
        if not own:
            return "", "unreached"
        quick = {}
        for test in own:
            if test.seconds < QUICK:
                quick.setdefault(test.program, []).append(test)
        runs = sorted(quick.values(), key=lambda tests: sum(test.seconds for test in tests))
        runs += [[test] for test in own if test.seconds >= QUICK]
        spent = 0
        for tests in runs:
            if spent > self.budget:
                break
            spent += sum(test.seconds for test in tests)
            limit = LIMIT_TIMES * sum(test.seconds for test in tests) + LIMIT_MORE
            code, output, _ = self.run(tests[0].program, [test.name for test in tests],
                                       {"THIMBLE_MUTANT": str(ident)}, limit)
            if code == 0:
                continue
            failed = re.search(r"\[  FAILED  \] ([\w./]+)", output)
            how = "hangs" if code is None else "crashes" if code < 0 else "fails"
            return how, failed.group(1) if failed else tests[0].program
        return "", "survived"

    def try_all(self, idents):
        """Yields (id, how, where) for each mutant when its result is known."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            futures = {pool.submit(self.killer_of, ident): ident for ident in idents}
            for future in concurrent.futures.as_completed(futures):
                yield futures[future], *future.result()


def number_of(title):
    """Returns a number below MUTANTS_MAX for a mutant that does not depend on changes elsewhere."""
    return int(hashlib.sha256(title.encode()).hexdigest()[:8], 16) % MUTANTS_MAX
