"""Writes many mutants into one source. The environment selects one of them at run time."""
from cpp_code import Code


def with_mutants(text, chosen):
    """Returns a source with the given mutants, (id, Mutant), and for each of its lines the ids of the mutants that
    a compiler's error there can come from."""
    code = Code(text)
    regions = {}
    for ident, mutant in chosen:
        regions.setdefault(mutant.region, []).append((ident, mutant))
    pieces, place = [], 0  # (text, ids)
    for number, here in sorted(regions.items(), key=lambda item: code.tokens[code.regions[item[0]].first].begin):
        region = code.regions[number]
        begin, end = code.tokens[region.first].begin, code.tokens[region.last - 1].end
        pieces.append((text[place:begin], set()))
        pieces += pieces_of(code, region, here)
        place = end
    pieces.append((text[place:], set()))
    out, lines = "", {}
    for piece, ids in pieces:
        first = out.count("\n") + 1
        out += piece
        if ids:
            for line in range(first, out.count("\n") + 2):
                lines.setdefault(line, set()).update(ids)
    return out, lines


def pieces_of(code, region, here):
    """Yields the texts that replace a region, each on separate lines."""
    whole = code.flat(region.first, region.last)
    everyone = {ident for ident, _ in here}
    if region.kind == "statement":
        yield "{\n", set()
        for ident, mutant in here:
            yield f"if (THIMBLE_MUTANT({ident})) {{ {mutated(code, region, mutant)} }} else", {ident}
            yield "\n", set()
        yield f"{{ {whole} }}", everyone
        yield "\n}", set()
        return
    cast = "static_cast<bool>" if region.kind == "condition" else f"static_cast<{region.type}>" if region.type else ""
    yield "\n", set()
    # The compiler evaluates constants at build time, so the mutant would never be selected at run time.
    macro = "THIMBLE_MUTANT_NOW" if region.const else "THIMBLE_MUTANT"
    for ident, mutant in here:
        yield f"({macro}({ident}) ? {cast}({mutated(code, region, mutant)}) :", {ident}
        yield "\n", set()
    yield f"{cast}({whole}){')' * len(here)}", everyone
    yield "\n", set()


def mutated(code, region, mutant):
    """Returns a region with its mutant, on one line."""
    before = [i for i in range(region.first, region.last) if code.tokens[i].end <= mutant.begin]
    behind = [i for i in range(region.first, region.last) if code.tokens[i].begin >= mutant.end]
    left = code.flat(before[0], before[-1] + 1) if before else ""
    right = code.flat(behind[0], behind[-1] + 1) if behind else ""
    return f"{left} {mutant.text} {right}"
