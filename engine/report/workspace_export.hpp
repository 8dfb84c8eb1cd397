// A workspace in the formats of other programs.
#pragma once

#include <string>

#include "engine/report/csv_table.hpp"
#include "engine/report/isosurface.hpp"
#include "engine/storage/safe_file.hpp"

namespace pkm {

/// For ParaView, as ImageData of the VTKHDF format: every field, the values of the held coordinates, the volume and the
/// design's parameters. The cells' centres become the image's points: that is where the fields were evaluated, what
/// contours are drawn from, and all that VTK 9.1 reads, which takes arrays of cells for arrays of points.
/// Written as write_file does. Throws StorageError.
void write_vtk_image(const std::string& path, const WorkspaceFields& workspace, const MechanismInfo& info,
                     std::span<const double> parameters, const std::string& title, Existing existing);

/// A row per cell, its centre's coordinates and all fields.
CsvTable workspace_table(const WorkspaceFields& workspace);

/// The surface as a binary STL file, whose coordinates are the workspace's axes in SI, rad beside m.
std::string stl_file(const Isosurface& surface, const std::string& title);

}  // namespace pkm
