// Runs the pkmopt program inside a fuzzer and captures its output.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "experiments/app/program.hpp"
#include "tests/campaigns/fuzz/expect.hpp"

namespace pkm::fuzz {

/// Redirects std::cout and std::cerr to strings during its lifetime.
class Capture {
 public:
  Capture() : cout_(std::cout.rdbuf(out.rdbuf())), cerr_(std::cerr.rdbuf(err.rdbuf())) {}
  ~Capture() {
    std::cout.rdbuf(cout_);
    std::cerr.rdbuf(cerr_);
  }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;
  std::ostringstream out, err;

 private:
  std::streambuf *cout_, *cerr_;
};

/// Runs the program in this process; expects a valid exit code and, on failure, an error message.
inline void expect_program(std::vector<std::string> arguments, const Catalogues& catalogues) {
  arguments.insert(arguments.begin(), "pkmopt");
  std::vector<char*> argv;
  std::string joined;
  for (std::string& argument : arguments) {
    argv.push_back(argument.data());
    joined += argument + ' ';
  }
  int code = 0;
  std::string printed, error;
  {
    const Capture capture;
    code = program_main(static_cast<int>(argv.size()), argv.data(), catalogues);
    printed = capture.out.str();
    error = capture.err.str();
  }
  expect(code >= 0 && code <= 4, "an exit code of the program");
  if (code == 1 || code == 2) expect_sentence(error, joined);
  expect_terminal(printed, error);
}

}  // namespace pkm::fuzz
