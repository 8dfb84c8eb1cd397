// A text that a user wrote, and the file it was read from.
#pragma once

#include <string>

namespace pkm {

struct SourceText {
  std::string text;
  std::string file_name;  ///< as messages call it
};

}  // namespace pkm
