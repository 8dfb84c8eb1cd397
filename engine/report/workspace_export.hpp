// A workspace in the formats of other programs.
#pragma once

#include <string>

#include "engine/report/csv_table.hpp"
#include "engine/report/isosurface.hpp"
#include "engine/storage/vtk_image_file.hpp"

namespace pkm {

/// For ParaView: every field, the values of the held coordinates, the volume and the design's parameters.
VtkImage vtk_image(const WorkspaceFields& workspace, const MechanismInfo& info, std::span<const double> parameters,
                   const std::string& title);

/// A row per cell, its centre's coordinates and all fields.
CsvTable workspace_table(const WorkspaceFields& workspace);

/// The surface as a binary STL file, whose coordinates are the workspace's axes in SI, rad beside m.
std::string stl_file(const Isosurface& surface, const std::string& title);

}  // namespace pkm
