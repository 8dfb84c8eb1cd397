// Expectations that hold for any input, shared by all fuzzers.
#pragma once

#include <array>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>

namespace pkm::fuzz {

/// Aborts if `condition` is false, so that libFuzzer saves the input.
inline void expect(bool condition, std::string_view what) {
  if (condition) return;
  std::cerr << "expected: " << what << std::endl;
  std::abort();
}

/// Expects a message for users: not empty, and without identifiers of the standard library, unless the input contains
/// them. Escaped bytes such as \xff are ignored.
inline void expect_sentence(std::string_view message, std::string_view input) {
  constexpr std::array kRaw = {"std::", "_M_", "basic_string", "filesystem error", "__n (", "stoi", "stod"};
  std::string words(message);
  for (std::size_t at = 0; (at = words.find("\\x", at)) != std::string::npos; ++at) words.replace(at, 4, "?");
  for (const std::string_view raw : kRaw)
    expect(words.find(raw) == std::string_view::npos || input.find(raw) != std::string_view::npos,
           "no identifiers of the standard library in: " + std::string(message));
  expect(!message.empty(), "a message that is not empty");
}

/// Expects output without control characters, and an error message of at most 2 kB.
inline void expect_terminal(std::string_view out, std::string_view error) {
  for (const std::string_view text : {out, error})
    for (const char c : text)
      expect(static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t', "no control characters on a terminal");
  expect(error.size() <= 2048, "a message of at most 2 kB, not " + std::to_string(error.size()) + " bytes");
}

}  // namespace pkm::fuzz
