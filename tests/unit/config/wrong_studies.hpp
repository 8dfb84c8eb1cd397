// Studies that are wrong in one way each, with the message verbatim.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "tests/unit/config/fake_catalogues.hpp"

namespace pkm::testing {

/// The message that a study gets from the reader, as a file called "s.toml".
inline std::string message_of(const std::string& text) {
  try {
    read_study_toml(text, "s.toml", fake_catalogues());
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

struct WrongStudy {
  std::string text;
  std::string message;
};

/// Checks each text between `head` and `tail`.
inline void expect_messages(const std::string& head, const std::vector<WrongStudy>& studies,
                            const std::string& tail = "") {
  for (const auto& study : studies) EXPECT_EQ(message_of(head + study.text + tail), study.message) << study.text;
}

inline const std::string kMachine = "[mechanism]\ntype = \"slider\"\n";                        // lines 1, 2
inline const std::string kProblem = kMachine + "[variables]\na = { min = 0.1, max = 0.9 }\n";  // to line 4
inline const std::string kVolume = kProblem + "[[objective]]\ntype = \"volume\"\n";            // to line 6
inline const std::string kStage = "\n[[stage]]\noptimiser = \"ga\"\n";

}  // namespace pkm::testing
