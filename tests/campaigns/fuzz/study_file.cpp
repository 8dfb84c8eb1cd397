// Input: a study file, its seal right, what is behind it changed by the mutator. What is read is shown, listed, written
// again or, where few evaluations are left of it, resumed: one of these for each input, chosen by its bytes, so that
// more inputs are tried.
#include <hdf5.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "engine/core/error.hpp"
#include "engine/report/chosen_design.hpp"
#include "engine/report/study_tables.hpp"
#include "engine/storage/study_file.hpp"
#include "engine/study/records.hpp"
#include "experiments/app/program.hpp"
#include "tests/campaigns/fuzz/capture.hpp"
#include "tests/campaigns/fuzz/expect.hpp"
#include "tests/campaigns/fuzz/study_mutator.hpp"
#include "tests/unit/storage/first_difference.hpp"

namespace pkm::fuzz {
namespace {

constexpr std::int64_t kMostEvaluations = 100;  ///< of a study that is resumed

const Catalogues& catalogues() {
  static const Catalogues all = all_catalogues();
  return all;
}

/// In memory where there is such a folder: each input is a file.
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
  expect(difference.empty(), "what is written is read again, but: " + difference);
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
    if (limit > kMostEvaluations) return false;
    evaluations += limit;
  }
  return evaluations <= kMostEvaluations;
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

/// HDF5 keeps no freed memory for itself: what it uses after that is seen, and no leak is suspected after each input.
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
    expect(!looks_elsewhere(bytes), "a study that is read holds all that it is made of");
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
