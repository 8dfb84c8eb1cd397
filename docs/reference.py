#!/usr/bin/env python3
"""Completes reference pages with the program: reference.py PROGRAM REPOSITORY DOCS

Appends the options of all commands to commands.md, the keys of JSON output to json.md, and the contents of a study file,
from a study that is run here, to study-file/layout.md. The report of this study is the example on the site."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

# Commands whose JSON output is documented.
JSON = [
    "list mechanisms 4ppa-2par",
    "list optimisers nlopt",
    "check experiments/4ppa-2par/wide-bounds.toml",
    "evaluate experiments/4ppa-2par/wide-bounds.toml",
    "pose 4ppa-2par --at x=0.25,y=0.85,z=-0.8,theta=30deg",
    "forward 4ppa-2par --joints q1=0.2131,q2=1.3869,q3=0.4154,q4=1.3846",
    "dynamics 3crr-r-cru --at x=0.2,y=0.17,z=0.22,phi=0.3 --acceleration x=5",
    "coupling 3crr-r-cru --cells x=4,y=4,z=4 --phi 0",
    "trajectory experiments/mechanisms/motors/rotary-delta.toml --motion cycle "
    "--motors experiments/mechanisms/motors/motors.toml --joint arm1.A",
    "simulate 3crr-r-cru --at x=0.2,y=0.17,z=0.22,phi=0.3 --forces rho3=8 --duration 10ms --step 1ms",
    "workspace 3crr-r-cru --cells x=8,y=8,z=8",
    "certify experiments/mechanisms/orthoglide.toml --gap 0.2",
    "certify experiments/mechanisms/motors/rotary-delta.toml --motion cycle",
    "tolerances experiments/mechanisms/five-bar.toml --box x=-50mm:50mm,y=300mm:400mm",
    "show study.h5",
]


def cell(value):
    """Text of a value in a table cell."""
    return str(value).replace("|", "\\|")


def table(head, rows):
    """A Markdown table."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(cell(value) for value in row) + " |" for row in rows]
    return "\n".join(lines) + "\n\n"


def fenced(text, language="text"):
    return f"```{language}\n{text.rstrip()}\n```\n\n"


def keys_of(value, path=""):
    """Generate (key, example) for all numbers and strings in a JSON object, of lists for the first element only."""
    if isinstance(value, dict):
        if len(value) > 5 and all(isinstance(inner, float) for inner in value.values()):  # by names of the mechanism
            name, number = next(iter(value.items()))
            yield f"{path}.NAME", f"{name}: {number}"
            return
        for key, inner in value.items():
            yield from keys_of(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list) and value and isinstance(value[0], (dict, list)):
        yield from keys_of(value[0], path + "[]")
    else:
        text = json.dumps(value, ensure_ascii=False)
        yield path, text if len(text) <= 60 else text[:57] + "..."


def json_tables(run):
    text = "\nThe following tables have the keys of some outputs. `[]` in a key stands for all elements of a list.\n\n"
    for line in JSON:
        answer = json.loads(run(*line.split(), "--json"))
        title = " ".join(word for word in line.split()[:2] if word.isalpha())
        text += f"## {title}\n\n" + fenced(f"pkmopt {line} --json", "sh")
        text += table(["key", "example"], [[f"`{key}`", f"`{example}`"] for key, example in keys_of(answer)])
    return text


def contents_of(study):
    rows, groups = [], []

    def words(attribute):
        """List of the strings in an attribute, which is a string or an array of strings."""
        texts = [attribute] if isinstance(attribute, (str, bytes)) else attribute
        return [text.decode() if isinstance(text, bytes) else str(text) for text in texts]

    with h5py.File(study) as file:
        def visit(name, item):
            about = ", ".join(words(item.attrs.get("description", "")))
            if isinstance(item, h5py.Dataset):
                units = dict.fromkeys(words(item.attrs.get("unit", "")))
                rows.append([f"`/{name}`", " x ".join(map(str, item.shape)) or "1", ", ".join(units), about])
            else:
                groups.append([f"`/{name}`", ", ".join(f"`{a}`" for a in item.attrs if a != "description"), about])
        file.visititems(visit)
    return ("\n## An example\n\nThe groups and datasets in the study file of "
            "`experiments/4ppa-2par/wide-bounds-20-by-2.toml`, with the descriptions that the file contains:\n\n" +
            table(["group", "attributes", "meaning"], groups) +
            table(["dataset", "size in this file", "unit", "meaning"], rows))


def main():
    program, repository, docs = (Path(argument).resolve() for argument in sys.argv[1:])

    def run(*arguments):
        done = subprocess.run([program, *arguments], cwd=repository, stdout=subprocess.PIPE, text=True)
        if done.returncode != 0:
            sys.exit(f"{program} {' '.join(arguments)} ends with code {done.returncode}")
        return done.stdout

    def append(page, text):
        with open(docs / "reference" / page, "a") as file:
            file.write(text)

    commands = run("--help").split("Subcommands:\n")[1].split("\n\n")[0].splitlines()
    append("commands.md", "".join(f"\n## {name}\n\n" + fenced(run(name, "--help"))
                                  for name in (line.split()[0] for line in commands)))

    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "study.h5"
        run("run", "experiments/4ppa-2par/wide-bounds-20-by-2.toml", "--output", str(study), "--quiet")
        run("report", str(study), "-o", str(docs / "_static" / "report.html"))
        append("export/report.md", "\n## An example\n\n<a href=\"../../_static/report.html\">A report</a> of the study "
               "`experiments/4ppa-2par/wide-bounds-20-by-2.toml`.\n")
        append("study-file/layout.md", contents_of(study))
        append("json.md", json_tables(lambda *words: run(*[str(study) if word == "study.h5" else word
                                                           for word in words])))


if __name__ == "__main__":
    main()
