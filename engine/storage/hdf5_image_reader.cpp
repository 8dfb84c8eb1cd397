// Reads an HDF5 file image from memory. The file may be malicious: every type, size and link is validated before use.
#include <hdf5.h>

#include <algorithm>
#include <type_traits>

#include "engine/storage/hdf5_handle.hpp"
#include "engine/storage/hdf5_image.hpp"

namespace pkm {
namespace {

using namespace hdf5;

Handle open_image(const std::string& file) {
  const std::string what = "the HDF5 data";
  const Handle access = access_in_memory(what);
  // HDF5 copies the bytes; it does not modify them.
  check(H5Pset_file_image(access.get(), const_cast<char*>(file.data()), file.size()), what);
  return {H5Fopen(new_name_in_memory().c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose, what};
}

std::size_t text_length(hid_t type, const std::string& what) {
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0)
    throw ImageError(what + ": is not text of fixed length");
  return H5Tget_size(type);
}

std::string read_text(hid_t attribute, const std::string& what) {
  const Handle stored(H5Aget_type(attribute), H5Tclose, what);
  if (H5Tis_variable_str(stored.get()) <= 0) throw ImageError(what + ": is not text of variable length");
  const Handle type = attribute_text_type();
  char* pointer = nullptr;
  check(H5Aread(attribute, type.get(), &pointer), what);
  std::string text = pointer ? pointer : "";
  H5free_memory(pointer);
  return text;
}

/// Throws ImageError unless the values of a dataset are stored as ImageWriter stores them: in this file, chunked,
/// contiguous or compact, without filters other than shuffle and deflate.
void check_storage(hid_t dataset, const std::string& what) {
  const Handle properties(H5Dget_create_plist(dataset), H5Pclose, what);
  const H5D_layout_t layout = H5Pget_layout(properties.get());
  if (layout != H5D_CHUNKED && layout != H5D_CONTIGUOUS && layout != H5D_COMPACT)
    throw ImageError(what + ": is a virtual dataset");
  if (H5Pget_external_count(properties.get()) != 0) throw ImageError(what + ": has its values in another file");
  for (int i = 0; i < H5Pget_nfilters(properties.get()); ++i) {
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(properties.get(), static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, &config);
    if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE)
      throw ImageError(what + ": is compressed by a filter that pkmopt does not use");
  }
}

/// Size in bytes of the values of a dataset in memory. Throws ImageError if deflate cannot have compressed so many
/// values into the stored bytes, so that a forged extent cannot cause a huge allocation.
std::size_t checked_size(hid_t dataset, const Extent& extent, std::size_t value_bytes, const std::string& what) {
  constexpr std::size_t kMaxCompressionRatio = 1032;  // largest ratio that deflate can achieve
  if (std::ranges::find(extent, std::size_t{0}) != extent.end()) return 0;
  const std::size_t max_bytes = H5Dget_storage_size(dataset) * kMaxCompressionRatio;
  std::size_t bytes = value_bytes;
  for (const std::size_t size : extent) {
    if (bytes > max_bytes / size) throw ImageError(what + ": declares more values than the file contains");
    bytes *= size;
  }
  return bytes;
}

/// Throws ImageError if a type is of another class (integer, float) than expected. Other widths and byte orders, as
/// other programs may have written them, are allowed, because HDF5 converts them.
void check_type(hid_t stored, hid_t expected, const std::string& what) {
  if (H5Tget_class(stored) != H5Tget_class(expected)) throw ImageError(what + ": has values of another type");
}

/// Throws ImageError if any object of the file, even one that only other programs read, is a soft or external link or
/// stores its values elsewhere: soft links can form a cycle, external ones expose other files.
void reject_links_and_external_data(hid_t file) {
  struct Visited {
    std::vector<std::string> paths;
    std::string link;
  } visited;
  const auto visit = [](hid_t, const char* name, const H5L_info_t* info, void* data) -> herr_t {
    const bool is_hard = info->type == H5L_TYPE_HARD;
    try {
      Visited& result = *static_cast<Visited*>(data);
      (is_hard ? result.paths.emplace_back() : result.link) = std::string("/") + name;
    } catch (...) {  // an exception must not propagate through C code
      return -1;
    }
    return is_hard ? 0 : 1;
  };
  check(H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit, &visited), "/");
  if (!visited.link.empty()) throw ImageError(visited.link + ": is a soft or external link");
  for (const std::string& path : visited.paths) {
    H5O_info_t object;
    check(H5Oget_info_by_name(file, path.c_str(), &object, H5P_DEFAULT), path);
    if (object.type == H5O_TYPE_DATASET)
      check_storage(Handle(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, path).get(), path);
  }
}

}  // namespace

