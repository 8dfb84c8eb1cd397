#include "engine/storage/hdf5_image.hpp"

#include <hdf5.h>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include "engine/storage/file_seal.hpp"

namespace pkm {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 17;
constexpr std::size_t kLeastDeflated = 1024;  // bytes of a chunk: to start deflate takes a quarter of a megabyte
constexpr std::size_t kGrowth = std::size_t{1} << 16;  // bytes; HDF5 clears them
constexpr std::size_t kMostInAttribute = 4000;         // texts, 16 bytes each: an attribute holds 64 kB in all
constexpr unsigned kDeflateLevel = 1;                  // twice as fast as level 6, and files are a few per cent larger

/// While one lives, HDF5 prints nothing.
class QuietErrors {
 public:
  QuietErrors() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

extern "C" herr_t take_first_error(unsigned, const H5E_error2_t* error, void* text) {
  *static_cast<std::string*>(text) = error->desc ? error->desc : "";
  return 1;  // stop
}

[[noreturn]] void fail(const std::string& what) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first_error, &reason);
  throw ImageError(what + (reason.empty() ? "" : ": " + reason));
}

void check(herr_t result, const std::string& what) {
  if (result < 0) fail(what);
}

/// Owns one HDF5 id: a leaked one would keep the file open.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    if (id < 0) fail(what);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle& operator=(Handle&&) = delete;
  hid_t get() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// A type in the file, and the same in memory.
struct TypePair {
  hid_t file, memory;
};

/// Little-endian in the file, whatever the machine.
template <class T>
TypePair number_type() {
  if constexpr (std::is_same_v<T, double>) return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE};
  if constexpr (std::is_same_v<T, float>) return {H5T_IEEE_F32LE, H5T_NATIVE_FLOAT};
  if constexpr (std::is_same_v<T, std::int64_t>) return {H5T_STD_I64LE, H5T_NATIVE_INT64};
  if constexpr (std::is_same_v<T, std::uint64_t>) return {H5T_STD_U64LE, H5T_NATIVE_UINT64};
  if constexpr (std::is_same_v<T, std::uint8_t>) return {H5T_STD_U8LE, H5T_NATIVE_UINT8};
}

/// In datasets, text is UTF-8 of fixed length, padded with NUL: it compresses and lies inside its dataset.
Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "text type");
  check(H5Tset_size(type.get(), std::max<std::size_t>(length, 1)), "text type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "text type");
  check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), "text type");
  return type;
}

std::size_t text_length(hid_t type, const std::string& what) {
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0)
    throw ImageError(what + ": is not text of fixed length");
  return H5Tget_size(type);
}

std::size_t product(const Extent& extent) {
  std::size_t count = 1;
  for (const std::size_t size : extent) count *= size;
  return count;
}

Handle make_space(const Extent& extent, const std::string& what) {
  if (extent.empty()) return {H5Screate(H5S_SCALAR), H5Sclose, what};
  const std::vector<hsize_t> size(extent.begin(), extent.end());
  std::vector<hsize_t> greatest = size;
  for (hsize_t& g : greatest) g = std::max<hsize_t>(g, 1);
  greatest[0] = H5S_UNLIMITED;
  return {H5Screate_simple(static_cast<int>(size.size()), size.data(), greatest.data()), H5Sclose, what};
}

Handle dataset_properties(const Extent& extent, std::size_t value_bytes, const std::string& what) {
  Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  check(H5Pset_obj_track_times(properties.get(), false), what);  // equal contents, equal bytes
  if (extent.empty()) return properties;
  std::vector<hsize_t> chunk(extent.begin(), extent.end());
  std::size_t row_bytes = value_bytes;
  for (std::size_t i = 1; i < chunk.size(); ++i) row_bytes *= chunk[i] = std::max<hsize_t>(chunk[i], 1);
  chunk[0] = std::clamp<hsize_t>(extent[0], 1, std::max<std::size_t>(kChunkBytes / row_bytes, 1));
  check(H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()), what);
  if (chunk[0] * row_bytes < kLeastDeflated) return properties;
  check(H5Pset_shuffle(properties.get()), what);
  check(H5Pset_deflate(properties.get(), kDeflateLevel), what);
  return properties;
}

