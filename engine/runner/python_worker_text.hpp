// The program of a worker process, bindings/python/pkmopt/_worker.py.
#pragma once

namespace pkm {

extern const char* const kPythonWorkerText;

}  // namespace pkm
