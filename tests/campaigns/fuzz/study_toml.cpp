// Fuzzer of studies in TOML. Input: the text of a study. It is parsed, and its problem is created and described, but
// not evaluated.
#include "engine/core/error.hpp"
#include "experiments/app/program.hpp"
#include "tests/campaigns/fuzz/expect.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pkm;
  static const Catalogues catalogues = all_catalogues();
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const Study study = read_study_toml(text, "study.toml", catalogues);
    fuzz::expect(!describe(study).empty(), "a study has a description");
  } catch (const ConfigError& error) {
    fuzz::expect_sentence(error.what(), text);
  }
  return 0;
}