/// @param size  of a list; none: a single value
void write_attribute(hid_t object, const std::string& name, std::optional<hsize_t> size, const TypePair& type,
                     const void* data, const std::string& what) {
  const Handle space(size ? H5Screate_simple(1, &*size, nullptr) : H5Screate(H5S_SCALAR), H5Sclose, what);
  const Handle attribute(H5Acreate2(object, name.c_str(), type.file, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         what);
  check(H5Awrite(attribute.get(), type.memory, data), what);
}

/// In attributes, text is UTF-8 of variable length: h5py hands it out as str.
Handle attribute_text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "text type");
  check(H5Tset_size(type.get(), H5T_VARIABLE), "text type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "text type");
  return type;
}

void write_texts(hid_t object, const std::string& name, std::optional<hsize_t> size,
                 const std::vector<std::string>& texts, const std::string& what) {
  const Handle type = attribute_text_type();
  std::vector<const char*> pointers;
  pointers.reserve(texts.size() + 1);  // HDF5 takes no null pointer, even for no text at all
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  write_attribute(object, name, size, {type.get(), type.get()}, pointers.data(), what);
}

void write_text(hid_t object, const std::string& name, const std::string& text, const std::string& what) {
  write_texts(object, name, {}, {text}, what);
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

Handle core_access(const std::string& what) {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, what);
  check(H5Pset_fapl_core(access.get(), kGrowth, false), what);
  check(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG), what);
  check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V110), what);
  return access;
}

Handle create_file(std::size_t user_block) {
  const std::string what = "a file in memory";
  const Handle access = core_access(what);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, what);
  check(H5Pset_userblock(creation.get(), user_block), what);
  check(H5Pset_istore_k(creation.get(), 4), what);  // small index nodes: most datasets have one chunk
  check(H5Pset_obj_track_times(creation.get(), false), what);
  return {H5Fcreate("study in memory", H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose, what};
}

Handle open_image(const std::string& file) {
  const std::string what = "the HDF5 data";
  const Handle access = core_access(what);
  // HDF5 copies the bytes.
  check(H5Pset_file_image(access.get(), const_cast<char*>(file.data()), file.size()), what);
  return {H5Fopen("study in memory", H5F_ACC_RDONLY, access.get()), H5Fclose, what};
}

std::string in_words(const Extent& extent) {
  std::string text;
  for (const std::size_t n : extent) text += (text.empty() ? "" : " x ") + std::to_string(n);
  return text.empty() ? "1" : text;
}

[[noreturn]] void refuse_size(const Leaf& leaf, const Extent& present, const Extent& expected) {
  throw ImageError(leaf.path + ": has " + in_words(present) + " values, but " + in_words(expected) + " are expected");
}

}  // namespace

struct ImageWriter::Parts {
  explicit Parts(std::size_t block) : user_block(block), file(create_file(block)) {}
  Handle object(const std::string& path, const std::string& what) const {
    return {H5Oopen(file.get(), path.c_str(), H5P_DEFAULT), H5Oclose, what};
  }
  std::size_t user_block;
  QuietErrors quiet;
  Handle file;
};

ImageWriter::ImageWriter(std::size_t user_block) : parts_(std::make_unique<Parts>(user_block)) {}
ImageWriter::~ImageWriter() = default;

void ImageWriter::group(const std::string& path, const std::string& description) {
  const Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, path);
  check(H5Pset_obj_track_times(properties.get(), false), path);
  const hid_t file = parts_->file.get();
  const Handle group(path == "/" ? H5Gopen2(file, "/", H5P_DEFAULT)
                                 : H5Gcreate2(file, path.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                     H5Gclose, path);
  write_text(group.get(), "description", description, path);
}

template <class T>
void ImageWriter::attribute(const std::string& group, const std::string& name, const T& value) {
  const std::string what = group + "@" + name;
  const Handle object = parts_->object(group, what);
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
  write_attribute(parts_->object(group, what).get(), name, values.size(), number_type<T>(), values.data(), what);
}

void ImageWriter::ascii_attribute(const std::string& group, const std::string& name, const std::string& text) {
  const std::string what = group + "@" + name;
  const Handle type = text_type(text.size());
  check(H5Tset_cset(type.get(), H5T_CSET_ASCII), what);
  write_attribute(parts_->object(group, what).get(), name, {}, {type.get(), type.get()}, text.data(), what);
}

