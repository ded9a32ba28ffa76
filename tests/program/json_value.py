#!/usr/bin/env python3
"""Checks a value of a JSON file. If it differs, prints the value and ends with 1.

   json_value.py FILE PATH OPERATOR VALUE
   json_value.py FILE PATH

PATH: .key.key, with [3] for an element of a list, [name=text] for the element whose key has this text, and # at the end for the
number of elements. OPERATOR: == != < <= > >= for numbers, texts, true, false and null; has, lacks: whether a list contains VALUE;
absent: there is no such value. Without an operator the value is printed."""
import json
import re
import sys


def find(whole, path):
    """Returns the value at a path; raises LookupError."""
    value = whole
    for key, index in re.findall(r"\.([A-Za-z0-9_-]+)|\[([^]]*)\]", path.rstrip("#")):
        if key:
            if not isinstance(value, dict):
                raise LookupError(key)
            value = value[key]
        elif "=" in index:
            name, text = index.split("=", 1)
            found = [one for one in value if str(one.get(name)) == text]
            if len(found) != 1:
                raise LookupError(index)
            value = found[0]
        else:
            value = value[int(index)]
    return len(value) if path.endswith("#") else value


def holds(value, operator, text):
    try:
        wanted = json.loads(text)
    except ValueError:
        wanted = text
    if operator in ("has", "lacks"):
        return isinstance(value, list) and (wanted in value) == (operator == "has")
    if operator in ("==", "!="):
        same = value == wanted and (isinstance(value, bool) == isinstance(wanted, bool))
        return same == (operator == "==")
    numbers = [one for one in (value, wanted) if isinstance(one, (int, float)) and not isinstance(one, bool)]
    if len(numbers) < 2:
        return False
    return {"<": value < wanted, "<=": value <= wanted, ">": value > wanted, ">=": value >= wanted}[operator]


def main():
    file, path, *rest = sys.argv[1:]
    try:
        value = find(json.load(open(file)), path)
    except (OSError, ValueError) as error:
        sys.exit(f"{file}: {error}")
    except (LookupError, TypeError):
        if rest and rest[0] == "absent":
            return
        sys.exit(f"{file}: there is no {path}")
    if not rest:
        print(json.dumps(value))
    elif rest[0] == "absent" or not holds(value, rest[0], rest[1]):
        sys.exit(f"{file}: {path} is {json.dumps(value)}, expected {' '.join(rest)}")


main()
