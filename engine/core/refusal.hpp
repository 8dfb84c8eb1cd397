// The answer to "can it?".
#pragma once

#include <optional>
#include <string>

namespace pkm {

/// One sentence that says why not; none: it can.
using Refusal = std::optional<std::string>;

}  // namespace pkm
