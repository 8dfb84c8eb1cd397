// Calls the functions of a study in the caller's program or in Python processes.
#include "bindings/c/handles.hpp"
#include "engine/core/stop.hpp"
#include "engine/problem/external_functions.hpp"
#include "engine/runner/python_functions.hpp"
#include "engine/storage/file_header.hpp"

namespace pkm::c {
namespace {

constexpr std::size_t kReasonBytes = 4096;

/// Calls functions that the caller's program provides.
class Functions final : public FunctionCaller {
 public:
  explicit Functions(const pkmopt_functions& given) : function_(given.function), user_(given.user) {
    for (std::size_t i = 0; i < given.count; ++i)
      functions_.emplace_back(required_text(given.calls[i], "calls"), required_text(given.hashes[i], "hashes"));
  }

  void evaluate(const std::string& call, std::span<const double> parameters, std::span<ExternalValue> values) override {
    const std::size_t width = parameters.size() / values.size();
    for (std::size_t row = 0; row < values.size(); ++row) {
      check_stop();
      ExternalValue& to = values[row];
      char reason[kReasonBytes] = "the call failed";
      const auto begin = std::chrono::steady_clock::now();
      const int failed = function_(call.c_str(), &parameters[row * width], &to.value, reason, sizeof reason, user_);
      to.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      to.failure = failed != 0 ? reason : "";
      to.is_computed = true;
    }
  }
  std::string source_hash(const std::string& call) const override {
    for (const auto& [name, hash] : functions_)
      if (name == call) return hash;
    return "";
  }
  bool has(const std::string& call) const {
    return std::ranges::any_of(functions_, [&](const auto& each) { return each.first == call; });
  }

 private:
  int (*function_)(const char*, const double*, double*, char*, std::size_t, void*);
  void* user_;
  std::vector<std::pair<std::string, std::string>> functions_;  // name and hash of each function
};

}  // namespace

std::shared_ptr<FunctionCaller> functions_of(const pkmopt_functions& given) {
  return std::make_shared<Functions>(given);
}

PythonOptions python_options(const pkmopt_python* given) {
  PythonOptions options;
  if (!given) return options;
  options.workers = given->workers;
  if (given->program) options.program = given->program;
  std::istringstream folders(text_or_empty(given->path));
  for (std::string folder; std::getline(folders, folder, ':');)
    if (!folder.empty()) options.path.push_back(folder);
  return options;
}

}  // namespace pkm::c

using namespace pkm::c;

pkmopt_status pkmopt_study_set_functions(pkmopt_study* study, const pkmopt_functions* functions) {
  return guarded([&] {
    const auto made = std::make_shared<Functions>(*functions);
    for (const std::string& call : study->study.problem->external_calls())
      if (!made->has(call)) throw pkm::ConfigError({"", 0, "functions"}, "no function " + call);
    study->study.problem->parts().functions->caller = made;
  });
}

pkmopt_status pkmopt_study_start_workers(pkmopt_study* study, const char* folder, const pkmopt_python* python,
                                         const pkmopt_options* options) {
  return guarded([&] {
    study->study.problem->parts().functions->caller = nullptr;
    with_options(options, false, [&] {
      pkm::start_python_workers(study->study, {text_or_empty(folder)}, {}, python_options(python),
                                pkm::team_size(options ? options->threads : 0));
    });
  });
}

pkmopt_status pkmopt_hash(const char* bytes, std::size_t size, char** hash) {
  return guarded([&] { *hash = allocated(pkm::xxh64_hex({bytes, size})); });
}