template <class T>
void ImageWriter::array(const Leaf& leaf, const std::vector<T>& values, const Extent& wanted) {
  Extent extent = wanted;
  if (!extent.empty() && extent[0] == kAnyRows) extent[0] = values.size();
  if (product(extent) != values.size()) refuse_size(leaf, {values.size()}, extent);
  const hid_t file = parts_->file.get();
  const Handle space = make_space(extent, leaf.path);
  const auto write = [&](const TypePair& type, std::size_t value_bytes, const void* data) {
    const Handle properties = dataset_properties(extent, value_bytes, leaf.path);
    const Handle dataset(
        H5Dcreate2(file, leaf.path.c_str(), type.file, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
        H5Dclose, leaf.path);
    if (!values.empty()) check(H5Dwrite(dataset.get(), type.memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), leaf.path);
    write_text(dataset.get(), "description", leaf.description, leaf.path);
    const auto label = [&](const std::string& name, const std::vector<std::string>& texts) {
      if (texts.size() <= kMostInAttribute) return write_texts(dataset.get(), name, texts.size(), texts, leaf.path);
      const std::string beside = leaf.path + "_" + name;
      write_text(dataset.get(), name, beside, leaf.path);
      array(Leaf{beside, "The attribute " + name + " of " + leaf.path}, texts, {kAnyRows});
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
  const std::string what = "the file's end";
  const hid_t file = parts_->file.get();
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), what);
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size < 0) fail(what);
  const std::size_t block = parts_->user_block;
  std::string bytes(block + static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file, bytes.data() + block, static_cast<std::size_t>(size)) != size) fail(what);
  // HDF5 1.10 hands out the file without its user block; the addresses inside count from the block's end all the same.
  if (!starts_hdf5(bytes, block)) bytes.erase(0, block);
  return bytes;
}

namespace {

/// The values lie in this file, as ImageWriter leaves them: chunked or one value, deflated at most.
void refuse_storage(hid_t dataset, const std::string& what) {
  const Handle properties(H5Dget_create_plist(dataset), H5Pclose, what);
  const H5D_layout_t layout = H5Pget_layout(properties.get());
  if (layout != H5D_CHUNKED && layout != H5D_CONTIGUOUS && layout != H5D_COMPACT)
    throw ImageError(what + ": is a view of other datasets");
  if (H5Pget_external_count(properties.get()) != 0) throw ImageError(what + ": has its values in another file");
  for (int i = 0; i < H5Pget_nfilters(properties.get()); ++i) {
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(properties.get(), static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, &config);
    if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE)
      throw ImageError(what + ": is packed by a filter that pkmopt does not use");
  }
}

/// Bytes of the dataset's values: no more than deflate can have packed into what the file holds of them, so that no
/// forged size is asked for.
std::size_t bytes_of(hid_t dataset, const Extent& extent, std::size_t value_bytes, const std::string& what) {
  constexpr std::size_t kMostDeflated = 1032;  // bytes in one
  if (std::ranges::find(extent, std::size_t{0}) != extent.end()) return 0;
  const std::size_t most = H5Dget_storage_size(dataset) * kMostDeflated;
  std::size_t bytes = value_bytes;
  for (const std::size_t size : extent) {
    if (bytes > most / size) throw ImageError(what + ": is larger than the values that the file holds");
    bytes *= size;
  }
  return bytes;
}

/// Other programs may have changed width or order of the bytes, which HDF5 converts.
void refuse_type(hid_t stored, hid_t expected, const std::string& what) {
  if (H5Tget_class(stored) != H5Tget_class(expected)) throw ImageError(what + ": has values of another type");
}

/// All of the file lies in the file, also what only other programs read: a soft link may go round in circles, an
/// external one shows another file.
void refuse_what_lies_elsewhere(hid_t file) {
  struct Found {
    std::vector<std::string> paths;
    std::string link;
  } found;
  const auto look = [](hid_t, const char* name, const H5L_info_t* info, void* data) -> herr_t {
    const bool is_here = info->type == H5L_TYPE_HARD;
    try {
      Found& here = *static_cast<Found*>(data);
      (is_here ? here.paths.emplace_back() : here.link) = std::string("/") + name;
    } catch (...) {  // none may pass through C
      return -1;
    }
    return is_here ? 0 : 1;
  };
  check(H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, look, &found), "/");
  if (!found.link.empty()) throw ImageError(found.link + ": is a link to another place");
  for (const std::string& path : found.paths) {
    H5O_info_t object;
    check(H5Oget_info_by_name(file, path.c_str(), &object, H5P_DEFAULT), path);
    if (object.type == H5O_TYPE_DATASET)
      refuse_storage(Handle(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, path).get(), path);
  }
}

}  // namespace

