#include "engine/study/stop_request.hpp"

#include <array>
#include <csignal>
#include <ctime>

namespace pkm {
namespace {

constexpr std::array kStopping = {SIGINT, SIGTERM, SIGHUP};
constexpr std::array kIgnored = {SIGXFSZ, SIGPIPE};

volatile std::sig_atomic_t received = 0;
volatile std::sig_atomic_t received_at = 0;  // s, monotonic
std::array<struct sigaction, kStopping.size() + kIgnored.size()> previous;
int depth = 0;

std::sig_atomic_t monotonic_seconds() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);  // async-signal-safe
  return static_cast<std::sig_atomic_t>(time.tv_sec);
}

void remember(int signal) {
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
  action.sa_handler = remember;
  for (const int signal : kStopping) {
    sigaction(signal, nullptr, &previous[i]);
    if (previous[i++].sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);  // nohup, or a script that ignores it
  }
  action.sa_handler = SIG_IGN;
  for (const int signal : kIgnored) sigaction(signal, &action, &previous[i++]);
}

StopRequest::~StopRequest() {
  if (--depth > 0) return;
  std::size_t i = 0;
  for (const int signal : kStopping) sigaction(signal, &previous[i++], nullptr);
  for (const int signal : kIgnored) sigaction(signal, &previous[i++], nullptr);
}

int StopRequest::signal() { return received; }

const char* StopRequest::name(int signal) {
  return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP";
}

}  // namespace pkm
