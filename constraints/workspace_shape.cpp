// The workspace's shape is one that can be used (4PPa-2PaR: eq 21, upper and lower part separate).
#include "constraints/design_test.hpp"
#include "constraints/list.hpp"

namespace pkm {

ConstraintEntry workspace_shape() { return design_test("workspace-shape", "the workspace has a usable shape"); }

}  // namespace pkm
