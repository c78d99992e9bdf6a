// SPDX-License-Identifier: Apache-2.0
// Facets -> a mesh in which equal vertices are one.
#pragma once

#include "scene/mesh.h"
#include "scene/notices.h"

#include <cstddef>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace clrt {

class StlMesh {
public:
    explicit StlMesh(NoticeList& notices) : notices_(notices) {}

    /// From here on facets are of this object.
    void begin_object(const std::string& name);

    /// Adds a facet, cut into triangles; one with fewer than three vertices or a non-finite one is left out,
    /// with a notice at `place`.
    void add_facet(const std::vector<glm::dvec3>& vertices, const SourcePlace& place);

    /// Facets that were left out.
    size_t dropped() const { return dropped_; }

    /// The mesh, and nothing stays here.
    Mesh take() { return std::move(mesh_); }

private:
    struct Hash {
        size_t operator()(const glm::dvec3& p) const;
    };

    u32 index_of(const glm::dvec3& position);

    NoticeList& notices_;
    Mesh mesh_;
    std::unordered_map<glm::dvec3, u32, Hash> indices_; // of positions
    std::vector<u32> cut_;
    size_t dropped_ = 0;
};

} // namespace clrt
