// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_instances.h"

#include "scene/place_instances.h"
#include "scene/readers/gltf_flatten.h"
#include "scene/readers/gltf_morph.h"
#include "scene/readers/gltf_skins.h"
#include "scene/vectors.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <map>

namespace clrt {

namespace {

/// The places of EXT_mesh_gpu_instancing: one transform each, between the node and its mesh.
std::vector<glm::dmat4> gpu_instances(const JsonValue& extension, GltfBuffers& buffers) {
    const JsonValue attributes = extension.at("attributes");
    const auto read = [&](const char* name, GltfElement element) {
        const std::optional<JsonValue> index = attributes.find(name);
        return index ? read_gltf_numbers(buffers, *index, element) : GltfNumbers();
    };
    const GltfNumbers translation = read("TRANSLATION", GltfElement::VEC3),
                      rotation = read("ROTATION", GltfElement::VEC4),
                      scale = read("SCALE", GltfElement::VEC3);
    const size_t count = std::max({translation.count(), rotation.count(), scale.count()});
    for (const GltfNumbers* numbers : {&translation, &rotation, &scale})
        if (numbers->count() != 0 && numbers->count() != count)
            attributes.fail(fmt::format("{} elements each", count), fmt::format("{}", numbers->count()));
    std::vector<glm::dmat4> transforms;
    for (size_t i = 0; i < count; ++i)
        transforms.push_back(
            gltf_transform(translation.count() ? glm::dvec3(translation.vec3(i)) : glm::dvec3(0),
                           rotation.count() ? glm::dvec4(rotation.vec4(i)) : glm::dvec4(0, 0, 0, 1),
                           scale.count() ? glm::dvec3(scale.vec3(i)) : glm::dvec3(1)));
    return transforms;
}

/// What meshes look like on their nodes: with what morph targets add, bent by skins.
class Shapes {
public:
    Shapes(const std::vector<GltfNode>& nodes, GltfBuffers& buffers, GltfMeshes& meshes, NoticeList& notices)
        : nodes_(nodes), buffers_(buffers), meshes_(meshes), notices_(notices) {}

    const std::vector<GltfPrimitive>* find(const GltfNode& node, const JsonValue& mesh,
                                           const JsonValue& index) {
        const std::vector<GltfPrimitive>* primitives = &meshes_.find(index);
        const std::vector<double> weights = morph_weights(*primitives, node, mesh);
        if (std::any_of(weights.begin(), weights.end(), [](double weight) { return weight != 0; })) {
            count(*primitives, node);
            primitives = &meshes_.keep(morph(*primitives, weights));
        }
        if (node.json.find("skin")) {
            count(*primitives, node);
            primitives = &meshes_.keep(bend_by_skin(*primitives, node, nodes_, buffers_, notices_));
        }
        return primitives;
    }

private:
    /// Counts the copy that is going to be made.
    void count(const std::vector<GltfPrimitive>& primitives, const GltfNode& node) {
        for (const GltfPrimitive& primitive : primitives)
            bytes_ += primitive.positions.size() * (2 * sizeof(glm::vec3) + sizeof(glm::vec2)) +
                      primitive.corners.size() * sizeof(u32);
        if (bytes_ > MOST_FLATTENED_BYTES)
            node.json.fail(fmt::format("skins and morph targets whose meshes take at most {} GiB",
                                       MOST_FLATTENED_BYTES >> 30),
                           "more");
    }