struct ImageReader::State {
  explicit State(const std::string& bytes) : file(open_image(bytes)) { reject_links_and_external_data(file.get()); }
  ErrorPrintingOff quiet;
  Handle file;
};

ImageReader::ImageReader(const std::string& file, int schema)
    : state_(std::make_unique<State>(file)), schema_(schema) {}
ImageReader::~ImageReader() = default;

void ImageReader::group(const std::string& path, const std::string&) const {
  const Handle group(H5Gopen2(state_->file.get(), path.c_str(), H5P_DEFAULT), H5Gclose, path);
}

bool ImageReader::has(const std::string& path) const {
  return H5Lexists(state_->file.get(), path.c_str(), H5P_DEFAULT) > 0;
}

std::size_t ImageReader::members(const std::string& path) const {
  H5G_info_t info;
  check(H5Gget_info_by_name(state_->file.get(), path.c_str(), &info, H5P_DEFAULT), path);
  return info.nlinks;
}

template <class T>
void ImageReader::attribute(const std::string& group, const std::string& name, T& value) const {
  const std::string what = group + "@" + name;
  const Handle attribute(H5Aopen_by_name(state_->file.get(), group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, what);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose, what);
  if (H5Sget_simple_extent_npoints(space.get()) != 1) throw ImageError(what + ": is not a single value");
  if constexpr (std::is_same_v<T, std::string>) {
    value = read_text(attribute.get(), what);
  } else {
    using Stored = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;
    Stored stored{};
    check_type(Handle(H5Aget_type(attribute.get()), H5Tclose, what).get(), number_type<Stored>().file, what);
    check(H5Aread(attribute.get(), number_type<Stored>().memory, &stored), what);
    value = static_cast<T>(stored);
  }
}

template <class T>
void ImageReader::array(const Leaf& leaf, std::vector<T>& values, const Extent& extent) const {
  const Handle dataset(H5Dopen2(state_->file.get(), leaf.path.c_str(), H5P_DEFAULT), H5Dclose, leaf.path);
  const Handle type(H5Dget_type(dataset.get()), H5Tclose, leaf.path);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose, leaf.path);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 0) fail(leaf.path);
  std::vector<hsize_t> size(static_cast<std::size_t>(rank));
  check(H5Sget_simple_extent_dims(space.get(), size.data(), nullptr), leaf.path);
  Extent expected = extent;
  if (!extent.empty() && extent[0] == kAnyRows && rank > 0) expected[0] = size[0];
  const Extent present(size.begin(), size.end());
  if (present != expected) throw_size_mismatch(leaf, present, expected);
  if constexpr (std::is_same_v<T, std::string>) {
    const std::size_t length = text_length(type.get(), leaf.path);
    std::string bytes(checked_size(dataset.get(), present, length, leaf.path), '\0');
    const std::size_t count = bytes.size() / length;
    if (count > 0) check(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), leaf.path);
    values.clear();
    for (std::size_t i = 0; i < count; ++i) {
      values.push_back(bytes.substr(i * length, length));
      values.back().erase(values.back().find_last_not_of('\0') + 1);
    }
  } else {
    check_type(type.get(), number_type<T>().file, leaf.path);
    values.resize(checked_size(dataset.get(), present, sizeof(T), leaf.path) / sizeof(T));
    if (!values.empty())
      check(H5Dread(dataset.get(), number_type<T>().memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), leaf.path);
  }
}

#define PKM_ATTRIBUTE(T) template void ImageReader::attribute(const std::string&, const std::string&, T&) const;
#define PKM_ARRAY(T) template void ImageReader::array(const Leaf&, std::vector<T>&, const Extent&) const;
PKM_ATTRIBUTE(std::string)
PKM_ATTRIBUTE(double)
PKM_ATTRIBUTE(std::int64_t)
PKM_ATTRIBUTE(std::uint64_t)
PKM_ATTRIBUTE(bool)
PKM_ARRAY(double)
PKM_ARRAY(float)
PKM_ARRAY(std::int64_t)
PKM_ARRAY(std::uint8_t)
PKM_ARRAY(std::string)
#undef PKM_ATTRIBUTE
#undef PKM_ARRAY

}  // namespace pkm
