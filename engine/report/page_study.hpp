// A study as a page is given it.
#pragma once

#include <optional>
#include <string>

#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

struct PageStudy {
  std::string file;             ///< as it is called
  StudyContents contents;       ///< all that the file holds
  std::optional<Study> study;   ///< built from the text in the file; none: this program cannot read it ...
  std::string unreadable = {};  ///< ... and why
};

}  // namespace pkm
