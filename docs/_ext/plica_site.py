"""Sphinx extension that makes a site of pages written for code hosts, by markers in comments.

- <!-- site: contents -->: a table of contents of the pages that list items and rows of tables link to.
- <!-- site: python NAME... -->: the reference of these names, from their docstrings.
- <!-- site: output --> above a picture: a notebook's saved output, left out where notebooks are run.
- <!-- site: bibliography -->: all of references.bib; a link to references.bib#KEY leads to its entry.
- A link to a file outside docs/ leads to a page that shows this file.
"""
import inspect
import re
from pathlib import Path

from docutils import nodes
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound
from sphinx.util import logging

log = logging.getLogger(__name__)
CODE = re.compile(r"(^```.*?^```$|(?<!`)(`+)(?!`)(?:(?!\n\n).)+?(?<!`)\2(?!`))", re.M | re.S)
LINK = re.compile(r"\]\(([^)\s]+)\)")
NAMED_LINK = re.compile(r"\[([\w./-]+\.md)\]\(([^)\s#:]+\.md)\)")  # text = file name
OUTPUT = re.compile(r"^<!-- site: output -->\n(!\[[^\]]*\]\([^)]*\)\n)", re.M)
MARK = re.compile(r"^<!-- site: (\w+) ?(.*?) -->$", re.M)


def outside_code(change, text):
    """Return the text with a change made outside code."""
    parts, end = [], 0
    for code in CODE.finditer(text):
        parts += [change(text[end:code.start()]), code.group()]
        end = code.end()
    return "".join(parts) + change(text[end:])


def rewrite_link(app, page, target):
    """Return the target of a page's link on the site."""
    if re.match(r"[a-z]+:", target) or target.startswith("#"):
        return target
    name, mark, anchor = target.partition("#")
    path = (page.parent / name).resolve()
    docs, root = Path(app.srcdir), Path(app.srcdir).parent
    if path == docs / "references.bib":
        return f"bib:{anchor}" if anchor else target
    if path.suffix == ".md" and in_docs(app, page, name):
        return target
    if path.is_dir() and docs in path.parents and (path / "README.md").is_file():
        return f"{name.rstrip('/')}/README.md{mark}{anchor}"
    if path.is_dir() or docs not in path.parents or path.suffix in (".py", ""):
        return f"source:{path.relative_to(root).as_posix()}"
    return target


def in_docs(app, page, name):
    return Path(app.srcdir) in (page.parent / name).resolve().parents


def contents(page_text):
    """Return a hidden table of contents of the first link of each list item and row."""
    found = []
    for line in page_text.splitlines():
        links = [target.split("#")[0] for target in LINK.findall(line) if re.search(r"\.md(#|$)", target)]
        if links and line.lstrip().startswith(("|", "-", "*")) and not re.match(r"[a-z]+:|\.\./\.\.", links[0]):
            found.append(links[0])
    entries = "\n".join(dict.fromkeys(found))
    return f"```{{toctree}}\n:hidden:\n:maxdepth: 1\n\n{entries}\n```"


def python_reference(names):
    import plica
    text = ""
    for name in names.split():
        thing = getattr(plica, name)
        if inspect.isclass(thing):
            # Of a named tuple: its docstring has them. An inherited `shape` would be a second target of types such as "shape (n,)".
            fields = ", ".join(getattr(thing, "_fields", () if "shape" in vars(thing) else ("shape",)))
            ours = any(base.__module__.startswith("plica") for base in thing.__bases__) and not issubclass(thing, Exception)
            inherited = "   :inherited-members:\n" if ours else ""
            text += f".. autoclass:: plica.{name}\n   :members:\n{inherited}   :exclude-members: {fields}\n\n"
        else:
            text += f".. autofunction:: plica.{name}\n\n"
    return f"````{{eval-rst}}\n{text}````"


def read(app, docname, source):
    page = Path(app.env.doc2path(docname))
    if page.suffix != ".md":
        return
    whole = OUTPUT.sub("" if app.config.nb_execution_mode != "off" else r"\1", source[0])

    def change(text):
        # Without a text of its own, a link to a page has the page's title.
        text = NAMED_LINK.sub(lambda found: f"[]({found[2]})" if in_docs(app, page, found[2]) else found[0], text)
        return LINK.sub(lambda found: f"]({rewrite_link(app, page, found[1])})", text)

    def mark(found):
        kind, rest = found.groups()
        if kind == "contents":
            return contents(outside_code(change, whole))
        if kind == "python":
            return python_reference(rest)
        if kind == "bibliography":
            return "```{bibliography}\n:all:\n```"
        log.warning("unknown mark <!-- site: %s -->", kind, location=docname)
        return found.group()

    source[0] = MARK.sub(mark, outside_code(change, whole))
    if page.parent.name == "notebooks" and "\n  language:" not in whole:  # colours of code, where notebooks are not run
        source[0] = source[0].replace("\nkernelspec:\n", "\nkernelspec:\n  language: python\n", 1)


def resolve(app, doctree, docname):
    """Resolve links to sources and to entries of the bibliography."""
    for link in doctree.findall(nodes.reference):
        kind, _, target = link.get("refuri", "").partition(":")
        if kind == "source":
            if not (Path(app.srcdir).parent / target).exists():
                log.warning("there is no %s", target, location=link)
                continue
            app.plica_sources.add(target)
            link["refuri"] = app.builder.get_relative_uri(docname, f"source/{target}")
        elif kind == "bib":
            if target not in app.plica_keys:
                log.warning("references.bib has no entry %s", target, location=link)
            link["refuri"] = app.builder.get_relative_uri(docname, "reference/references") + f"#cite-{target}"


def shown(path, text):
    try:
        lexer = get_lexer_for_filename(path.name)
    except ClassNotFound:
        lexer = get_lexer_for_filename("x.sh") if text.startswith("#!/bin/bash") else TextLexer()
    return f'<div class="highlight">{highlight(text, lexer, HtmlFormatter(wrapcode=True))}</div>'


def source_pages(app):
    root = Path(app.srcdir).parent
    for target in sorted(app.plica_sources):
        path = root / target
        if path.is_dir():
            names = sorted(one.name + "/" * one.is_dir() for one in path.iterdir() if one.name != "__pycache__")
            body = f"<ul>{''.join(f'<li><code>{name}</code></li>' for name in names)}</ul>"
        else:
            body = shown(path, path.read_text(encoding="utf-8"))
        yield f"source/{target}", {"title": target, "body": f"<h1><code>{target}</code></h1>{body}"}, "page.html"


def begin(app):
    app.plica_sources = set()
    text = (Path(app.srcdir) / "references.bib").read_text(encoding="utf-8")
    app.plica_keys = set(re.findall(r"^@\w+\{([^,]+),", text, re.M))


def setup(app):
    app.connect("builder-inited", begin)
    app.connect("source-read", read)
    app.connect("doctree-resolved", resolve)
    app.connect("html-collect-pages", source_pages)
    return {"parallel_read_safe": True, "parallel_write_safe": False}
