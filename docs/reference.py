#!/usr/bin/env python3
"""Generates reference pages with the program: reference.py PROGRAM REPOSITORY DOCS

Catalogues are generated from `pkmopt list --json`, commands from `--help`, JSON keys from the output of commands, and
the contents of a study file from a study that is run here. The report of this study is the example on the site."""
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
    if value is None or value == [] or value == "":
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.10g}"
    if isinstance(value, list):
        return ", ".join(f"`{v}`" for v in value)
    return str(value).replace("|", "\\|")


def table(head, rows):
    """A Markdown table without its empty columns."""
    shown = [i for i in range(len(head)) if any(cell(row[i]) for row in rows)]
    lines = ["| " + " | ".join(head[i] for i in shown) + " |", "|" + "---|" * len(shown)]
    lines += ["| " + " | ".join(cell(row[i]) for i in shown) + " |" for row in rows]
    return "\n".join(lines) + "\n\n"


def value_range(entry):
    low, high = entry["min"], entry["max"]
    if low is None and high is None:
        return ""
    if high is None:
        return f"from {cell(low)}"
    return f"up to {cell(high)}" if low is None else f"{cell(low)} .. {cell(high)}"


def unit(entry):
    return None if entry["unit"] in (None, "1") else entry["unit"]


def sentence(text):
    return text[0].upper() + text[1:] + "."


def parameters(entries):
    return table(["name", "unit", "default", "range", "meaning"],
                 [[f"`{e['name']}`", unit(e), e["default"], value_range(e), e["meaning"]] for e in entries])


def options(entries):
    def default(entry):
        return "required" if entry["required"] else entry["default"]
    return table(["key", "kind", "unit", "default", "range", "choices", "meaning"],
                 [[f"`{e['name']}`", e["kind"], unit(e), default(e), value_range(e), e["choices"], e["meaning"]]
                  for e in entries])


def mechanism_page(entry):
    text = f"# {entry['name']}\n\n{sentence(entry['meaning'])}\n\nSource: {entry['source']}.\n\n"
    names = {"coordinates": "pose", "joints": "joints", "modes": "working modes; the first is the default",
             "branches": "assembly branches", "swept": "swept coordinates", "fixed": "fixed coordinates",
             "columns_along": "direction of columns", "volume_unit": "unit of the volume",
             "integrated_unit": "unit of the volume integrated over the fixed coordinates",
             "size": "size, for workspace-ratio",
             "size_unit": "unit of the size", "characteristic_length": "characteristic length of the conditioning",
             "mass_models": "mass models", "masses": "default mass model",
             "objectives": "supported objectives", "constraints": "supported constraints"}
    text += table(["property", "value"], [[title, entry[key]] for key, title in names.items() if cell(entry[key])])
    if entry["other_sweeps"]:
        text += "## Other sweeps\n\n" + table(["fixed", "swept", "direction of columns", "unit of the volume"], [
            [s["fixed"], s["swept"], s["columns_along"], s["volume_unit"]] for s in entry["other_sweeps"]])
    text += "## Parameters\n\n" + parameters(entry["parameters"])
    for model, besides in entry.get("parameters_besides", {}).items():
        text += f"## Parameters of {model.replace(' = ', ' ')}\n\n" + parameters(besides)
    if entry["limits"]:
        text += "## Limits of poses\n\n" + table(
            ["name", "unit", "inactive", "range", "constraint", "derivation", "meaning"],
            [[f"`{e['name']}`", unit(e), e["inactive"], value_range(e), f"`{e['constraint']}`", e["derivation"],
              e["meaning"]] for e in entry["limits"]])
    if entry["inputs"]:
        text += "## Inputs\n\n" + table(["name", "unit", "default", "meaning"], [
            [f"`{e['name']}`", unit(e), e["default"], e["meaning"]] for e in entry["inputs"]])
    if entry["quantities"]:
        text += "## Quantities\n\n" + table(["name", "unit", "depends on", "meaning"], [
            [f"`{e['name']}`", unit(e), e["depends_on"], e["meaning"]] for e in entry["quantities"]])
    if entry["design_tests"]:
        text += "## Constraints of the design\n\n" + table(
            ["constraint", "unit", "meaning"],
            [[f"`{e['name']}`", unit(e), e["meaning"]] for e in entry["design_tests"]])
    own = {e["name"] for e in entry["parameters"]}
    text += "## Names in formulas besides the parameters\n\n" + table(
        ["name", "unit", "available", "meaning"],
        [[f"`{e['name']}`", unit(e), e["known"], e["meaning"]]
         for e in entry["expression_names"] if e["name"] not in own])
    return text


def support(entry):
    if all(m["serves"] for m in entry["mechanisms"]):
        return "Supported by all built-in mechanisms.\n\n"
    able = [m["name"] for m in entry["mechanisms"] if m["serves"]]
    return f"Supported by the built-in mechanisms {cell(able)}.\n\n"


def objectives_page(entries):
    text = ("# Objectives\n\nThe `type` of an `[[objective]]`, a `[[output]]`, or, with `min` or `max`, a "
            "`[[constraint]]`. Options are keys of the same table.\n\n")
    for e in entries:
        text += f"## {e['name']}\n\n{sentence(e['meaning'])}\n\n"
        text += f"Default direction: {e['direction']}. "
        text += support(e) + (options(e["options"]) if e["options"] else "")
    return text


