#!/usr/bin/env bash
# Fails where the object files given define a symbol that the linker may take for another file's: such code, compiled for
# AVX2 or AVX-512, would end up where a processor without them runs it. All that kernels share are the functions that
# carry their instruction set in their name.
set -euo pipefail
shared=$(nm --demangle --defined-only "$@" | grep -E ' [WVu] ' | grep -v '<(pkm::InstructionSet)[0-9]' || true)
if [[ -n $shared ]]; then
  echo "kernels share code with files of other instruction sets; inline it or keep it in an anonymous namespace:"
  echo "$shared"
  exit 1
fi
(($(nm --demangle --defined-only "$@" | grep -c '<(pkm::InstructionSet)[12]') > 0))  # there are kernels at all
