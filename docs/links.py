#!/usr/bin/env python3
"""Checks links: links.py FOLDER [md]. Prints the broken ones and fails if there are any.

Checks the links between the HTML pages of a website or, with md, the links in the Markdown files of a repository:
files have to exist, and anchors have to be names of headings, by the rules of GitHub."""
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    def __init__(self, file):
        super().__init__()
        self.links, self.anchors = [], {""}
        self.feed(file.read_text())

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.anchors.add(value)
            elif name in ("href", "src") and value:
                self.links.append(value)


class Text:
    """A Markdown file."""

    def __init__(self, file):
        self.links, self.anchors, inside = [], {""}, None
        for line in file.read_text().splitlines():
            fence = re.match(r" *(```+)", line)
            if inside:
                inside = None if line.strip() == inside else inside
            elif fence:
                inside = fence[1]
                self.links += re.findall(r"```\{(?:figure|image)\} (\S+)", line)
            elif heading := re.match(r"#+ (.*)", line):
                self.add_anchor(heading[1])
            else:
                line = re.sub(r"`[^`]*`", "", line)
                self.links += re.findall(r"\]\(<?([^)>\s]+)>?\)|(?:src|href)=\"([^\"]+)\"", line)
        self.links = [link if isinstance(link, str) else link[0] or link[1] for link in self.links]

    def add_anchor(self, heading):
        heading = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        self.anchors.add(name if name not in self.anchors else f"{name}-1")


def main():
    folder = Path(sys.argv[1]).resolve()
    kind, suffix = (Text, "md") if sys.argv[2:] == ["md"] else (Page, "html")
    pages = {file: kind(file) for file in folder.rglob(f"*.{suffix}")
             if not re.match(r"build|packages|\.|_static|tests/docs/wrong", str(file.relative_to(folder)))}
    broken, count = [], 0
    for file, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            count += 1
            target = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            if target.is_dir() and kind is Page:
                target /= "index.html"
            if not target.exists() or (target in pages and unquote(parts.fragment) not in pages[target].anchors):
                broken.append(f"{file.relative_to(folder)}: {link}")
    print(f"{count} links in {len(pages)} pages, {len(broken)} of them broken")
    for line in broken:
        print(" ", line)
    sys.exit(bool(broken) or not pages)


if __name__ == "__main__":
    main()
