#include "tests/campaigns/fuzz/study_mutator.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/storage/file_header.hpp"
#include "tests/campaigns/fuzz/record_mutator.hpp"

namespace pkm::fuzz {
namespace {

/// Owns one HDF5 identifier. It may be invalid: operations that HDF5 rejects have no effect.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle& operator=(Handle&&) = delete;
  hid_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

constexpr hsize_t kMaxBytes = 1 << 20;  ///< larger datasets and attributes are not changed

/// A study file opened as an HDF5 image in memory.
class Image {
 public:
  explicit Image(const std::string& file) : file_(open(file)) {}
  explicit operator bool() const { return static_cast<bool>(file_); }
  hid_t id() const { return file_.get(); }

  struct Object {
    std::string path;
    H5O_type_t type;
  };
  std::vector<Object> objects() const {
    std::vector<Object> all;
    const auto add = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
      const bool root = std::strcmp(name, ".") == 0;
      static_cast<std::vector<Object>*>(list)->push_back({root ? "/" : "/" + std::string(name), info->type});
      return 0;
    };
    H5Ovisit2(id(), H5_INDEX_NAME, H5_ITER_INC, add, &all, H5O_INFO_BASIC);
    return all;
  }

  /// The bytes of the file, after an empty block for the header; empty on failure.
  std::string bytes() const {
    H5Fflush(id(), H5F_SCOPE_GLOBAL);
    const ssize_t size = H5Fget_file_image(id(), nullptr, 0);
    if (size <= 0) return {};
    std::string all(kHeaderBytes + static_cast<std::size_t>(size), '\0');
    H5Fget_file_image(id(), all.data() + kHeaderBytes, static_cast<std::size_t>(size));
    if (!has_hdf5_signature(all, kHeaderBytes))
      all.erase(0, kHeaderBytes);  // depending on the version of HDF5, the image already contains the user block
    return has_hdf5_signature(all, kHeaderBytes) ? all : std::string();
  }

 private:
  static Handle open(const std::string& file) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fapl_core(access.get(), 1 << 16, false);
    H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
    H5Pset_file_image(access.get(), const_cast<char*>(file.data()), file.size());
    return {H5Fopen("fuzzed study in memory", H5F_ACC_RDWR, access.get()), H5Fclose};
  }
  Handle file_;
};

/// Makes one random change in an HDF5 file.
class Mutator {
 public:
  Mutator(const Image& image, unsigned seed) : file_(image.id()), engine_(seed), objects_(image.objects()) {
    for (const auto& object : objects_)
      if (object.type == H5O_TYPE_DATASET) datasets_.push_back(object.path);
  }

  void change() {
    if (datasets_.empty()) return;
    const std::string& dataset = any(datasets_);
    switch (below(16)) {
      case 0:
      case 1:
      case 2:
      case 3:
        return change_values(dataset);
      case 4:
      case 5:
        return change_rows(dataset);
      case 6:
      case 7:
        return recreate(dataset);
      case 8:
        H5Ldelete(file_, dataset.c_str(), H5P_DEFAULT);
        return;
      case 9:
        return swap(dataset, any(datasets_));
      case 10:
        return link(any(objects_).path, any(objects_).path);
      case 11:
        return copy(any(objects_).path, dataset);
      case 12:
      case 13:
        return change_attribute(any(objects_).path);
      default:
        return change_text();
    }
  }

 private:
  std::size_t below(std::size_t end) { return engine_() % end; }
  template <class T>
  const T& any(const std::vector<T>& list) {
    return list[below(list.size())];
  }

