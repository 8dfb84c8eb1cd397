#include "engine/runner/python_functions.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "engine/config/text_file.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/storage/file_header.hpp"

namespace pkm {
namespace {

namespace fs = std::filesystem;

ConfigError call_error(const Study& study, const std::string& call, const std::string& what) {
  return ConfigError({study.file_name, 0, "call = \"" + call + "\""}, what);
}

/// The recorded hash of the file that defines a function; "" if none is recorded.
std::string recorded_hash(const std::vector<FunctionRecord>& recorded, const std::string& call) {
  const auto found = std::ranges::find(recorded, call, &FunctionRecord::call);
  return found == recorded.end() ? "" : found->hash;
}

std::string changed_text(const std::string& what) {
  return what + " was changed after the study was started; restore it, or start a new study";
}

/// Finds the file that defines a function. Without a recorded hash, it is the first existing file in `folders`; with
/// one, the first file whose contents have this hash.
PythonFunction find_function(const Study& study, const std::string& call, const std::vector<std::string>& folders,
                             const std::string& hash) {
  const std::size_t colon = call.rfind(':');
  if (colon == std::string::npos)
    throw call_error(study, call,
                     "the function is in no file, so that only the program that started the study can call it; "
                     "a function of a file is \"FILE.py:FUNCTION\"");
  PythonFunction function{call, call.substr(0, colon), call.substr(colon + 1), ""};
  std::vector<std::string> tried, changed;
  for (const std::string& folder : folders) {
    const std::string file = (fs::path(folder) / call.substr(0, colon)).lexically_normal().string();
    std::error_code ignored;
    if (contains(tried, file) || (tried.push_back(file), !fs::exists(file, ignored))) continue;
    function.hash = xxh64_hex(read_text_file(file, "a file in Python"));
    function.file = fs::absolute(file, ignored).string();
    if (hash.empty() || function.hash == hash) return function;
    changed.push_back(file);
  }
  if (!changed.empty()) throw StorageError(changed_text(join(changed, " and ")));
  throw call_error(study, call, "there is no file " + join(tried, " or "));
}

}  // namespace

std::string folder_of(const std::string& file) { return fs::path(file).parent_path().string(); }

void start_python_workers(const Study& study, const std::vector<std::string>& folders,
                          const std::vector<FunctionRecord>& recorded, const PythonOptions& options, int threads) {
  const DesignProblem& problem = *study.problem;
  ExternalFunctions& functions = *problem.parts().functions;
  if (problem.external_calls().empty() || functions.caller) return;
  std::vector<PythonFunction> found;
  for (const std::string& call : problem.external_calls())
    found.push_back(find_function(study, call, folders, recorded_hash(recorded, call)));
  const int workers = options.workers > 0 ? options.workers : threads;
  functions.caller = std::make_shared<PythonWorkers>(
      std::move(found), names_of(problem.parts().mechanism->info().parameters), options, workers);
}

std::vector<FunctionRecord> function_records(const Study& study) {
  const DesignProblem& problem = *study.problem;
  const FunctionCaller* const caller = problem.parts().functions->caller.get();
  std::vector<FunctionRecord> records;
  for (const std::string& call : problem.external_calls()) {
    if (!caller) throw std::logic_error("the function " + call + " of the study is not connected");
    records.push_back({call, caller->source_hash(call)});
  }
  return records;
}

void expect_recorded_functions(const Study& study, const std::vector<FunctionRecord>& recorded) {
  for (const FunctionRecord& own : function_records(study))
    if (const std::string hash = recorded_hash(recorded, own.call); hash != own.hash)
      throw StorageError(changed_text("the function " + own.call));
}

}  // namespace pkm
