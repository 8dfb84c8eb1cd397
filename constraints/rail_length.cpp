// The rails are long enough for the links (4PPa-2PaR: eq 18).
#include "constraints/design_test.hpp"
#include "constraints/list.hpp"

namespace pkm {

ConstraintEntry rail_length() { return design_test("rail-length", "the rails are long enough for the links"); }

}  // namespace pkm
