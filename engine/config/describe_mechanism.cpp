// Text of `pkmopt check` for a mechanism file: how it was interpreted, and which analyses it supports.

#include <algorithm>
#include <set>
#include <sstream>

#include "engine/config/mechanism_file.hpp"
#include "engine/config/mechanism_frames.hpp"
#include "engine/config/mechanism_mobility.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/display_unit.hpp"
#include "engine/core/error.hpp"
#include "engine/core/formatted.hpp"
#include "engine/core/options.hpp"
#include "engine/core/text_table.hpp"
#include "engine/core/unit.hpp"
#include "engine/math/eigen_solvers.hpp"
#include "engine/mechanism/availability.hpp"
#include "engine/mechanism/redundant_drives.hpp"
#include "engine/mechanism/sampled_poses.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm {
namespace {

std::string names_text(const std::vector<std::string>& names, std::size_t max_count = 8) {
  const std::vector<std::string> first(names.begin(),
                                       names.begin() + static_cast<std::ptrdiff_t>(std::min(max_count, names.size())));
  return join(first) + (names.size() > max_count ? ", .. (" + std::to_string(names.size()) + " in all)" : "");
}

/// Sentence that explains why no pose is feasible: it lists the margins that are negative at all sampled poses, if
/// there are any.
std::string why_no_feasible_pose(const Mechanism& mechanism, std::span<const double> parameters) {
  constexpr std::size_t kTrials = 10'000;
  const SampledPoses poses(mechanism, parameters);
  std::set<std::string> satisfied;
  NamedValues margins;  // margins of the sampled pose at which most margins are defined
  for (std::size_t trial = 1; trial <= kTrials; ++trial) {
    const MechanismInfo& info = mechanism.info();
    PoseReport report = mechanism.inspect(parameters, poses[trial], info.modes.front(), no_limits(info));
    for (const auto& [name, margin] : report.margins)
      if (margin >= 0) satisfied.insert(name);
    if (report.margins.size() > margins.size()) margins = std::move(report.margins);
  }
  std::vector<std::string> never;
  for (const auto& [name, margin] : margins)
    if (!satisfied.contains(name)) never.push_back(name);
  return "none of " + std::to_string(kTrials) + " sampled poses in the search box is feasible; " +
         (never.empty() ? "every limit is satisfied at some pose, but no pose satisfies all of them"
                        : "satisfied at no pose: " + names_text(never));
}

/// Explains why the drives do not determine all coordinates: drives that act along one line, i.e. whose rows of the
/// Jacobian are proportional, drives without effect or, if there are none, the coordinates that are undetermined.
std::string why_rank_deficient(const MechanismInfo& info, const Eigen::MatrixXd& J, std::size_t rank) {
  constexpr double kZero = 1e-9;  // relative
  const auto name = [&info](Eigen::Index row) { return info.joints[static_cast<std::size_t>(row)].name; };
  const double size = J.rowwise().norm().maxCoeff();
  std::vector<std::string> causes;
  std::vector<bool> listed(static_cast<std::size_t>(J.rows()));
  for (Eigen::Index i = 0; i < J.rows(); ++i) {
    if (J.row(i).norm() <= kZero * size) causes.push_back(name(i) + " does not move the platform");
    if (J.row(i).norm() <= kZero * size || listed[static_cast<std::size_t>(i)]) continue;
    std::vector<std::string> group = {name(i)};
    for (Eigen::Index k = i + 1; k < J.rows(); ++k) {
      const double along = J.row(k).dot(J.row(i)) / J.row(i).squaredNorm();
      if (J.row(k).norm() <= kZero * size || (J.row(k) - along * J.row(i)).norm() > kZero * J.row(k).norm()) continue;
      listed[static_cast<std::size_t>(k)] = true;
      group.push_back(name(k));
    }
    if (group.size() > 1) causes.push_back(join(group) + " act along one line");
  }
  if (!causes.empty()) return join(causes, "; ");
  const Eigen::JacobiSVD<Eigen::MatrixXd> decomposition(J, Eigen::ComputeFullV);
  const Eigen::MatrixXd free = decomposition.matrixV().rightCols(J.cols() - static_cast<Eigen::Index>(rank));
  std::vector<std::string> undetermined;
  for (std::size_t i = 0; i < info.coordinates.size(); ++i)
    if (free.row(static_cast<Eigen::Index>(i)).norm() > kZero * free.norm())
      undetermined.push_back(info.coordinates[i].name);
  return "it can move along a combination of " + join(undetermined);
}

/// Text of a computed length or angle with four significant digits, in the unit in which people read it.
std::string four_digits(double value, const std::string& unit) {
  const DisplayUnit shown = display_unit(unit);
  return formatted("%.4g ", value / shown.size) + shown.name;
}

/// Writes a feasible pose in the middle of the workspace. If no pose is feasible, writes the margins that are negative
/// at all sampled poses.
void write_nominal_pose(std::ostream& out, const Mechanism& mechanism, std::span<const double> parameters) {
  const MechanismInfo& info = mechanism.info();
  out << "\nnominal pose, of the default parameters in working mode " << info.modes.front() << '\n';
  if (!mechanism.ranges(parameters)) {
    out << "  none: [survey] has no box of all swept coordinates, or no default values of the fixed ones\n";
    return;
  }
  const auto nominal = central_pose(mechanism, parameters, no_limits(info), info.modes.front());
  if (!nominal) {
    out << "  " << why_no_feasible_pose(mechanism, parameters) << '\n';
    return;
  }
  const PoseReport report = mechanism.inspect(parameters, *nominal, info.modes.front(), no_limits(info));
  std::vector<std::string> at, joints;
  for (std::size_t i = 0; i < nominal->size(); ++i)
    at.push_back(info.coordinates[i].name + " = " + four_digits((*nominal)[i], info.coordinates[i].unit));
  for (std::size_t i = 0; i < info.joints.size(); ++i)
    joints.push_back(info.joints[i].name + " = " + four_digits((*report.joints)[i], info.joints[i].unit));
  out << "  " << join(at) << "\n  " << join(joints) << '\n';
  if (!report.J) {
    out << "  singular: the joint speeds are not determined by the rates of the coordinates\n";
    return;
  }
  Eigen::MatrixXd J(report.J->rows(), report.J->cols());
  for (Eigen::Index i = 0; i < J.rows(); ++i)
    for (Eigen::Index j = 0; j < J.cols(); ++j)
      J(i, j) = (*report.J)(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  const auto rank = static_cast<std::size_t>(J.jacobiSvd().setThreshold(1e-9).rank());
  const std::string cause = rank < info.coordinates.size() ? why_rank_deficient(info, J, rank) : "";
  out << "  mobility: " << mobility_text(mechanism, parameters, *nominal, rank, cause) << '\n';
}

/// The reason why the masses of the default design are invalid; "" if they are valid.
std::string why_no_masses(const Mechanism& mechanism) {
  std::vector<double> nominal;
  for (const Parameter& p : mechanism.info().parameters) nominal.push_back(p.nominal);
  try {
    mechanism.dynamics()->equations(std::span<const double>(nominal), mechanism.info().modes.front(), {}, {});
  } catch (const DesignError& reason) {
    return std::string("invalid for the default parameters: ") + reason.what();
  }
  return "";
}

/// The reason why the default analysis of the workspace cannot use columns; "" if it can.
std::string why_no_columns(const Mechanism& mechanism) {
  if (!mechanism.columns()) return mechanism.why_no_columns();
  const MechanismInfo& info = mechanism.info();
  try {
    prepare_workspace(mechanism, {.method = ColumnOptions{}, .fixed = {}, .limits = no_limits(info)},
                      {.mode = info.modes.front()});
  } catch (const std::invalid_argument& reason) {
    return reason.what();
  }
  return "";
}

void write_abilities(std::ostream& out, const Mechanism& mechanism, bool keeps_links_clear) {
  std::vector<std::vector<std::string>> can, cannot;
  const auto tell = [&](bool has, const char* what, const std::string& how, const std::string& why) {
    (has ? can : cannot).push_back({what, has ? how : why});
  };
  tell(mechanism.voxels(), "workspace by voxels", "one to three coordinates swept", "");
  const std::string no_columns = why_no_columns(mechanism);
  tell(mechanism.columns() && no_columns.empty(), "exact workspace by columns",
       "workspace.method = \"columns\", with derivatives by all parameters", no_columns);
  tell(mechanism.bounds(), "certified bounds of the workspace", "pkmopt certify, by interval arithmetic", "");
  const Unsupported undefined = why_no_conditioning(mechanism.info());
  tell(!undefined, "conditioning", "", undefined.value_or(""));
  for (const UndefinedQuantity& quantity : mechanism.info().undefined_quantities)
    tell(false, quantity.name.c_str(), "", quantity.why);
  tell(mechanism.velocities(), "speeds and accelerations of joints", "influence coefficients of first and second order",
       "");
  tell(mechanism.forward(), "forward kinematics", "Newton's method from many poses; may miss assembly modes",
       "needs as many joints as coordinates");
  tell(mechanism.size(), "workspace-ratio", "", "[platform] size is missing");
  tell(mechanism.design_tests(), "tests of the design", "", "there is no [[design]]");
  tell(keeps_links_clear, "clearance of links",
       "constraint clearance or limit clearance_min; not for exact columns and certified bounds",
       "needs two links that could collide: limbs with `radius`, or [[link]]");
  tell(mechanism.links(), "pictures", "", "no limb has a radius, and there is no [[link]]");
  const Unsupported no_forces = why_no_drive_forces(mechanism), no_coupling = why_no_joint_forces(mechanism);
  const bool is_redundant = !no_forces && no_coupling;
  if (!is_redundant) {
    tell(!no_forces, "forces and coupling", no_forces ? "" : why_no_masses(mechanism), no_forces.value_or(""));
    tell(mechanism.reactions(), "forces in the joints", "pkmopt dynamics and trajectory --reactions",
         mechanism.why_no_reactions());
  } else {
    tell(true, "forces of the drives", why_no_masses(mechanism), "");
    const std::string counts = "there are " + std::to_string(mechanism.info().joints.size()) + " joints for " +
                               std::to_string(mechanism.info().coordinates.size()) + " coordinates, so that ";
    tell(false, "inertia and coupling of the joints", "",
         counts + "the joints do not move independently; the inertia M_X of the platform is defined");
    tell(false, "drive trains, and limits of forces in fastest motions", "",
         counts + "the motion alone does not determine the force of each drive");
    tell(false, "forces in the joints", "", counts + "they depend on how the drives share the load");
  }
  out << format_titled_table("available", can);
  out << format_titled_table("not available, and why", cannot);
}

}  // namespace

std::string describe_mechanism(const Mechanism& mechanism) {
  const MechanismInfo& info = mechanism.info();
  std::ostringstream out;
  out << "mechanism  " << info.name << (info.title.empty() ? "" : ": " + info.title) << '\n';
  if (!info.source.empty()) out << "source     " << info.source << '\n';

  std::vector<std::vector<std::string>> parameters, coordinates, joints, limits;
  std::vector<double> nominal;
  for (const Parameter& p : info.parameters) {
    parameters.push_back({p.name, display_text(p.nominal, p.unit), display_range(p.lower, p.upper, p.unit), p.meaning});
    nominal.push_back(p.nominal);
  }
  const auto ranges = mechanism.ranges(nominal);
  for (std::size_t i = 0; i < info.coordinates.size(); ++i) {
    const AxisInfo& axis = info.coordinates[i];
    const auto swept =
        std::ranges::find(info.sweeps.front().swept, static_cast<int>(i)) != info.sweeps.front().swept.end();
    coordinates.push_back({axis.name, display_unit(axis.unit).name, swept ? "swept" : "fixed",
                           ranges ? display_range((*ranges)[i][0], (*ranges)[i][1], axis.unit) : "no box"});
  }
  for (std::size_t i = 0; i < info.joints.size(); ++i)
    joints.push_back({info.joints[i].name, display_unit(info.joints[i].unit).name,
                      i < info.closed_forms.size() ? info.closed_forms[i] : ""});
  for (const LimitInfo& limit : info.limits)
    limits.push_back(
        {limit.name, "inactive " + display_text(limit.inactive, limit.unit), limit.derivation, limit.meaning});
  out << format_titled_table("parameters", parameters);
  out << format_titled_table("coordinates", coordinates);
  out << frames_text(mechanism);
  out << format_titled_table("joints", joints);
  out << format_titled_table("limits", limits);
  out << "\nworking modes: " << names_text(info.modes) << '\n';
  if (const DesignTests* const tests = mechanism.design_tests()) {
    std::vector<std::vector<std::string>> rows;
    for (const DesignMarginInfo& test : tests->list()) rows.push_back({test.name, test.unit, test.meaning});
    out << format_titled_table("tests of the design", rows);
  }
  const auto joined = mechanism.links() ? mechanism.links()->joined() : std::vector<JoinedLinks>();
  std::vector<std::vector<std::string>> links;
  for (const auto& [link, others] : joined)
    links.push_back({link, others.empty() ? "all others" : "all but " + names_text(others)});
  out << format_titled_table("links, and the links that their clearance is tested against", links);
  write_nominal_pose(out, mechanism, nominal);
  write_abilities(out, mechanism, !joined.empty());
  return out.str();
}

}  // namespace pkm
