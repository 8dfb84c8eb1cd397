#!/usr/bin/env python3
"""Checks that the tests which pages name exist: test_names.py ROOT PROGRAM .., where the programs list their tests.
Prints the names that select no test, and fails if there are any.

Pages name tests by `--gtest_filter='PATTERN'`, by `-R NAME` or `-R "NAME\\|NAME"` as docs/accuracy.md explains, and
READMEs of the library by `Suite.Test`."""
import fnmatch
import re
import subprocess
import sys
from pathlib import Path


def tests_of(program):
    listed = subprocess.run([program, "--gtest_list_tests"], check=True, capture_output=True, text=True).stdout
    for line in listed.splitlines():
        name = line.split("#")[0].strip()
        if not line.startswith(" "):
            suite = name
        else:
            yield suite + name


def patterns_of(text, page):
    """Patterns of the names of tests, and what the page says."""
    for pattern in re.findall(r"gtest_filter='([^']+)'", text):
        yield pattern, pattern
    for names in re.findall(r'`-R (?:"([^"`]+)"|([^\s"`]+))', text):
        for name in "".join(names).split("\\|"):
            yield f"*{name}*", name
    if page.name == "README.md":
        for name in re.findall(r"`([A-Z]\w+\.[A-Z]\w+)`", text):
            yield f"*{name}*", name


def main():
    root = Path(sys.argv[1])
    tests = [test for program in sys.argv[2:] for test in tests_of(program)]
    pages = [page for folder in ("docs", "engine", "tests", "benchmarks") for page in (root / folder).rglob("*.md")]
    pages = [page for page in pages + list(root.glob("*.md")) if "wrong" not in page.relative_to(root).parts]
    count, faults = 0, []
    for page in sorted(pages):
        for pattern, name in patterns_of(page.read_text(), page):
            if name.strip("*") == "NAME":
                continue
            count += 1
            is_folder = name.islower() and (root / "tests" / name).is_dir()  # a name for `ctest -R`
            if not is_folder and not fnmatch.filter(tests, pattern):
                faults.append(f"{page.relative_to(root)}: {name}")
    print(f"{count} names of tests, {len(faults)} of them select none", *faults, sep="\n  ")
    sys.exit(bool(faults) or not count)


if __name__ == "__main__":
    main()
