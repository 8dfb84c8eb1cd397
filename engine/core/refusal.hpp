// An answer to "can it?" that says why not.
#pragma once

#include <optional>
#include <string>

namespace pkm {

/// One sentence saying why not; none: it can.
using Refusal = std::optional<std::string>;

}  // namespace pkm