  std::int64_t any_integer(std::int64_t now) {
    constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min(), kMax = -(kMin + 1);
    const auto neighbour = static_cast<std::uint64_t>(now);
    const std::vector<std::int64_t> list = {-1,
                                            0,
                                            1,
                                            2,
                                            255,
                                            1 << 16,
                                            std::int64_t{1} << 31,
                                            std::int64_t{1} << 32,
                                            kMin,
                                            kMax,
                                            static_cast<std::int64_t>(neighbour + 1),
                                            static_cast<std::int64_t>(neighbour - 1),
                                            static_cast<std::int64_t>(0 - neighbour)};
    return any(list);
  }
  double any_number(double now) {
    using Limits = std::numeric_limits<double>;
    const std::vector<double> list = {0,
                                      -0.0,
                                      1,
                                      -1,
                                      0.5,
                                      1e-300,
                                      1e300,
                                      -1e300,
                                      Limits::infinity(),
                                      -Limits::infinity(),
                                      Limits::quiet_NaN(),
                                      Limits::denorm_min(),
                                      now * 2,
                                      -now};
    return any(list);
  }
  std::string any_text() {
    const std::vector<std::string> list = {"",
                                           "a",
                                           "-",
                                           "=1+1",
                                           "\x1b[2J",
                                           "\xff\xfe",
                                           "</script><b>",
                                           "ga",
                                           "nlopt",
                                           "workspace-ratio",
                                           "4ppa-2par",
                                           "3crr-r-cru",
                                           "/etc/passwd",
                                           "a\nb,c\"d",
                                           std::string(3000, 'n')};
    return any(list);
  }

  /// Changes up to three of `values`, an array of elements of `type`.
  void change_some(std::vector<char>& values, hid_t type) {
    const std::size_t size = H5Tget_size(type);
    if (size == 0 || values.size() < size) return;
    for (std::size_t times = 1 + below(3); times > 0; --times) {
      char* const at = values.data() + size * below(values.size() / size);
      const H5T_class_t kind = H5Tget_class(type);
      if (kind == H5T_INTEGER && size <= 8) {
        std::int64_t now = 0;
        std::memcpy(&now, at, size);  // little-endian
        now = any_integer(now);
        std::memcpy(at, &now, size);
      } else if (kind == H5T_FLOAT && size == 8) {
        double now = 0;
        std::memcpy(&now, at, size);
        now = any_number(now);
        std::memcpy(at, &now, size);
      } else if (below(2) == 0) {
        const std::string text = any_text();
        std::memset(at, 0, size);
        std::memcpy(at, text.data(), std::min(size, text.size()));
      } else {
        at[below(size)] = static_cast<char>(below(256));
      }
    }
  }

  void change_values(const std::string& path) {
    const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle type(H5Dget_type(dataset.get()), H5Tclose), space(H5Dget_space(dataset.get()), H5Sclose);
    const hssize_t count = H5Sget_simple_extent_npoints(space.get());
    const std::size_t size = H5Tget_size(type.get());
    if (!dataset || count <= 0 || H5Tis_variable_str(type.get()) != 0 || size == 0) return;
    if (static_cast<hsize_t>(count) > kMaxBytes / size || H5Dget_storage_size(dataset.get()) == 0) return;
    std::vector<char> values(static_cast<std::size_t>(count) * size);
    if (H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return;
    change_some(values, type.get());
    H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }

  hsize_t any_size(hsize_t now) {
    const std::vector<hsize_t> list = {0,
                                       1,
                                       2,
                                       3,
                                       now - (now > 0),
                                       now + 1,
                                       2 * now,
                                       1000,
                                       hsize_t{1} << 31,
                                       (hsize_t{1} << 32) + 1,
                                       hsize_t{1} << 61};
    return any(list);
  }

  void change_rows(const std::string& path) {
    const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(H5Dget_space(dataset.get()), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space.get());
    if (rank <= 0) return;
    std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr);
    extent[0] = any_size(extent[0]);
    H5Dset_extent(dataset.get(), extent.data());
  }

  Handle any_type() {
    const std::vector<hid_t> numbers = {H5T_STD_I64LE,  H5T_IEEE_F64LE, H5T_STD_U8LE,  H5T_STD_I64BE,
                                        H5T_IEEE_F32LE, H5T_STD_U64LE,  H5T_STD_I16LE, H5T_STD_REF_OBJ};
    if (below(3) > 0) return {H5Tcopy(any(numbers)), H5Tclose};
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    const std::vector<std::size_t> lengths = {1, 7, 1000, std::size_t{1} << 20, std::size_t{1} << 31, H5T_VARIABLE};
    H5Tset_size(type.get(), any(lengths));
    H5Tset_cset(type.get(), below(2) == 0 ? H5T_CSET_UTF8 : H5T_CSET_ASCII);
    if (below(2) == 0) H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
    return type;
  }

