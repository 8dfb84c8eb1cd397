// The sections of the page, each as the data that it draws.
//
// Each function gives null where there is nothing to show: the page then leaves the section out. Numbers
// that are shown as values are exact; long columns are packed (engine/report/packed.hpp). What the numbers mean and how
// they look is said in engine/report/page/, in the file of the same name.
#pragma once

#include "engine/report/json_text.hpp"
#include "engine/report/views.hpp"

namespace pkm {

/// Mechanism, parameters, variables, objectives, constraints, reports: what the other sections give names and units by.
Json problem_data(const PageStudy& page);
/// State, best design beside the others, what holds it back, where the time went, how to repeat it.
Json summary_data(const PageStudy& page);
/// Each stage's generations: best, median and quartiles of the objectives, shares, indicators; starts of solvers.
Json convergence_data(const StudyContents& contents);
/// The designs of the populations, thinned, and which of them each generation has.
Json populations_data(const StudyContents& contents);
/// The trade-offs, with knees and compromise, and the sections below for some of their designs.
Json front_data(const PageStudy& page);

/// The parameters of a design that no study has found.
Json design_data(const Views& views);
/// The feasible cells of each design with their fields, and the surface around them with the fields at its vertices.
Json workspace_data(const Views& views);
/// The same of the map that the file itself holds, which has no fields.
Json workspace_data(const StudyContents& contents);
/// The links of each design at the poses that the page's sliders reach and along the motions, and its dimensions.
Json mechanism_data(const Views& views);
/// Coupling indices against the first rotation, where there is one, if the study asks for coupling; maps and histograms
/// are drawn from the workspace's fields.
Json coupling_data(const Views& views);
/// Joints, forces and power along the study's motions.
Json motions_data(const Views& views);

}  // namespace pkm
