"""Lists the possible mutants of a source."""
import dataclasses
import hashlib
import re

from cpp_code import Code


@dataclasses.dataclass(frozen=True)
class Mutant:
    """One place of a source with another text."""

    file: str
    line: int  # from 1
    kind: str
    old: str  # the line before and after the change
    new: str
    region: int  # index in the file's regions
    begin: int  # offset in the file's text
    end: int
    text: str
    number: int = 1  # counts mutants with the same text in this file

    def title(self):
        again = f" ({self.number})" if self.number > 1 else ""
        return f"{self.file}: `{self.old}` -> `{self.new}`{again}"

    def rank(self, seed):
        """Returns the rank by which a sample is drawn. It depends only on the mutant itself, so a change elsewhere
        does not change the sample."""
        return hashlib.sha256(f"{seed} {self.title()}".encode()).hexdigest()


def flipped(pairs):
    return {**dict(pairs), **{b: a for a, b in pairs}}


OPERATORS = {
    "relation": {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="},
    "operator": flipped([("+", "-"), ("*", "/"), ("+=", "-="), ("&&", "||")]),
}
BOUNDS = {"min": "max", "max": "min"}
TRUTHS = {"true": "false", "false": "true"}


def other_number(text):
    """Returns a different constant, or None."""
    m = re.fullmatch(r"(0[xX][\da-fA-F']+|\d[\d']*)([uUlLzZ]*)", text)
    if m:
        return str(int(m.group(1).replace("'", ""), 0 if m.group(1)[:2] in ("0x", "0X") else 10) + 1) + m.group(2)
    m = re.fullmatch(r"([\d']*\.?\d*(?:[eE][-+]?\d+)?)(f?)", text)
    if m and m.group(1):
        value = f"{float(m.group(1).replace(chr(39), '')) * 1.5 + 0.5:g}"
        return value + (".0f" if m.group(2) and value.isdigit() else m.group(2))
    return None


def changes_of(code, region):
    """Yields (kind, begin, end, text) for each change that a region allows."""
    tokens, at = code.tokens, code.at
    first, last = region.first, region.last
    begin, end = tokens[first].begin, tokens[last - 1].end
    whole = code.flat(first, last)
    if region.kind == "condition":
        yield "negated", begin, end, f"!({whole})"
    if region.kind == "statement" and (at(first) != "return" or at(first + 1) == ";"):
        yield "removed", begin, end, ";"
    if re.search(r"\b(kill|unlink|remove|rename)\(", whole):
        return  # a mutant of these could act outside of the test
    for i in range(first, last):
        token = tokens[i]
        spaced = (0 < i < len(tokens) - 1 and tokens[i - 1].end < token.begin and token.end < tokens[i + 1].begin)
        if token.kind == "sign" and spaced:
            for kind, table in OPERATORS.items():
                if token.text in table:
                    yield kind, token.begin, token.end, table[token.text]
        if token.text == "-" and not spaced and at(i - 1) in ("=", ",", "(", "return", "?", ":", "{") \
                and (tokens[i + 1].kind == "word" or at(i + 1) == "("):
            yield "sign", token.begin, token.end, ""
        if token.kind == "number" and (other := other_number(token.text)):
            yield "constant", token.begin, token.end, other
        if token.text in TRUTHS:
            yield "constant", token.begin, token.end, TRUTHS[token.text]
        if token.text in BOUNDS and at(i - 1) == "::" and at(i - 2) == "std" and at(i + 1) in "(<":
            yield "operator", token.begin, token.end, BOUNDS[token.text]
        if token.text == "(" and i + 4 < last and tokens[i - 1].kind == "word" and at(i + 2) == "," \
                and tokens[i + 1].kind == tokens[i + 3].kind == "word" and at(i + 4) in (",", ")"):
            yield "swapped", tokens[i + 1].begin, tokens[i + 3].end, f"{at(i + 3)}, {at(i + 1)}"


def shortened(text):
    text = " ".join(text.split())
    return text if len(text) <= 110 else text[:107] + "..."


def mutants_of_text(name, text):
    """Lists every mutant of a source."""
    code = Code(text)
    found, seen = [], {}
    for number, region in enumerate(code.regions):
        for kind, begin, end, new in changes_of(code, region):
            line = text.count("\n", 0, begin) + 1
            line_begin, line_end = text.rfind("\n", 0, begin) + 1, text.find("\n", end)
            old_line = shortened(text[line_begin:line_end])
            new_line = shortened(text[line_begin:begin] + new + text[end:line_end])
            seen[old_line, new_line] = again = seen.get((old_line, new_line), 0) + 1
            found.append(Mutant(name, line, kind, old_line, new_line, number, begin, end, new, again))
    return found


def mutants_of(root, folders):
    """Lists every mutant of the sources in some folders."""
    found = []
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".cpp", ".h", ".inc"):
                found += mutants_of_text(str(path.relative_to(root)), path.read_text())
    return found
