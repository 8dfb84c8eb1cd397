"""Checks the JSON Schemas of the program: check_schema.py PROGRAM REPOSITORY

Every TOML file that the repository ships, and every template that the program writes, is valid. Every key of a schema
occurs in one of these files or in those of tests/data/keys, which the program accepts. Files with wrong keys are
invalid."""
import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)

PROGRAM, REPOSITORY = sys.argv[1], Path(sys.argv[2])
KINDS = ["study", "mechanism", "motion", "task", "motors"]
# Files that are wrong on purpose, or no files of pkmopt.
OTHERS = {"pyproject.toml"}
failures = []


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], stdout=subprocess.PIPE, text=True, check=True).stdout


def kind_of(document):
    if "platform" in document:
        return "mechanism"
    if "mechanism" in document or "stage" in document:
        return "study"
    if "task" in document:
        return "task"
    if "motor" in document:
        return "motors"
    # a catalogue has one list of tables, whose keys are free
    return "catalogue" if len(document) == 1 and isinstance(next(iter(document.values())), list) else "motion"


VALIDATORS = {}
for kind in KINDS:
    schema = json.loads(run("schema", kind))
    jsonschema.Draft7Validator.check_schema(schema)
    VALIDATORS[kind] = jsonschema.Draft7Validator(schema)


def deepest(error):
    """The most specific of the errors in alternatives."""
    while error.context:
        error = max(error.context, key=lambda each: (len(each.absolute_path), each.validator not in ("const", "enum")))
    return error


def errors_of(kind, text):
    return [f"{'.'.join(map(str, deepest(e).absolute_path))}: {deepest(e).message[:200]}"
            for e in VALIDATORS[kind].iter_errors(tomllib.loads(text))]


# Keys that occur, as paths of properties without indices of lists.
used = {kind: set() for kind in KINDS}


def collect(schema, value, path, kind):
    """Adds the keys of a valid value that the schema describes."""
    for alternative in schema.get("anyOf", []) + schema.get("oneOf", []):
        if jsonschema.Draft7Validator(alternative).is_valid(value):
            collect(alternative, value, path, kind)
    if isinstance(value, list):
        for element in value:
            collect(schema.get("items", {}), element, path, kind)
    if isinstance(value, dict):
        for key, inner in value.items():
            known = schema.get("properties", {}).get(key)
            if known is not None:
                used[kind].add((*path, key))
                collect(known, inner, (*path, key), kind)
            elif isinstance(schema.get("additionalProperties"), dict):
                collect(schema["additionalProperties"], inner, (*path, "NAME"), kind)


def keys_of(schema, path):
    """All keys of a schema, as paths."""
    for alternative in schema.get("anyOf", []) + schema.get("oneOf", []):
        yield from keys_of(alternative, path)
    if "items" in schema:
        yield from keys_of(schema["items"], path)
    for key, inner in schema.get("properties", {}).items():
        if inner.get("not") == {}:  # an old name
            continue
        yield (*path, key)
        yield from keys_of(inner, (*path, key))
    if isinstance(schema.get("additionalProperties"), dict):
        yield from keys_of(schema["additionalProperties"], (*path, "NAME"))


def check(name, text):
    kind = kind_of(tomllib.loads(text))
    if kind == "catalogue":
        return
    found = errors_of(kind, text)
    failures.extend(f"{name} ({kind}): {error}" for error in found)
    if not found:
        collect(VALIDATORS[kind].schema, tomllib.loads(text), (), kind)


folders = ["experiments", "engine/config/mechanisms", "tests/data", "tests/browser/studies"]
files = sorted(file for folder in folders for file in (REPOSITORY / folder).rglob("*.toml") if file.name not in OTHERS)
assert len(files) > 50, files
for file in files:
    check(file.relative_to(REPOSITORY), file.read_text())
mechanisms = [entry["name"] for entry in json.loads(run("list", "mechanisms", "--json"))["mechanisms"]]
for name in mechanisms:
    check(f"pkmopt list {name} --file", run("list", name, "--file"))
    check(f"pkmopt new study {name}", run("new", "study", name))
with tempfile.TemporaryDirectory() as folder:
    template = Path(folder) / "robot.toml"
    run("new", "mechanism", "robot", "-o", str(template))
    check("pkmopt new mechanism", template.read_text())
    check("pkmopt new study", run("new", "study", str(template)))

