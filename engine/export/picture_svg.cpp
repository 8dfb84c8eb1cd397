#include <cmath>

#include "engine/core/formatted.hpp"
#include "engine/export/picture.hpp"
#include "engine/export/xml_text.hpp"

namespace pkm {
namespace {

std::string pixels(double value) { return formatted("%.2f", value); }

std::string text_of(const Colour& colour) {
  std::string text = "#";
  for (const double part : colour) {
    const auto value = static_cast<unsigned>(std::lround(part));
    for (const unsigned digit : {value / 16, value % 16}) text += "0123456789abcdef"[digit];
  }
  return text;
}

std::string text_element(const Picture::Text& text) {
  const std::string x = pixels(text.x), y = pixels(text.y);
  std::string style;
  if (text.anchor == Picture::Anchor::middle) style += " text-anchor=\"middle\"";
  if (text.anchor == Picture::Anchor::end) style += " text-anchor=\"end\"";
  if (text.bold) style += " font-weight=\"bold\"";
  if (text.angle != 0) style += " transform=\"rotate(" + formatted("%.4g", -text.angle) + " " + x + " " + y + ")\"";
  const auto element = [&](const std::string& colours) {
    return "<text x=\"" + x + "\" y=\"" + y + "\"" + style + colours + ">" + xml_text(text.content) + "</text>\n";
  };
  std::string border;
  if (text.background) border = element(" class=\"border\" stroke=\"" + text_of(*text.background) + "\"");
  return border + element(text.colour == Colour{0, 0, 0} ? "" : " fill=\"" + text_of(text.colour) + "\"");
}

std::string path_data(const std::vector<PlanePoint>& points) {
  std::string data;
  for (std::size_t k = 0; k < points.size(); ++k)
    data += (k == 0 ? "M" : "L") + pixels(points[k][0]) + " " + pixels(points[k][1]);
  return data;
}

std::string path_data(const std::vector<SliceOutline::Loop>& loops) {
  std::string data;
  for (const SliceOutline::Loop& loop : loops) data += path_data(loop) + "Z";
  return data;
}

/// Text of an XML attribute; "" if the value is 1, which is the default of these attributes.
std::string attribute(const std::string& name, double value) {
  return value == 1 ? "" : " " + name + "=\"" + formatted("%.4g", value) + "\"";
}

}  // namespace

std::string svg_file(const Picture& picture) {
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + pixels(picture.width) + "\" height=\"" +
                    pixels(picture.height) +
                    "\" font-family=\"sans-serif\" font-size=\"13\">\n<style>.grid { stroke: #ddd } .border { "
                    "stroke-width: 4; stroke-linejoin: round }</style>\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  for (const Picture::Line& line : picture.grid)
    svg += "<path class=\"grid\" d=\"M" + pixels(line.x1) + " " + pixels(line.y1) + "L" + pixels(line.x2) + " " +
           pixels(line.y2) + "\"/>\n";
  for (const Picture::Area& area : picture.areas)
    svg += "<path class=\"area\" fill=\"" + text_of(area.colour) + "\"" + attribute("fill-opacity", area.opacity) +
           " fill-rule=\"evenodd\" d=\"" + path_data(area.loops) + "\"/>\n";
  for (const Picture::Polyline& line : picture.lines)
    svg += "<path class=\"line\" fill=\"none\" stroke=\"" + text_of(line.colour) + "\"" +
           attribute("stroke-width", line.width) + " d=\"" + path_data(line.points) + "\"/>\n";
  if (!picture.outline.empty())
    svg += std::string("<path class=\"outline\" fill=\"") +
           (picture.outline_is_filled ? "#4a7fb5\" fill-opacity=\"0.45\" fill-rule=\"evenodd" : "none") +
           "\" stroke=\"#1f4e79\" d=\"" + path_data(picture.outline) + "\"/>\n";
  for (const Picture::Text& text : picture.texts) svg += text_element(text);
  for (const auto& [left, top, width, height] : picture.frames)
    svg += "<rect x=\"" + pixels(left) + "\" y=\"" + pixels(top) + "\" width=\"" + pixels(width) + "\" height=\"" +
           pixels(height) + "\" fill=\"none\" stroke=\"#222\"/>\n";
  return svg + "</svg>\n";
}

}  // namespace pkm
