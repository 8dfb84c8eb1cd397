// Reference of all keys of studies, mechanism files, motion files and motor files in Markdown, generated from the
// descriptions by which the files are read.
#pragma once

#include <string>

namespace pkm {

/// The content of docs/reference/keys.md.
std::string keys_markdown();

}  // namespace pkm
