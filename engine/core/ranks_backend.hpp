// What a library for messages has to do for engine/core/ranks.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/ranks.hpp"

namespace pkm::ranks {

class Backend {
 public:
  virtual ~Backend() = default;  ///< leaves the group; collective
  int rank = 0, size = 1;
  virtual void broadcast(char* bytes, std::size_t count) = 0;
  /// Of each rank `sizes[rank]` bytes, one after the other.
  virtual void all_gather(const char* mine, const std::vector<std::size_t>& sizes, char* all) = 0;
  virtual std::unique_ptr<Counter::Shared> counter() = 0;
  virtual void post(const std::string& message) = 0;
  virtual std::optional<std::string> poll() = 0;
  [[noreturn]] virtual void abort(int exit_code) = 0;
};

/// "Open MPI 4.1.4"; "" in a build without such a library.
std::string library();
/// Joins the processes of a launcher. Throws std::runtime_error in a build without such a library.
std::unique_ptr<Backend> join();

}  // namespace pkm::ranks
