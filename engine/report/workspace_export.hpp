// Exports a workspace as VTKHDF image, CSV table or STL surface.
#pragma once

#include <string>

#include "engine/report/csv_table.hpp"
#include "engine/report/isosurface.hpp"
#include "engine/storage/safe_file.hpp"

namespace pkm {

/// Writes ImageData in the VTKHDF format, for ParaView: all fields, the values of the fixed coordinates, the volume and
/// the parameters of the design. The centres of the cells become the points of the image, because the fields were
/// evaluated there, contour filters need point data, and VTK 9.1 reads cell arrays as point arrays.
/// The file is written as by write_file(). Throws StorageError.
void write_vtk_image(const std::string& path, const WorkspaceFields& workspace, const MechanismInfo& info,
                     std::span<const double> parameters, const std::string& title, Existing existing);

/// One row per cell: the coordinates of its centre and all fields.
CsvTable workspace_table(const WorkspaceFields& workspace);

/// The content of a binary STL file. Its coordinates are those of the workspace's axes in SI units, so rotations are in
/// rad next to lengths in m.
std::string stl_file(const Isosurface& surface, const std::string& title);

}  // namespace pkm
