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

/// Exception for a failed HDF5 call or an invalid file image. The message begins with the path of the object:
/// "/stages/1/evaluations/design: ...".
class ImageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Description of a dataset: its path, and the metadata that are stored as its attributes.
struct Leaf {
  std::string path;
  std::string description;
  /// One unit for all values, or one unit for each column.
  std::vector<std::string> units = std::vector<std::string>(1, "1");
  /// Names of the columns, i.e. of the indices of the last dimension; empty: unnamed.
  std::vector<std::string> columns = {};
};

/// Sizes of the dimensions of a dataset, the one that varies slowest first; {}: a scalar.
using Extent = std::vector<std::size_t>;
/// Value of the first size of an Extent for datasets with any number of rows, which then follows from the number of
/// values.
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
  /// Writes a dataset: chunked, extensible along the first dimension, and compressed by the filters shuffle and
  /// deflate. A scalar is stored contiguously instead.
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
  /// Checks that a group exists. Throws ImageError if it does not.
  void group(const std::string& path, const std::string& description) const;
  bool has(const std::string& path) const;
  /// @return number of groups and datasets directly in the group
  std::size_t members(const std::string& group) const;
  int schema() const { return schema_; }
  template <class T>
  void attribute(const std::string& group, const std::string& name, T& value) const;
  /// Reads a dataset into `values`. Throws ImageError if it does not have the expected extent.
  /// @param extent  extent that the dataset must have; a first size of kAnyRows accepts any number of rows
  template <class T>
  void array(const Leaf& leaf, std::vector<T>& values, const Extent& extent) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
  int schema_;
};

}  // namespace pkm
