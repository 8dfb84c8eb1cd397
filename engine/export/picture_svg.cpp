#include "engine/core/formatted.hpp"
#include "engine/export/picture.hpp"
#include "engine/export/xml_text.hpp"

namespace pkm {
namespace {

std::string pixels(double value) { return formatted("%.2f", value); }

std::string text_element(const Picture::Text& text) {
  const std::string x = pixels(text.x), y = pixels(text.y);
  std::string style;
  if (text.anchor == Picture::Anchor::middle) style += " text-anchor=\"middle\"";
  if (text.anchor == Picture::Anchor::end) style += " text-anchor=\"end\"";
  if (text.bold) style += " font-weight=\"bold\"";
  if (text.vertical) style += " transform=\"rotate(-90 " + x + " " + y + ")\"";
  return "<text x=\"" + x + "\" y=\"" + y + "\"" + style + ">" + xml_text(text.content) + "</text>\n";
}

}  // namespace

std::string svg_file(const Picture& picture) {
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + pixels(picture.width) + "\" height=\"" +
                    pixels(picture.height) +
                    "\" font-family=\"sans-serif\" font-size=\"13\">\n<style>.grid { stroke: #ddd }</style>\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  for (const Picture::Line& line : picture.grid)
    svg += "<path class=\"grid\" d=\"M" + pixels(line.x1) + " " + pixels(line.y1) + "L" + pixels(line.x2) + " " +
           pixels(line.y2) + "\"/>\n";
  for (const Picture::Text& text : picture.texts) svg += text_element(text);
  svg += "<path class=\"outline\" fill=\"#4a7fb5\" fill-opacity=\"0.45\" fill-rule=\"evenodd\" stroke=\"#1f4e79\" d=\"";
  for (const SliceOutline::Loop& loop : picture.outline) {
    for (std::size_t k = 0; k < loop.size(); ++k)
      svg += (k == 0 ? "M" : "L") + pixels(loop[k][0]) + " " + pixels(loop[k][1]);
    svg += "Z";
  }
  const auto& [left, top, width, height] = picture.frame;
  return svg + "\"/>\n<rect x=\"" + pixels(left) + "\" y=\"" + pixels(top) + "\" width=\"" + pixels(width) +
         "\" height=\"" + pixels(height) + "\" fill=\"none\" stroke=\"#222\"/>\n</svg>\n";
}

}  // namespace pkm
