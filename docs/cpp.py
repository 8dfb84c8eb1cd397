#!/usr/bin/env python3
"""Writes the pages of the C++ library: cpp.py REPOSITORY DOCS XML, where XML is Doxygen's output for the headers.
cpp.py --headers prints the names of the headers.

A page contains the first comment of each header, and Breathe directives for the declarations of the header."""
import sys
from pathlib import Path
from xml.etree import ElementTree


def public_headers(repository):
    """The public headers by page, in the order of engine/public_headers.txt."""
    pages = {}
    for line in (repository / "engine/public_headers.txt").read_text().splitlines():
        if line.startswith("["):
            group = pages.setdefault(line.strip("[]"), [])
        elif line.endswith(".hpp"):
            group.append(line)
    return pages


def fenced(code):
    language = "cpp" if code.rstrip().endswith((";", "}")) else "text"  # formulas
    return f"```{language}\n{code}\n```\n\n"


def first_comment(header):
    lines = []
    for line in header.read_text().splitlines():
        if not line.startswith("//"):
            break
        lines.append(line[2:].removeprefix(" "))
    return "\n".join(lines)


def markdown_of(comment):
    """Convert a comment to Markdown: indented lines become blocks of C++ code or formulas."""
    text, code = "", []
    for line in comment.splitlines() + [""]:
        if line.startswith("  "):
            code.append(line[2:])
        else:
            text += ("\n" + fenced("\n".join(code)) if code else "") + line + "\n"
            code = []
    return text.strip() + "\n\n"


def declared_in(header, xml):
    """Breathe directives for the public declarations of a header, in the order of the header."""
    directives = []
    compounds = [ElementTree.parse(file).getroot()[0] for file in sorted(xml.glob("*_1_1*.xml"))]
    for entry in compounds:
        if entry.find("location").get("file") == header and entry.get("prot", "public") == "public":
            name = entry.findtext("compoundname")
            if name.count("::") == 1:
                directives.append((int(entry.find("location").get("line")),
                                   f"doxygen{entry.get('kind')}", name, ":members:\n:undoc-members:\n"))
    for member in ElementTree.parse(xml / "namespacepkm.xml").getroot().iter("memberdef"):
        if member.find("location").get("file") == header:
            kind = {"variable": "doxygenvariable", "function": "doxygenfunction", "enum": "doxygenenum",
                    "typedef": "doxygentypedef"}[member.get("kind")]
            name = "pkm::" + member.findtext("name")
            if kind == "doxygenfunction":
                name += member.findtext("argsstring")
            directives.append((int(member.find("location").get("line")), kind, name, ""))
    return [f"```{{{kind}}} {name}\n{rest}```\n\n" for _, kind, name, rest in sorted(directives)]


def write_pages(repository, docs, xml):
    toc = []
    for title, group in public_headers(repository).items():
        name = title.lower().replace(" ", "-").replace("+", "p")
        toc.append(f"{title} <{name}>")
        text = f"# {title}\n\n"
        for header in group:
            text += f"## {header}\n\n" + markdown_of(first_comment(repository / header))
            text += "".join(declared_in(header, xml))
        (docs / f"{name}.md").write_text(text)
    with open(docs / "index.md", "a") as index:
        index.write("\n```{toctree}\n:maxdepth: 2\n\n" + "\n".join(toc) + "\n```\n")


def main():
    if sys.argv[1:] == ["--headers"]:
        print(*(header for group in public_headers(Path(__file__).parent.parent).values() for header in group))
        return
    repository, docs, xml = map(Path, sys.argv[1:])
    pages = docs / "reference" / "cpp"
    write_pages(repository, pages, xml)


if __name__ == "__main__":
    main()
