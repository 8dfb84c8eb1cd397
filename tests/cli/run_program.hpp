// Runs a program as a child process and captures its output.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

namespace pkm::testing {

struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal number if a signal ended the program; -1 after a timeout
  std::string out, err;

  /// Parses stdout, the output of --json. Throws if it is not JSON.
  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// Temporary file without a name that captures the output of a child process.
class Capture {
 public:
  Capture() : file_(std::tmpfile()) {
    if (!file_) throw std::runtime_error("no temporary file");
  }
  ~Capture() { std::fclose(file_); }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  int descriptor() const { return fileno(file_); }
  std::string text() const {
    std::rewind(file_);
    std::string all;
    for (int c; (c = std::fgetc(file_)) != EOF;) all += static_cast<char>(c);
    return all;
  }

 private:
  std::FILE* file_;
};

/// @param command  path of the program and its arguments
/// @param folder   working folder of the program
inline ProgramResult run_program(const std::vector<std::string>& command, const std::string& folder = ".",
                                 std::chrono::seconds time_limit = std::chrono::seconds(240)) {
  std::vector<char*> argv;
  for (const auto& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const Capture out, err;
  const pid_t child = fork();
  if (child == 0) {  // between fork and exec only system calls are safe
    if (chdir(folder.c_str()) != 0 || dup2(out.descriptor(), 1) < 0 || dup2(err.descriptor(), 2) < 0) _exit(126);
    execv(argv[0], argv.data());
    _exit(127);
  }
  ProgramResult result;
  int status = 0;
  const auto deadline = std::chrono::steady_clock::now() + time_limit;
  bool ended = false;
  while (!(ended = waitpid(child, &status, WNOHANG) == child) && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (ended) {
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  } else {
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
  }
  result.out = out.text();
  result.err = err.text();
  return result;
}

/// Runs the pkmopt of this build.
inline ProgramResult pkmopt(std::vector<std::string> arguments, const std::string& folder = ".") {
  arguments.insert(arguments.begin(), PKM_PROGRAM);
  return run_program(arguments, folder);
}

}  // namespace pkm::testing
