// Builds an HDF5 file image in memory.
#include <hdf5.h>

#include <algorithm>
#include <optional>
#include <type_traits>

#include "engine/storage/file_header.hpp"
#include "engine/storage/hdf5_handle.hpp"
#include "engine/storage/hdf5_image.hpp"

namespace pkm {
namespace {

using namespace hdf5;

constexpr std::size_t kChunkBytes = std::size_t{1} << 17;
// Smaller chunks are not compressed, because deflate allocates 256 kB for each.
constexpr std::size_t kMinDeflatedBytes = 1024;
// Maximum number of texts of an attribute: each takes 16 bytes, and HDF5 allows 64 kB.
constexpr std::size_t kMaxAttributeTexts = 4000;
// Level 1 is twice as fast as level 6, and its files are only a few per cent larger.
constexpr unsigned kDeflateLevel = 1;

/// Type of text in datasets: UTF-8 of fixed length, padded with NUL. Unlike text of variable length it is compressed
/// and stored within the dataset.
Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "text type");
  check(H5Tset_size(type.get(), std::max<std::size_t>(length, 1)), "text type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "text type");
  check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), "text type");
  return type;
}

std::size_t product(const Extent& extent) {
  std::size_t count = 1;
  for (const std::size_t size : extent) count *= size;
  return count;
}

/// Dataspace with the given extent, of which the first dimension is unlimited.
Handle make_space(const Extent& extent, const std::string& what) {
  if (extent.empty()) return {H5Screate(H5S_SCALAR), H5Sclose, what};
  const std::vector<hsize_t> size(extent.begin(), extent.end());
  std::vector<hsize_t> max_size = size;
  for (hsize_t& s : max_size) s = std::max<hsize_t>(s, 1);
  max_size[0] = H5S_UNLIMITED;
  return {H5Screate_simple(static_cast<int>(size.size()), size.data(), max_size.data()), H5Sclose, what};
}

/// Creation properties of a dataset: chunking and filters.
Handle dataset_properties(const Extent& extent, std::size_t value_bytes, const std::string& what) {
  Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  // HDF5 must not store timestamps, so that equal contents give equal bytes.
  check(H5Pset_obj_track_times(properties.get(), false), what);
  if (extent.empty()) return properties;
  std::vector<hsize_t> chunk(extent.begin(), extent.end());
  std::size_t row_bytes = value_bytes;
  for (std::size_t i = 1; i < chunk.size(); ++i) row_bytes *= chunk[i] = std::max<hsize_t>(chunk[i], 1);
  chunk[0] = std::clamp<hsize_t>(extent[0], 1, std::max<std::size_t>(kChunkBytes / row_bytes, 1));
  check(H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()), what);
  if (chunk[0] * row_bytes < kMinDeflatedBytes) return properties;
  check(H5Pset_shuffle(properties.get()), what);
  check(H5Pset_deflate(properties.get(), kDeflateLevel), what);
  return properties;
}

/// @param size  number of elements of a one-dimensional attribute; std::nullopt: a scalar
void write_attribute(hid_t object, const std::string& name, std::optional<hsize_t> size, const TypePair& type,
                     const void* data, const std::string& what) {
  const Handle space(size ? H5Screate_simple(1, &*size, nullptr) : H5Screate(H5S_SCALAR), H5Sclose, what);
  const Handle attribute(H5Acreate2(object, name.c_str(), type.file, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         what);
  check(H5Awrite(attribute.get(), type.memory, data), what);
}

void write_texts(hid_t object, const std::string& name, std::optional<hsize_t> size,
                 const std::vector<std::string>& texts, const std::string& what) {
  const Handle type = attribute_text_type();
  std::vector<const char*> pointers;
  // At least one element is allocated, because HDF5 rejects a null pointer even if there are no texts.
  pointers.reserve(texts.size() + 1);
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  write_attribute(object, name, size, {type.get(), type.get()}, pointers.data(), what);
}

void write_text(hid_t object, const std::string& name, const std::string& text, const std::string& what) {
  write_texts(object, name, {}, {text}, what);
}

Handle create_file(std::size_t user_block) {
  const std::string what = "creating a file image";
  const Handle access = access_in_memory(what);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, what);
  check(H5Pset_userblock(creation.get(), user_block), what);
  check(H5Pset_istore_k(creation.get(), 4), what);  // small index nodes, because most datasets have a single chunk
  check(H5Pset_obj_track_times(creation.get(), false), what);
  return {H5Fcreate(new_name_in_memory().c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose, what};
}

}  // namespace

struct ImageWriter::State {
  explicit State(std::size_t block) : user_block(block), file(create_file(block)) {}
  Handle object(const std::string& path, const std::string& what) const {
    return {H5Oopen(file.get(), path.c_str(), H5P_DEFAULT), H5Oclose, what};
  }
  std::size_t user_block;
  ErrorPrintingOff quiet;
  Handle file;
};

ImageWriter::ImageWriter(std::size_t user_block) : state_(std::make_unique<State>(user_block)) {}
ImageWriter::~ImageWriter() = default;

