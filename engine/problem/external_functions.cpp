#include "engine/problem/external_functions.hpp"

namespace pkm {

void ExternalFunctions::note_failure(const std::string& call, const std::string& reason) {
  const std::lock_guard guard(mutex_);
  failures_.emplace(call, reason);
}

std::map<std::string, std::string> ExternalFunctions::failures() const {
  const std::lock_guard guard(mutex_);
  return failures_;
}

}  // namespace pkm
