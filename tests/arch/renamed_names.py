#!/usr/bin/env python3
"""Checks the guide's page of the API (app/guide/pages/api.md): its section "Renamed names" lists each deprecated name of the
installed headers, and each renamed key of scene and arm files, with the new name in the same row.

renamed_names.py SOURCES
"""
import pathlib
import re
import sys

DEPRECATED = re.compile(r'\[\[deprecated\("renamed to (\w+)"\)\]\]')
KEY = re.compile(r'RenamedKey\{"[^"]*", "(\w+)", "(\w+)"\}')


def old_name(text, begin, end):
    """The name that the attribute at `begin` to `end` belongs to."""
    using = re.search(r"using (\w+) $", text[:begin])
    if using:
        return using.group(1)
    declared = re.search(r"(\w+)\s*(?:\(|=)", text[end:])
    return declared.group(1)


def renamed(root):
    for header in sorted(root.glob("*/include/**/*.h")) + sorted(root.glob("app/*/include/**/*.h")):
        text = header.read_text()
        for match in DEPRECATED.finditer(text):
            yield header.relative_to(root), old_name(text, match.start(), match.end()), match.group(1)
    keys = root / "app/scene/src/yaml/renamed_keys.h"
    for match in KEY.finditer(keys.read_text()):
        yield keys.relative_to(root), match.group(1), match.group(2)


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    page = (root / "app/guide/pages/api.md").read_text()
    rows = [line.split("|")[1:3] for line in page.splitlines() if line.startswith("|") and line.count("|") > 2]

    def listed(old, new):
        return any(re.search(rf"\b{old}\b", a) and re.search(rf"\b{new}\b", b) for a, b in rows)

    names = list(renamed(root))
    found = [f"{file}: the page app/guide/pages/api.md lacks {old}, now {new}. Add it to \"Renamed names\"."
             for file, old, new in names if not listed(old, new)]
    if len(names) < 10:
        found.append("Fewer than ten renamed names were found: this check does not read the headers any more.")
    print("\n".join(found) if found else f"The page lists all {len(names)} renamed names.")
    return 1 if found else 0


sys.exit(main())
