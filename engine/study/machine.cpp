#include "engine/study/machine.hpp"

#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <thread>

#include "engine/core/instruction_set.hpp"

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

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace pkm
