// Interface to the message-passing library behind engine/core/ranks: implemented with MPI (ranks_mpi.cpp), or absent
// (ranks_serial.cpp).
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
  virtual ~Backend() = default;  ///< leaves the group of processes; collective
  int rank = 0, size = 1;
  virtual void broadcast(char* bytes, std::size_t count) = 0;
  /// Concatenates the bytes of all ranks in `all`.
  /// @param sizes  number of bytes of each rank
  virtual void all_gather(const char* mine, const std::vector<std::size_t>& sizes, char* all) = 0;
  virtual std::unique_ptr<Counter::Shared> counter() = 0;
  virtual void post(const std::string& message) = 0;
  virtual std::optional<std::string> poll() = 0;
  [[noreturn]] virtual void abort(int exit_code) = 0;
};

/// Name and version of the library, for example "Open MPI 4.1.4"; "" in a build without MPI.
std::string library();
/// Connects the processes that the launcher has started. Throws std::runtime_error if the library has no thread
/// support, and std::logic_error in a build without MPI.
std::unique_ptr<Backend> join();

}  // namespace pkm::ranks
