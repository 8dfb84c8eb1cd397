// Fuzzer of study files (HDF5). Input: a study file with a valid header and contents changed by the mutator. A file
// that can be read is printed, listed, written again or, if it needs few evaluations, resumed: one of these per input,
// selected by its hash, so that more inputs are tested.
#include <hdf5.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "engine/core/error.hpp"
#include "engine/export/study_tables.hpp"
#include "engine/results/chosen_design.hpp"
#include "engine/runner/records.hpp"
#include "engine/storage/study_file.hpp"
#include "experiments/app/program.hpp"
#include "tests/campaigns/fuzz/capture.hpp"
#include "tests/campaigns/fuzz/expect.hpp"
#include "tests/campaigns/fuzz/study_mutator.hpp"
#include "tests/unit/storage/first_difference.hpp"

namespace pkm::fuzz {
namespace {

constexpr std::int64_t kMaxEvaluations = 100;  ///< larger studies are not resumed

const Catalogues& catalogues() {
  static const Catalogues all = all_catalogues();
  return all;
}

/// Temporary folder, in memory if possible: each input is written to a file.
class Folder {
 public:
  Folder() {
    const bool memory = std::filesystem::exists("/dev/shm");
    std::string name = (memory ? "/dev/shm" : std::filesystem::temp_directory_path().string()) + "/pkmopt-fuzz-XXXXXX";
    expect(mkdtemp(name.data()) != nullptr, "a temporary folder");
    path_ = name;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

void list(const StudyContents& contents) {
  for (const auto& [name, table] : study_tables(contents)) expect(!table.text().empty(), name + " has a text");
}

void write_again(const StudyContents& contents, const std::string& path) {
  write_study(path, contents);
  const std::string difference = first_difference(read_study(path), contents);
  expect(difference.empty(), "a written file is read with the same contents, but: " + difference);
}

void choose_designs(const StudyContents& contents, const Study& study) {
  std::vector<DesignChoice> choices(4);
  choices[1].baseline = true;
  choices[2].generation = 1;
  choices[2].individual = 1;
  choices[3].front = 1;
  for (const DesignChoice& choice : choices) try {
      chosen_design(contents, study, choice);
    } catch (const ConfigError& error) {
      expect_sentence(error.what(), "");
    }
}

bool is_short(const Study& study) {
  if (!study.problem->parts().plan.columns()) return false;
  std::int64_t evaluations = 0;
  for (const Stage& stage : study.stages) {
    const std::int64_t limit = stage.optimiser->evaluation_limit(*study.problem);
    if (limit > kMaxEvaluations) return false;
    evaluations += limit;
  }
  return evaluations <= kMaxEvaluations;
}

void use(const StudyContents& contents, const std::string& path, const std::string& other, std::size_t choice) {
  switch (choice % 4) {
    case 0:
      return expect_program({"show", path}, catalogues());
    case 1:
      return expect_program({"show", path, "--json"}, catalogues());
    case 2:
      list(contents);
      return write_again(contents, other);
    default: {
      const Study study = study_of(contents, catalogues());
      choose_designs(contents, study);
      if (is_short(study)) expect_program({"resume", path, "--threads", "1"}, catalogues());
    }
  }
}

}  // namespace
}  // namespace pkm::fuzz

/// Disables the free lists of HDF5, so that the sanitizer detects use after free and reports no leak after each input.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  H5set_free_list_limits(0, 0, 0, 0, 0, 0);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pkm;
  using namespace pkm::fuzz;
  static const Folder folder;
  const std::string path = folder / "study.h5", bytes(reinterpret_cast<const char*>(data), size);
  std::ofstream(path, std::ios::binary) << bytes;
  try {
    const StudyContents contents = read_study(path);
    expect(!has_external_references(bytes), "a study that is read is self-contained");
    use(contents, path, folder / "again.h5", std::hash<std::string>{}(bytes));
  } catch (const ConfigError& error) {
    expect_sentence(error.what(), "");
  } catch (const StorageError& error) {
    expect_sentence(error.what(), "");
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  const std::string changed = pkm::fuzz::mutated_study({reinterpret_cast<const char*>(data), size}, seed);
  if (changed.size() > most) return size;
  std::memcpy(data, changed.data(), changed.size());
  return changed.size();
}
