#include "engine/export/stroke_font.hpp"

#include <algorithm>
#include <iterator>

namespace pkm {
namespace {

// Lengths in units of the font: y of the baseline, space between letters, space between words.
constexpr double kBaseline = 6, kGap = 2, kSpace = 3;

// Strokes of the characters from '!' to '~'. Each string is a list of polylines, separated by '|'. Each point has one
// digit for x and one for y (downwards). Capital letters extend from y = 0 to 6, small letters from y = 2, descenders
// to y = 8.
constexpr std::string_view kLetters[] = {
    "00 04|06",                                         // !
    "00 02|20 22",                                      // "
    "10 16|30 36|02 42|04 44",                          // #
    "41 30 10 01 02 13 33 44 45 36 16 05|20 26",        // $
    "40 06|00 10 11 01 00|35 45 46 36 35",              // %
    "46 11 10 20 21 03 05 16 26 44",                    // &
    "00 02",                                            // '
    "10 02 04 16",                                      // (
    "00 12 14 06",                                      // )
    "20 24|01 43|41 03",                                // *
    "21 25|03 43",                                      // +
    "15 16 07",                                         // ,
    "03 33",                                            // -
    "06",                                               // .
    "40 06",                                            // /
    "10 30 41 45 36 16 05 01 10",                       // 0
    "01 20 26|06 46",                                   // 1
    "01 10 30 41 42 06 46",                             // 2
    "01 10 30 41 42 33 44 45 36 16 05|13 33",           // 3
    "36 30 04 44",                                      // 4
    "40 00 02 32 43 45 36 16 05",                       // 5
    "41 30 10 01 05 16 36 45 44 33 13 04",              // 6
    "00 40 16",                                         // 7
    "13 33 42 41 30 10 01 02 13 04 05 16 36 45 44 33",  // 8
    "05 16 36 45 41 30 10 01 02 13 33 42",              // 9
    "03|06",                                            // :
    "13|15 16 07",                                      // ;
    "31 03 35",                                         // <
    "02 42|04 44",                                      // =
    "01 33 05",                                         // >
    "01 10 30 41 42 23 24|26",                          // ?
    "35 24 22 33 34 35 44 41 30 10 01 05 16 36",        // @
    "06 20 46|14 34",                                   // A
    "00 06 36 45 44 33 03|33 42 41 30 00",              // B
    "41 30 10 01 05 16 36 45",                          // C
    "00 06 26 44 42 20 00",                             // D
    "40 00 06 46|03 33",                                // E
    "40 00 06|03 33",                                   // F
    "41 30 10 01 05 16 36 45 43 23",                    // G
    "00 06|40 46|03 43",                                // H
    "00 06",                                            // I
    "30 35 26 16 05",                                   // J
    "00 06|40 03 46",                                   // K
    "00 06 46",                                         // L
    "06 00 23 40 46",                                   // M
    "06 00 46 40",                                      // N
    "10 30 41 45 36 16 05 01 10",                       // O
    "06 00 30 41 42 33 03",                             // P
    "10 30 41 45 36 16 05 01 10|34 47",                 // Q
    "06 00 30 41 42 33 03|13 46",                       // R
    "41 30 10 01 02 13 33 44 45 36 16 05",              // S
    "00 40|20 26",                                      // T
    "00 05 16 36 45 40",                                // U
    "00 26 40",                                         // V
    "00 16 22 36 40",                                   // W
    "00 46|40 06",                                      // X
    "00 23 40|23 26",                                   // Y
    "00 40 06 46",                                      // Z
    "10 00 07 17",                                      // [
    "00 46",                                            // backslash
    "00 10 17 07",                                      // ]
    "02 20 42",                                         // ^
    "07 47",                                            // _
    "00 11",                                            // `
    "33 22 12 03 05 16 26 35|32 36",                    // a
    "00 06|05 16 26 35 33 22 12 03",                    // b
    "33 22 12 03 05 16 26 35",                          // c
    "30 36|35 26 16 05 03 12 22 33",                    // d
    "04 34 33 22 12 03 05 16 26 35",                    // e
    "30 20 11 16|02 22",                                // f
    "32 37 28 18 07|35 26 16 05 03 12 22 33",           // g
    "00 06|03 12 22 33 36",                             // h
    "00|02 06",                                         // i
    "10|12 17 08",                                      // j
    "00 06|32 04 36",                                   // k
    "00 06",                                            // l
    "02 06|03 12 23 26|23 32 43 46",                    // m
    "02 06|03 12 22 33 36",                             // n
    "12 22 33 35 26 16 05 03 12",                       // o
    "02 08|03 12 22 33 35 26 16 05",                    // p
    "32 38|33 22 12 03 05 16 26 35",                    // q
    "02 06|03 12 22",                                   // r
    "32 12 03 14 24 35 26 06",                          // s
    "10 15 26|02 22",                                   // t
    "02 05 16 26 35|32 36",                             // u
    "02 26 42",                                         // v
    "02 16 23 36 42",                                   // w
    "02 36|32 06",                                      // x
    "02 26|42 18 08",                                   // y
    "02 32 06 36",                                      // z
    "20 11 12 03 14 15 26",                             // {
    "00 07",                                            // |
    "00 11 12 23 14 15 06",                             // }
    "04 13 33 42",                                      // ~
};
static_assert(std::size(kLetters) == '~' - '!' + 1);

/// Appends the strokes of a letter to the text.
void add(std::string_view letter, TextStrokes& text) {
  double widest = 0;
  bool begun = false;
  std::array<double, 2> last{};
  for (std::size_t i = 0; i + 1 < letter.size(); i += 3) {  // each point takes two digits, followed by a space or a bar
    const double x = letter[i] - '0', y = letter[i + 1] - '0' - kBaseline;
    const bool ends = i + 2 >= letter.size() || letter[i + 2] == '|';
    widest = std::max(widest, x);
    const std::array<double, 2> point = {text.width + x, y};
    if (begun)
      text.strokes.push_back({last[0], last[1], point[0], point[1]});
    else if (ends)
      text.strokes.push_back({point[0], point[1], point[0], point[1]});
    last = point;
    begun = !ends;
  }
  text.width += widest + kGap;
}

}  // namespace

TextStrokes text_strokes(std::string_view text) {
  TextStrokes found;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xC0U) == 0x80U) continue;  // continuation byte of a UTF-8 character
    if (c == ' ')
      found.width += kSpace;
    else
      add(kLetters[(c > ' ' && c <= '~' ? c : '?') - '!'], found);
  }
  return found;
}

}  // namespace pkm
