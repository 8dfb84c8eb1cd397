#include "engine/report/html_page.hpp"

#include <nlohmann/json.hpp>

#include "engine/report/json_text.hpp"
#include "engine/report/page_parts.hpp"
#include "engine/report/sections.hpp"

namespace pkm {
namespace {

std::string quoted(const std::string& text) { return json_text(nlohmann::json(text)); }

using Sections = std::vector<std::pair<std::string, std::string>>;

void add_views(const Views& views, Sections& sections) {
  sections.insert(sections.end(), {{"workspace", workspace_data(views)},
                                   {"mechanism", mechanism_data(views)},
                                   {"coupling", coupling_data(views)},
                                   {"motions", motions_data(views)}});
}

std::string study_data(const PageStudy& page) {
  const StudyContents& contents = page.contents;
  Sections sections = {{"name", quoted(contents.name)},
                       {"file", quoted(page.file)},
                       {"problem", problem_data(page)},
                       {"summary", summary_data(page)},
                       {"convergence", convergence_data(contents)},
                       {"populations", populations_data(contents)},
                       {"front", front_data(contents)}};
  if (page.study)
    add_views(views_of(page), sections);
  else
    sections.emplace_back("workspace", workspace_data(contents));
  return json_object(sections);
}

}  // namespace

std::string page_data(const std::vector<PageStudy>& studies, const std::string& program) {
  std::string list;
  for (const PageStudy& page : studies) list += (list.empty() ? "" : ",") + study_data(page);
  return json_object({{"program", quoted(program)}, {"studies", '[' + list + ']'}});
}

std::string page_data(const Views& views, const std::string& program) {
  Sections sections = {{"name", quoted(views.mechanism.info().name + ", " + views.designs.front().name)},
                       {"file", quoted("")},
                       {"design", design_data(views)}};
  add_views(views, sections);
  return json_object({{"program", quoted(program)}, {"studies", '[' + json_object(sections) + ']'}});
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