struct ImageReader::Parts {
  explicit Parts(const std::string& bytes) : file(open_image(bytes)) { refuse_what_lies_elsewhere(file.get()); }
  QuietErrors quiet;
  Handle file;
};

ImageReader::ImageReader(const std::string& file, int schema)
    : parts_(std::make_unique<Parts>(file)), schema_(schema) {}
ImageReader::~ImageReader() = default;

void ImageReader::group(const std::string& path, const std::string&) const {
  const Handle group(H5Gopen2(parts_->file.get(), path.c_str(), H5P_DEFAULT), H5Gclose, path);
}

bool ImageReader::has(const std::string& path) const {
  return H5Lexists(parts_->file.get(), path.c_str(), H5P_DEFAULT) > 0;
}

std::size_t ImageReader::members(const std::string& path) const {
  H5G_info_t info;
  check(H5Gget_info_by_name(parts_->file.get(), path.c_str(), &info, H5P_DEFAULT), path);
  return info.nlinks;
}

template <class T>
void ImageReader::attribute(const std::string& group, const std::string& name, T& value) const {
  const std::string what = group + "@" + name;
  const Handle attribute(H5Aopen_by_name(parts_->file.get(), group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, what);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose, what);
  if (H5Sget_simple_extent_npoints(space.get()) != 1) throw ImageError(what + ": is not a single value");
  if constexpr (std::is_same_v<T, std::string>) {
    value = read_text(attribute.get(), what);
  } else {
    using Stored = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;
    Stored stored{};
    refuse_type(Handle(H5Aget_type(attribute.get()), H5Tclose, what).get(), number_type<Stored>().file, what);
    check(H5Aread(attribute.get(), number_type<Stored>().memory, &stored), what);
    value = static_cast<T>(stored);
  }
}

template <class T>
void ImageReader::array(const Leaf& leaf, std::vector<T>& values, const Extent& extent) const {
  const Handle dataset(H5Dopen2(parts_->file.get(), leaf.path.c_str(), H5P_DEFAULT), H5Dclose, leaf.path);
  const Handle type(H5Dget_type(dataset.get()), H5Tclose, leaf.path);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose, leaf.path);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 0) fail(leaf.path);
  std::vector<hsize_t> size(static_cast<std::size_t>(rank));
  check(H5Sget_simple_extent_dims(space.get(), size.data(), nullptr), leaf.path);
  Extent expected = extent;
  if (!extent.empty() && extent[0] == kAnyRows && rank > 0) expected[0] = size[0];
  const Extent present(size.begin(), size.end());
  if (present != expected) refuse_size(leaf, present, expected);
  if constexpr (std::is_same_v<T, std::string>) {
    const std::size_t length = text_length(type.get(), leaf.path);
    std::string bytes(bytes_of(dataset.get(), present, length, leaf.path), '\0');
    const std::size_t count = bytes.size() / length;
    if (count > 0) check(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), leaf.path);
    values.clear();
    for (std::size_t i = 0; i < count; ++i) {
      values.push_back(bytes.substr(i * length, length));
      values.back().erase(values.back().find_last_not_of('\0') + 1);
    }
  } else {
    refuse_type(type.get(), number_type<T>().file, leaf.path);
    values.resize(bytes_of(dataset.get(), present, sizeof(T), leaf.path) / sizeof(T));
    if (!values.empty())
      check(H5Dread(dataset.get(), number_type<T>().memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), leaf.path);
  }
}

#define PKM_ATTRIBUTE(T)                                                                  \
  template void ImageWriter::attribute(const std::string&, const std::string&, const T&); \
  template void ImageReader::attribute(const std::string&, const std::string&, T&) const;
#define PKM_ARRAY(T)                                                                   \
  template void ImageWriter::array(const Leaf&, const std::vector<T>&, const Extent&); \
  template void ImageReader::array(const Leaf&, std::vector<T>&, const Extent&) const;
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
