// Text in XML files: SVG, URDF and VTK.
#pragma once

#include <string>

namespace pkm {

/// Escapes text for an element or an attribute of XML.
std::string xml_text(const std::string& text);

}  // namespace pkm
