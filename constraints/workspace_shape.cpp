// Design-level constraint: the workspace has a usable shape (4PPa-2PaR: eq 21, its upper and lower parts are separate).
#include "constraints/list.hpp"
#include "engine/problem/design_test.hpp"

namespace pkm {

ConstraintEntry workspace_shape() { return design_test("workspace-shape", "the workspace has a usable shape"); }

}  // namespace pkm
