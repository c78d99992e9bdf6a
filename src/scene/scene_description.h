// SPDX-License-Identifier: Apache-2.0
// What a reader makes of a file: everything in terms of the field, nothing of the format's own.
#pragma once

#include "options/light_options.h"
#include "output/named_file.h"
#include "scene/material_description.h"
#include "scene/mesh.h"

#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// A camera of the file, world units; `at` is some point ahead.
struct FileCamera {
    std::string name; ///< "" where it has none
    Camera camera;
    std::optional<double> aspect{}; ///< width over height of its picture; absent: any
};

/// A place where a prototype is seen.
struct MeshInstance {
    u32 prototype; ///< into SceneDescription::prototypes
    u32 object;    ///< into the object names of SceneDescription::mesh
    glm::dmat4 to_world;
};

struct SceneDescription {
    Mesh mesh;                    ///< what is seen where it is
    std::vector<Mesh> prototypes; ///< meshes that instances share, without motion, in frames of their own
    std::vector<MeshInstance> instances; ///< by maps that place_instances.h can undo
    std::vector<Remark> colour_remarks;  ///< about Mesh::colours, not said where another surface takes theirs
    std::vector<MaterialDescription> materials; ///< those that triangles use
    std::vector<PointOptions> points;           ///< lights that are no geometry, in the units of the options
    std::vector<SunOptions> suns;
    std::vector<FileCamera> cameras;
    std::string z_up_reason;      ///< "it ...": why its up is z; empty where the file does not tell
    bool is_y_up = false;         ///< the format says that its up is y
    std::vector<NamedFile> files; ///< opened beside the scene's own
    size_t dropped_faces = 0;     ///< with a non-finite vertex or fewer than three corners
};

} // namespace clrt
