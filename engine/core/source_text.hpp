// Source text written by a user, with the name of its file for error messages.
#pragma once

#include <string>

namespace pkm {

struct SourceText {
  std::string text;
  std::string file_name;  ///< as shown in error messages
};

}  // namespace pkm
