#include <filesystem>
#include <stdexcept>

#include "bindings/c/handles.hpp"
#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"
#include "experiments/app/program.hpp"
#include "experiments/app/version.hpp"

namespace pkm::c {
namespace {

std::string& last_error() {
  thread_local std::string sentence;
  return sentence;
}

void set_error(const std::string& sentence) noexcept {
  try {
    last_error() = sentence;
  } catch (const std::bad_alloc&) {
    last_error().clear();
  }
}

}  // namespace

pkmopt_status store_current_error() noexcept {
  try {
    throw;
  } catch (const ConfigError& error) {
    set_error(error.what());
    return PKMOPT_INVALID_INPUT;
  } catch (const StorageError& error) {
    set_error(error.what());
    return PKMOPT_FILE_ERROR;
  } catch (const DesignError& error) {
    set_error(error.what());
    return PKMOPT_DESIGN_ERROR;
  } catch (const std::bad_alloc&) {
    set_error("out of memory");
    return PKMOPT_NO_MEMORY;
  } catch (const std::logic_error& error) {
    // Analyses throw std::invalid_argument for input that they do not support; other logic errors are bugs.
    const bool is_refusal = dynamic_cast<const std::invalid_argument*>(&error) != nullptr;
    set_error(error.what());
    return is_refusal ? PKMOPT_INVALID_INPUT : PKMOPT_INTERNAL_ERROR;
  } catch (const std::exception& error) {
    set_error(message_of(error));
    return PKMOPT_INTERNAL_ERROR;
  } catch (const Stopped&) {
    set_error("stopped by the caller");
    return PKMOPT_STOPPED;
  } catch (...) {
    set_error("an unknown exception");
    return PKMOPT_INTERNAL_ERROR;
  }
}

const Catalogues& catalogues() {
  static const Catalogues all = all_catalogues();
  return all;
}

char* allocated(const std::string& text) {
  char* const copy = allocated_array<char>(text.size() + 1);
  std::memcpy(copy, text.c_str(), text.size() + 1);
  return copy;
}

std::string required_text(const char* text, const char* argument) {
  if (!text) throw ConfigError({"", 0, argument}, "NULL", "a text");
  return text;
}

void refuse_existing(const std::string& file, bool overwrite) {
  std::error_code ignored;
  if (!overwrite && std::filesystem::exists(file, ignored))
    throw StorageError(file + " exists already; set overwrite to replace it, or choose another name");
}

bool Interrupt::is_requested() {
  constexpr std::chrono::milliseconds kInterval(50);
  if (requested_.load(std::memory_order_relaxed)) return true;
  if (!options_.interrupt || std::this_thread::get_id() != caller_) return false;
  const auto now = std::chrono::steady_clock::now();
  if (now - polled_ < kInterval) return false;
  polled_ = now;
  if (options_.interrupt(options_.user) != 0) requested_ = true;
  return requested_;
}

}  // namespace pkm::c

const char* pkmopt_version() {
  static const std::string version = pkm::program_version();
  return version.c_str();
}

const char* pkmopt_error() { return pkm::c::last_error().c_str(); }

void pkmopt_free(void* memory) { std::free(memory); }

pkmopt_status pkmopt_number(const char* text, const char* unit, double* value) {
  using namespace pkm::c;
  return guarded([&] {
    const std::string given = required_text(text, "text"), si_unit = required_text(unit, "unit");
    const auto parsed = pkm::parse_quantity(given, si_unit);
    if (!parsed)
      throw pkm::ConfigError({"", 0, "value"}, "'" + given + "'",
                             "a number, with or without a unit of the dimension of " + si_unit);
    *value = *parsed;
  });
}
