// Certificates of final designs by interval arithmetic: motions that must be followed, and largest solids; and the time
// that certificates take.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/problem/design_problem.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Certifies that a feasible design satisfies all pose-level limits along the motions that it has to follow, also
/// between their samples. If a limit is proven to be violated, the design's status becomes failed; other results are
/// added to the notes. Throws Stopped.
/// @param name  of the design, such as "best design"
void certify_motions(const ProblemParts& parts, const std::string& name, DesignRecord& design,
                     std::vector<std::string>& notes);

/// Certifies the largest solids of a feasible design. They touch the boundary of the workspace, and are therefore
/// reduced. If a limit is proven to be violated in one, the design's status becomes failed; other results are added to
/// the notes. Throws Stopped.
void certify_solids(const ProblemParts& parts, const std::string& name, DesignRecord& design,
                    std::vector<std::string>& notes);

/// Whether a note is one of those that certify_motions() and certify_solids() add.
bool is_note_of_certificate(const std::string& note);

/// Times that the certificates of one design take [s]. A certificate that takes longer than some tenths of a second is
/// not completed, but its time is estimated from the rate at which it examines boxes.
struct CertificateCost {
  double volume = 0;   ///< certified bounds of the volume, extrapolated to the requested gap
  double motions = 0;  ///< maximum time, at the maximum number of boxes
  double solids = 0;   ///< maximum time, at the maximum number of boxes
};
/// Measures the certificates that a study requests. Throws Stopped.
/// @param parameters  a design that can be evaluated
CertificateCost certificate_cost(const ProblemParts& parts, std::span<const double> parameters);

}  // namespace pkm
