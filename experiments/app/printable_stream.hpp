// What a program prints, printable: names of files and of studies, which may be another's, do not steer a terminal.
#pragma once

#include <functional>
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace pkm {

/// While it lives, what goes to a stream arrives there with its control characters escaped, all but line feeds and
/// tabs. Text that must stay on its line is escaped where it is printed.
class PrintableStream : private std::streambuf {
 public:
  using Paint = std::function<std::string(std::string_view lines)>;

  /// @param paint  what whole lines that are printable look like; they are then held back until the stream is flushed
  explicit PrintableStream(std::ostream& stream, Paint paint = {});
  ~PrintableStream() override;
  PrintableStream(const PrintableStream&) = delete;
  PrintableStream& operator=(const PrintableStream&) = delete;

 private:
  std::streamsize xsputn(const char* text, std::streamsize size) override;
  int_type overflow(int_type c) override;
  int sync() override;
  bool pass(std::size_t size);
  bool pass_painted(std::size_t size);
  bool hand_on(const std::string& text);

  std::ostream& stream_;
  std::streambuf* sink_;
  Paint paint_;
  std::string begun_;      ///< what has come and is not handed on: bytes of a character whose end is still to come
  std::string unpainted_;  ///< printable text that is held back
};

}  // namespace pkm
