#include "experiments/app/printable_stream.hpp"

#include "engine/core/printable.hpp"

namespace pkm {

PrintableStream::PrintableStream(std::ostream& stream) : stream_(stream), sink_(stream.rdbuf()) { stream.rdbuf(this); }

PrintableStream::~PrintableStream() {
  const auto state = stream_.rdstate();
  pass(begun_.size());
  stream_.rdbuf(sink_);  // clears the state
  stream_.setstate(state);
}

/// Hands on the first bytes of what has come.
bool PrintableStream::pass(std::size_t size) {
  const std::string shown = printable(std::string_view(begun_).substr(0, size), "\n\t");
  begun_.erase(0, size);
  const auto length = static_cast<std::streamsize>(shown.size());
  return sink_->sputn(shown.data(), length) == length;
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

int PrintableStream::sync() { return sink_->pubsync(); }

}  // namespace pkm
