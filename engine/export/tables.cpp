#include "engine/export/tables.hpp"

#include "engine/core/catalogue.hpp"
#include "engine/problem/pose_statistic.hpp"

namespace pkm {

CsvTable workspace_table(const WorkspaceFields& workspace) {
  std::vector<std::string> columns;
  for (const auto* const axes : {&workspace.axes, &workspace.fixed})
    for (const WorkspaceAxis& axis : *axes) columns.push_back(column_header(axis.name, axis.unit));
  for (const WorkspaceField& field : workspace.fields) columns.push_back(column_header(field.name, field.unit));
  CsvTable table(columns);
  for (std::size_t cell = 0; cell < workspace.cells(); ++cell) {
    const Pose<double> pose = workspace.pose(cell);
    table.begin_row();
    for (const auto* const axes : {&workspace.axes, &workspace.fixed})
      for (const WorkspaceAxis& axis : *axes) table.add(pose[static_cast<std::size_t>(axis.coordinate)]);
    for (const WorkspaceField& field : workspace.fields) table.add(field.values[cell]);
  }
  return table;
}

CsvTable coupling_table(const MechanismInfo& info, const WorkspaceResult<double>& workspace) {
  std::vector<std::string> columns = names_of(info.coordinates);
  for (std::size_t i = 1; i <= info.joints.size(); ++i) columns.push_back("dci_" + std::to_string(i));
  columns.emplace_back("dci_worst");
  CsvTable table(columns);
  Scratch scratch;
  const std::vector<double>& worst = reduced_field(workspace, kCouplingIndex, "worst", scratch);
  for (std::size_t k = 0; k < workspace.weight.size(); ++k) {
    table.begin_row();
    table.add(workspace.pose[k]);
    for (std::size_t i = 0; i < info.joints.size(); ++i) table.add(workspace.field(kCouplingIndex, i)[k]);
    table.add(worst[k]);
  }
  return table;
}

CsvTable simulation_table(const MechanismInfo& info, const Simulation& run, bool friction) {
  std::vector<std::string> columns = {"time"};
  for (const char* suffix : {"", "_speed", "_acceleration"})
    for (const AxisInfo& axis : info.coordinates) columns.push_back(axis.name + suffix);
  columns.insert(columns.end(), {"kinetic_energy", "work_of_drives", "work_of_weight", "work_of_wrench"});
  if (friction) columns.emplace_back("work_of_friction");
  CsvTable table(columns);
  for (const SimulationState& s : run.states) {
    table.begin_row();
    table.add(s.time);
    for (const auto* values : {&s.pose, &s.velocity, &s.acceleration}) table.add(*values);
    for (const double value : {s.kinetic_energy, s.work_of_drives, s.work_of_weight, s.work_of_wrench})
      table.add(value);
    if (friction) table.add(s.work_of_friction);
  }
  return table;
}

}  // namespace pkm
