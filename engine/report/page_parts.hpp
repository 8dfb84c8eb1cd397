// The page without data, as it lies in engine/report/page/: what the build has put into the library.
#pragma once

#include <string_view>

namespace pkm {

struct PageParts {
  std::string_view html;  ///< with marks where the others and the data belong
  std::string_view style;
  std::string_view script;
  std::string_view plotly;
};

/// Throws std::runtime_error with a sentence where the library was built without them.
PageParts page_parts();

}  // namespace pkm
