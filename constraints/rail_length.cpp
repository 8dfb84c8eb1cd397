// Design-level constraint: the rails are long enough for the links (4PPa-2PaR: eq 18).
#include "constraints/list.hpp"
#include "engine/problem/design_test.hpp"

namespace pkm {

ConstraintEntry rail_length() { return design_test("rail-length", "the rails are long enough for the links"); }

}  // namespace pkm
