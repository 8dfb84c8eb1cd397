// Fuzzer of motions. Input: the text of a motion. It is parsed for every mechanism and sampled at both ends and in the
// middle.
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/motion_table.hpp"
#include "engine/core/error.hpp"
#include "tests/campaigns/fuzz/expect.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pkm;
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const auto& mechanism : all_mechanisms()) try {
      std::vector<double> parameters;
      for (const Parameter& p : mechanism->info().parameters) parameters.push_back(p.nominal);
      const auto motion = read_motion_toml(text, "motion.toml", motion_names(*mechanism, parameters));
      fuzz::expect(motion->duration() > 0, "a motion takes time");
      fuzz::expect(sample(*motion, 3).size() == 3, "as many samples as requested");
      is_periodic(*motion, mechanism->info().coordinates);
    } catch (const ConfigError& error) {
      fuzz::expect_sentence(error.what(), text);
    }
  return 0;
}
