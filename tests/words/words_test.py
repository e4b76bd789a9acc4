#!/usr/bin/python3
"""Checks the words of pages, messages, docstrings and comments.

Usage: words_test.py ROOT [FILE...]; with files, only the idioms in these. Looks for
- idioms of tests/words/banned.tsv in Markdown, C++, Python, TypeScript, TOML and HTML (code is skipped, wrapped lines are joined);
- sentences over 35 words on the pages that newcomers read first;
- README over 600 words, and the user's part of the documentation over 60 000. --count prints the table by folder.
Prints one line per breach, with file, line and what to write instead; exit status 1 if there is any.
"""
import io
import re
import sys
import tokenize
from pathlib import Path

MOST_WORDS = {"README.md": 600, "user's part": 60_000}
LONGEST_SENTENCE = 35
FIRST_PAGES = ("README.md", "docs/index.md", "docs/start/", "docs/concepts/", "docs/gallery.md")
FOR_DEVELOPERS = ("docs/developers/", "docs/decisions/", "docs/pictures/")
FOLDERS = ("src", "python", "viewer/src", "scenarios", "docs", "cmake", "packaging", "tools", "bench/data")
SUFFIXES = (".md", ".cpp", ".hpp", ".py", ".ts", ".toml", ".html", ".css", ".sh", ".cmake")

arguments = [one for one in sys.argv[1:] if one != "--count"]
root = Path(arguments[0]).resolve()


def banned():
    rows = (line.split("\t") for line in (root / "tests/words/banned.tsv").read_text(encoding="utf-8").splitlines()
            if line and not line.startswith("#"))
    return [(re.compile(pattern.replace(" ", r"\s+"), re.I), instead) for pattern, instead in rows]


def blank(text):
    """Spaces in place of the text, with its lines kept."""
    return re.sub(r"[^\n]", " ", text)


def prose_of_markdown(text):
    """Without code, comments of HTML, formulas, addresses of links, and the titles in a list of references."""
    for pattern in (r"^```.*?^```$", r"<!--.*?-->", r"(?<!`)(`+)(?!`)(?:(?!\n\n).)+?(?<!`)\1(?!`)",
                    r"\$\$.*?\$\$", r"\$[^$\n]+\$", r"\]\([^)\s]+\)", r"<[a-z/][^>]*>", r"\A---\n.*?\n---\n"):
        text = re.sub(pattern, lambda found: blank(found[0]), text, flags=re.M | re.S)
    return text


TOKEN = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/|\'(?:\\.|[^\'\\\n])\'|#include[^\n]*|[^"\'/R#]+|.', re.S)


def prose_of_cpp(text):
    """Comments and strings, joined where a literal or a comment is continued."""
    text = "".join(found[0] if found[0].startswith(('"', 'R"', "//", "/*")) else blank(found[0]) for found in TOKEN.finditer(text))
    text = re.sub(r'"(\s*)"', lambda found: " " + found[1] + " ", text)  # "one " "literal"
    return re.sub(r"^( *)///?(?=[ \n])", lambda found: blank(found[0]), text, flags=re.M)


def prose_of_python(text):
    lines = [blank(line) for line in text.splitlines(keepends=True)]
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in (tokenize.STRING, tokenize.COMMENT):
            continue
        (first, begin), _ = token.start, token.end
        words = re.sub(r"^#+", lambda found: blank(found[0]), token.string) if token.type == tokenize.COMMENT else token.string
        words = re.sub(r"``.*?``|`[^`\n]+`", lambda found: blank(found[0]), words)
        for offset, part in enumerate(words.splitlines(keepends=True)):
            column = begin if offset == 0 else 0
            row = lines[first - 1 + offset]
            lines[first - 1 + offset] = row[:column] + part + row[column + len(part):]
    return re.sub(r'"(\s*)f?"', lambda found: " " + found[1] + " ", "".join(lines))


