#!/usr/bin/env python3
"""Checks the size of pages: pages.py DOCS. Prints the pages that it finds, and fails if there are any.

A page has its own content: it does not consist of a file that it includes. It explains one idea in at most 1500 words,
except lists: the glossary and those that the program generates."""
import re
import sys
from pathlib import Path

MOST_WORDS = 1500
FEWEST_OWN_WORDS = 40  # of a page that includes a file
LISTS = ("keys.md", "catalogue.md", "glossary.md")


def faults_of(page, name):
    text = page.read_text()
    own = re.sub(r"^(```+).*?^\1$", "", text, flags=re.MULTILINE | re.DOTALL)
    words = len(text.split())
    if "```{include}" in text and len(own.split()) < FEWEST_OWN_WORDS:
        yield f"{name}: consists of an included file"
    if name.name not in LISTS and words > MOST_WORDS:
        yield f"{name}: {words} words, expected at most {MOST_WORDS}"


def main():
    docs = Path(sys.argv[1])
    pages = sorted(docs.rglob("*.md"))
    faults = [fault for page in pages for fault in faults_of(page, page.relative_to(docs))]
    print(f"{len(pages)} pages, {len(faults)} faults", *faults, sep="\n  ")
    sys.exit(bool(faults) or not pages)


if __name__ == "__main__":
    main()
