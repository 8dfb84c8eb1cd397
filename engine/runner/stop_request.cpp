#include "engine/runner/stop_request.hpp"

#include <array>
#include <csignal>
#include <ctime>

namespace pkm {
namespace {

constexpr std::array kStopSignals = {SIGINT, SIGTERM, SIGHUP};
constexpr std::array kIgnoredSignals = {SIGXFSZ, SIGPIPE};

volatile std::sig_atomic_t received = 0;     // number of the first signal received; 0: none
volatile std::sig_atomic_t received_at = 0;  // time at which it was received, on the monotonic clock [s]
// Handlers that the signals had before; they are restored when the outermost StopRequest is destroyed.
std::array<struct sigaction, kStopSignals.size() + kIgnoredSignals.size()> previous;
int depth = 0;  // number of nested StopRequest objects

std::sig_atomic_t monotonic_seconds() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);  // may be called in a signal handler
  return static_cast<std::sig_atomic_t>(time.tv_sec);
}

void handle_signal(int signal) {
  if (received != 0 && monotonic_seconds() - received_at > 1) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
    return;
  }
  if (received == 0) {
    received_at = monotonic_seconds();
    received = signal;
  }
}

}  // namespace

StopRequest::StopRequest() {
  if (depth++ > 0) return;
  received = 0;
  struct sigaction action {};
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  std::size_t i = 0;
  action.sa_handler = handle_signal;
  for (const int signal : kStopSignals) {
    sigaction(signal, nullptr, &previous[i]);
    // A signal that the process ignores stays ignored: nohup, and shells for jobs in the background, set SIG_IGN.
    if (previous[i++].sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  action.sa_handler = SIG_IGN;
  for (const int signal : kIgnoredSignals) sigaction(signal, &action, &previous[i++]);
}

StopRequest::~StopRequest() {
  if (--depth > 0) return;
  std::size_t i = 0;
  for (const int signal : kStopSignals) sigaction(signal, &previous[i++], nullptr);
  for (const int signal : kIgnoredSignals) sigaction(signal, &previous[i++], nullptr);
}

int StopRequest::signal() { return received; }

const char* StopRequest::name(int signal) {
  return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP";
}

}  // namespace pkm
