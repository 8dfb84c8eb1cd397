#include "engine/report/html_page.hpp"

#include <stdexcept>

#include "engine/report/sections.hpp"

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

void add(Json& study, const char* name, Json section) {
  if (!section.is_null()) study[name] = std::move(section);
}

void add_views(Json& study, const Views& views) {
  add(study, "workspace", workspace_data(views));
  add(study, "mechanism", mechanism_data(views));
  add(study, "coupling", coupling_data(views));
  add(study, "motions", motions_data(views));
}

Json study_data(const PageStudy& page) {
  const StudyContents& contents = page.contents;
  Json study = {{"name", contents.name}, {"file", page.file}};
  add(study, "problem", problem_data(page));
  add(study, "summary", summary_data(page));
  add(study, "convergence", convergence_data(contents));
  add(study, "populations", populations_data(contents));
  add(study, "front", front_data(page));
  if (page.study)
    add_views(study, views_of(page));
  else
    add(study, "workspace", workspace_data(contents));
  return study;
}

std::string text_of(Json studies, const std::string& program) {
  Json page = {{"program", program}};
  page["studies"] = std::move(studies);
  return json_text(page);
}

}  // namespace

std::string page_data(const std::vector<PageStudy>& studies, const std::string& program) {
  Json list = Json::array();
  for (const PageStudy& page : studies) list.push_back(study_data(page));
  return text_of(std::move(list), program);
}

std::string page_data(const Views& views, const std::string& program) {
  Json study = {{"name", views.mechanism.info().name + ", " + views.designs.front().name}, {"file", ""}};
  add(study, "design", design_data(views));
  add_views(study, views);
  return text_of(Json::array({std::move(study)}), program);
}

PageParts page_parts() {
#ifdef PKM_PAGE_EMBEDDED
  return {{pkm_page_html, pkm_page_html_end},
          {pkm_page_style, pkm_page_style_end},
          {pkm_page_script, pkm_page_script_end},
          {pkm_page_plotly, pkm_page_plotly_end}};
#else
  throw std::runtime_error(
      "this pkmopt was built without its page, because npm or its registry was missing or PKM_REPORT was off: with npm "
      "installed, configure and build it again");
#endif
}

std::string html_page(const std::string& data) {
  const PageParts parts = page_parts();
  const std::vector<std::pair<std::string_view, std::string_view>> marks = {
      {"{{style}}", parts.style}, {"{{data}}", data}, {"{{plotly}}", parts.plotly}, {"{{script}}", parts.script}};
  std::string page;
  std::string_view rest = parts.html;
  for (const auto& [mark, text] : marks) {  // in the order in which the page has them
    const std::size_t at = rest.find(mark);
    page.append(rest.substr(0, at)).append(text);
    rest.remove_prefix(at + mark.size());
  }
  return page.append(rest);
}

}  // namespace pkm
