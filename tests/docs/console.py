#!/usr/bin/env python3
"""Tests the terminal sessions on pages: console.py [--write] PROGRAM PAGE.md...

Runs the commands that the pages show and compares their output with the pages. With --write it writes the new output
into the pages instead.

A block ```console contains commands after `$ ` and their output, from stdout and stderr. The commands of a page run one
after the other in one temporary folder. In it, `pkmopt` is PROGRAM, `pkmopt-check-proof` is the program beside it,
`python3` and `octave-cli` find the repository's packages pkmopt and the library of the same build, and `experiments`,
`benchmarks` and `tests` are links to those of the repository. A block ```{code-block} with `:caption: NAME`, or any
block below a line `<!-- NAME -->`, is written to the file NAME before the commands that follow it. If NAME is a file of
the repository, such as experiments/4ppa-2par/rails.toml, the block has to be a part of that file instead. A command has
to succeed unless `$ echo $?` follows. It runs on two threads.

The output has to match the page. Whitespace and values that differ from run to run are not compared: times (a number
before ns, us, ms, s, min or h), numbers of threads, shares of time ("59 % on", "0.0 % of the time"), file sizes (kB,
MB), the revision after the version, and the part of a cost estimate about exact values, which is printed only if they
take long. A line `...` matches any number of lines, `...` at the end of a line matches its rest."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
VARIABLE_PARTS = [
    (r", then exact values of the final designs in at most .*", ""),
    (r"\d[\d.]* (ns|us|ms|s|min|h)\b", "TIME"),
    (r"\d+ threads?\b", "THREADS"),
    (r"\d[\d.]* %(?= on | of the time)", "SHARE"),
    (r"\d[\d.]* [kM]B\b", "SIZE"),
    (r"(?<=\d )\([0-9a-f]{12}\S*\)", "(REVISION)"),
    (r"\s+", " "),
]
# Progress messages, which appear only in long runs or on a busy machine.
PROGRESS = re.compile(r"(stage \d+ of \d+: )?\S+ generation \d+, \d+ evaluations, .* left|final step: .*"
                      r"|this run: \d+ evaluations in .*"
                      r"|pkmopt: (measuring the time of an evaluation|evaluating .*|\S+ is computing, Ctrl-C ends it)")


def comparable(line):
    for pattern, replacement in VARIABLE_PARTS:
        line = re.sub(pattern, replacement, line)
    return line.strip()


def matches(shown, printed):
    """Return whether the printed lines match the lines on the page."""
    if not shown:
        return not printed
    if shown[0].strip() == "...":
        return any(matches(shown[1:], printed[i:]) for i in range(len(printed) + 1))
    if not printed:
        return False
    a, b = comparable(shown[0]), comparable(printed[0])
    equal = b.startswith(a[:-3].rstrip()) if a.endswith("...") else a == b
    return equal and matches(shown[1:], printed[1:])


def blocks_of(lines):
    """Generate (begin, end, language, caption) of each fenced block; begin and end exclude the fences and options."""
    begin = None
    for number, line in enumerate(lines):
        if begin is None and line.startswith("```"):
            begin = number + 1
            language = line.strip("`").strip()
        elif begin is not None and line.startswith("```"):
            above = re.fullmatch(r"<!-- (\S+) -->", lines[begin - 2]) if begin > 1 else None
            caption = above[1] if above else None
            while lines[begin].startswith(":") and begin < number:
                if lines[begin].startswith(":caption:"):
                    caption = lines[begin].removeprefix(":caption:").strip()
                begin += 1
            yield begin, number, language, caption
            begin = None


def commands_of(lines):
    """Return a list of (command, output lines), both as lists of lines, of a console block."""
    found = []
    for line in lines:
        if line.startswith("$ "):
            found.append(([line], []))
        elif found and found[-1][0][-1].endswith("\\") and not found[-1][1]:
            found[-1][0].append(line)
        elif found:
            found[-1][1].append(line)
        else:
            sys.exit(f"a console block begins with '{line}'; expected a command after '$ '")
    return found


class Folder:
    """The temporary folder in which the commands of a page run, and the exit code of the last command."""

    def __init__(self, path, program):
        self.path, self.code = path, 0
        for part in ("experiments", "benchmarks", "tests"):
            (path / part).symlink_to(REPOSITORY / part)
        tools = path / ".tools"
        tools.mkdir()
        (tools / "pkmopt").symlink_to(program.resolve())
        checker = "pkmopt-check-proof"
        (tools / checker).symlink_to(program.resolve().with_name(checker))
        self.environment = {**os.environ, "PATH": f"{tools}:/usr/bin:{os.environ['PATH']}", "OMP_NUM_THREADS": "2",
                            "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": str(REPOSITORY / "bindings" / "python"),
                            "PKMOPT_LIBRARY": str(program.resolve().parents[1] / "lib" / "libpkmopt.so.0"),
                            "OCTAVE_PATH": f"{REPOSITORY}/bindings/matlab:{program.resolve().parents[1]}/lib/octave",
                            "OCTAVE_HISTFILE": "/dev/null",
                            **dict.fromkeys(["OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM",
                                             "OMPI_MCA_rmaps_base_oversubscribe"], "1")}

    def run(self, command):
        before = f"(exit {self.code})\n"
        done = subprocess.run(["bash", "-c", before + command], cwd=self.path, env=self.environment, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.code = done.returncode
        return [line for line in done.stdout.splitlines() if not PROGRESS.fullmatch(line)]


def find_faults(page, program, write):
    """Run the commands of a page; return descriptions of failures and differences. With write, update the page."""
    lines, faults, written, copied = page.read_text().splitlines(), [], [], 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = Folder(Path(scratch), program)
        for begin, end, language, caption in blocks_of(lines):
            if caption and "/" in caption and (REPOSITORY / caption).is_file():
                if "\n".join(lines[begin:end]) not in (REPOSITORY / caption).read_text():
                    faults.append(f"{page}:{begin}: the block is not a part of {caption}")
            elif caption:
                (folder.path / caption).write_text("\n".join(lines[begin:end]) + "\n")
            if language != "console":
                continue
            written += lines[copied:begin]
            copied = end
            commands = commands_of(lines[begin:end])
            for number, (command, shown) in enumerate(commands):
                printed = folder.run("\n".join(command).removeprefix("$ "))
                may_fail = number + 1 < len(commands) and commands[number + 1][0] == ["$ echo $?"]
                if folder.code != 0 and not may_fail:
                    faults.append("\n".join([f"{page}:{begin}: {command[0]}", f"  ends with code {folder.code}",
                                             *printed]))
                fits = matches(shown, printed)
                if not fits:
                    faults.append("\n".join([f"{page}:{begin}: {command[0]}", "shown:", *shown, "printed:", *printed]))
                written += [*command, *(shown if fits else printed)]
    if write:
        page.write_text("\n".join(written + lines[copied:]) + "\n")
    return faults


def main():
    arguments = sys.argv[1:]
    write = arguments[0] == "--write"
    program, *pages = map(Path, arguments[write:])
    faults = [fault for page in pages for fault in find_faults(page, program, write)]
    for fault in faults:
        print(fault, end="\n\n")
    sys.exit(bool(faults) and not write)


if __name__ == "__main__":
    main()
