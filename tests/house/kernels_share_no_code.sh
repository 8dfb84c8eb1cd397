#!/usr/bin/env bash
# Fails if one of the given object files, compiled for AVX2 or AVX-512, defines a weak symbol without an instruction set
# in its name. The linker keeps one definition of a weak symbol for all files, so such code could be executed on a
# processor that does not support these instructions.
set -euo pipefail
shared=$(nm --demangle --defined-only "$@" | grep -E ' [WVu] ' | grep -v '<(pkm::InstructionSet)[0-9]' || true)
if [[ -n $shared ]]; then
  echo "kernels define code shared with other instruction sets; inline it or move it to an anonymous namespace:"
  echo "$shared"
  exit 1
fi
(($(nm --demangle --defined-only "$@" | grep -c '<(pkm::InstructionSet)[12]') > 0))  # the object files contain kernels
