// A child process for tests: start it, send signals, wait for its end, read its output.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace pkm::testing {

class ChildProcess {
 public:
  struct Settings {
    rlim_t file_size = RLIM_INFINITY;  ///< RLIMIT_FSIZE [bytes]; simulates a full disk
    bool ignores_hangup = false;       ///< ignores SIGHUP, as under nohup
  };

  /// Starts `arguments` in `folder`; stdout and stderr go to `folder`/output.txt.
  ChildProcess(const std::vector<std::string>& arguments, const std::string& folder, Settings settings)
      : output_(folder + "/output.txt") {
    std::vector<char*> argv;
    for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    // Between fork and exec only async-signal-safe system calls are allowed.
    if (chdir(folder.c_str()) != 0) _exit(126);
    const int file = open("output.txt", O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(file, 1);
    dup2(file, 2);
    const rlimit limit{settings.file_size, settings.file_size};
    setrlimit(RLIMIT_FSIZE, &limit);
    for (const int number : {SIGINT, SIGTERM})
      ::signal(number, SIG_DFL);  // background processes of scripts inherit ignored signals
    ::signal(SIGHUP, settings.ignores_hangup ? SIG_IGN : SIG_DFL);
    execv(argv[0], argv.data());
    _exit(127);
  }
  ChildProcess(const std::vector<std::string>& arguments, const std::string& folder)
      : ChildProcess(arguments, folder, Settings{}) {}

  ~ChildProcess() {
    if (running_) {
      signal(SIGKILL);
      wait();
    }
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void signal(int number) const { kill(pid_, number); }

  /// Waits for the end of the process.
  /// @return its exit code; 128 + the number of the signal that ended it; -1 if it was killed after 120 s
  int wait() {
    int status = 0;
    for (int i = 0; i < 120'000; ++i) {
      if (waitpid(pid_, &status, WNOHANG) == pid_) {
        running_ = false;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    signal(SIGKILL);
    waitpid(pid_, &status, 0);
    running_ = false;
    return -1;
  }

  std::string output() const {
    std::ifstream file(output_);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

 private:
  std::string output_;
  pid_t pid_ = -1;
  bool running_ = true;
};

}  // namespace pkm::testing
