#!/usr/bin/env python3
"""Writes the guide's page of all functions and constants of other makers' APIs, from the sources.

app/guide/compat_audit.py prints the page; put it into app/guide/pages/compat_audit.md.
"""
import pathlib
import re

COMPAT = pathlib.Path(__file__).resolve().parent.parent / "compat"


def names(api):
    """Returns the exported names of an API by the section of its table."""
    sections = {}
    title = ""
    for line in (COMPAT / api / "symbols.txt").read_text().splitlines():
        if line.startswith("#"):
            title = line
        elif line:
            sections.setdefault(title, []).append(line)
    return sections


def text_of(folder):
    return "\n".join(file.read_text() for file in sorted((COMPAT / folder).glob("*.cpp")))


def table(head, rows):
    print(f"| {head[0]} | {head[1]} |\n|---|---|")
    for row in rows:
        print(f"| {row[0]} | {row[1]} |")
    print()


def listed(functions):
    return ", ".join(f"`{name}`" for name in sorted(functions))


def hd_parameters():
    """Returns the state of each numeric parameter of HDAPI, from the table that implements them."""
    source = (COMPAT / "hd" / "hd_parameters.cpp").read_text()
    rows = re.findall(r"\{(HD_\w+), (\w+), \w+, (\w+)(?:, (\w+))?\}", source)
    for name, count, get, put in rows:
        size = "one for each motor" if count == "kPerMotor" else count
        state = f"read ({size})" if get != "get_nothing" else f"reads zero ({size}): no such part"
        if put == "set_motors":
            state += "; setting is refused, because forces must pass the gate"
        elif put:
            state += ", set"
        yield name, state


def hd_errors():
    """Returns the state of each error of HDAPI."""
    used = text_of("hd")
    header = (COMPAT / "include/thimble/compat/HD/hdDefines.h").read_text()
    for name in re.findall(r"#define (HD_\w+) 0x0[1-6]\w\wu", header):
        reported = re.search(rf"(record_\w+\(|return |\? |: ){name}\b", used.replace("case " + name, ""))
        yield name, "reported" if reported else "never reported"


def main():
    print("# Functions and constants of other makers' APIs\n")
    print("Written by `app/guide/compat_audit.py` from the sources of the [libraries](other_programs.md).")
    print("*Works* means that it is answered, within the [limits](other_programs.md#limits) of our arms. *Refused* means")
    print("that it returns the error of the API for a feature that an arm lacks. *Not answered* means that it returns -1")
    print("with `DHD_ERROR_NOT_IMPLEMENTED`.\n")

    functions = [n for section in names("hd").values() for n in section]
    capabilities = re.findall(r"case (HD_\w+):\n\s*return &Device::", (COMPAT / "hd/hd_get_set.cpp").read_text())
    texts = re.findall(r"number == (HD_\w+)", (COMPAT / "hd/hd_parameters.cpp").read_text())
    print("## HDAPI\n")
    print(f"All {len(functions)} functions work: {listed(functions)}.\n")
    parameters = dict(hd_parameters())
    for text in texts:
        parameters[text] = f"text; {parameters[text]}" if text in parameters else "text"
    print(f"{len(parameters)} parameters:\n")
    table(("parameter", "state"), [(f"`{name}`", state) for name, state in parameters.items()])
    print(f"Capabilities, each of which can be enabled and disabled: {listed(capabilities)}.\n")
    table(("error", "state"), [(f"`{name}`", state) for name, state in hd_errors()])

    print("## HL\n")
    hl = [n for section in names("hl").values() for n in section]
    functions = [name for name in hl if name.startswith("hl")]
    answered = ("hlGetError", "hlGetCurrentContext", "hlGetCurrentDevice", "hlDeploymentLicense")
    print(f"{len(answered)} of {len(functions)} functions work: {listed(answered)}. `hlCreateContext` leaves "
          "`HL_DEVICE_ERROR`. The others leave `HL_INVALID_OPERATION`, and getters return zero: "
          f"{listed(set(functions) - set(answered) - {'hlCreateContext'})}.\n")
    print(f"{len(hl) - len(functions)} constants are texts of the library: {listed(set(hl) - set(functions))}.\n")

    print("## hdPhantom\n")
    phantom = [n for section in names("hdphantom").values() for n in section]
    print(f"All {len(phantom)} functions work: {listed(phantom)}.\n")

    print("## DHD and DRD\n")
    source = text_of("dhd")
    refused = set(re.findall(r'(?:not_available|refuse)\(\s*"(\w+)"', source))
    refused |= set(re.findall(r"int (\w+)\([^{}]*\) \{\n  if \(!open_arm\([^{}]*\)\) return -1;\n"
                              r"  return fail\([^{}]*DHD_ERROR_NOT_AVAILABLE", source))
    sections = names("dhd")
    unanswered = next(v for k, v in sections.items() if k.startswith("# Not implemented"))
    working = [n for k, v in sections.items() if not k.startswith("# Not") for n in v if n not in refused]
    total = len(working) + len(refused) + len(unanswered)
    print(f"Of {total} functions, {len(working)} work, {len(refused)} are refused, {len(unanswered)} are not answered.\n")
    table(("state", "functions"), [("works", listed(working)), ("refused", listed(refused)),
                                   ("not answered", listed(unanswered))])


main()