def prose(path):
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".md":
        return prose_of_markdown(text)
    if path.suffix in (".cpp", ".hpp", ".ts"):
        return re.sub(r"`[^`\n]*`", lambda found: blank(found[0]), prose_of_cpp(text)) if path.suffix != ".ts" else prose_of_cpp(text)
    if path.suffix == ".py":
        return prose_of_python(text)
    return re.sub(r"^( *)#(?=[ \n])", lambda found: blank(found[0]), text, flags=re.M)


def read():
    """Files whose words are checked."""
    for path in sorted([*root.glob("*.md"), *(root / ".github").rglob("*"), *(path for folder in FOLDERS for path in (root / folder).rglob("*"))]):
        name = path.relative_to(root).as_posix()
        if path.is_file() and path.suffix in SUFFIXES and "node_modules" not in path.parts and not name.startswith("scenarios/data"):
            yield path


def sentences(text):
    """(line, sentence) of Markdown's paragraphs, list items and cells of tables."""
    text = re.sub(r"^```.*?^```$", lambda found: blank(found[0]), text, flags=re.M | re.S)
    text = re.sub(r"(?<!`)(`+)(?!`)(?:(?!\n\n).)+?(?<!`)\1(?!`)", lambda found: "code" + blank(found[0])[4:], text, flags=re.S)
    for pattern in (r"^(:?:::+|```).*?$", r"^:[\w-]+:.*$", r"^#.*$", r"!\[[^\]]*\]"):
        text = re.sub(pattern, lambda found: blank(found[0]), text, flags=re.M)
    text = prose_of_markdown(text)
    begin = 0
    ends = list(re.finditer(r"(?<=[.!?:;])[*_)\"]*\s+(?=[A-Z*_\[(`])|\n\s*\n|\n\s*[-*|\d]|\|", text)) + [None]
    for end in ends:
        piece = text[begin:end.start() if end else len(text)]
        yield text[:begin].count("\n") + 1 + (len(piece) - len(piece.lstrip())  and piece[:len(piece) - len(piece.lstrip())].count("\n")), piece
        begin = end.end() if end else begin


breaches, looked = [], 0
files = [Path(one).resolve() for one in arguments[1:]] or list(read())
rules = banned()
for path in files:
    text = re.sub(r" *\n[ \n]*", lambda found: "\n" * found[0].count("\n"), re.sub(r"[ \t]+", " ", prose(path)))
    looked += 1
    for pattern, instead in rules:
        for found in pattern.finditer(text):
            breaches.append(f"{path.relative_to(root)}:{text[:found.start()].count(chr(10)) + 1}: "
                            f"\"{' '.join(found[0].split())}\"; write: {instead}")
    name = str(path.relative_to(root))
    if path.suffix == ".md" and name.startswith(FIRST_PAGES):
        for line, sentence in sentences(path.read_text(encoding="utf-8")):
            number = len(re.findall(r"[\w'’µ×%.-]*\w[\w'’µ×%.-]*", sentence))
            if number > LONGEST_SENTENCE:
                breaches.append(f"{name}:{line}: a sentence of {number} words, over {LONGEST_SENTENCE}: {' '.join(sentence.split())[:70]}…")

if len(arguments) == 1:
    words = {}
    for path in files:
        name = str(path.relative_to(root))
        if path.suffix == ".md" and (name == "README.md" or name.startswith("docs/")) and not name.startswith(FOR_DEVELOPERS):
            words[name] = len(path.read_text(encoding="utf-8").split())
    words["user's part"] = sum(words.values())
    if "--count" in sys.argv:
        print("\n".join(f"{number:6} {name}" for name, number in words.items()))
    for name, most in MOST_WORDS.items():
        if words.get(name, 0) > most:
            breaches.append(f"{name}: {words[name]} words, over {most}")
    print(f"README {words.get('README.md', 0)} words, user's part {words['user' + chr(39) + 's part']}.")
print(f"Looked at {looked} files for {len(rules)} idioms.")
if not looked or not rules:
    breaches.append("nothing was looked at: is this the root of plica?")
print("\n".join(breaches))
sys.exit(1 if breaches else 0)
