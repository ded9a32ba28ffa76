"""The table of what became of the mutants, tests/MUTANTS.md."""
import re

EQUIVALENT = "equivalent"  # a reason with this prefix means that no test can detect the mutant
HEAD = """# Mutants

Made by `tests/mutate.sh`: single places of driver, render, scene and session are broken, one at a time (a relation, an operator, a
constant, a sign, a negated condition, swapped arguments, a removed statement), and the unit tests that come by the
place run until one fails. The reasons are written by hand and kept by the script; one that begins with *equivalent*
says that no test could fail, and the mutant does not count. At least 90 % of the others must be killed.
"""


def cell(text):
    return text.replace("|", "¦")


def reasons_in(table):
    """Returns the reasons that a table gives for survivors, by their titles."""
    reasons = {}
    for line in table.read_text().splitlines() if table.exists() else []:
        m = re.match(r"\| (.+: `.+` -> `.*`(?: \(\d+\))?) \| (\w+) \| (.*) \|$", line)
        if m:
            reasons[m.group(1)] = m.group(3)
    return reasons


class Count:
    """How many of some mutants came to which end."""

    def __init__(self):
        self.killed = self.survived = self.equivalent = 0

    def share(self):
        return self.killed / max(1, self.killed + self.survived)

    def row(self, name):
        return f"| {name} | {self.killed} | {self.survived} | {self.equivalent} | {100 * self.share():.0f} % |"


def summary(results, reasons):
    """Counts by library and by file, and all; `results` are (mutant, how)."""
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
    """Writes what became of all, and returns the counts."""
    reasons = reasons_in(table)
    counts = summary(results, reasons)
    files = sorted(name for name in counts if "/" in name)
    rows = sorted(name for name in counts if "/" not in name and name != "all") + ["all"]
    header = " | killed | survived | equivalent | killed of what could be |\n|---|---|---|---|---|"
    lines = [HEAD, f"{len(results)} mutants of seed {seed} in {len(files)} files; {uncompilable} more did not compile.",
             "", "| library" + header, *(counts[name].row(name) for name in rows if name in counts),
             "", "## Survivors", "", "| place | kind | why no test fails |", "|---|---|---|"]
    for mutant, how in results:
        if not how:
            title = cell(mutant.title())
            lines.append(f"| {title} | {mutant.kind} | {reasons.get(title, 'not looked at yet')} |")
    lines += ["", "## By file", "", "| file" + header, *(counts[name].row(name) for name in files)]
    table.write_text("\n".join(lines) + "\n")
    return counts
