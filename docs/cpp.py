#!/usr/bin/env python3
"""Writes the pages of the C++ library: cpp.py REPOSITORY DOCS XML, where XML is Doxygen's output for the headers.
cpp.py --headers prints the names of the headers.

A page contains the first comment of each header, and Breathe directives for the declarations of the header."""
import sys
from pathlib import Path
from xml.etree import ElementTree

# Public headers of the library by page, in the order of the documentation.
HEADERS = {
    "The command line as a library": ["experiments/app/program.hpp"],
    "A mechanism": ["engine/mechanism/mechanism.hpp", "engine/mechanism/mechanism_list.hpp",
                    "engine/core/parameter.hpp", "engine/core/unsupported.hpp", "engine/geometry/pose.hpp"],
    "Capabilities of a mechanism": [
        "engine/mechanism/abilities/kinematics.hpp", "engine/mechanism/abilities/design.hpp",
        "engine/mechanism/abilities/columns.hpp", "engine/mechanism/abilities/dynamics.hpp",
        "engine/mechanism/abilities/bounds.hpp", "engine/dynamics/drive_train.hpp",
        "engine/geometry/influence.hpp", "engine/geometry/placed_link.hpp",
        "engine/dynamics/pose_dynamics.hpp", "engine/dynamics/reactions.hpp", "engine/motion/motion.hpp",
        "engine/mechanism/pose_quantity.hpp"],
    "Workspace analysis": ["engine/mechanism/plan.hpp", "engine/mechanism/workspace_result.hpp",
                           "engine/mechanism/workspace_evaluator.hpp"],
    "A design problem": ["engine/problem/problem.hpp", "engine/problem/evaluation.hpp",
                         "engine/problem/evaluator.hpp", "engine/problem/design_problem.hpp",
                         "engine/problem/quantity.hpp"],
    "Optimisers and options": ["engine/optimisers/optimiser.hpp", "engine/core/options.hpp"],
    "Studies": ["engine/config/study.hpp", "engine/config/study_changes.hpp", "engine/config/mechanism_file.hpp",
                "engine/core/error.hpp"],
}


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
    index = ("# The C++ library\n\nThe public headers, with the paths to use in `#include`. "
             "[A mechanism in C++](../../tutorials/own-mechanism.md#in-c) shows a complete program.\n\n")
    toc = []
    for title, group in HEADERS.items():
        name = title.lower().replace(" ", "-")
        toc.append(f"{title} <{name}>")
        text = f"# {title}\n\n"
        for header in group:
            text += f"## {header}\n\n" + markdown_of(first_comment(repository / header))
            text += "".join(declared_in(header, xml))
        (docs / f"{name}.md").write_text(text)
    (docs / "index.md").write_text(index + "```{toctree}\n:maxdepth: 2\n\n" + "\n".join(toc) + "\n```\n")


def main():
    if sys.argv[1:] == ["--headers"]:
        print(*(header for group in HEADERS.values() for header in group))
        return
    repository, docs, xml = map(Path, sys.argv[1:])
    pages = docs / "reference" / "cpp"
    pages.mkdir(exist_ok=True)
    write_pages(repository, pages, xml)


if __name__ == "__main__":
    main()
