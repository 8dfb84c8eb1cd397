#!/usr/bin/env python3
"""Runs what pages show on a terminal: console.py PROGRAM PAGE.md...; with --write before PROGRAM it puts what came out
into the pages instead of comparing it.

A block ```console holds commands after `$ ` and what they print, on stdout and stderr. The commands of a page run one
after the other in one empty folder, in which `pkmopt` is PROGRAM, `pkmopt-check-proof` its neighbour, `experiments`,
`benchmarks` and `tests` are those of the repository, and the page's files are: a block ```{code-block} with
`:caption: NAME`, or one below a line `<!-- NAME -->`, is written to NAME before the commands that stand below it. A
command has to succeed, unless `$ echo $?` comes next. It runs on two threads.

What is printed has to be what the page shows, but for the number of spaces between words and for what every run has
of its own, whose values are not compared: times (a number before ns, us, ms, s, min or h), numbers of threads, shares
of time ("59 % on", "0.0 % of the time"), sizes of files (kB, MB), the revision behind the version, and what an estimate
says of exact values, which it does if they take longer than it waits. A line `...` stands for any lines, `...` at the
end of a line for its rest."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
OWN_TO_EACH_RUN = [
    (r", then exact values of the final designs in at most .*", ""),
    (r"\d[\d.]* (ns|us|ms|s|min|h)\b", "TIME"),
    (r"\d+ threads?\b", "THREADS"),
    (r"\d[\d.]* %(?= on | of the time)", "SHARE"),
    (r"\d[\d.]* [kM]B\b", "SIZE"),
    (r"(?<=\d )\([0-9a-f]{12}\S*\)", "(REVISION)"),
    (r"\s+", " "),
]
# What a run says now and then, where it takes long: on a busy machine.
PROGRESS = re.compile(r"(stage \d+ of \d+: )?\S+ generation \d+, \d+ evaluations, .* left|final step: .*"
                      r"|pkmopt: (measuring what an evaluation takes|evaluating .*|\S+ is computing, Ctrl-C ends it)")


def comparable(line):
    for pattern, stand_in in OWN_TO_EACH_RUN:
        line = re.sub(pattern, stand_in, line)
    return line.strip()


def same(shown, printed):
    """Whether lines that a page shows stand for those that were printed."""
    if not shown:
        return not printed
    if shown[0].strip() == "...":
        return any(same(shown[1:], printed[i:]) for i in range(len(printed) + 1))
    if not printed:
        return False
    a, b = comparable(shown[0]), comparable(printed[0])
    equal = b.startswith(a[:-3].rstrip()) if a.endswith("...") else a == b
    return equal and same(shown[1:], printed[1:])


def blocks_of(lines):
    """(first line, end, language, caption) of each fenced block; the lines are those between the fences."""
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
    """(command, lines shown below it) of a console block."""
    found = []
    for line in lines:
        if line.startswith("$ "):
            found.append(([line], []))
        elif found and found[-1][0][-1].endswith("\\") and not found[-1][1]:
            found[-1][0].append(line)
        elif found:
            found[-1][1].append(line)
        else:
            sys.exit(f"a block console begins with '{line}', not with a command after '$ '")
    return found


class Folder:
    """Where the commands of a page run."""

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
                            "PYTHONDONTWRITEBYTECODE": "1",
                            **dict.fromkeys(["OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM",
                                             "OMPI_MCA_rmaps_base_oversubscribe"], "1")}

    def run(self, command):
        before = f"(exit {self.code})\n"
        done = subprocess.run(["bash", "-c", before + command], cwd=self.path, env=self.environment, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.code = done.returncode
        return [line for line in done.stdout.splitlines() if not PROGRESS.fullmatch(line)]


def faults_of(page, program, write):
    lines, faults, written, copied = page.read_text().splitlines(), [], [], 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = Folder(Path(scratch), program)
        for begin, end, language, caption in blocks_of(lines):
            if caption:
                (folder.path / caption).write_text("\n".join(lines[begin:end]) + "\n")
            if language != "console":
                continue
            written += lines[copied:begin]
            copied = end
            commands = commands_of(lines[begin:end])
            for number, (command, shown) in enumerate(commands):
                printed = folder.run("\n".join(command).removeprefix("$ "))
                told = number + 1 < len(commands) and commands[number + 1][0] == ["$ echo $?"]
                if folder.code != 0 and not told:
                    faults.append("\n".join([f"{page}:{begin}: {command[0]}", f"  ends with code {folder.code}",
                                             *printed]))
                fits = same(shown, printed)
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
    faults = [fault for page in pages for fault in faults_of(page, program, write)]
    for fault in faults:
        print(fault, end="\n\n")
    sys.exit(bool(faults) and not write)


if __name__ == "__main__":
    main()
