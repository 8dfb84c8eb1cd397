// Studies of the program's own catalogues, as a file called "s.toml".
#pragma once

#include <string>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/study.hpp"
#include "engine/core/error.hpp"
#include "objectives/all.hpp"

namespace pkm::testing {

inline Catalogues all_catalogues() { return {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()}; }

inline Study read_real(const std::string& text) { return read_study_toml(text, "s.toml", all_catalogues()); }

/// The message that a study gets from the reader, or "accepted".
inline std::string real_complaint(const std::string& text) {
  try {
    read_real(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace pkm::testing
