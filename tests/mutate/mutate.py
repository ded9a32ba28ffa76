"""Makes mutants of the project's libraries, builds all at once, tries them with the tests, and writes a table.

Called by tests/mutate.sh, which describes the options. A plan (plan.json) names libraries, targets and test programs.
"""
import argparse
import json
import os
import pathlib
import sys
import time

from built_tree import BuiltTree
from places import mutants_of
from table import cell, reasons_in, summary, write_table
from trials import Trials, number_of

KILLED_MIN = 0.9  # share that must be killed


def draw(root, plan, options):
    """Returns the mutants to try, by their ids."""
    chosen = {}
    for library, folders in plan["libraries"].items():
        if options.library and library not in options.library:
            continue
        everyone = mutants_of(root, folders)
        print(f"{library}: {len(everyone)} mutants are possible", flush=True)
        if options.again:
            drawn = [m for m in everyone if f"{m.file}:{m.line}" in options.again]
        else:
            drawn = sorted(everyone, key=lambda m: m.rank(options.seed))[:options.count // len(plan["libraries"])]
        for mutant in drawn:
            ident = number_of(mutant.title())
            while ident in chosen:
                ident += 1
            chosen[ident] = mutant
    return chosen


def known_results(file, options, chosen):
    """Returns the results of an earlier run for mutants that need not be tried again: {id: (how, where)}."""
    if not options.survivors or not file.exists():
        return {}
    known = json.loads(file.read_text())
    return {ident: known[m.title()] for ident, m in chosen.items() if known.get(m.title(), ["", ""])[0]}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", type=pathlib.Path, required=True)
    parser.add_argument("--plan", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--table", type=pathlib.Path, required=True)
    parser.add_argument("--count", type=int, default=800)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--library", action="append")
    parser.add_argument("--budget", type=float, default=60)
    parser.add_argument("--again", action="append", default=[])
    parser.add_argument("--survivors", action="store_true")
    options = parser.parse_args()
    plan = json.loads(options.plan.read_text())
    begin = time.monotonic()

    chosen = draw(options.root, plan, options)
    if not chosen:
        sys.exit("No mutant is possible there.")
    tree = BuiltTree(options.root, options.work / "source", plan)
    uncompilable = tree.build_without(chosen)
    print(f"{len(chosen)} mutants built, {uncompilable} do not compile", flush=True)
    # Scenes with a scanned mesh search beside their own sources, which are a copy here.
    os.environ.setdefault("THIMBLE_MESHES", str(options.root / "build/meshes"))
    trials = Trials(tree.build, plan["programs"], options.jobs, options.budget)
    tests = trials.measure(options.work / "tests.json")
    print(f"{len(tests)} tests take {sum(test.seconds for test in tests):.0f} s", flush=True)

    results_file = options.work / "results.json"
    ends = known_results(results_file, options, chosen)

    def keep():  # so that --survivors can continue an interrupted run
        if not options.again:
            results_file.write_text(json.dumps({chosen[i].title(): end for i, end in ends.items()}, indent=0))

    for ident, how, where in trials.try_all(ident for ident in chosen if ident not in ends):
        ends[ident] = (how, where)
        keep()
        mutant = chosen[ident]
        print(f"{len(ends)}/{len(chosen)} {mutant.file}:{mutant.line} {mutant.kind}: {how or 'SURVIVED'} ({where})\n"
              f"    - {mutant.old}\n    + {mutant.new}", flush=True)
    results = [(m, ends[i][0]) for i, m in sorted(chosen.items(), key=lambda x: (x[1].file, x[1].line, x[1].title()))]
    if options.again:
        counts = summary(results, reasons_in(options.table))
    else:
        keep()
        counts = write_table(options.table, results, uncompilable, options.seed)
    reasons = reasons_in(options.table)
    for mutant, how in results:
        if not how:
            print(f"survived: {mutant.file}:{mutant.line} {mutant.kind}\n    - {mutant.old}\n    + {mutant.new}\n"
                  f"    {reasons.get(cell(mutant.title()), 'no reason given yet')}")
    every = counts["all"]
    print(f"{every.killed} killed, {every.survived} survived, {every.equivalent} equivalent: {100 * every.share():.1f} % "
          f"(at least {100 * KILLED_MIN:.0f} %) in {(time.monotonic() - begin) / 60:.0f} min")
    return 0 if every.share() >= KILLED_MIN else 1


if __name__ == "__main__":
    sys.exit(main())
