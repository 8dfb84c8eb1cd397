#include "experiments/app/printable_stream.hpp"

#include <utility>

#include "engine/core/printable.hpp"

namespace pkm {

PrintableStream::PrintableStream(std::ostream& stream, Paint paint)
    : stream_(stream), sink_(stream.rdbuf()), paint_(std::move(paint)) {
  stream.rdbuf(this);
}

PrintableStream::~PrintableStream() {
  const auto state = stream_.rdstate();
  pass(begun_.size());
  pass_painted(unpainted_.size());
  stream_.rdbuf(sink_);  // clears the state
  stream_.setstate(state);
}

bool PrintableStream::hand_on(const std::string& text) {
  const auto length = static_cast<std::streamsize>(text.size());
  return sink_->sputn(text.data(), length) == length;
}

/// Hands on the first bytes of what has come.
bool PrintableStream::pass(std::size_t size) {
  const std::string shown = printable(std::string_view(begun_).substr(0, size), "\n\t");
  begun_.erase(0, size);
  if (!paint_) return hand_on(shown);
  unpainted_ += shown;
  return true;
}

/// Hands on the first bytes of what is held back.
bool PrintableStream::pass_painted(std::size_t size) {
  if (size == 0) return true;
  const std::string shown = paint_(std::string_view(unpainted_).substr(0, size));
  unpainted_.erase(0, size);
  return hand_on(shown);
}

std::streamsize PrintableStream::xsputn(const char* text, std::streamsize size) {
  begun_.append(text, static_cast<std::size_t>(size));
  return pass(begun_.size() - begun_character(begun_)) ? size : 0;
}

PrintableStream::int_type PrintableStream::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char byte = traits_type::to_char_type(c);
  return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
}

int PrintableStream::sync() {
  const bool handed_on = pass_painted(unpainted_.rfind('\n') + 1);  // of a line without its end: 0
  return sink_->pubsync() == 0 && handed_on ? 0 : -1;
}

}  // namespace pkm
