"""Finds the statements and conditions of C++ code from its tokens only.

It covers the part of the language that this project uses. Code that it misinterprets becomes a mutant that does
not compile, and those are dropped.
"""
import dataclasses
import re

TOKEN = re.compile(r"""
    (?P<blank>\s+|//[^\n]*|/\*.*?\*/)
  | (?P<directive>\#(?:[^\n\\]|\\.)*)
  | (?P<text>(?:u8|[uUL])?R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"|(?:u8|[uUL])?"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])+')
  | (?P<number>\.?\d(?:[eEpP][-+]|[\w.]|'(?=\w))*)
  | (?P<word>[A-Za-z_]\w*)
  | (?P<sign><=>|<<=|\.\.\.|->\*?|::|\+\+|--|&&|\|\||[-+*/%&|^=!<>]=|<<|[^\s\w])
""", re.X | re.S)
DECLARATION = re.compile(
    r"^(?:const|constexpr|static|auto|constinit|unsigned|typename|thread_local|volatile|struct|alignas)\b"
    r"|^\w+(?:::\w+)*(?:<[^;=()]*>(?:::\w+)*)?(?:\s*(?:const\b)?\s*[*&]+\s*|\s+)(?:const\s+)?"
    r"[A-Za-z_]\w*\s*(?:[=;({\[,]|$)")
CONTAINERS = {"namespace", "class", "struct", "union", "extern"}


@dataclasses.dataclass(frozen=True)
class Token:
    kind: str
    text: str
    begin: int
    end: int


@dataclasses.dataclass(frozen=True)
class Region:
    """Tokens that can have an original and a mutated form: a whole statement, a condition, or an initialiser and its type."""

    kind: str
    first: int
    last: int  # index after its last token
    type: str = ""
    const: bool = False


class Code:
    """A file's tokens and its regions."""

    def __init__(self, text):
        self.text = text
        self.tokens = [Token(m.lastgroup if m.lastgroup != "mark" else "text", m.group(), m.start(), m.end())
                       for m in TOKEN.finditer(text) if m.lastgroup not in ("blank", "directive")]
        self.partner = {}
        opened = []
        for i, token in enumerate(self.tokens):
            if token.kind == "sign" and token.text in "([{":
                opened.append(i)
            elif token.kind == "sign" and token.text in ")]}" and opened:
                self.partner[opened.pop()] = i
        self.regions = []
        self.walk_declarations(0, len(self.tokens))

    def at(self, i):
        return self.tokens[i].text if 0 <= i < len(self.tokens) else ""

    def flat(self, first, last):
        """Returns the text of tokens on one line, without comments."""
        out = []
        for i in range(first, last):
            gap = self.tokens[i].begin > self.tokens[i - 1].end if i > first else False
            out.append((" " if gap else "") + self.tokens[i].text)
        return "".join(out)

    def head(self, i):
        """Returns the index at which the statement of a token begins."""
        while i > 0 and self.at(i - 1) not in (";", "{", "}"):
            i -= 1
        return i

    def opens_code(self, i):
        """Returns whether a brace opens statements, and not a class, a namespace or an initialiser."""
        words = [self.at(k) for k in range(self.head(i), i)]
        while len(words) > 2 and words[0] == "template":
            words = words[1:]
        if words and (words[0] in CONTAINERS or "enum" in words):
            return False
        before = self.at(i - 1)
        if before in (")", "else", "do", "try", "noexcept", "override", "mutable", ";", "{") or not words:
            return before != "{" or i > 0
        if before == "const" and ")" in words:
            return True
        gap = self.tokens[i].begin > self.tokens[i - 1].end
        if before in ("]", "}") and gap or before == ":" and words[0] in ("case", "default"):
            return True
        if "->" in words:
            behind = words[len(words) - words[::-1].index("->"):]
            return ")" in words and all(re.match(r"[\w:<>,*& ]+$", word) for word in behind)
        return False

    def walk_declarations(self, first, last):
        i = first
        while i < last:
            if self.at(i) == "{" and i in self.partner and self.tokens[i].kind == "sign":
                end = self.partner[i]
                if self.is_enum(i):
                    pass
                elif self.opens_code(i):
                    self.walk_code(i + 1, end)
                else:
                    self.walk_declarations(i + 1, end)
                i = end
            i += 1

    def is_enum(self, i):
        return "enum" in [self.at(k) for k in range(self.head(i), i)]

    def holds_code(self, first, last):
        return any(self.at(i) == "{" and i in self.partner and self.opens_code(i) for i in range(first, last))

    def walk_code(self, first, last):
        i = first
        while i < last:
            word = self.at(i)
            if word in ("if", "while", "switch", "for", "catch"):
                fixed = self.at(i + 1) == "constexpr"
                opening = i + (2 if fixed else 1)
                end = self.partner.get(opening, last)
                if not fixed:
                    self.take_parenthesis(word, opening + 1, end)
                self.walk_declarations(opening + 1, end)
                i = end + 1
            elif word in ("else", "do", "try", ";", "}"):
                i += 1
            elif word in ("case", "default"):
                while i < last and self.at(i) != ":":
                    i += 1
                i += 1
            elif word == "{" and i in self.partner:
                self.walk_code(i + 1, self.partner[i])
                i = self.partner[i] + 1
            else:
                end = self.end_of_statement(i, last)
                self.walk_declarations(i, end)
                if self.at(end - 1) == ";" and not self.holds_code(i, end):
                    self.take_statement(i, end)
                i = end

    def end_of_statement(self, i, last):
        while i < last and self.at(i) != ";":
            i = self.partner.get(i, i) + 1
        return min(i + 1, last)

    def take_parenthesis(self, word, first, last):
        parts, begin, i = [], first, first
        while i <= last:
            if i == last or self.at(i) == ";":
                parts.append((begin, i))
                begin = i + 1
            i = self.partner.get(i, i) + 1
        if word in ("if", "while"):
            self.take("condition", *parts[-1])
        if word == "for" and len(parts) == 3:
            self.take_initialisers(*parts[0])
            self.take("condition", *parts[1])
        elif len(parts) == 2:
            self.take_initialisers(*parts[0])

    def take(self, kind, first, last, type_of="", const=False):
        if first < last and not self.holds_code(first, last):
            self.regions.append(Region(kind, first, last, type_of, const))

    def take_statement(self, first, last):
        word = self.at(first)
        if word in ("using", "typedef", "static_assert", "template", "goto", "throw", "delete", "enum", "class",
                    "friend", "union", "asm"):
            return
        if word not in ("return", "break", "continue") and DECLARATION.match(self.flat(first, last)):
            if not {"constexpr", "static", "constinit"} & {self.at(i) for i in range(first, last)}:
                self.take_initialisers(first, last - 1)
            return
        self.take("statement", first, last)

    def take_initialisers(self, first, last):
        begin = i = first
        while i < last:
            if self.at(i) == "=":
                end = i + 1
                while end < last and self.at(end) != ",":
                    end = self.partner.get(end, end) + 1
                words = self.flat(first, i - 1)
                plain = "," not in words and not re.search(r"\bauto\b|&|=|\[", words)
                if self.at(i + 1) != "{":
                    self.take("initialiser", i + 1, end, re.sub(r"^const ", "", words) if plain else "",
                              self.at(begin) == "const")
                i = end
            i = self.partner.get(i, i) + 1
