// Backend of a build without MPI, used instead of engine/core/ranks_mpi.cpp: there is always exactly one process.
#include <stdexcept>

#include "engine/core/ranks_backend.hpp"

namespace pkm::ranks {

std::string library() { return ""; }

std::unique_ptr<Backend> join() { throw std::logic_error("built without MPI"); }

}  // namespace pkm::ranks
