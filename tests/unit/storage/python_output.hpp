// Runs Python scripts that read files with independent libraries (h5py, VTK), and formats numbers for comparison.
#pragma once

#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace pkm::test {

/// @return standard output and standard error of a shell command
inline std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  char block[4096];
  while (const std::size_t n = std::fread(block, 1, sizeof block, pipe)) text.append(block, n);
  ::pclose(pipe);
  return text;
}

/// @return the output of a script in tests/python
inline std::string python_output(const std::string& script, const std::string& arguments) {
  return output_of("/usr/bin/python3 '" + std::string(PKM_TEST_DATA) + "/../python/" + script + "' " + arguments);
}

/// @return the bits of the numbers in hexadecimal, each preceded by a space
inline std::string bits(const std::vector<double>& values) {
  std::string text;
  char word[20];
  for (const double value : values) {
    std::snprintf(word, sizeof word, " %016llx", static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(value)));
    text += word;
  }
  return text;
}

}  // namespace pkm::test
