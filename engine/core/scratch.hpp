// Per-thread scratch memory, reused so that evaluating a design does not allocate.
#pragma once

#include <memory>
#include <vector>

namespace pkm {

/// Type-indexed container with at most one object of each type. A computation defines a struct for its temporary data
/// and obtains it with get(). The struct still contains the values of the previous call, so its vectors keep their
/// capacity, and the computation must initialise all values that it reads. Not thread-safe: every worker thread has its
/// own.
class Scratch {
 public:
  /// Returns the object of type T. The first call default-constructs it; later calls return the same object.
  template <class T>
  T& get() {
    for (const auto& holder : holders_)
      if (holder->type == &kType<T>) return static_cast<Holder<T>&>(*holder).value;
    auto made = std::make_unique<Holder<T>>();
    T& value = made->value;
    holders_.push_back(std::move(made));
    return value;
  }

 private:
  template <class T>
  static constexpr char kType = 0;  // its address, which is different for each type, identifies the type

  struct HolderBase {
    explicit HolderBase(const char* type_id) : type(type_id) {}
    virtual ~HolderBase() = default;
    const char* type;
  };
  template <class T>
  struct Holder : HolderBase {
    Holder() : HolderBase(&kType<T>) {}
    T value{};
  };

  std::vector<std::unique_ptr<HolderBase>> holders_;
};

}  // namespace pkm
