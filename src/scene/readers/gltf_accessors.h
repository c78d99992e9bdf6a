// SPDX-License-Identifier: Apache-2.0
// Typed arrays of a glTF file, every access checked: any component type, strides, sparse replacements,
// normalised integers.
#pragma once

#include "kernels/shared/types.h"
#include "scene/readers/gltf_buffers.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

namespace clrt {

/// What an accessor's elements may be.
enum class GltfElement { SCALAR, VEC2, VEC3, VEC4, COLOUR, MAT4 }; ///< COLOUR: VEC3 or VEC4

/// Elements of `components` numbers, side by side. Normalised integers are from 0 or -1 to 1.
struct GltfNumbers {
    size_t components = 0;
    std::vector<float> values;

    size_t count() const { return components ? values.size() / components : 0; }
    glm::vec2 vec2(size_t i) const { return {at(i, 0), at(i, 1)}; }
    glm::vec3 vec3(size_t i) const { return {at(i, 0), at(i, 1), at(i, 2)}; }
    glm::vec4 vec4(size_t i) const { return {vec3(i), at(i, 3)}; }
    float at(size_t i, size_t c) const { return values[components * i + c]; }
};

/// The accessor of an index. Throws SceneError: JSON path, expected, found.
GltfNumbers read_gltf_numbers(GltfBuffers& buffers, const JsonValue& index, GltfElement element);

/// The same of unsigned whole numbers: indices.
std::vector<u32> read_gltf_indices(GltfBuffers& buffers, const JsonValue& index);

/// How many elements an accessor has, without reading them.
size_t gltf_count(const GltfFile& file, const JsonValue& index);

} // namespace clrt
