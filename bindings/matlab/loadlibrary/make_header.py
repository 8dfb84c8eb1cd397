#!/usr/bin/env python3
"""Prints pkmopt_prototypes.h, which is pkmopt.h for loadlibrary() of MATLAB: make_header.py PKMOPT.H

loadlibrary() supports neither pointers to pointers to structs, nor structs with functions, nor attributes of compilers.
Therefore objects and options are void*, enumerations are int, and there are only the functions."""

import re
import sys

PREAMBLE = """/* The functions of pkmopt.h for loadlibrary() of MATLAB, made by make_header.py. Objects and options are void*, and
 * a status is an int: 0 is success; see pkmopt.h for everything else. Options have to be NULL. */
#include <stddef.h>
#include <stdint.h>
"""


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        text = re.sub(r"/\*.*?\*/", "", file.read(), flags=re.DOTALL)
    print(PREAMBLE)
    for prototype in re.findall(r"^PKMOPT_API ([^;]*);", text, flags=re.MULTILINE):
        prototype = re.sub(r"\s+", " ", prototype).replace("pkmopt_status", "int")
        types = "mechanism|design|study|results|optimiser|options|run_options|functions|python"
        prototype = re.sub(r"\bpkmopt_(%s)\*" % types, "void*", prototype)
        print(prototype + ";")


if __name__ == "__main__":
    main()
