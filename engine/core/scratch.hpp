// Room for what a computation overwrites, kept for the next one, so that nothing is allocated per design.
#pragma once

#include <memory>
#include <vector>

namespace pkm {

/// Holds one object of each type that it is asked for. Whoever computes asks for a struct of its own, and finds it as
/// the last call left it: its vectors keep their memory, and what counts is set anew. Serves one computation at a time,
/// so every worker has one.
class Scratch {
 public:
  /// Made by its default constructor when it is asked for first, and then always the same object.
  template <class T>
  T& get() {
    for (const auto& held : held_)
      if (held->type == &kType<T>) return static_cast<Holder<T>&>(*held).value;
    auto made = std::make_unique<Holder<T>>();
    T& value = made->value;
    held_.push_back(std::move(made));
    return value;
  }

 private:
  template <class T>
  static constexpr char kType = 0;  // its address stands for the type

  struct Held {
    explicit Held(const char* of) : type(of) {}
    virtual ~Held() = default;
    const char* type;
  };
  template <class T>
  struct Holder : Held {
    Holder() : Held(&kType<T>) {}
    T value{};
  };

  std::vector<std::unique_ptr<Held>> held_;
};

}  // namespace pkm