  /// Replaces a dataset by one of the same name with another type, rank, size or storage, without its values.
  void recreate(const std::string& path) {
    std::vector<hsize_t> extent;
    Handle type(-1, H5Tclose);
    {
      const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
      const Handle space(H5Dget_space(dataset.get()), H5Sclose);
      const int rank = H5Sget_simple_extent_ndims(space.get());
      if (rank < 0) return;
      extent.resize(static_cast<std::size_t>(rank));
      H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr);
      if (below(2) == 0) extent.resize(below(4), 1);
      if (!extent.empty() && below(2) == 0) {
        hsize_t& size = extent[below(extent.size())];
        size = any_size(size);
      }
      Handle same(H5Dget_type(dataset.get()), H5Tclose);
      make(path, extent, below(2) == 0 ? std::move(same) : any_type());
    }
  }

  void make(const std::string& path, const std::vector<hsize_t>& extent, const Handle& type) {
    const int rank = static_cast<int>(extent.size());
    const Handle space(rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, extent.data(), nullptr), H5Sclose);
    const Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (!space || !type) return;
    H5Pset_obj_track_times(how.get(), false);
    switch (below(5)) {
      case 0:
        H5Pset_external(how.get(), "/proc/self/status", 0, H5F_UNLIMITED);
        break;
      case 1:
        if (rank > 0)
          H5Pset_virtual(how.get(), space.get(), below(2) == 0 ? "." : "other.h5", "/best/design", space.get());
        break;
      case 2:
        H5Pset_layout(how.get(), H5D_COMPACT);
        break;
      case 3:
        if (rank > 0) {
          std::vector<hsize_t> chunk = extent;
          for (hsize_t& size : chunk) size = std::clamp<hsize_t>(size, 1, 8);
          H5Pset_chunk(how.get(), rank, chunk.data());
        }
        break;
      default:
        H5Pset_alloc_time(how.get(), H5D_ALLOC_TIME_LATE);
    }
    H5Ldelete(file_, path.c_str(), H5P_DEFAULT);
    const Handle made(H5Dcreate2(file_, path.c_str(), type.get(), space.get(), H5P_DEFAULT, how.get(), H5P_DEFAULT),
                      H5Dclose);
  }

  void swap(const std::string& one, const std::string& other) {
    if (one == other) return;
    H5Lmove(file_, one.c_str(), file_, "/swapped", H5P_DEFAULT, H5P_DEFAULT);
    H5Lmove(file_, other.c_str(), file_, one.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    H5Lmove(file_, "/swapped", file_, other.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }

  void link(const std::string& from, const std::string& to) {
    if (from == "/" || from == to) return;
    if (below(2) == 0 && to != "/") {
      H5Ldelete(file_, from.c_str(), H5P_DEFAULT);
      H5Lcreate_hard(file_, to.c_str(), file_, from.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    } else if (below(2) == 0) {
      H5Ldelete(file_, from.c_str(), H5P_DEFAULT);
      H5Lcreate_soft(to.c_str(), file_, from.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    } else {
      H5Ldelete(file_, from.c_str(), H5P_DEFAULT);
      H5Lcreate_external("other.h5", to.c_str(), file_, from.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    }
  }

  void copy(const std::string& from, const std::string& to) {
    if (from == to || from == "/") return;
    H5Ldelete(file_, to.c_str(), H5P_DEFAULT);
    H5Ocopy(file_, from.c_str(), file_, to.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }

  void change_attribute(const std::string& path) {
    const Handle object(H5Oopen(file_, path.c_str(), H5P_DEFAULT), H5Oclose);
    std::vector<std::string> names;
    const auto add = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
      static_cast<std::vector<std::string>*>(list)->push_back(name);
      return 0;
    };
    H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
    if (names.empty()) return;
    const std::string name = any(names);
    const std::size_t choice = below(8);
    if (choice == 0 || choice == 1) {
      H5Adelete(object.get(), name.c_str());
      if (choice == 0) return;
      const Handle type = any_type();
      const hsize_t two = 2;
      const Handle space(below(2) == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &two, nullptr), H5Sclose);
      const Handle made(H5Acreate2(object.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                        H5Aclose);
      return;
    }
    const Handle attribute(H5Aopen(object.get(), name.c_str(), H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute.get()), H5Tclose), space(H5Aget_space(attribute.get()), H5Sclose);
    if (H5Sget_simple_extent_npoints(space.get()) != 1) return;
    if (H5Tis_variable_str(type.get()) > 0) {
      const std::string text = any_text();
      const char* const pointer = text.c_str();
      H5Awrite(attribute.get(), type.get(), &pointer);
      return;
    }
    const std::size_t size = H5Tget_size(type.get());
    if (size == 0 || size > kMaxBytes) return;
    std::vector<char> value(size);
    if (H5Aread(attribute.get(), type.get(), value.data()) < 0) return;
    change_some(value, type.get());
    H5Awrite(attribute.get(), type.get(), value.data());
  }

  /// Changes one line of the text of the study or of its mechanism, so that it contradicts the record: removes,
  /// duplicates or moves it, or changes a digit.
  void change_text() {
    const bool mechanism = H5Lexists(file_, "/mechanism", H5P_DEFAULT) > 0 && below(2) == 0;
    const char* const path = mechanism ? "/mechanism/toml" : "/toml";
    const Handle dataset(H5Dopen2(file_, path, H5P_DEFAULT), H5Dclose);
    const Handle type(H5Dget_type(dataset.get()), H5Tclose), space(H5Dget_space(dataset.get()), H5Sclose);
    const std::size_t size = H5Tget_size(type.get());
    if (!dataset || H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0) return;
    if (size > kMaxBytes || H5Sget_simple_extent_npoints(space.get()) != 1) return;
    std::string text(size, '\0');
    if (H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return;
    text.resize(std::strlen(text.c_str()));
    change_line(text);
    const Handle other(H5Tcopy(type.get()), H5Tclose);
    H5Tset_size(other.get(), std::max<std::size_t>(text.size(), 1));
    text.resize(std::max<std::size_t>(text.size(), 1));
    H5Ldelete(file_, path, H5P_DEFAULT);
    const Handle made(H5Dcreate2(file_, path, other.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                      H5Dclose);
    H5Dwrite(made.get(), other.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data());
  }

  void change_line(std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t from = 0; from < text.size();) {
      const std::size_t end = std::min(text.find('\n', from), text.size() - 1) + 1;
      lines.push_back(text.substr(from, end - from));
      from = end;
    }
    if (lines.empty()) return;
    const std::size_t at = below(lines.size());
    switch (below(4)) {
      case 0:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 1:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(below(lines.size())), lines[at]);
        break;
      case 2:
        std::swap(lines[at], lines[below(lines.size())]);
        break;
      default: {
        const std::size_t digit = lines[at].find_first_of("0123456789");
        if (digit != std::string::npos) lines[at][digit] = static_cast<char>('0' + below(10));
      }
    }
    text.clear();
    for (const std::string& line : lines) text += line;
  }

  hid_t file_;
  std::mt19937 engine_;
  std::vector<Image::Object> objects_;
  std::vector<std::string> datasets_;
};

/// Schema version of a study file; 0 if its header is invalid.
int schema_of(const std::string& file) {
  try {
    return verify_header(file, "", std::numeric_limits<int>::max());
  } catch (const StorageError&) {
    return 0;
  }
}

}  // namespace

std::string mutated_study(const std::string& file, unsigned seed) {
  const int schema = schema_of(file);
  if (schema == 0) return file;
  std::mt19937 engine(seed);
  if (engine() % 4 == 0) return with_mutated_record(file, schema, engine);
  std::string changed;
  {
    const Image image(file);
    if (!image) return file;
    for (std::size_t times = 1 + engine() % 3; times > 0; --times)
      Mutator(image, static_cast<unsigned>(engine())).change();
    changed = image.bytes();
  }
  if (changed.empty()) return file;
  seal(changed, schema);
  return changed;
}

bool has_external_references(const std::string& file) {
  const Image image(file);
  if (!image) return false;
  bool found = false;
  const auto visit = [](hid_t, const char*, const H5L_info_t* info, void* result) -> herr_t {
    *static_cast<bool*>(result) |= info->type != H5L_TYPE_HARD;
    return 0;
  };
  H5Lvisit(image.id(), H5_INDEX_NAME, H5_ITER_INC, visit, &found);
  for (const auto& object : image.objects()) {
    if (object.type != H5O_TYPE_DATASET) continue;
    const Handle dataset(H5Dopen2(image.id(), object.path.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle how(H5Dget_create_plist(dataset.get()), H5Pclose);
    found |= H5Pget_external_count(how.get()) > 0 || H5Pget_layout(how.get()) == H5D_VIRTUAL;
  }
  return found;
}

}  // namespace pkm::fuzz
