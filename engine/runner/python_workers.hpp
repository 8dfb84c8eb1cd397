// Worker processes that call the Python functions of a study.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "engine/problem/external_functions.hpp"

namespace pkm {

struct PythonOptions {
  int workers = 0;                     ///< number of worker processes; 0: one for each thread
  std::string program = "python3";     ///< command that starts the Python interpreter
  std::vector<std::string> path = {};  ///< additional folders in which Python searches for modules
};

/// A function and the file that defines it.
struct PythonFunction {
  std::string call;  ///< name of the function in the study, for example "cost.py:price"
  std::string file, function;
  std::string hash;  ///< hash of the contents of the file
};

/// Calls Python functions in separate processes. If a process ends during a call, the process is replaced and the call
/// counts as failed. Results do not depend on the number of processes.
class PythonWorkers final : public FunctionCaller {
 public:
  /// Starts the processes and loads the functions. Throws ConfigError if a function cannot be loaded, and Stopped.
  /// @param parameters  names of the mechanism's parameters
  /// @param workers     number of processes, at least 1
  PythonWorkers(std::vector<PythonFunction> functions, std::vector<std::string> parameters,
                const PythonOptions& options, int workers);
  ~PythonWorkers() override;

  void evaluate(const std::string& call, std::span<const double> parameters, std::span<ExternalValue> values) override;
  std::string source_hash(const std::string& call) const override;

 private:
  class Process;
  struct Setup;
  class Batch;

  /// Waits until at least one process is idle, then returns up to `count` idle processes, which are reserved for the
  /// caller until give_back().
  std::vector<std::unique_ptr<Process>> take_idle(std::size_t count);
  void give_back(std::vector<std::unique_ptr<Process>> processes);

  std::vector<PythonFunction> functions_;
  std::unique_ptr<const Setup> setup_;
  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<Process>> idle_;
};

}  // namespace pkm
