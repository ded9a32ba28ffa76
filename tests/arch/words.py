#!/usr/bin/env python3
"""Checks the project's text against the words of its glossary (app/guide/pages/glossary.md).

   words.py SOURCE_DIR [--count]

Fails if a document, a comment or a string uses a banned word, or if the sentences of a document have 20 words or more on average.
Checks the files that words.list names; a line "allow" there is an exception with its reason. --count prints the number of banned
words per folder, for all files, and never fails."""
import collections
import fnmatch
import pathlib
import re
import shutil
import subprocess
import sys

WORDS_MAX = 20     # average words of a sentence, exclusive
ALLOWED_MAX = 40   # lines of exceptions
# Banned words, and the words of the glossary.
BANNED = [
    (r"told|untold", "reported, printed, logged, detected"),
    (r"tells?|telling", "report, print, return, log, distinguish"),
    (r"anew", "again; restart"),
    (r"mend(?:s|ed|ing)?", "fix, repair"),
    (r"foretells?|foretold|foretelling", "predict"),
    (r"whoever|whomever|whosoever", "the caller, a client, another thread"),
    (r"nobody|somebody", "no caller, another program"),
    (r"to the (?:last )?bit", "bit-identical"),
    (r"(?:goes|go|went|gone) on", "continue"),
    (r"be had", "available"),
    (r"of (?:his|her) own", "its own"),
    (r"in place of", "instead of"),
    (r"put(?:s|ting)? right", "repair, correct"),
    (r"left away|leaves? \w+ away", "omit, remove"),
    (r"is to be seen|are to be seen", "is visible"),
    (r"wound alike", "consistently oriented"),
    (r"no more than that", "only that"),
    (r"by heart", "in memory"),
    (r"so many|so much", "N"),
    (r"stands? (?:in|by|beside|for itself)", "is in, is next to"),
    (r"beforehand", "before, in advance"),
    (r"thereof|whereof|thereby|therein", "of it, by it, in it"),
]
PATTERN = re.compile("|".join(rf"(?P<b{i}>\b(?:{word})\b)" for i, (word, _) in enumerate(BANNED)), re.IGNORECASE)
CODE = (".h", ".cpp", ".c", ".inc")
HASH = (".sh", ".py", ".cmake", ".yaml", ".yml", ".list", ".rules", ".awk", "CMakeLists.txt")
TOKEN = re.compile(r'R"([^ ()\\\n]*)\((?:.|\n)*?\)\1"|//[^\n]*|/\*(?:.|\n)*?\*/|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'')


def tracked(source):
    """Returns the files of the project: those in git, or all files if the folder is no clone or there is no git."""
    if shutil.which("git"):
        listed = subprocess.run(["git", "-C", source, "ls-files"], capture_output=True, text=True)
        if listed.returncode == 0 and listed.stdout:
            return listed.stdout.split("\n")[:-1]
    return [str(file.relative_to(source)) for file in pathlib.Path(source).rglob("*")
            if file.is_file() and not str(file.relative_to(source)).startswith(("build", ".git/"))]


def blank(text):
    """Returns the line ends of a text only, so that line numbers do not change."""
    return "\n" * text.count("\n")


def prose(name, text):
    """Returns the readable text of a file, on its original lines: comments and strings of a source, a document without code."""
    if name.endswith(".md"):
        text = re.sub(r"^( *)```.*?^ *```", lambda m: blank(m[0]), text, flags=re.MULTILINE | re.DOTALL)
        return re.sub(r"`[^`\n]*`", "CODE", text)
    if name.endswith(CODE):
        found, at = [], 0
        for token in TOKEN.finditer(text):
            found.append(blank(text[at:token.start()]))
            found.append(re.sub(r"`[^`\n]*`", "CODE", token[0]) if token[0][0] in "/\"R" else "")
            at = token.end()
        return "".join(found) + blank(text[at:])
    if name.endswith(HASH):
        return re.sub(r"`[^`\n]*`", "CODE", text) if name.endswith((".py", ".list")) else \
            "\n".join(re.sub(r"`[^`]*`", "CODE", m[0]) if (m := re.search(r"(?:^|\s)#.*|\"[^\"]*\"", line)) else ""
                      for line in text.split("\n"))
    return None


def sentence_words(text):
    """Returns the words of each sentence of a document: paragraphs and items of lists, no tables, headings and code."""
    counts, paragraph = [], []

    def end():
        for sentence in re.split(r"(?<=[.!?:;])\s+", " ".join(paragraph)):
            words = re.findall(r"[A-Za-z0-9][\w'./%-]*", re.sub(r"\]\([^)]*\)", "]", sentence))
            if len(words) > 2:
                counts.append(len(words))
        paragraph.clear()

    for line in text.split("\n"):
        if re.match(r"\s*([|#<>!]|$|    )", line):
            end()
        else:
            if re.match(r"\s*([-*]|\d+\.)\s", line):
                end()
            paragraph.append(line.strip())
    end()
    return counts


def read_list(source):
    """Returns the patterns of the files that are checked, and the exceptions as (file pattern, word, reason)."""
    checked, allowed = [], []
    for number, line in enumerate((source / "tests/arch/words.list").read_text().split("\n"), 1):
        if not line or line.startswith("#"):
            continue
        fields = [field.strip() for field in line.split("|")]
        if fields[0] == "allow" and len(fields) == 4 and all(fields):
            allowed.append((fields[1], fields[2].lower(), number))
        elif len(fields) == 1:
            checked.append(fields[0])
        else:
            sys.exit(f"tests/arch/words.list:{number}: expected a pattern or 'allow | FILE | WORD | REASON'")
    if len(allowed) > ALLOWED_MAX:
        sys.exit(f"tests/arch/words.list: {len(allowed)} exceptions; at most {ALLOWED_MAX}: rewrite the sentences")
    return checked, allowed


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    count = "--count" in sys.argv[2:]
    checked, allowed = ([], []) if count else read_list(source)
    used, matched, bad, folders = set(), set(), 0, collections.Counter()
    for name in tracked(source):
        patterns = [pattern for pattern in checked if fnmatch.fnmatch(name, pattern)]
        if not count and not patterns or not (source / name).is_file():
            continue
        if name.startswith("tests/arch/words"):  # the list of the banned words itself
            continue
        matched.update(patterns)
        try:
            text = prose(name, (source / name).read_text())
        except UnicodeDecodeError:
            continue
        if text is None:
            continue
        for number, line in enumerate(text.split("\n"), 1):
            for found in PATTERN.finditer(line):
                exception = next((a for a in allowed if fnmatch.fnmatch(name, a[0]) and a[1] == found[0].lower()), None)
                if exception:
                    used.add(exception)
                    continue
                folders[str(pathlib.PurePath(name).parent)] += 1
                if not count:
                    bad += 1
                    print(f"{name}:{number}: '{found[0]}': write {BANNED[int(found.lastgroup[1:])][1]}")
        if name.endswith(".md") and not count:
            sentences = sentence_words(text)
            if sentences and sum(sentences) >= WORDS_MAX * len(sentences):
                bad += 1
                print(f"{name}: {sum(sentences) / len(sentences):.1f} words a sentence; write shorter ones (below {WORDS_MAX})")
    if count:
        for folder, number in sorted(folders.items()):
            print(f"{number:6} {folder}")
        print(f"{sum(folders.values()):6} in all")
        return
    for exception in allowed:
        if exception not in used:
            bad += 1
            print(f"tests/arch/words.list:{exception[2]}: the exception is unused; remove it")
    for pattern in checked:
        if pattern not in matched:
            bad += 1
            print(f"tests/arch/words.list: no file matches {pattern}")
    if bad:
        sys.exit(1)
    print(f"{len(matched)} patterns of files pass; {len(allowed)} exceptions.")


if __name__ == "__main__":
    main()
