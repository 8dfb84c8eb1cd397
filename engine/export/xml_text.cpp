#include "engine/export/xml_text.hpp"

#include "engine/core/printable.hpp"

namespace pkm {

std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : printable(text))
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return result;
}

}  // namespace pkm
