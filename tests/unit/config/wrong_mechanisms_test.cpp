// Mechanism files that are wrong in one way each: tests/data/mechanisms/wrong.txt has them with what is said of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "engine/config/mechanism_file.hpp"
#include "engine/core/error.hpp"

namespace pkm {
namespace {

using ::testing::HasSubstr;

struct Case {
  std::string fragments;  ///< as they stand: "a | b"
  std::string body;
};

/// The base, then the cases.
std::vector<Case> cases() {
  std::ifstream file(PKM_TEST_DATA "/mechanisms/wrong.txt");
  std::vector<Case> all;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("### "))
      all.push_back({line.substr(4), ""});
    else if (!all.empty())
      all.back().body += line + "\n";
  }
  return all;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// The file of a case.
std::string file_of(const std::string& body, const std::string& base) {
  const std::size_t colon = body.find(": ");
  const std::string verb = body.substr(0, colon);
  if (verb != "replace" && verb != "remove" && verb != "append") return body;
  std::string rest = body.substr(colon + 2, body.size() - colon - 3);
  replace_all(rest, "\\n", "\n");
  if (verb == "append") return base + rest;
  const std::size_t arrow = verb == "remove" ? rest.size() : rest.find(" => ");
  const std::string old = rest.substr(0, arrow), now = verb == "remove" ? "" : rest.substr(arrow + 4);
  std::string text = base;
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  EXPECT_EQ(text.find(old, at + 1), std::string::npos) << "twice: " << old;
  return text.replace(at, old.size(), now);
}

TEST(WrongMechanisms, AreRefusedInASentenceThatSaysWhereAndWhy) {
  const std::vector<Case> all = cases();
  ASSERT_GT(all.size(), 90u);
  ASSERT_EQ(all[0].fragments, "base");
  const std::string& base = all[0].body;
  EXPECT_EQ(read_mechanism_toml(base, "delta.toml")->info().name, "delta");
  for (std::size_t i = 1; i < all.size(); ++i) {
    SCOPED_TRACE(all[i].fragments + "\n" + all[i].body);
    std::string message = "it is accepted";
    try {
      read_mechanism_toml(file_of(all[i].body, base), "delta.toml");
    } catch (const ConfigError& error) {
      message = error.what();
    }
    EXPECT_LT(message.size(), 2000u);
    EXPECT_THAT(message, HasSubstr("delta.toml"));
    std::istringstream fragments(all[i].fragments + " ");
    for (std::string fragment; std::getline(fragments, fragment, '|');) {
      const std::size_t first = fragment.find_first_not_of(' '), last = fragment.find_last_not_of(' ');
      EXPECT_THAT(message, HasSubstr(fragment.substr(first, last + 1 - first)));
    }
  }
}

}  // namespace
}  // namespace pkm
