#include "experiments/app/printable_stream.hpp"

#include <utility>

#include "engine/core/printable.hpp"

namespace pkm {

PrintableStream::PrintableStream(std::ostream& stream, Style style)
    : stream_(stream), sink_(stream.rdbuf()), style_(std::move(style)) {
  stream.rdbuf(this);
}

PrintableStream::~PrintableStream() {
  const auto state = stream_.rdstate();
  escape_received(received_.size());
  write_escaped(escaped_.size());
  stream_.rdbuf(sink_);  // restores the previous buffer; this also clears the error state
  stream_.setstate(state);
}

bool PrintableStream::write(const std::string& text) {
  const auto length = static_cast<std::streamsize>(text.size());
  return sink_->sputn(text.data(), length) == length;
}

/// Escapes the first `size` bytes of received_, and writes them, unless they have to be buffered for `style_`.
bool PrintableStream::escape_received(std::size_t size) {
  const std::string shown = printable(std::string_view(received_).substr(0, size), "\n\t");
  received_.erase(0, size);
  if (!style_) return write(shown);
  escaped_ += shown;
  return true;
}

/// Writes the first `size` bytes of escaped_, after style_ has added colours and line breaks.
bool PrintableStream::write_escaped(std::size_t size) {
  if (size == 0) return true;
  const std::string shown = style_(std::string_view(escaped_).substr(0, size));
  escaped_.erase(0, size);
  return write(shown);
}

std::streamsize PrintableStream::xsputn(const char* text, std::streamsize size) {
  received_.append(text, static_cast<std::size_t>(size));
  return escape_received(received_.size() - incomplete_character_size(received_)) ? size : 0;
}

PrintableStream::int_type PrintableStream::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char byte = traits_type::to_char_type(c);
  return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
}

int PrintableStream::sync() {
  const bool written = write_escaped(escaped_.rfind('\n') + 1);  // only complete lines are written
  return sink_->pubsync() == 0 && written ? 0 : -1;
}

}  // namespace pkm
