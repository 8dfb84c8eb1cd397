#include "experiments/app/next_step.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>

namespace pkm {
namespace {

/// Returns true if `file` is an existing file with this extension. A missing file is reported later, by the attempt to
/// read it.
bool is_file(const std::string& file, const std::string& extension) {
  std::error_code ignored;
  return file.ends_with(extension) && std::filesystem::is_regular_file(file, ignored);
}

bool is_built_in_mechanism(const std::string& word, const Session& session) {
  return std::ranges::any_of(session.catalogues.mechanisms, [&](const auto& known) { return known.name() == word; });
}

}  // namespace

std::string quoted(const std::string& word) {
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("_-./+=,:@%", c); };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string file_argument(const std::string& file) { return file.starts_with('-') ? "./" + file : file; }

std::string command_text(const Session& session, const std::vector<std::string>& words) {
  std::string text = session.program;
  for (const std::string& word : words) text += ' ' + quoted(word);
  return text;
}

std::string next_step(const Session& session, const std::vector<std::string>& words) {
  return "next: " + command_text(session, words) + '\n';
}

void expect_file(const std::string& word, const std::string& expected, const std::string& alternative,
                 const Session& session) {
  std::error_code ignored;
  if (is_built_in_mechanism(word, session) && !std::filesystem::exists(word, ignored))
    throw ConfigError({}, "the mechanism '" + word + "'", expected,
                      session.program + ' ' + alternative + ' ' + quoted(file_argument(word)));
}

void expect_study_file(const std::string& file, const std::string& alternative, const Session& session) {
  expect_file(file, "a study file, F.h5", "list mechanisms", session);
  if (is_file(file, ".toml"))
    throw ConfigError({file, 0, ""}, "a file in TOML", "a study file, F.h5, as '" + session.program + " run' writes it",
                      session.program + ' ' + alternative + ' ' + quoted(file_argument(file)));
}

void expect_toml(const std::string& file, const std::string& alternative, const Session& session) {
  if (is_file(file, ".h5"))
    throw ConfigError({file, 0, ""}, "a study file", "a study or a mechanism in TOML",
                      session.program + ' ' + alternative + ' ' + quoted(file_argument(file)));
}

}  // namespace pkm
