// Writes the results of studies, or one design, as a self-contained HTML page with plots (`pkmopt report`). The page
// opens from disk and makes no network requests.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/report/shown_designs.hpp"
#include "engine/results/task_comparison.hpp"

namespace pkm {

/// Data of a page as JSON text: {"program": .., "studies": [..]}. Each study has one member for each panel; panels
/// without content are omitted.
/// @param program  name and version of the program, for example "pkmopt 0.1.0 (a1b2c3d)"
/// @param task     a comparison of robots in a task, which the page then shows; null: none. There may be no studies
std::string page_data(const std::vector<PageStudy>& studies, const std::string& program,
                      const TaskComparison* task = nullptr);

/// Data of a page for one design without a study. The list "studies" then has one element, with the panels of that
/// design.
std::string page_data(const ShownDesigns& shown, const std::string& program);

/// The files of engine/report/page/, which the build embeds into the library.
struct PageAssets {
  std::string_view html;  ///< template with the placeholders {{style}}, {{data}}, {{plotly}}, {{script}}
  std::string_view style;
  std::string_view script;
  std::string_view plotly;
};
/// Returns the files of the HTML page that are embedded in the library. Throws std::runtime_error if it was built
/// without them.
PageAssets page_assets();

/// Text of the complete page. Throws std::runtime_error if the library was built without the files of the page.
/// @param data  result of page_data()
std::string html_page(const std::string& data);

}  // namespace pkm
