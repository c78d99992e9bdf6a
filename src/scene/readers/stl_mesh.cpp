// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/stl_mesh.h"

#include "scene/triangulate.h"
#include "scene/vectors.h"

#include <algorithm>
#include <xxhash.h>

namespace clrt {

size_t StlMesh::Hash::operator()(const glm::dvec3& p) const {
    return size_t(XXH3_64bits(&p, sizeof p));
}

u32 StlMesh::index_of(const glm::dvec3& position) {
    const glm::dvec3 p = position + 0.0; // -0 is 0
    const auto [found, is_new] = indices_.emplace(p, u32(mesh_.positions.size()));
    if (is_new)
        mesh_.positions.push_back(p);
    return found->second;
}

void StlMesh::begin_object(const std::string& name) {
    mesh_.object_names.push_back(name);
}

void StlMesh::add_facet(const std::vector<glm::dvec3>& vertices, const SourcePlace& place) {
    const bool is_finite_facet =
        std::all_of(vertices.begin(), vertices.end(), [](const glm::dvec3& p) { return is_finite(p); });
    if (vertices.size() < 3 || !is_finite_facet) {
        notices_.add(is_finite_facet ? "a facet with fewer than three vertices is left out"
                                     : "a facet with a vertex that is not finite is left out",
                     place);
        ++dropped_;
        return;
    }
    if (!triangulate(vertices, cut_))
        notices_.add("a facet that crosses itself or has no area is cut into triangles that may overlap",
                     place);
    for (size_t i = 0; i < cut_.size(); i += 3) {
        MeshTriangle triangle{{0, 0, 0},
                              {NO_INDEX, NO_INDEX, NO_INDEX},
                              {NO_INDEX, NO_INDEX, NO_INDEX},
                              0,
                              u32(mesh_.object_names.size() - 1)};
        for (size_t k = 0; k < 3; ++k)
            triangle.v[k] = index_of(vertices[cut_[i + k]]);
        mesh_.triangles.push_back(triangle);
    }
}

} // namespace clrt