def constraints_page(entries):
    text = ("# Constraints\n\nThe `type` of a `[[constraint]]`. Constraints of poses restrict the workspace. "
            "Constraints of the design have a margin, which is non-negative if they are satisfied. With `min` or "
            "`max`, every [objective](objectives.md) can also be a constraint.\n\n")
    for e in entries:
        text += f"## {e['name']}\n\n{sentence(e['meaning'])}\n\nConstraint of the {e['level']}. " + support(e)
        by_options = {}
        for mechanism, specs in e["options"].items():
            by_options.setdefault(json.dumps(specs), []).append(mechanism)
        for specs, mechanisms in by_options.items():
            if json.loads(specs):
                text += ("For " + ", ".join(f"`{m}`" for m in mechanisms) + ":\n\n" if len(by_options) > 1 else "")
                text += options(json.loads(specs))
    return text


def optimisers_page(entries):
    text = ("# Optimisers\n\nThe `optimiser` of a `[[stage]]`. Options are keys of the same table. Stages run one "
            "after the other; each one can start from the results of the previous ones.\n\n")
    for e in entries:
        c = e["capabilities"]
        max_objectives = c["max_objectives"]
        objectives = ("one objective" if max_objectives == 1 else "any number of objectives" if max_objectives is None
                      else f"{c['min_objectives']} to {max_objectives} objectives")
        supported = [objectives, "constraints" if c["constraints"] else "no constraints",
                 "variables with a step" if c["discrete"] else "no variables with a step"]
        if c["needs_gradient"]:
            supported.append("requires gradients")
        text += f"## {e['name']}\n\n{sentence(e['meaning'])}\n\nSupports: {', '.join(supported)}.\n\n"
        text += options(e["options"])
    return text


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


def json_page(run):
    text = ("# JSON\n\nWith `--json` a command prints one JSON object. Numbers have full precision, matrices are lists "
            "of rows, and `null` means that a value does not exist. `[]` in a key stands for all elements of a list. "
            "The tables below are generated from the output of the commands.\n\n")
    for line in JSON:
        answer = json.loads(run(*line.split(), "--json"))
        title = " ".join(word for word in line.split()[:2] if word.isalpha())
        text += f"## {title}\n\n" + fenced(f"pkmopt {line} --json", "sh")
        text += table(["key", "example"], [[f"`{key}`", f"`{example}`"] for key, example in keys_of(answer)])
    return text


def schema_page(study):
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
    return ("# Contents of a study file\n\nThe groups and datasets in the study file of "
            "`experiments/4ppa-2par/wide-bounds-20-by-2.toml`, with the descriptions that the file contains. "
            "[The study file](study-file.md) explains how to read it.\n\n## Groups\n\n" +
            table(["group", "attributes", "meaning"], groups) + "## Datasets\n\n" +
            table(["dataset", "size in this file", "unit", "meaning"], rows))


def main():
    program, repository, docs = (Path(argument).resolve() for argument in sys.argv[1:])

    def run(*arguments):
        done = subprocess.run([program, *arguments], cwd=repository, stdout=subprocess.PIPE, text=True)
        if done.returncode != 0:
            sys.exit(f"{program} {' '.join(arguments)} ends with code {done.returncode}")
        return done.stdout

    reference = docs / "reference"
    (reference / "catalogue").mkdir(exist_ok=True)

    catalogue = json.loads(run("list", "--json"))
    pages = {m["name"]: mechanism_page(m) for m in catalogue["mechanisms"]}
    pages["objectives"] = objectives_page(catalogue["objectives"])
    pages["constraints"] = constraints_page(catalogue["constraints"])
    pages["optimisers"] = optimisers_page(catalogue["optimisers"])
    index = "# Catalogue\n\nAll names that a study can use, generated from `pkmopt list --json`.\n\n"
    for kind, entries in catalogue.items():
        page = "{}.md" if kind == "mechanisms" else kind + ".md#{}"
        index += f"## {kind.capitalize()}\n\n" + table(
            ["name", "meaning"], [[f"[{e['name']}]({page.format(e['name'])})", e["meaning"]] for e in entries])
    pages["index"] = index + "```{toctree}\n:hidden:\n\n" + "\n".join(pages) + "\n```\n"
    for name, text in pages.items():
        (reference / "catalogue" / f"{name}.md").write_text(text)

    help_text = run("--help")
    table_of_commands = help_text.split("Subcommands:\n")[1].split("\n\n")[0]
    commands = [line.split()[0] for line in table_of_commands.splitlines()]
    text = ("# Commands\n\nAll commands with their options: the output of `pkmopt --help` and "
            "`pkmopt COMMAND --help`.\n\n" + fenced(help_text))
    for command in commands:
        text += f"## {command}\n\n" + fenced(run(command, "--help"))
    (reference / "commands.md").write_text(text)

    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "study.h5"
        run("run", "experiments/4ppa-2par/wide-bounds-20-by-2.toml", "--output", str(study), "--quiet")
        run("report", str(study), "-o", str(docs / "_static" / "report.html"))
        (reference / "schema.md").write_text(schema_page(study))
        (reference / "json.md").write_text(
            json_page(lambda *words: run(*[str(study) if word == "study.h5" else word for word in words])))


if __name__ == "__main__":
    main()
