#include "engine/report/page_parts.hpp"

#include <stdexcept>

#ifdef PKM_PAGE_EMBEDDED
extern "C" {
extern const char pkm_page_html[], pkm_page_html_end[];
extern const char pkm_page_style[], pkm_page_style_end[];
extern const char pkm_page_script[], pkm_page_script_end[];
extern const char pkm_page_plotly[], pkm_page_plotly_end[];
}
#endif

namespace pkm {

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

}  // namespace pkm
