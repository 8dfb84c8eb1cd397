// `pkmopt-check-proof FILE`: command line of the proof checker.
#include <cerrno>
#include <cstdio>
#include <iostream>
#include <memory>

#include "experiments/checker/check.hpp"

namespace pkm::checker {
namespace {

/// The contents of a file. Throws std::system_error if it cannot be read.
std::string text_of(const char* path) {
  const auto fail = [] { throw std::system_error(errno, std::generic_category()); };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path, "rb"), std::fclose);
  if (!file) fail();
  std::string text;
  char buffer[1 << 16];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, file.get())) text.append(buffer, count);
  if (std::ferror(file.get())) fail();
  return text;
}

constexpr const char* kUsage = "usage: pkmopt-check-proof FILE\n";
constexpr const char* kHelp =
    "\nCheck a proof that 'pkmopt certify --proof FILE' wrote.\n"
    "\n"
    "  --help      Print this text\n"
    "  --version   Print the version\n"
    "\n"
    "Exit code: 0 accepted, 1 refused, 2 not checked (no such file, out of memory, output not written, ..).\n";

/// Writes to stdout. @return the exit code: 0, or 2 if stdout cannot be written
int print(const std::string& text) {
  std::cout << text << std::flush;
  if (std::cout) return 0;
  std::cerr << "not checked: the output cannot be written\n";
  return 2;
}

int check(int count, char** words) {
  const std::string word = count == 2 ? words[1] : "";
  if (word == "--help" || word == "-h") return print(std::string(kUsage) + kHelp);
  if (word == "--version") return print("pkmopt-check-proof " PKM_CHECKER_VERSION "\n");
  if (word.empty() || word.starts_with('-')) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    return print(Check(text_of(words[1])).run());
  } catch (const InvalidProof& reason) {
    std::cerr << "refused: " << reason.what() << '\n';
    return 1;
  } catch (const std::bad_alloc&) {
    std::cerr << "not checked: out of memory\n";
  } catch (const std::system_error& reason) {
    std::cerr << "not checked: " << words[1] << ": " << reason.code().message() << '\n';
  } catch (const std::exception& reason) {
    std::cerr << "not checked: internal error: " << reason.what() << '\n';
  }
  return 2;
}

}  // namespace
}  // namespace pkm::checker

int main(int count, char** words) { return pkm::checker::check(count, words); }
