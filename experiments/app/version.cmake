# Writes OUTPUT, the definitions of version.hpp, with the git revision of SOURCE: "unknown" if SOURCE is not the root of
# a git working tree; "+changes" is appended if tracked files differ from the commit.
set(revision unknown)
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-cdup --short=12 HEAD
  RESULT_VARIABLE failed OUTPUT_VARIABLE lines ERROR_QUIET)
if(NOT failed AND lines MATCHES "^\n([0-9a-f]+)\n$")  # an empty first line: SOURCE is the root
  set(revision ${CMAKE_MATCH_1})
  execute_process(COMMAND git -C ${SOURCE} diff-index --quiet HEAD -- RESULT_VARIABLE changed ERROR_QUIET)
  if(changed)
    string(APPEND revision "+changes")
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include "experiments/app/version.hpp"

namespace pkm {

std::string program_version() { return "@VERSION@"; }
std::string program_revision() { return "@revision@"; }

}  // namespace pkm
]] @ONLY)
