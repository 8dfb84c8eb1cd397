// Output filter that escapes control characters, so that names of files and studies from untrusted sources cannot
// inject escape sequences into a terminal.
#pragma once

#include <functional>
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace pkm {

/// While an instance exists, control characters written to a stream are escaped, except for line feeds and tabs. (Text
/// that must not contain line feeds is escaped where it is printed.)
class PrintableStream : private std::streambuf {
 public:
  using Style = std::function<std::string(std::string_view lines)>;

  /// @param style  adds colours and line breaks to whole lines, after escaping; if given, output is buffered until the
  ///               stream is flushed
  explicit PrintableStream(std::ostream& stream, Style style = {});
  ~PrintableStream() override;
  PrintableStream(const PrintableStream&) = delete;
  PrintableStream& operator=(const PrintableStream&) = delete;

 private:
  std::streamsize xsputn(const char* text, std::streamsize size) override;
  int_type overflow(int_type c) override;
  int sync() override;
  bool escape_received(std::size_t size);
  bool write_escaped(std::size_t size);
  bool write(const std::string& text);

  std::ostream& stream_;
  std::streambuf* sink_;
  Style style_;
  /// Bytes that are not yet escaped: the beginning of a UTF-8 character whose other bytes have not been received.
  std::string received_;
  std::string escaped_;  ///< escaped text, buffered until the next flush
};

}  // namespace pkm
