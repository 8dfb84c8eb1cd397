// RAII wrappers of the HDF5 C library, shared by reader and writer: identifiers, errors as exceptions, data types.
// hdf5.h is included in .cpp files only; here its identifiers (hid_t) are std::int64_t and its results (herr_t) int,
// negative on failure.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "engine/storage/hdf5_image.hpp"

namespace pkm::hdf5 {

/// While an instance exists, HDF5 does not print its errors.
class ErrorPrintingOff {
 public:
  ErrorPrintingOff();
  ~ErrorPrintingOff();
  ErrorPrintingOff(const ErrorPrintingOff&) = delete;
  ErrorPrintingOff& operator=(const ErrorPrintingOff&) = delete;

 private:
  int (*handler_)(std::int64_t, void*) = nullptr;
  void* data_ = nullptr;
};

/// Throws ImageError with the innermost message of HDF5's error stack.
/// @param what  the object that was being accessed, for the message
[[noreturn]] void fail(const std::string& what);
/// Throws ImageError if the result of an HDF5 call indicates a failure.
inline void check(int result, const std::string& what) {
  if (result < 0) fail(what);
}

/// Owner of an HDF5 identifier, which it releases. An identifier that is not released would keep the file open.
class Handle {
 public:
  /// Throws ImageError if `id` is negative.
  /// @param close  the HDF5 function that releases the identifier
  /// @param what   the object that the identifier refers to, for messages
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

/// The HDF5 identifiers of one data type: of the values in the file and of the values in memory.
struct TypePair {
  std::int64_t file, memory;
};
/// The data type of numbers of type T, which are little-endian in the file on every machine.
/// T: double, float, std::int64_t, std::uint64_t or std::uint8_t
template <class T>
TypePair number_type();
/// Data type of text attributes: UTF-8 of variable length, which the Python package h5py returns as str.
Handle attribute_text_type();

/// Access properties for a file that is kept in memory and never written to disk (core driver of HDF5).
Handle access_in_memory(const std::string& what);
/// Creates a new name for a file in memory. HDF5 treats two open files in memory with the same name as one file, so
/// that two threads would read each other's data.
std::string new_name_in_memory();

/// Throws ImageError with the message that the extent of a dataset differs from the expected one.
[[noreturn]] void throw_size_mismatch(const Leaf& leaf, const Extent& present, const Extent& expected);

}  // namespace pkm::hdf5
