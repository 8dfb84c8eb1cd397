#include "engine/runner/machine.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <thread>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/instruction_set.hpp"
#include "engine/core/ranks.hpp"

namespace pkm {

std::string describe_processor() {
  std::string processor = "unknown processor";
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) {
      processor = line.substr(line.find(':') + 2);
      break;
    }
  return processor;
}

std::string describe_machine() {
  utsname system{};
  uname(&system);
  return describe_processor() + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores, " +
         std::string(name_of(instruction_set())) + ", " + system.sysname + " " + system.release + " " + system.machine;
}

std::string describe_team(int threads, int total_threads) {
  const auto words = [](int n) { return std::to_string(n) + (n == 1 ? " thread" : " threads"); };
  const int ranks = ranks::size();
  if (ranks == 1) return words(threads);
  if (ranks * threads == total_threads) return std::to_string(ranks) + " ranks x " + words(threads);
  return std::to_string(ranks) + " ranks with " + words(total_threads) + " in all";
}

std::string describe_hosts() {
  std::vector<std::string> hosts;
  for (int rank = 0; rank < ranks::size(); ++rank)
    if (std::ranges::find(hosts, ranks::host(rank)) == hosts.end()) hosts.push_back(ranks::host(rank));
  return join(hosts);
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace pkm
