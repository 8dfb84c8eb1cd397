// Text of the Python program that a worker process runs, bindings/python/pkmopt/_worker.py.
#pragma once

namespace pkm {

extern const char* const kPythonWorkerText;

}  // namespace pkm
