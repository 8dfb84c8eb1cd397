// Writer and reader of HDF5 file images, i.e. complete HDF5 files in memory. Private to the engine.
//
// HDF5 works in memory only (its core driver), so that it never encounters a full disk, a lock or a partially written
// file, and all its errors are caused by the data. The bytes are written to disk by write_file(), see safe_file.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace pkm {

/// An HDF5 call failed, or a file image is invalid. The message begins with the path of the object:
/// "/stages/1/evaluations/design: ...".
class ImageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A dataset: its path and the metadata that is stored as its attributes.
struct Leaf {
  std::string path;
  std::string description;
  std::vector<std::string> units = std::vector<std::string>(1, "1");  ///< one for all values, or one per column
  std::vector<std::string> columns = {};  ///< names along the last dimension; empty: unnamed
};

/// Sizes of the dimensions of a dataset, slowest first; {}: a scalar.
using Extent = std::vector<std::size_t>;
/// First size of an Extent that stands for any number of rows: the number of values determines it.
inline constexpr std::size_t kAnyRows = static_cast<std::size_t>(-1);

/// Builds a file image. All functions throw ImageError.
/// Element types T of arrays: double, float, std::int64_t, std::uint8_t or std::string; of attributes: std::string,
/// double, std::int64_t, std::uint64_t or bool.
class ImageWriter {
 public:
  static constexpr bool kReads = false;

  /// @param user_block  size of the user block, the zero bytes in front of the HDF5 data: 0, or 512 times a power of
  /// two
  explicit ImageWriter(std::size_t user_block);
  ~ImageWriter();
  void group(const std::string& path, const std::string& description);
  template <class T>
  void attribute(const std::string& group, const std::string& name, const T& value);
  /// Writes a one-dimensional attribute. T: double or std::int64_t
  template <class T>
  void list_attribute(const std::string& group, const std::string& name, const std::vector<T>& values);
  /// Writes a text attribute as ASCII of fixed length, as the VTKHDF format requires.
  void ascii_attribute(const std::string& group, const std::string& name, const std::string& text);
  /// Writes a dataset: chunked, extensible along the first dimension, with the shuffle and deflate filters; a scalar is
  /// stored contiguously.
  template <class T>
  void array(const Leaf& leaf, const std::vector<T>& values, const Extent& extent);
  /// @return the bytes of the complete file. Must be the last call.
  std::string finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Reads a file image that ImageWriter could have written. Throws ImageError for everything else that HDF5 allows: soft
/// and external links, values in other files, unexpected types, sizes that exceed the data in the file.
class ImageReader {
 public:
  static constexpr bool kReads = true;

  /// @param schema  schema version of the file, as schema() returns it
  ImageReader(const std::string& file, int schema);
  ~ImageReader();
  /// Throws ImageError if the group does not exist.
  void group(const std::string& path, const std::string& description) const;
  bool has(const std::string& path) const;
  /// @return number of groups and datasets directly in the group
  std::size_t members(const std::string& group) const;
  int schema() const { return schema_; }
  template <class T>
  void attribute(const std::string& group, const std::string& name, T& value) const;
  /// @param extent  required extent; a first size of kAnyRows accepts any number of rows
  template <class T>
  void array(const Leaf& leaf, std::vector<T>& values, const Extent& extent) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
  int schema_;
};

}  // namespace pkm
