// SPDX-License-Identifier: Apache-2.0
// Colours of vertices (`v x y z r g b`, as MeshLab, Blender and scanners write them). They are sRGB, as in
// Blender and three.js, and stand for the map_Kd of materials that have none: they multiply Kd, which is 1
// where it is not given.
#pragma once

#include "scene/material_description.h"
#include "scene/readers/mtl_reader.h"
#include "scene/readers/obj_reader.h"

#include <string>
#include <vector>

namespace clrt {

/// Makes the mesh's colours linear; vertices without one become white. Whole numbers from 0 to 255 are bytes.
/// Numbers that are no colours (negative, infinite, larger than 255) take all colours with them. Returns what
/// is to be said about them.
std::vector<Remark> decode_vertex_colours(ObjMesh& mesh, const std::string& path);

/// For each material, whether a triangle with it has a coloured vertex. To be called before the colours are
/// decoded; empty if the mesh has none.
std::vector<bool> coloured_materials(const ObjMesh& mesh);

/// The material, which has no map_Kd, with the colours of the vertices as its map_Kd.
MtlMaterial with_vertex_colours(MtlMaterial material, const SourcePlace& first_colour);

} // namespace clrt
