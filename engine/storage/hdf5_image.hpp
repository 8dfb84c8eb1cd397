// HDF5 files in memory: one class builds the bytes of a file, one reads them. Private to the engine.
//
// Everything happens in memory (HDF5's core driver), so HDF5 never meets a full disk, a lock or a half-written file,
// and its errors are limited to what lies in the data. Writing to disk is plain write(2), see safe_file.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace pkm {

/// What HDF5 could not do, or what a file lacks: "/stages/1/evaluations/design: ...".
class ImageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One dataset and what is written beside its values.
struct Leaf {
  std::string path;
  std::string description;
  std::vector<std::string> units = std::vector<std::string>(1, "1");  ///< one for all values, or one per column
  std::vector<std::string> columns = {};  ///< names along the last dimension; empty where it has none
};

/// Sizes of a dataset, slowest first; {} is a single value.
using Extent = std::vector<std::size_t>;
inline constexpr std::size_t kAnyRows = static_cast<std::size_t>(-1);

/// T of an array: double, float, std::int64_t, std::uint8_t or std::string; of an attribute: std::string, double,
/// std::int64_t, std::uint64_t or bool.
class ImageWriter {
 public:
  static constexpr bool kReads = false;

  /// @param user_block  bytes in front of the HDF5 data, left empty: 512 or a multiple of it, or 0
  explicit ImageWriter(std::size_t user_block);
  ~ImageWriter();
  void group(const std::string& path, const std::string& description);
  template <class T>
  void attribute(const std::string& group, const std::string& name, const T& value);
  /// A list of numbers, double or std::int64_t.
  template <class T>
  void list_attribute(const std::string& group, const std::string& name, const std::vector<T>& values);
  /// ASCII of fixed length, as some readers want it.
  void ascii_attribute(const std::string& group, const std::string& name, const std::string& text);
  /// Chunked, extensible along the first dimension, shuffled and deflated; a single value is stored as such.
  template <class T>
  void array(const Leaf& leaf, const std::vector<T>& values, const Extent& extent);
  /// The whole file. To be called last.
  std::string finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Takes what ImageWriter writes, and refuses by ImageError all else that HDF5 could read: links, values in other
/// files, other types, sizes that the file cannot hold.
class ImageReader {
 public:
  static constexpr bool kReads = true;

  /// @param schema  of the layout, for whoever describes it
  ImageReader(const std::string& file, int schema);
  ~ImageReader();
  void group(const std::string& path, const std::string& description) const;  ///< must be there
  bool has(const std::string& path) const;
  std::size_t members(const std::string& group) const;  ///< how many groups and datasets lie in it
  int schema() const { return schema_; }
  template <class T>
  void attribute(const std::string& group, const std::string& name, T& value) const;
  /// @param extent  must equal the dataset's; a first size of kAnyRows takes what is there
  template <class T>
  void array(const Leaf& leaf, std::vector<T>& values, const Extent& extent) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  int schema_;
};

}  // namespace pkm
