// Catalogue of mechanisms with lazy construction: each is constructed at its first use.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// A mechanism of a catalogue, constructed at its first use. Thread-safe.
class MechanismEntry {
 public:
  using Make = std::function<std::shared_ptr<const Mechanism>()>;

  MechanismEntry(std::string name, Make make)
      : name_(std::move(name)), made_(std::make_shared<Made>()), make_(std::move(make)) {}
  /// An entry for a mechanism that is already constructed.
  template <class M>
  MechanismEntry(std::shared_ptr<M> mechanism)
      : MechanismEntry(mechanism->info().name, [mechanism] { return mechanism; }) {}

  const std::string& name() const { return name_; }
  const std::shared_ptr<const Mechanism>& get() const {
    std::call_once(made_->once, [this] { made_->mechanism = make_(); });
    return made_->mechanism;
  }
  operator std::shared_ptr<const Mechanism>() const { return get(); }
  const Mechanism& operator*() const { return *get(); }
  const Mechanism* operator->() const { return get().get(); }

 private:
  struct Made {
    std::once_flag once;
    std::shared_ptr<const Mechanism> mechanism;
  };
  std::string name_;
  std::shared_ptr<Made> made_;
  Make make_;
};

/// The mechanisms that a study can refer to by name.
using MechanismList = std::vector<MechanismEntry>;

}  // namespace pkm
