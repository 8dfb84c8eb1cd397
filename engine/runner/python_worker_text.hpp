// The program of a worker process, python_worker.py.
#pragma once

namespace pkm {

extern const char* const kPythonWorkerText;

}  // namespace pkm