    const std::vector<GltfNode>& nodes_;
    GltfBuffers& buffers_;
    GltfMeshes& meshes_;
    NoticeList& notices_;
    size_t bytes_ = 0;
};

/// A mesh that is used.
struct Use {
    size_t count = 0;      ///< of its instances that could share it
    size_t triangles = 0;  ///< that do not shine
    glm::dvec3 largest{0}; ///< |coordinates| of its corners
    u32 prototype = NO_INDEX;
};

using Uses = std::map<const std::vector<GltfPrimitive>*, Use>;

glm::dvec3 largest_coordinates(const std::vector<GltfPrimitive>& primitives) {
    glm::dvec3 largest(0);
    for (const GltfPrimitive& primitive : primitives)
        for (const glm::vec3& p : primitive.positions)
            if (is_finite(glm::dvec3(p)))
                largest = glm::max(largest, glm::abs(glm::dvec3(p)));
    return largest;
}

/// Whether an instance has a map that can be undone, and all its corners are finite.
bool can_share(const glm::dmat4& world, const glm::dvec3& largest) {
    if (kind_of_map(world) != MapKind::PLACES)
        return false;
    glm::dvec3 farthest = glm::abs(glm::dvec3(world[3]));
    for (int column = 0; column < 3; ++column)
        farthest += glm::abs(glm::dvec3(world[column])) * largest[column];
    return is_finite(farthest);
}

Uses find_uses(const std::vector<GltfInstance>& instances, const GltfMaterials& materials) {
    Uses uses;
    for (const GltfInstance& instance : instances) {
        const auto [known, is_new] = uses.try_emplace(instance.primitives);
        Use& use = known->second;
        if (is_new) {
            use.largest = largest_coordinates(*instance.primitives);
            for (const GltfPrimitive& primitive : *instance.primitives)
                if (!materials.is_emissive(primitive.material))
                    use.triangles += primitive.corners.size() / 3;
        }
        use.count += can_share(instance.world, use.largest);
    }
    return uses;
}

bool is_shared(const Use& use, Toggle choice) {
    if (use.count < 2 || use.triangles == 0 || choice == Toggle::OFF)
        return false;
    return choice == Toggle::ON || (use.count - 1) * use.triangles >= LEAST_COPIED_TRIANGLES;
}

bool is_finite_triangle(const GltfPrimitive& primitive, const u32* corners) {
    return std::all_of(corners, corners + 3,
                       [&](u32 v) { return is_finite(glm::dvec3(primitive.positions[v])); });
}

/// Adds a primitive to a prototype; returns the triangles with a corner that is not finite, which are not
/// added.
size_t add_primitive(const GltfPrimitive& primitive, Mesh& mesh) {
    const u32 first_position = u32(mesh.positions.size()), first_normal = u32(mesh.normals.size()),
              first_uv = u32(mesh.uvs.size());
    if (!primitive.colours.empty()) {
        mesh.colours.resize(first_position, glm::vec3(1));
        mesh.colours.insert(mesh.colours.end(), primitive.colours.begin(), primitive.colours.end());
    }
    mesh.positions.insert(mesh.positions.end(), primitive.positions.begin(), primitive.positions.end());
    mesh.normals.insert(mesh.normals.end(), primitive.normals.begin(), primitive.normals.end());
    add_coordinates(primitive, mesh);
    if (!mesh.colours.empty())
        mesh.colours.resize(mesh.positions.size(), glm::vec3(1));
    size_t dropped = 0;
    for (size_t i = 0; i < primitive.corners.size(); i += 3) {
        const u32* const corner = &primitive.corners[i];
        MeshTriangle triangle{};
        triangle.material = primitive.material;
        for (size_t k = 0; k < 3; ++k) {
            triangle.v[k] = first_position + corner[k];
            triangle.n[k] = primitive.normals.empty() ? NO_INDEX : first_normal + corner[k];
            triangle.t[k] = primitive.uvs.empty() ? NO_INDEX : first_uv + corner[k];
        }
        if (is_finite_triangle(primitive, corner))
            mesh.triangles.push_back(triangle);
        else
            ++dropped;
    }
    return dropped;
}

/// The part of a mesh that does not shine, and whether there is another.
bool add_prototype(const std::vector<GltfPrimitive>& primitives, const GltfMaterials& materials,
                   SceneDescription& scene) {
    bool shines = false;
    Mesh& mesh = scene.prototypes.emplace_back();
    for (const GltfPrimitive& primitive : primitives)
        if (materials.is_emissive(primitive.material))
            shines = true;
        else
            scene.dropped_faces += add_primitive(primitive, mesh);
    return shines;
}

} // namespace

std::vector<GltfInstance> find_gltf_instances(const std::vector<GltfNode>& nodes, GltfBuffers& buffers,
                                              GltfMeshes& meshes, const ReadContext& context, Mesh& mesh) {
    std::vector<GltfInstance> instances;
    Shapes shapes(nodes, buffers, meshes, context.notices);
    size_t vanished = 0;
    const auto add = [&](const GltfInstance& instance) {
        if (kind_of_map(instance.world) == MapKind::VANISHES && !context.is_key_frame)
            ++vanished;
        else
            instances.push_back(instance);
    };
    for (const GltfNode& node : nodes) {
        const std::optional<JsonValue> index = node.json.find("mesh");
        if (!index)
            continue;
        const JsonValue shape = buffers.file().json().element("meshes", *index);
        const std::vector<GltfPrimitive>* const primitives = shapes.find(node, shape, *index);
        const u32 object = u32(mesh.object_names.size());
        mesh.object_names.push_back(node.name.empty() ? shape.text("name") : node.name);
        const std::optional<JsonValue> extensions = node.json.find("extensions");
        const auto places = extensions ? extensions->find("EXT_mesh_gpu_instancing") : std::nullopt;
        if (const auto skin = node.json.find("skin")) { // in the world's frame already
            add({primitives, glm::dmat4(1), object});
            if (places)
                context.notices.add("EXT_mesh_gpu_instancing is ignored where a skin places the mesh",
                                    skin->place());
        } else if (!places)
            add({primitives, node.world, object});
        else
            for (const glm::dmat4& place : gpu_instances(*places, buffers))
                add({primitives, node.world * place, object});
    }
    if (vanished)
        context.notices.add(
            fmt::format("{} instances are scaled to nothing, or their transforms are not finite: "
                        "left out",
                        vanished),
            {buffers.file().name(), 0});
    return instances;
}

std::vector<GltfInstance> share_gltf_meshes(std::vector<GltfInstance> instances,
                                            const GltfMaterials& materials, const ReadContext& context,
                                            const std::string& path, SceneDescription& scene) {
    Uses uses = find_uses(instances, materials);
    std::vector<GltfInstance> copied;
    std::map<u32, bool> shines; // by prototype
    size_t triangles = 0;
    for (GltfInstance& instance : instances) {
        Use& use = uses[instance.primitives];
        if (!is_shared(use, context.instances) || !can_share(instance.world, use.largest)) {
            copied.push_back(instance);
            continue;
        }
        if (use.prototype == NO_INDEX) {
            use.prototype = u32(scene.prototypes.size());
            shines[use.prototype] = add_prototype(*instance.primitives, materials, scene);
            triangles += use.triangles;
        }
        scene.instances.push_back({use.prototype, instance.object, instance.world});
        if (shines[use.prototype]) {
            instance.only_emissive = true;
            copied.push_back(instance);
        }
    }
    if (!scene.instances.empty())
        context.notices.add(fmt::format("{} instances share {} meshes of {} triangles",
                                        scene.instances.size(), scene.prototypes.size(), triangles),
                            {path, 0});
    return copied;
}

} // namespace clrt
