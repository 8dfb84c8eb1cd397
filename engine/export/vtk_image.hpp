// Writer for a workspace as an image in the VTKHDF format, version 1.0, for ParaView and VTK.
#pragma once

#include <span>
#include <string>

#include "engine/storage/safe_file.hpp"
#include "engine/workspace/workspace_fields.hpp"

namespace pkm {

/// Writes ImageData in the VTKHDF format: all fields, the values of the fixed coordinates, the volume and the
/// parameters of the design. The centres of the cells become the points of the image, because the fields were evaluated
/// there, contour filters need point data, and VTK 9.1 reads cell arrays as point arrays. The file is written by
/// write_file(). Throws StorageError.
void write_vtk_image(const std::string& path, const WorkspaceFields& workspace, const MechanismInfo& info,
                     std::span<const double> parameters, const std::string& title, Existing existing);

}  // namespace pkm
