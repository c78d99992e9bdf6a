// SPDX-License-Identifier: Apache-2.0
// Motion of the scene while the shutter is open, from a second file of the same faces.
#pragma once

#include "scene/mesh.h"
#include "scene/notices.h"
#include "scene/scene.h"

#include <glm/vec2.hpp>
#include <string>

namespace clrt {

/// The files of both ends of the way, for messages.
struct MotionFiles {
    std::string start, end;
};

/// Moves a mesh, which is that of time 0, to where it is when the shutter opens, and sets its end positions
/// and normals to where it is when it closes, if that is another place. Smoothing groups become normals
/// first. How polygons are cut into triangles is that of time 0. Throws SceneError, naming the end's file and
/// the first difference, where its vertices, normals or faces are not those of the start.
void add_motion(const MotionFiles& files, const glm::dvec2& shutter, Mesh& mesh, Mesh end,
                NoticeList& notices);

/// Gives what was added to the scene since its geometry was assembled no motion, and forgets motion that is
/// none. Throws SceneError where an emissive triangle moves: the density of its points would change with
/// time.
void finish_moves(const std::string& end_file, Scene& scene);

} // namespace clrt
