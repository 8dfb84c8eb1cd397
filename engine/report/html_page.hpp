// `pkmopt report`: one HTML file that shows what studies found, opens from disk and asks no network for anything.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/report/views.hpp"

namespace pkm {

/// The page's data: {"program": .., "studies": [..]}, a study having the sections that it has something for.
/// @param program  what made it, "pkmopt 0.1.0 (a1b2c3d)"
std::string page_data(const std::vector<PageStudy>& studies, const std::string& program);

/// The same of one design, without a study: {"program": .., "studies": [one with the sections on the design]}.
std::string page_data(const Views& views, const std::string& program);

/// The page without data, as it lies in engine/report/page/: what the build has put into the library.
struct PageParts {
  std::string_view html;  ///< with marks where the others and the data belong
  std::string_view style;
  std::string_view script;
  std::string_view plotly;
};
/// Throws std::runtime_error with a sentence where the library was built without them.
PageParts page_parts();

/// The page around its data. Throws as page_parts() does.
std::string html_page(const std::string& data);

}  // namespace pkm
