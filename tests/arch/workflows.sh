#!/usr/bin/env bash
# Checks the GitHub workflows, and the one that users copy: each is YAML, its steps are bash, each file that a step runs exists
# and is executable, and jobs wait for existing jobs.
#   workflows.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
/usr/bin/python3 -c 'import yaml' 2>/dev/null || {
  echo "NOT TESTED: the workflows; install python3-yaml."
  exit 77
}
/usr/bin/python3 - .github/workflows/*.yml app/examples/*.yml <<'END'
import itertools, os, re, subprocess, sys, yaml

failures = []
actions = programs = 0


def fail(place, what):
    failures.append(f"FAILED: {place}: {what}")


def variants(text, matrix):
    """Yields the text for each combination of the matrix; other expressions become a word."""
    names = [name for name in matrix if isinstance(matrix[name], list)]
    for values in itertools.product(*(matrix[name] for name in names)):
        now = text
        for name, value in zip(names, values):
            now = re.sub(r"\$\{\{ *matrix\." + name + r" *\}\}", str(value), now)
        yield re.sub(r"\$\{\{.*?\}\}", "WORD", now)


for file in sys.argv[1:]:
    try:
        workflow = yaml.safe_load(open(file))
    except yaml.YAMLError as error:
        fail(file, error)
        continue
    own = file.startswith(".github/")
    if not workflow.get(True):  # YAML 1.1 reads the key "on" as true
        fail(file, "no trigger (on)")
    if own and workflow.get("permissions") != {"contents": "read"}:
        fail(file, "permissions: expected contents: read; a job that needs more must request it")
    jobs = workflow.get("jobs", {})
    for name, job in jobs.items():
        place = f"{file}: {name}"
        for key in ("runs-on", "timeout-minutes", "steps"):
            if key not in job:
                fail(place, f"no {key}")
        needs = job.get("needs", [])
        for other in [needs] if isinstance(needs, str) else needs:
            if other not in jobs:
                fail(place, f"it needs {other}, which is not a job")
        container = job.get("container")
        image = container.get("image") if isinstance(container, dict) else container
        runs = [step["run"] for step in job["steps"] if "run" in step]
        if runs and image != "debian:12":
            fail(place, f"its steps run on {image}; expected the container debian:12")
        for step in job["steps"]:
            if ("run" in step) == ("uses" in step):
                fail(place, f"a step needs either run or uses: {step}")
            if "uses" in step:
                actions += 1
                if not re.fullmatch(r"[\w-]+/[\w/-]+@v\d+", step["uses"]):
                    fail(place, f"{step['uses']}: expected OWNER/ACTION@vN")
        for run in runs:
            for text in variants(run, job.get("strategy", {}).get("matrix", {})):
                checked = subprocess.run(["bash", "-n"], input=text, capture_output=True, text=True)
                if checked.returncode != 0:
                    fail(place, checked.stderr.strip())
                for program in re.findall(r"(?<![\w./-])(?:app|tests)/[\w./-]+\.sh\b", text) if own else []:
                    programs += 1
                    if not os.access(program, os.X_OK):
                        fail(place, f"{program} is not an executable file")

print("\n".join(failures) or f"{len(sys.argv) - 1} workflows, {actions} actions, {programs} programs")
if not failures and (actions < 10 or programs < 10):
    failures.append("fewer than 10 actions or programs were found")
sys.exit(1 if failures else 0)
END
