// SPDX-License-Identifier: Apache-2.0
#include "scene/place_instances.h"

#include "error.h"
#include "scene/assemble_geometry.h"
#include "scene/cut_vast.h"
#include "scene/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <utility>

namespace clrt {
namespace {

/// Below this ratio of lengths and of volumes a map leaves floats no digits to undo it.
constexpr double LEAST_RATIO = 1e-5;

/// So many corners are placed for the exact box of all instances.
constexpr size_t MOST_PLACED_CORNERS = 50000000;

/// Stand-ins of all instances together.
constexpr size_t MOST_STAND_INS = 1 << 20;

/// Smaller instances, in the normalised frame, are left out: floats hardly tell their corners apart.
constexpr double LEAST_SIZE = 0x1p-22;

glm::dvec3 transformed(const glm::dmat4& map, const glm::dvec3& p) {
    return glm::dvec3(map * glm::dvec4(p, 1));
}

std::array<glm::dvec3, 8> corners_of(const Bounds& box) {
    std::array<glm::dvec3, 8> corners;
    for (size_t i = 0; i < 8; ++i)
        corners[i] = {i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y,
                      i & 4 ? box.high.z : box.low.z};
    return corners;
}

std::vector<Bounds> bounds_of_prototypes(const SceneDescription& description) {
    std::vector<Bounds> bounds;
    for (const Mesh& mesh : description.prototypes)
        bounds.push_back(bounds_of_triangles(mesh));
    return bounds;
}

bool is_mirror(const glm::dmat4& map) {
    return glm::determinant(glm::dmat3(map)) < 0;
}

/// How far apart the triangles of a prototype are that stand for an instance.
size_t stand_in_stride(const SceneDescription& description) {
    size_t all = 0;
    for (const MeshInstance& instance : description.instances)
        all += description.prototypes[instance.prototype].triangles.size();
    return 1 + all / MOST_STAND_INS;
}

void add_stand_in(const Mesh& mesh, const MeshTriangle& from, const MeshInstance& instance, Scene& scene) {
    const u32 first = u32(scene.positions.size());
    for (const u32 v : from.v)
        scene.positions.push_back(
            to_vec4(to_normalised(scene.normalisation, transformed(instance.to_world, mesh.positions[v]))));
    Triangle triangle{first,    first + 1, first + 2, NO_INDEX,      NO_INDEX, NO_INDEX,
                      NO_INDEX, NO_INDEX,  NO_INDEX,  from.material, NO_INDEX, instance.object};
    if (is_mirror(instance.to_world))
        std::swap(triangle.v1, triangle.v2);
    scene.triangles.push_back(triangle);
}

/// A mesh in its own frame, as the scene's arrays take it.
struct FramedMesh {
    Scene scene;
    Normalisation frame;
};

FramedMesh assemble_framed(Mesh& mesh, const std::string& path, NoticeList& notices) {
    FramedMesh part;
    const Bounds bounds = bounds_of_triangles(mesh);
    part.frame = fit_normalisation(bounds);
    assemble_geometry(mesh, bounds, part.frame, path, part.scene, notices);
    cut_vast_triangles(part.scene);
    return part;
}

/// Moves indices behind what is there already.
void shift(u32& index, size_t by) {
    if (index != NO_INDEX)
        index += u32(by);
}

void append_part(const Scene& part, u32 object, Scene& scene) {
    scene.prototypes.push_back({u32(scene.triangles.size()), u32(part.triangles.size())});
    const size_t positions = scene.positions.size(), normals = scene.normals.size(),
                 uvs = scene.uvs.size() / 2;
    for (Triangle triangle : part.triangles) {
        for (u32* v : {&triangle.v0, &triangle.v1, &triangle.v2})
            shift(*v, positions);
        for (u32* n : {&triangle.n0, &triangle.n1, &triangle.n2})
            shift(*n, normals);
        for (u32* t : {&triangle.t0, &triangle.t1, &triangle.t2})
            shift(*t, uvs);
        triangle.object = object;
        scene.triangles.push_back(triangle);
    }
    if (!part.vertex_colours.empty()) {
        scene.vertex_colours.resize(positions, glm::vec3(1));
        scene.vertex_colours.insert(scene.vertex_colours.end(), part.vertex_colours.begin(),
                                    part.vertex_colours.end());
    }
    scene.positions.insert(scene.positions.end(), part.positions.begin(), part.positions.end());
    scene.normals.insert(scene.normals.end(), part.normals.begin(), part.normals.end());
    scene.uvs.insert(scene.uvs.end(), part.uvs.begin(), part.uvs.end());
    if (!part.second_uvs.empty()) {
        scene.second_uvs.resize(2 * uvs);
        scene.second_uvs.insert(scene.second_uvs.end(), part.second_uvs.begin(), part.second_uvs.end());
    }
    if (!scene.second_uvs.empty())
        scene.second_uvs.resize(scene.uvs.size());
    scene.statistics.degenerate_triangles += part.statistics.degenerate_triangles;
}

/// Along an axis of the prototype, for a world coordinate of 1 in every direction.
double sum_of(const vec4& row) {
    return std::fabs(double(row.x)) + std::fabs(double(row.y)) + std::fabs(double(row.z));
}

/// The map from a prototype's normalised frame to the scene's.
glm::dmat4 frame_to_frame(const Normalisation& from, const glm::dmat4& to_world, const Normalisation& to) {
    glm::dmat4 map(glm::dmat3(to_world) * (to.scale / from.scale));
    map[3] = glm::dvec4(to_normalised(to, transformed(to_world, from.centre)), 1);
    return map;
}

/// Whether floats can tell an instance's corners apart.
bool is_visible(const Instance& instance) {
    return std::all_of(std::begin(instance.to_prototype), std::end(instance.to_prototype),
                       [](const vec4& row) { return sum_of(row) * LEAST_SIZE <= 1; });
}

glm::dvec3 largest_coordinates(const Scene& scene, const Prototype& prototype) {
    glm::dvec3 largest(0);
    for (u32 i = 0; i < prototype.triangle_count; ++i) {
        const Triangle& t = scene.triangles[prototype.first_triangle + i];
        for (const u32 v : {t.v0, t.v1, t.v2})
            largest = glm::max(largest, glm::abs(to_dvec3(scene.positions[v])));
    }
    return largest;
}

} // namespace

Instance make_instance(const glm::dmat4& map, const glm::dvec3& largest) {
    Instance instance{};
    glm::dmat3 rounded;
    double half = 0, reach = 0; // of the instance in the world, and of what is added to place it
    for (int row = 0; row < 3; ++row) {
        vec4& to_world = instance.to_world[row];
        to_world = to_vec4({map[0][row], map[1][row], map[2][row]}, map[3][row]);
        rounded[0][row] = double(to_world.x);
        rounded[1][row] = double(to_world.y);
        rounded[2][row] = double(to_world.z);
        const double coordinate = glm::dot(glm::abs(to_dvec3(to_world)), largest);
        half = std::max(half, coordinate);
        reach = std::max(reach, coordinate + std::fabs(double(to_world.w)));
    }
    const glm::dmat3 inverse = glm::inverse(rounded);
    for (int row = 0; row < 3; ++row) {
        vec4& to_prototype = instance.to_prototype[row];
        to_prototype = to_vec4({inverse[0][row], inverse[1][row], inverse[2][row]});
        INSTANCE_SLACK(to_prototype) = float(sum_of(to_prototype) * (30 * half + 4 * reach));
    }
    instance.side = glm::determinant(rounded) < 0 ? -1.0f : 1.0f;
    return instance;
}

MapKind kind_of_map(const glm::dmat4& to_world) {
    for (int column = 0; column < 4; ++column)
        if (!is_finite(glm::dvec3(to_world[column])))
            return MapKind::VANISHES;
    const glm::dvec3 x(to_world[0]), y(to_world[1]), z(to_world[2]);
    const double lengths[3] = {glm::length(x), glm::length(y), glm::length(z)};
    const auto [least, most] = std::minmax_element(lengths, lengths + 3);
    if (!(*most > 0))
        return MapKind::VANISHES;
    const glm::dvec3 a = x / *most, b = y / *most, c = z / *most;
    if (glm::cross(a, b) == glm::dvec3(0) && glm::cross(b, c) == glm::dvec3(0) &&
        glm::cross(c, a) == glm::dvec3(0))
        return MapKind::VANISHES;
    if (*least < LEAST_RATIO * *most)
        return MapKind::FLATTENS;
    const double volume = std::fabs(glm::dot(glm::cross(x / lengths[0], y / lengths[1]), z / lengths[2]));
    return volume < LEAST_RATIO ? MapKind::FLATTENS : MapKind::PLACES;
}

Bounds bounds_with_instances(const SceneDescription& description, const Bounds& own) {
    if (description.instances.empty())
        return own;
    const std::vector<Bounds> boxes = bounds_of_prototypes(description);
    size_t corners = 0;
    for (const MeshInstance& instance : description.instances)
        corners += 3 * description.prototypes[instance.prototype].triangles.size();
    bool is_first = description.mesh.triangles.empty();
    Bounds all = own;
    const auto extend = [&](const glm::dvec3& p) {
        all.low = is_first ? p : glm::min(all.low, p);
        all.high = is_first ? p : glm::max(all.high, p);
        is_first = false;
    };
    for (const MeshInstance& instance : description.instances) {
        const Mesh& mesh = description.prototypes[instance.prototype];
        if (corners > MOST_PLACED_CORNERS)
            for (const glm::dvec3& corner : corners_of(boxes[instance.prototype]))
                extend(transformed(instance.to_world, corner));
        else
            for (const MeshTriangle& triangle : mesh.triangles)
                for (const u32 v : triangle.v)
                    extend(transformed(instance.to_world, mesh.positions[v]));
    }
    return all;
}

StandIns add_stand_ins(const SceneDescription& description, Scene& scene) {
    StandIns stand_ins{scene.triangles.size(), 0, scene.positions.size(), 0};
    const size_t stride = stand_in_stride(description);
    for (const MeshInstance& instance : description.instances) {
        const Mesh& mesh = description.prototypes[instance.prototype];
        for (size_t i = 0; i < mesh.triangles.size(); i += stride)
            add_stand_in(mesh, mesh.triangles[i], instance, scene);
    }
    stand_ins.triangles = scene.triangles.size() - stand_ins.first_triangle;
    stand_ins.positions = scene.positions.size() - stand_ins.first_position;
    return stand_ins;
}

void remove_stand_ins(const StandIns& stand_ins, Scene& scene) {
    const auto erase = [](auto& values, size_t first, size_t count) {
        const auto begin = values.begin() + std::ptrdiff_t(first);
        values.erase(begin, begin + std::ptrdiff_t(count));
        values.shrink_to_fit();
    };
    if (stand_ins.triangles == 0)
        return;
    erase(scene.triangles, stand_ins.first_triangle, stand_ins.triangles);
    erase(scene.positions, stand_ins.first_position, stand_ins.positions);
    for (size_t i = stand_ins.first_triangle; i < scene.triangles.size(); ++i)
        for (u32* v : {&scene.triangles[i].v0, &scene.triangles[i].v1, &scene.triangles[i].v2})
            *v -= u32(stand_ins.positions);
}

void append_instances(SceneDescription& description, const std::string& path, Scene& scene,
                      NoticeList& notices) {
    if (description.instances.empty())
        return;
    std::vector<u32> objects(description.prototypes.size(), 0);
    for (auto instance = description.instances.rbegin(); instance != description.instances.rend(); ++instance)
        objects[instance->prototype] = instance->object;
    std::vector<Normalisation> frames;
    std::vector<glm::dvec3> largest;
    for (size_t i = 0; i < description.prototypes.size(); ++i) {
        const FramedMesh part = assemble_framed(description.prototypes[i], path, notices);
        if (scene.positions.size() + part.scene.positions.size() >= NO_INDEX)
            throw SceneError(path, 0, fmt::format("expected at most {} vertices", NO_INDEX - 1));
        append_part(part.scene, objects[i], scene);
        frames.push_back(part.frame);
        largest.push_back(largest_coordinates(scene, scene.prototypes.back()));
    }
    scene.instances.reserve(description.instances.size() + 1);
    scene.instances.emplace_back();
    size_t left_out = 0;
    for (const MeshInstance& from : description.instances) {
        const glm::dmat4 map = frame_to_frame(frames[from.prototype], from.to_world, scene.normalisation);
        Instance instance = make_instance(map, largest[from.prototype]);
        instance.prototype = from.prototype;
        instance.object = from.object;
        if (is_visible(instance))
            scene.instances.push_back(instance);
        else
            ++left_out;
    }
    std::vector<MeshInstance>().swap(description.instances);
    if (left_out)
        notices.add_line(fmt::format("{}: {} instances are smaller than {:.0e} of the scene: left out", path,
                                     left_out, LEAST_SIZE));
}

} // namespace clrt