void ImageWriter::group(const std::string& path, const std::string& description) {
  const Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, path);
  check(H5Pset_obj_track_times(properties.get(), false), path);
  const hid_t file = state_->file.get();
  const Handle group(path == "/" ? H5Gopen2(file, "/", H5P_DEFAULT)
                                 : H5Gcreate2(file, path.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                     H5Gclose, path);
  write_text(group.get(), "description", description, path);
}

template <class T>
void ImageWriter::attribute(const std::string& group, const std::string& name, const T& value) {
  const std::string what = group + "@" + name;
  const Handle object = state_->object(group, what);
  if constexpr (std::is_same_v<T, std::string>) {
    write_text(object.get(), name, value, what);
  } else {
    using Stored = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;
    const auto stored = static_cast<Stored>(value);
    write_attribute(object.get(), name, {}, number_type<Stored>(), &stored, what);
  }
}

template <class T>
void ImageWriter::list_attribute(const std::string& group, const std::string& name, const std::vector<T>& values) {
  const std::string what = group + "@" + name;
  write_attribute(state_->object(group, what).get(), name, values.size(), number_type<T>(), values.data(), what);
}

void ImageWriter::ascii_attribute(const std::string& group, const std::string& name, const std::string& text) {
  const std::string what = group + "@" + name;
  const Handle type = text_type(text.size());
  check(H5Tset_cset(type.get(), H5T_CSET_ASCII), what);
  write_attribute(state_->object(group, what).get(), name, {}, {type.get(), type.get()}, text.data(), what);
}

template <class T>
void ImageWriter::array(const Leaf& leaf, const std::vector<T>& values, const Extent& requested) {
  Extent extent = requested;
  if (!extent.empty() && extent[0] == kAnyRows) extent[0] = values.size();
  if (product(extent) != values.size()) throw_size_mismatch(leaf, {values.size()}, extent);
  const hid_t file = state_->file.get();
  const Handle space = make_space(extent, leaf.path);
  const auto write = [&](const TypePair& type, std::size_t value_bytes, const void* data) {
    const Handle properties = dataset_properties(extent, value_bytes, leaf.path);
    const Handle dataset(
        H5Dcreate2(file, leaf.path.c_str(), type.file, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
        H5Dclose, leaf.path);
    if (!values.empty()) check(H5Dwrite(dataset.get(), type.memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), leaf.path);
    write_text(dataset.get(), "description", leaf.description, leaf.path);
    const auto label = [&](const std::string& name, const std::vector<std::string>& texts) {
      if (texts.size() <= kMaxAttributeTexts) return write_texts(dataset.get(), name, texts.size(), texts, leaf.path);
      const std::string list_path = leaf.path + "_" + name;
      write_text(dataset.get(), name, list_path, leaf.path);
      array(Leaf{list_path, "The attribute " + name + " of " + leaf.path}, texts, {kAnyRows});
    };
    if (!leaf.columns.empty()) label("columns", leaf.columns);
    if (leaf.columns.empty() && leaf.units.size() == 1)
      write_text(dataset.get(), "unit", leaf.units[0], leaf.path);
    else
      label("unit", leaf.units);
  };
  if constexpr (std::is_same_v<T, std::string>) {
    std::size_t length = 1;
    for (const std::string& text : values) length = std::max(length, text.size());
    std::string bytes(length * values.size(), '\0');
    for (std::size_t i = 0; i < values.size(); ++i) values[i].copy(&bytes[i * length], length);
    const Handle type = text_type(length);
    write({type.get(), type.get()}, length, bytes.data());
  } else {
    write(number_type<T>(), sizeof(T), values.data());
  }
}

std::string ImageWriter::finish() {
  const std::string what = "completing the file image";
  const hid_t file = state_->file.get();
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), what);
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size < 0) fail(what);
  const std::size_t block = state_->user_block;
  std::string bytes(block + static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file, bytes.data() + block, static_cast<std::size_t>(size)) != size) fail(what);
  // HDF5 1.10 returns the image without the user block (addresses in the file are relative to its end), later versions
  // with it.
  if (!has_hdf5_signature(bytes, block)) bytes.erase(0, block);
  return bytes;
}

#define PKM_ATTRIBUTE(T) template void ImageWriter::attribute(const std::string&, const std::string&, const T&);
#define PKM_ARRAY(T) template void ImageWriter::array(const Leaf&, const std::vector<T>&, const Extent&);
PKM_ATTRIBUTE(std::string)
PKM_ATTRIBUTE(double)
PKM_ATTRIBUTE(std::int64_t)
PKM_ATTRIBUTE(std::uint64_t)
PKM_ATTRIBUTE(bool)
template void ImageWriter::list_attribute(const std::string&, const std::string&, const std::vector<double>&);
template void ImageWriter::list_attribute(const std::string&, const std::string&, const std::vector<std::int64_t>&);
PKM_ARRAY(double)
PKM_ARRAY(float)
PKM_ARRAY(std::int64_t)
PKM_ARRAY(std::uint8_t)
PKM_ARRAY(std::string)
#undef PKM_ATTRIBUTE
#undef PKM_ARRAY

}  // namespace pkm
