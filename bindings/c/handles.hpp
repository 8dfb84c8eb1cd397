// Parts shared by the sources of the C interface: the objects behind its handles, errors, allocated texts and arrays.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "bindings/c/pkmopt.h"
#include "engine/config/study.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/team.hpp"
#include "engine/generic/pose_arrays.hpp"
#include "engine/runner/python_workers.hpp"

namespace pkm::c {

using Json = nlohmann::ordered_json;

/// Stores the error that is being handled, for pkmopt_error() on this thread. To be called in a catch block.
pkmopt_status store_current_error() noexcept;

/// Calls body() and converts exceptions to a status and a message.
template <class Body>
pkmopt_status guarded(const Body& body) noexcept {
  try {
    body();
    return PKMOPT_OK;
  } catch (...) {
    return store_current_error();
  }
}

const Catalogues& catalogues();

/// A copy of a text that pkmopt_free() frees.
char* allocated(const std::string& text);
inline char* allocated(const Json& json) {
  return allocated(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}
/// An array that pkmopt_free() frees; not null even if it is empty.
template <class T>
T* allocated_array(std::size_t count) {
  void* const memory = std::malloc(std::max<std::size_t>(1, count) * sizeof(T));
  if (!memory) throw std::bad_alloc();
  return static_cast<T*>(memory);
}

/// Returns the text of an argument. Throws ConfigError if `text` is null.
std::string required_text(const char* text, const char* argument);
inline std::string text_or_empty(const char* text) { return text ? text : ""; }

/// Throws StorageError if the file exists and is not to be overwritten.
void refuse_existing(const std::string& file, bool overwrite);

/// Requests a stop if the function pkmopt_options.interrupt returns true. The function is called only on the thread
/// that constructed the object; is_requested() is thread-safe.
class Interrupt {
 public:
  explicit Interrupt(const pkmopt_options& options) : options_(options) {}
  /// Returns true if the caller's function has returned true, i.e. if the caller wants to stop.
  bool is_requested();

 private:
  pkmopt_options options_;
  std::thread::id caller_ = std::this_thread::get_id();
  std::chrono::steady_clock::time_point polled_ = std::chrono::steady_clock::now();  ///< time of the last call of the
                                                                                     ///< function; used by that thread
                                                                                     ///< only
  std::atomic<bool> requested_ = false;
};

/// Runs body() with the number of threads in the options. After an interrupt, it ends with the exception Stopped.
/// @param is_parallel  false: body() runs on the calling thread alone, which saves the time to start a team
template <class Body>
void with_options(const pkmopt_options* given, bool is_parallel, const Body& body) {
  const pkmopt_options options = given ? *given : pkmopt_options{};
  Interrupt interrupt(options);
  std::optional<StopScope> scope;
  if (options.interrupt) scope.emplace([&interrupt] { return interrupt.is_requested(); });
  if (is_parallel)
    with_team(options.threads, body);
  else
    body();
}

/// Parses the changes of a study: lines "set NAME=VALUE", "limit NAME=VALUE" and "cells NAME=NUMBER".
StudyChanges changes_of(const char* lines);
std::unique_ptr<pkmopt_study> study_handle(Study study);
std::shared_ptr<FunctionCaller> functions_of(const pkmopt_functions& given);
PythonOptions python_options(const pkmopt_python* given);

}  // namespace pkm::c

struct pkmopt_mechanism {
  std::shared_ptr<const pkm::Mechanism> mechanism;
  std::string text;  ///< text of the mechanism's file
};

struct pkmopt_design {
  std::shared_ptr<const pkm::Mechanism> mechanism;
  std::vector<double> parameters;
  std::string mode;
  std::size_t mode_index = 0;
  pkm::LimitSpec limits;
  // The following members are computed at their first use.
  mutable std::once_flag has_joints, has_jacobians, has_margin_names;
  mutable std::vector<std::string> margin_names;
  mutable std::optional<pkm::generic::PoseArrays> joints, jacobians;
};

struct pkmopt_study {
  pkm::Study study;
  // The evaluator of the workspace is prepared at its first use.
  mutable std::once_flag has_workspace;
  mutable std::unique_ptr<const pkm::WorkspaceEvaluator> workspace;
  // Scratch memory of evaluations of single designs.
  mutable std::mutex scratch_mutex;
  mutable std::vector<std::unique_ptr<pkm::Scratch>> idle_scratch;
};
