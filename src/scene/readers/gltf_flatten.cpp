// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_flatten.h"

#include "scene/readers/gltf_instances.h"
#include "scene/vectors.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace clrt {

namespace {

/// Between two updates of the progress line.
constexpr size_t INSTANCES_A_STEP = 256;

/// What flattened instances take.
struct Size {
    size_t vertices = 0, triangles = 0, bytes = 0;
};

size_t vertex_bytes(const GltfPrimitive& primitive, bool has_colours) {
    const auto bytes = [](const auto& values) { return values.empty() ? 0 : sizeof values.front(); };
    return sizeof(glm::dvec3) + bytes(primitive.normals) + bytes(primitive.uvs) +
           bytes(primitive.second_uvs) + (has_colours ? sizeof(glm::vec3) : 0);
}

bool is_copied(const GltfPrimitive& primitive, const GltfInstance& instance, const GltfMaterials& materials) {
    return !instance.only_emissive || materials.is_emissive(primitive.material);
}

Size measure(const std::vector<GltfInstance>& instances, const GltfMaterials& materials, bool has_colours) {
    Size size;
    for (const GltfInstance& instance : instances)
        for (const GltfPrimitive& primitive : *instance.primitives) {
            if (!is_copied(primitive, instance, materials))
                continue;
            size.vertices += primitive.positions.size();
            size.triangles += primitive.corners.size() / 3;
            size.bytes += primitive.positions.size() * vertex_bytes(primitive, has_colours) +
                          primitive.corners.size() / 3 * sizeof(MeshTriangle);
        }
    return size;
}

bool has_colours(const std::vector<GltfInstance>& instances) {
    return std::any_of(instances.begin(), instances.end(), [](const GltfInstance& instance) {
        return std::any_of(instance.primitives->begin(), instance.primitives->end(),
                           [](const GltfPrimitive& primitive) { return !primitive.colours.empty(); });
    });
}

/// Adds copies of primitives to a mesh.
class Flattener {
public:
    Flattener(Mesh& mesh, bool has_colours) : mesh_(mesh), has_colours_(has_colours) {}

    void add(const GltfPrimitive& primitive, const GltfInstance& instance) {
        const u32 first_position = u32(mesh_.positions.size()), first_normal = u32(mesh_.normals.size()),
                  first_uv = u32(mesh_.uvs.size());
        for (const glm::vec3& p : primitive.positions)
            mesh_.positions.emplace_back(instance.world * glm::dvec4(glm::dvec3(p), 1));
        add_normals(primitive, normal_transform(instance.world));
        add_coordinates(primitive, mesh_);
        if (has_colours_)
            add_colours(primitive);
        const bool mirrored = is_mirrored(instance.world);
        for (size_t i = 0; i < primitive.corners.size(); i += 3) {
            u32 corner[3] = {primitive.corners[i], primitive.corners[i + 1], primitive.corners[i + 2]};
            if (mirrored)
                std::swap(corner[1], corner[2]);
            MeshTriangle triangle{};
            triangle.material = primitive.material;
            triangle.object = instance.object;
            for (size_t k = 0; k < 3; ++k) {
                triangle.v[k] = first_position + corner[k];
                triangle.n[k] = primitive.normals.empty() ? NO_INDEX : first_normal + corner[k];
                triangle.t[k] = primitive.uvs.empty() ? NO_INDEX : first_uv + corner[k];
            }
            add_finite(triangle);
        }
    }

    size_t dropped() const { return dropped_; }

private:
    void add_normals(const GltfPrimitive& primitive, const glm::dmat3& turn) {
        for (const glm::vec3& n : primitive.normals) {
            const glm::dvec3 turned = turn * glm::dvec3(n);
            const double size = largest_magnitude(turned);
            mesh_.normals.emplace_back(size > 0 ? turned / size
                                                : turned); // floats hold it whatever the scale
        }
    }

    void add_colours(const GltfPrimitive& primitive) {
        mesh_.colours.insert(mesh_.colours.end(), primitive.colours.begin(), primitive.colours.end());
        mesh_.colours.resize(mesh_.positions.size(), glm::vec3(1));
    }

    void add_finite(const MeshTriangle& triangle) {
        const bool finite =
            std::all_of(triangle.v, triangle.v + 3, [&](u32 v) { return is_finite(mesh_.positions[v]); });
        dropped_ += !finite;
        if (finite)
            mesh_.triangles.push_back(triangle);
    }

    static double largest_magnitude(const glm::dvec3& v) {
        return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    }

    Mesh& mesh_;
    bool has_colours_;
    size_t dropped_ = 0;
};

void check_size(const Size& size, size_t instances, const GltfFile& file) {
    if (size.vertices >= NO_INDEX || size.bytes > MOST_FLATTENED_BYTES)
        file.json().root().fail(
            fmt::format("meshes that take at most {} GiB and {} vertices with a copy for each instance "
                        "(--instances on shares what neither shines nor moves)",
                        MOST_FLATTENED_BYTES >> 30, NO_INDEX - 1),
            fmt::format("{} instances of {} triangles and {} vertices, {:.1f} GiB", instances, size.triangles,
                        size.vertices, double(size.bytes) / double(size_t(1) << 30)));
}

} // namespace

void flatten_gltf(const std::vector<GltfNode>& nodes, GltfBuffers& buffers, GltfMeshes& meshes,
                  const GltfMaterials& materials, const ReadContext& context, SceneDescription& scene) {
    std::vector<GltfInstance> instances = find_gltf_instances(nodes, buffers, meshes, context, scene.mesh);
    instances = share_gltf_meshes(std::move(instances), materials, context, buffers.file().name(), scene);
    const bool coloured = has_colours(instances);
    const Size size = measure(instances, materials, coloured);
    check_size(size, instances.size(), buffers.file());
    std::set<const void*> shapes;
    for (const GltfInstance& instance : instances)
        shapes.insert(instance.primitives);
    if (instances.size() > shapes.size())
        context.notices.add(fmt::format("{} instances of {} meshes, a copy for each: {} triangles, {:.1f} MB",
                                        instances.size(), shapes.size(), size.triangles,
                                        double(size.bytes) / 1e6),
                            {buffers.file().name(), 0});
    scene.mesh.positions.reserve(size.vertices);
    scene.mesh.triangles.reserve(size.triangles);
    Flattener flattener(scene.mesh, coloured);
    for (size_t i = 0; i < instances.size(); ++i) {
        for (const GltfPrimitive& primitive : *instances[i].primitives)
            if (is_copied(primitive, instances[i], materials))
                flattener.add(primitive, instances[i]);
        if (i % INSTANCES_A_STEP == 0)
            context.progress.update({"load", double(i) / double(instances.size())});
    }
    scene.dropped_faces = flattener.dropped();
}

} // namespace clrt
