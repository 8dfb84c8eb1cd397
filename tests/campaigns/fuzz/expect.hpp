// What must hold whatever the input: checked by all fuzzers.
#pragma once

#include <array>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>

namespace pkm::fuzz {

/// Ends the program if `holds` is false, so that libFuzzer keeps the input.
inline void expect(bool holds, std::string_view what) {
  if (holds) return;
  std::cerr << "expected: " << what << std::endl;
  std::abort();
}

/// A message is a sentence for people: the standard library's words are in it only if they are in the input, too. Bytes
/// written as \xff are none of its letters.
inline void expect_sentence(std::string_view message, std::string_view input) {
  constexpr std::array kRaw = {"std::", "_M_", "basic_string", "filesystem error", "__n (", "stoi", "stod"};
  std::string words(message);
  for (std::size_t at = 0; (at = words.find("\\x", at)) != std::string::npos; ++at) words.replace(at, 4, "?");
  for (const std::string_view raw : kRaw)
    expect(words.find(raw) == std::string_view::npos || input.find(raw) != std::string_view::npos,
           "no words of the standard library in: " + std::string(message));
  expect(!message.empty(), "a message that is not empty");
}

/// What reaches a terminal does not steer it, and what is wrong is told in at most 2 kB.
inline void expect_terminal(std::string_view out, std::string_view complaint) {
  for (const std::string_view text : {out, complaint})
    for (const char c : text)
      expect(static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t', "no control characters on a terminal");
  expect(complaint.size() <= 2048, "a complaint of at most 2 kB, not " + std::to_string(complaint.size()) + " bytes");
}

}  // namespace pkm::fuzz
