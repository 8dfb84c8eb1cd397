// Source text written by a user, with the name of its file for error messages.
#pragma once

#include <string>

namespace pkm {

struct SourceText {
  std::string text;
  std::string file_name;  ///< name of the file, as it is shown in error messages
};

}  // namespace pkm
