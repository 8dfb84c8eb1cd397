#include "engine/study/stop_request.hpp"

#include <csignal>

namespace pkm {
namespace {

volatile std::sig_atomic_t received = 0;
struct sigaction old_int, old_term, old_xfsz;

void remember(int signal) {
  received = signal;
  std::signal(signal, SIG_DFL);
}

}  // namespace

StopRequest::StopRequest() {
  received = 0;
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &old_int);
  sigaction(SIGTERM, &action, &old_term);
  action.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &action, &old_xfsz);
}

StopRequest::~StopRequest() {
  sigaction(SIGINT, &old_int, nullptr);
  sigaction(SIGTERM, &old_term, nullptr);
  sigaction(SIGXFSZ, &old_xfsz, nullptr);
}

int StopRequest::signal() { return received; }

}  // namespace pkm
