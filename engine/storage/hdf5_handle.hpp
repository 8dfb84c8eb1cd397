// What writing and reading of HDF5 files share: ids that are given back, errors as exceptions, types. Without HDF5's
// own header, which stays in sources: its ids are std::int64_t, its results int, negative for a failure.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "engine/storage/hdf5_image.hpp"

namespace pkm::hdf5 {

/// While one lives, HDF5 prints nothing.
class QuietErrors {
 public:
  QuietErrors();
  ~QuietErrors();
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  int (*print_)(std::int64_t, void*) = nullptr;
  void* data_ = nullptr;
};

/// Throws ImageError: what could not be done, and why by HDF5.
[[noreturn]] void fail(const std::string& what);
/// Fails where HDF5 has.
inline void check(int result, const std::string& what) {
  if (result < 0) fail(what);
}

/// Owns one HDF5 id: a leaked one would keep the file open.
class Handle {
 public:
  Handle(std::int64_t id, int (*close)(std::int64_t), const std::string& what) : id_(id), close_(close) {
    if (id < 0) fail(what);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle& operator=(Handle&&) = delete;
  std::int64_t get() const { return id_; }

 private:
  std::int64_t id_;
  int (*close_)(std::int64_t);
};

/// A type in the file, and the same in memory.
struct TypePair {
  std::int64_t file, memory;
};
/// Little-endian in the file, whatever the machine. T: double, float, std::int64_t, std::uint64_t or std::uint8_t.
template <class T>
TypePair number_type();
/// In attributes, text is UTF-8 of variable length: h5py hands it out as str.
Handle attribute_text_type();

/// How files are opened that lie in memory.
Handle access_in_memory(const std::string& what);

/// Throws ImageError: a dataset has other sizes than its leaf should.
[[noreturn]] void refuse_size(const Leaf& leaf, const Extent& present, const Extent& expected);

}  // namespace pkm::hdf5
