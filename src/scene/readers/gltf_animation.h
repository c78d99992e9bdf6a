// SPDX-License-Identifier: Apache-2.0
// Where the nodes of a glTF file are at a moment of its animations.
#pragma once

#include "options/scene_options.h"
#include "scene/notices.h"
#include "scene/readers/gltf_buffers.h"
#include "scene/readers/gltf_nodes.h"

namespace clrt {

/// What the animations set at reading.time: that of reading.animation alone where it names one, else all of
/// them. Before its first and behind its last key frame a value stands still. Between key frames as glTF 2.0,
/// appendix C, says: steps, straight lines, spherical ones for rotations, cubic Hermite splines. Nothing
/// without a time: the nodes are then where they stand in the file. Of two animations of the same property
/// the second is left out with a notice. Throws SceneError.
GltfPoses read_gltf_poses(GltfBuffers& buffers, const GltfReading& reading, NoticeList& notices);

} // namespace clrt
