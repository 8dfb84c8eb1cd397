// The languages in which `pkmopt generate` writes code.
#pragma once

#include <string>
#include <vector>

#include "engine/mechanism/code_module.hpp"

namespace pkm::code {

/// A generated file with its name and content. The name is a path relative to the output folder.
struct File {
  std::string name, text;
};
std::vector<File> c_files(const Module& module);
std::vector<File> cpp_files(const Module& module);
std::vector<File> python_files(const Module& module);
std::vector<File> matlab_files(const Module& module);

}  // namespace pkm::code
