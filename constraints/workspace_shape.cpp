// The workspace's shape is one that can be used (4PPa-2PaR: eq 21, upper and lower part separate).
#include "constraints/list.hpp"
#include "engine/problem/design_test.hpp"

namespace pkm {

ConstraintEntry workspace_shape() { return design_test("workspace-shape", "the workspace has a usable shape"); }

}  // namespace pkm
