#!/usr/bin/env python3
"""Converts the notebooks of the documentation to pages: notebooks.py DOCS

Writes DOCS/notebooks/NAME.md and its pictures beside each NAME.ipynb, with the stored outputs."""
import base64
import json
import re
import sys
from pathlib import Path


def text_of(lines):
    return lines if isinstance(lines, str) else "".join(lines)


def fenced(text, language):
    fence = "```"
    while fence in text:
        fence += "`"
    return f"{fence}{language}\n{text.rstrip()}\n{fence}\n\n"


def page(path):
    """The text of the page. Writes the pictures."""
    notebook = json.loads(path.read_text())
    text, pictures = "", 0
    for number, cell in enumerate(notebook["cells"]):
        source = text_of(cell["source"])
        if cell["cell_type"] == "markdown":
            text += re.sub(r"\]\(([\w-]+)\.ipynb\)", r"](\1.md)", source) + "\n\n"
            if number == 0:
                text += f"This page is a notebook: {{download}}`{path.name} <{path.name}>`.\n\n"
            continue
        text += fenced(source, "python")
        for output in cell["outputs"]:
            data = output.get("data", {})
            if "image/png" in data:
                pictures += 1
                picture = path.with_name(f"{path.stem}-{pictures}.png")
                picture.write_bytes(base64.b64decode(text_of(data["image/png"])))
                text += f"![output of the cell above]({picture.name})\n\n"
            else:
                text += fenced(text_of(output.get("text") or data["text/plain"]), "text")
    return text


def main():
    for path in sorted((Path(sys.argv[1]) / "notebooks").glob("*.ipynb")):
        path.with_suffix(".md").write_text(page(path))


if __name__ == "__main__":
    main()
