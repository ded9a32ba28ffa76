"""The table of the results of the mutants, tests/MUTANTS.md."""
import re

EQUIVALENT = "equivalent"  # a reason with this prefix means that no test can detect the mutant
HEAD = """# Mutants

Written by `tests/mutate.sh`. It breaks single places of driver, render, scene and session, one at a time: a relation, an operator, a
constant, a sign, a negated condition, swapped arguments or a removed statement. The unit tests that reach the place
run until one fails. The reasons are written by hand, and the script keeps them. A reason that begins with
*equivalent* means that no test can fail; the mutant does not count. At least 90 % of the others must be killed.
"""


def cell(text):
    return text.replace("|", "¦")


def reasons_in(table):
    """Returns the reasons for survivors in a table, by their titles."""
    reasons = {}
    for line in table.read_text().splitlines() if table.exists() else []:
        m = re.match(r"\| (.+: `.+` -> `.*`(?: \(\d+\))?) \| (\w+) \| (.*) \|$", line)
        if m:
            reasons[m.group(1)] = m.group(3)
    return reasons


class Count:
    """Counts of the results of some mutants."""

    def __init__(self):
        self.killed = self.survived = self.equivalent = 0

    def share(self):
        return self.killed / max(1, self.killed + self.survived)

    def row(self, name):
        return f"| {name} | {self.killed} | {self.survived} | {self.equivalent} | {100 * self.share():.0f} % |"


def summary(results, reasons):
    """Returns the counts by library, by file and in all; `results` are (mutant, how)."""
    counts = {}
    for mutant, how in results:
        library = mutant.file.split("/")[0]
        for name in ("all", library, mutant.file):
            count = counts.setdefault(name, Count())
            if how:
                count.killed += 1
            elif reasons.get(cell(mutant.title()), "").startswith(EQUIVALENT):
                count.equivalent += 1
            else:
                count.survived += 1
    return counts


def write_table(table, results, uncompilable, seed):
    """Writes the results of all mutants, and returns the counts."""
    reasons = reasons_in(table)
    counts = summary(results, reasons)
    files = sorted(name for name in counts if "/" in name)
    rows = sorted(name for name in counts if "/" not in name and name != "all") + ["all"]
    header = " | killed | survived | equivalent | killed share |\n|---|---|---|---|---|"
    lines = [HEAD, f"{len(results)} mutants of seed {seed} in {len(files)} files; {uncompilable} more did not compile.",
             "", "| library" + header, *(counts[name].row(name) for name in rows if name in counts),
             "", "## Survivors", "", "| place | kind | why no test fails |", "|---|---|---|"]
    for mutant, how in results:
        if not how:
            title = cell(mutant.title())
            lines.append(f"| {title} | {mutant.kind} | {reasons.get(title, 'not analysed yet')} |")
    lines += ["", "## By file", "", "| file" + header, *(counts[name].row(name) for name in files)]
    table.write_text("\n".join(lines) + "\n")
    return counts