# The program accepts the files that exist for this test only.
samples = REPOSITORY / "tests/data/keys"
for file in sorted(samples.glob("*.toml")):
    kind, first_line = kind_of(tomllib.loads(file.read_text())), file.read_text().partition("\n")[0]
    if kind == "catalogue":
        continue
    command = ["check", file]
    if kind == "motion":  # "# A motion of MECHANISM.toml .."
        command = ["trajectory", samples / next(w for w in first_line.split() if w.endswith(".toml")), "--motion", file]
    done = subprocess.run([PROGRAM, *command], capture_output=True, text=True)
    if done.returncode not in (0, 1):  # 1: poses of the motion are not feasible
        failures.append(f"{file.name}: {done.stderr}")

# The options of the catalogues have tests of their own.
CATALOGUES = {"objective", "constraint", "output", "stage"}
OF_STUDIES = {"region", "motion", "workspace", "motor", "drive_train"}  # the same tables as in studies
for kind in KINDS:
    for path in sorted(set(keys_of(VALIDATORS[kind].schema, ())) - used[kind]):
        if path[0] not in CATALOGUES and not (kind == "task" and path[0] in OF_STUDIES):
            failures.append(f"no file uses the key {'.'.join(path)} of {kind}")

STUDY = """[mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.15, max = 0.3 }
[workspace]
method = "voxels"
[[objective]]
type = "workspace-volume"
[[constraint]]
type = "conditioning"
min = 0.1
[[constraint]]
type = "my-own-test"
[[stage]]
optimiser = "ga"
"""
ROBOT = (REPOSITORY / "experiments/mechanisms/rotary-delta.toml").read_text()
WRONG = [
    (STUDY, '"4ppa-2par"', '"4ppa-2pra"'), (STUDY, "[variables]", "[varables]"), (STUDY, "max = 0.3", "maximum = 0.3"),
    (STUDY, "a = {", "a = 1 #"), (STUDY, 'method = "voxels"', 'method = "voxel"'),
    (STUDY, "[workspace]", "[workspace]\ncels = { x = 3 }"), (STUDY, "[workspace]", '[workspace]\nmethd = "columns"'),
    (STUDY, "[workspace]", "[workspace]\ntolerance = 1"), (STUDY, "[workspace]", "[workspace]\ntolerance = true"),
    (STUDY, "[workspace]", "[workspace]\ncells = { x = 0 }"), (STUDY, "[workspace]", "[workspace]\ncertain = []"),
    (STUDY, "[[objective]]", "[[objectives]]"), (STUDY, '"workspace-volume"', '"workspace-volum"'),
    (STUDY, '"workspace-volume"', '"workspace-volume"\ndirecton = "minimise"'),
    (STUDY, '"workspace-volume"', '"workspace-volume"\nmin = 3'), (STUDY, "min = 0.1", "least = 0.1"),
    (STUDY, '"my-own-test"', '"my-own-test"\nmin = 1'), (STUDY, 'optimiser = "ga"', 'optimiser = "ga"\npoplation = 3'),
    (STUDY, 'optimiser = "ga"', 'optimiser = "ga"\npopulation = "many"'), (STUDY, 'optimiser = "ga"', 'optimizer = "ga"'),
    (STUDY, '[[stage]]\noptimiser = "ga"', ""), (STUDY, "[[stage]]", "[[report]]\ntype = \"conditioning\"\n[[stage]]"),
    (ROBOT, "[platform]", "[platfrom]"), (ROBOT, "[[limb]]", "[[limb]]\ncrnk = 1"),
    (ROBOT, "[[limb]]", "[[limb]]\nslider_mass = 1"), (ROBOT, 'drive = "crank"', 'drive = "crnk"'),
    (ROBOT, "[survey]", "[survey]\nhold = { x = 0 }"), (ROBOT, 'about = "z"', 'about = "w"'),
]
for text, before, after in WRONG:
    before = before if before in text else before.replace(" = ", "    = ")  # as aligned in the file
    kind = kind_of(tomllib.loads(text))
    if errors_of(kind, text):
        failures.append(f"before {after!r}: {errors_of(kind, text)}")
    elif before not in text:
        failures.append(f"{before!r} is not in the text")
    elif not errors_of(kind, text.replace(before, after, 1)):
        failures.append(f"a file with {after!r} is valid")

print("\n".join(failures) or f"{len(files)} files are valid, {len(WRONG)} wrong ones are not")
sys.exit(1 if failures else 0)
