// The build without MPI: instead of engine/core/ranks_mpi.cpp.
#include <stdexcept>

#include "engine/core/ranks_backend.hpp"

namespace pkm::ranks {

std::string library() { return ""; }

std::unique_ptr<Backend> join() { throw std::logic_error("built without MPI"); }

}  // namespace pkm::ranks
