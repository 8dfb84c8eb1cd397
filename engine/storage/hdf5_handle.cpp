#include "engine/storage/hdf5_handle.hpp"

#include <hdf5.h>

#include <atomic>
#include <type_traits>

namespace pkm::hdf5 {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>);

// Size in bytes by which the memory of a file image grows; small, because HDF5 zeroes each increment.
constexpr std::size_t kMemoryIncrement = std::size_t{1} << 16;

/// Callback of H5Ewalk2: copies the description of the first error that it is called with and ends the walk.
extern "C" herr_t copy_description(unsigned, const H5E_error2_t* error, void* text) {
  *static_cast<std::string*>(text) = error->desc ? error->desc : "";
  return 1;  // a positive value ends the walk
}

/// Text of an extent for messages, for example "12 x 2".
std::string text_of(const Extent& extent) {
  std::string text;
  for (const std::size_t n : extent) text += (text.empty() ? "" : " x ") + std::to_string(n);
  return text.empty() ? "1" : text;
}

}  // namespace

ErrorPrintingOff::ErrorPrintingOff() {
  H5Eget_auto2(H5E_DEFAULT, &handler_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}
ErrorPrintingOff::~ErrorPrintingOff() { H5Eset_auto2(H5E_DEFAULT, handler_, data_); }

void fail(const std::string& what) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, copy_description, &reason);
  throw ImageError(what + (reason.empty() ? "" : ": " + reason));
}

template <>
TypePair number_type<double>() {
  return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE};
}
template <>
TypePair number_type<float>() {
  return {H5T_IEEE_F32LE, H5T_NATIVE_FLOAT};
}
template <>
TypePair number_type<std::int64_t>() {
  return {H5T_STD_I64LE, H5T_NATIVE_INT64};
}
template <>
TypePair number_type<std::uint64_t>() {
  return {H5T_STD_U64LE, H5T_NATIVE_UINT64};
}
template <>
TypePair number_type<std::uint8_t>() {
  return {H5T_STD_U8LE, H5T_NATIVE_UINT8};
}

Handle attribute_text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "text type");
  check(H5Tset_size(type.get(), H5T_VARIABLE), "text type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "text type");
  return type;
}

Handle access_in_memory(const std::string& what) {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, what);
  check(H5Pset_fapl_core(access.get(), kMemoryIncrement, false), what);
  check(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG), what);
  check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V110), what);
  return access;
}

std::string new_name_in_memory() {
  static std::atomic<std::uint64_t> count = 0;
  return "study in memory " + std::to_string(count++);
}

void throw_size_mismatch(const Leaf& leaf, const Extent& present, const Extent& expected) {
  throw ImageError(leaf.path + ": has " + text_of(present) + " values, but " + text_of(expected) + " are expected");
}

}  // namespace pkm::hdf5
