#include "engine/report/html_page.hpp"

#include <stdexcept>

#include "engine/report/panels.hpp"

#ifdef PKM_PAGE_EMBEDDED
extern "C" {
extern const char pkm_page_html[], pkm_page_html_end[];
extern const char pkm_page_style[], pkm_page_style_end[];
extern const char pkm_page_script[], pkm_page_script_end[];
extern const char pkm_page_plotly[], pkm_page_plotly_end[];
}
#endif

namespace pkm {
namespace {

/// Adds the data of a panel to those of a study or of the page, unless they are null.
void add_panel(Json& to, const char* name, Json data) {
  if (!data.is_null()) to[name] = std::move(data);
}

void add_design_panels(Json& study, const ShownDesigns& shown) {
  add_panel(study, "workspace", workspace_data(shown));
  add_panel(study, "mechanism", mechanism_data(shown));
  add_panel(study, "coupling", coupling_data(shown));
  add_panel(study, "motions", motions_data(shown));
}

Json study_data(const PageStudy& page) {
  const StudyContents& contents = page.contents;
  Json study = {{"name", contents.name}, {"file", page.file}};
  add_panel(study, "problem", problem_data(page));
  add_panel(study, "summary", summary_data(page));
  add_panel(study, "convergence", convergence_data(contents));
  add_panel(study, "sweeps", sweeps_data(contents));
  add_panel(study, "populations", populations_data(contents));
  add_panel(study, "front", front_data(page));
  if (page.study)
    add_design_panels(study, evaluate_shown_designs(page));
  else
    add_panel(study, "workspace", workspace_data(contents));
  return study;
}

std::string report_text(Json studies, const std::string& program, Json task = {}) {
  Json page = {{"program", program}};
  add_panel(page, "task", std::move(task));
  page["studies"] = std::move(studies);
  return json_text(page);
}

}  // namespace

std::string page_data(const std::vector<PageStudy>& studies, const std::string& program, const TaskComparison* task) {
  Json list = Json::array();
  for (const PageStudy& page : studies) list.push_back(study_data(page));
  return report_text(std::move(list), program, task ? task_data(*task) : Json());
}

std::string page_data(const ShownDesigns& shown, const std::string& program) {
  Json study = {{"name", shown.mechanism.info().name + ", " + shown.designs.front().name}, {"file", ""}};
  add_panel(study, "design", design_data(shown));
  add_design_panels(study, shown);
  return report_text(Json::array({std::move(study)}), program);
}

PageAssets page_assets() {
#ifdef PKM_PAGE_EMBEDDED
  return {{pkm_page_html, pkm_page_html_end},
          {pkm_page_style, pkm_page_style_end},
          {pkm_page_script, pkm_page_script_end},
          {pkm_page_plotly, pkm_page_plotly_end}};
#else
  throw std::runtime_error(
      "this pkmopt was built without the report page, because npm or its registry was missing or PKM_REPORT was off; "
      "install npm, then configure and build pkmopt again");
#endif
}

std::string html_page(const std::string& data) {
  const PageAssets assets = page_assets();
  const std::vector<std::pair<std::string_view, std::string_view>> placeholders = {
      {"{{style}}", assets.style}, {"{{data}}", data}, {"{{plotly}}", assets.plotly}, {"{{script}}", assets.script}};
  std::string page;
  std::string_view rest = assets.html;
  // The list has the order in which the placeholders occur in the template.
  for (const auto& [placeholder, text] : placeholders) {
    const std::size_t at = rest.find(placeholder);
    page.append(rest.substr(0, at)).append(text);
    rest.remove_prefix(at + placeholder.size());
  }
  return page.append(rest);
}

}  // namespace pkm
