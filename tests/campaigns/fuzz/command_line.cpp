// Fuzzer of the command line. Input: one byte that selects a command, then its further arguments, one per line.
// Commands on a single pose are executed. Commands that take long or write files get a file that does not exist, so
// that only their arguments are parsed. The byte may also select the parsers of assignments, axes and ranges.
#include <array>
#include <sstream>

#include "engine/config/assignments.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/core/error.hpp"
#include "tests/campaigns/fuzz/capture.hpp"

namespace pkm::fuzz {
namespace {

struct Command {
  const char* name;
  const char* target;
};

constexpr std::array kCommands = {
    Command{"pose", "4ppa-2par"},       Command{"pose", "3crr-r-cru"},    Command{"pose", "2t1r-p-hybrid"},
    Command{"forward", "4ppa-2par"},    Command{"forward", "3crr-r-cru"}, Command{"dynamics", "4ppa-2par"},
    Command{"dynamics", "3crr-r-cru"},  Command{"list", "mechanisms"},    Command{"run", "none.toml"},
    Command{"check", "none.toml"},      Command{"evaluate", "none.toml"}, Command{"coupling", "none.toml"},
    Command{"trajectory", "none.toml"}, Command{"simulate", "none.toml"}, Command{"workspace", "none.toml"},
    Command{"resume", "none.h5"},       Command{"show", "none.h5"},       Command{"report", "none.h5"},
    Command{"export", "none.h5"}};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line.substr(0, line.find('\0')));
  return lines;
}

void read_values(const std::string& text) {
  for (const char* unit : {"m", "rad", "1"}) try {
      expect(!parse_values(text, "--axis", {"x", unit}).empty(), "an axis has values");
    } catch (const ConfigError& error) {
      expect_sentence(error.what(), text);
    }
}

void read_lists(const std::string& text) {
  const std::vector<std::string> lists = lines_of(text);
  for (const auto& mechanism : all_mechanisms()) {
    const MechanismInfo& info = mechanism->info();
    const auto parameters = assignable_parameters(info), coordinates = assignable_axes(info.coordinates);
    const auto reads = [&text](const auto& reader) {
      try {
        reader();
      } catch (const ConfigError& error) {
        expect_sentence(error.what(), text);
      }
    };
    reads([&] { expect(parse_assignments(lists, "--set", parameters).size() == parameters.size(), "all names"); });
    reads([&] { expect(parse_all_assignments(lists, "--at", coordinates).size() == coordinates.size(), "all names"); });
    reads([&] {
      for (const auto& [from, to] : parse_ranges(lists, "--box", coordinates)) expect(from < to, "a range ascends");
    });
    reads([&] { parse_wrench(lists); });
  }
}

}  // namespace
}  // namespace pkm::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pkm::fuzz;
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::size_t choice = data[0] % (kCommands.size() + 2);
  if (choice < kCommands.size()) {
    static const pkm::Catalogues catalogues = pkm::all_catalogues();
    std::vector<std::string> arguments = {kCommands[choice].name, kCommands[choice].target};
    for (const std::string& line : lines_of(text)) arguments.push_back(line);
    expect_program(arguments, catalogues);
  } else if (choice == kCommands.size()) {
    read_values(text);
  } else {
    read_lists(text);
  }
  return 0;
}
