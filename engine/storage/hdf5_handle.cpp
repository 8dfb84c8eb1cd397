#include "engine/storage/hdf5_handle.hpp"

#include <hdf5.h>

#include <type_traits>

namespace pkm::hdf5 {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>);

constexpr std::size_t kGrowth = std::size_t{1} << 16;  // bytes; HDF5 clears them

extern "C" herr_t take_first_error(unsigned, const H5E_error2_t* error, void* text) {
  *static_cast<std::string*>(text) = error->desc ? error->desc : "";
  return 1;  // stop
}

std::string in_words(const Extent& extent) {
  std::string text;
  for (const std::size_t n : extent) text += (text.empty() ? "" : " x ") + std::to_string(n);
  return text.empty() ? "1" : text;
}

}  // namespace

QuietErrors::QuietErrors() {
  H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}
QuietErrors::~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }

void fail(const std::string& what) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first_error, &reason);
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
  check(H5Pset_fapl_core(access.get(), kGrowth, false), what);
  check(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG), what);
  check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V110), what);
  return access;
}

void refuse_size(const Leaf& leaf, const Extent& present, const Extent& expected) {
  throw ImageError(leaf.path + ": has " + in_words(present) + " values, but " + in_words(expected) + " are expected");
}

}  // namespace pkm::hdf5
