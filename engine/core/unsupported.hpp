// Result of a capability check.
#pragma once

#include <optional>
#include <string>

namespace pkm {

/// The reason why a request is not supported, as one sentence; empty if it is supported.
using Unsupported = std::optional<std::string>;

}  // namespace pkm
