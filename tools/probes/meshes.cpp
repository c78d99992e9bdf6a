// SPDX-License-Identifier: Apache-2.0
#include "probes/meshes.h"

#include "probes/random_inputs.h"
#include "scene/normalise.h"
#include "scene/place_instances.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

namespace clrt {

namespace {

Bounds bounds_of(const Scene& scene) {
    const double most = std::numeric_limits<double>::max();
    Bounds bounds{glm::dvec3(most), glm::dvec3(-most)};
    for (const Triangle& triangle : scene.triangles)
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 p = corner_position(scene, triangle, corner);
            bounds.low = glm::min(bounds.low, p);
            bounds.high = glm::max(bounds.high, p);
        }
    return scene.triangles.empty() ? Bounds() : bounds;
}

float coordinate(const vec4& row, const vec4& p) {
    return std::fma(row.x, p.x, std::fma(row.y, p.y, std::fma(row.z, p.z, row.w)));
}

vec4 placed_as_kernels_do(const Instance& instance, const vec4& p) {
    return {coordinate(instance.to_world[0], p), coordinate(instance.to_world[1], p),
            coordinate(instance.to_world[2], p), 0};
}

/// By the transpose of the inverse.
glm::dvec3 turned_normal(const Instance& instance, const glm::dvec3& n) {
    return glm::normalize(n.x * to_dvec3(instance.to_prototype[0]) +
                          n.y * to_dvec3(instance.to_prototype[1]) +
                          n.z * to_dvec3(instance.to_prototype[2]));
}

} // namespace

glm::dvec3 corner_position(const Scene& scene, const Triangle& triangle, int corner) {
    const u32 index = corner == 0 ? triangle.v0 : corner == 1 ? triangle.v1 : triangle.v2;
    return to_dvec3(scene.positions[index]);
}

glm::dvec3 triangle_normal(const Scene& scene, const Triangle& triangle) {
    const glm::dvec3 p0 = corner_position(scene, triangle, 0);
    return glm::cross(corner_position(scene, triangle, 1) - p0, corner_position(scene, triangle, 2) - p0);
}

u32 add_position(Scene& scene, const glm::dvec3& position) {
    scene.positions.push_back(to_vec4(position));
    return static_cast<u32>(scene.positions.size() - 1);
}

void add_triangle(Scene& scene, u32 v0, u32 v1, u32 v2) {
    Triangle triangle{};
    triangle.v0 = v0, triangle.v1 = v1, triangle.v2 = v2;
    triangle.n0 = triangle.n1 = triangle.n2 = NO_INDEX;
    triangle.t0 = triangle.t1 = triangle.t2 = NO_INDEX;
    triangle.emitter = NO_INDEX;
    scene.triangles.push_back(triangle);
}

void add_triangle(Scene& scene, const glm::dvec3& p0, const glm::dvec3& p1, const glm::dvec3& p2) {
    const u32 first = add_position(scene, p0);
    add_position(scene, p1);
    add_position(scene, p2);
    add_triangle(scene, first, first + 1, first + 2);
}

void append_scene(Scene& scene, const Scene& other) {
    const u32 first = static_cast<u32>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), other.positions.begin(), other.positions.end());
    for (const Triangle& triangle : other.triangles)
        add_triangle(scene, first + triangle.v0, first + triangle.v1, first + triangle.v2);
}

Scene make_empty_scene() {
    Scene scene;
    Material opaque{};
    opaque.matte = {0.5f, 0.5f, 0.5f, 1.0f};
    opaque.lobes = LOBE_MATTE;
    opaque.map_matte = opaque.map_specular = opaque.map_emission = opaque.map_coverage = NO_INDEX;
    opaque.map_roughness = opaque.map_metallic = opaque.map_normal = opaque.map_bump = NO_INDEX;
    scene.materials.push_back(opaque);
    return scene;
}

Scene make_ball(int slices, int stacks) {
    Scene scene = make_empty_scene();
    const u32 n = static_cast<u32>(slices), bands = static_cast<u32>(stacks);
    const u32 north = add_position(scene, {0, 0, 1});
    for (u32 band = 1; band < bands; ++band)
        for (u32 slice = 0; slice < n; ++slice) {
            const double theta = PI * band / stacks, phi = 2 * PI * slice / slices;
            add_position(scene,
                         {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
        }
    const u32 south = add_position(scene, {0, 0, -1});
    const auto ring = [&](u32 band, u32 slice) { return 1 + (band - 1) * n + slice % n; };
    for (u32 slice = 0; slice < n; ++slice) {
        add_triangle(scene, north, ring(1, slice), ring(1, slice + 1));
        for (u32 band = 1; band + 1 < bands; ++band) {
            add_triangle(scene, ring(band, slice), ring(band + 1, slice), ring(band + 1, slice + 1));
            add_triangle(scene, ring(band, slice), ring(band + 1, slice + 1), ring(band, slice + 1));
        }
        add_triangle(scene, south, ring(bands - 1, slice + 1), ring(bands - 1, slice));
    }
    return scene;
}

Scene make_star(int slices, int stacks, unsigned seed) {
    Scene scene = make_ball(slices, stacks);
    Random random(seed);
    for (vec4& p : scene.positions)
        p = to_vec4(to_dvec3(p) * random.between(1, 6));
    return scene;
}

Scene make_soup(int count, double size, unsigned seed) {
    Scene scene = make_empty_scene();
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 centre = random.in_cube(1);
        const glm::dvec3 p0 = centre + random.in_cube(size), p1 = centre + random.in_cube(size);
        add_triangle(scene, p0, p1, centre + random.in_cube(size));
    }
    return scene;
}

Scene make_tilted_plane(int cells) {
    Scene scene = make_empty_scene();
    const u32 n = static_cast<u32>(cells);
    for (u32 j = 0; j <= n; ++j)
        for (u32 i = 0; i <= n; ++i) {
            const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
            add_position(scene, {x, y, x / 2 - y / 4});
        }
    for (u32 j = 0; j < n; ++j)
        for (u32 i = 0; i < n; ++i) {
            const u32 corner = j * (n + 1) + i;
            add_triangle(scene, corner, corner + 1, corner + n + 2);
            add_triangle(scene, corner, corner + n + 2, corner + n + 1);
        }
    return scene;
}

Scene make_room(const glm::dvec3& low, const glm::dvec3& high) {
    Scene scene = make_empty_scene();
    for (int i = 0; i < 8; ++i)
        add_position(scene, {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    const u32 walls[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                             {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    for (const auto& wall : walls) {
        add_triangle(scene, wall[0], wall[1], wall[2]);
        add_triangle(scene, wall[0], wall[2], wall[3]);
    }
    return scene;
}

Scene placed(Scene scene, double size, const glm::dvec3& place) {
    for (vec4& p : scene.positions)
        p = to_vec4(to_dvec3(p) * size + place);
    return scene;
}

Scene normalised(Scene scene) {
    scene.normalisation = fit_normalisation(bounds_of(scene));
    for (vec4& p : scene.positions)
        p = to_vec4(to_normalised(scene.normalisation, to_dvec3(p)));
    return scene;
}

void add_instances(Scene& scene, const Scene& prototype, const std::vector<glm::dmat4>& maps) {
    const u32 first = static_cast<u32>(scene.triangles.size()), number = u32(scene.prototypes.size());
    append_scene(scene, prototype);
    scene.prototypes.push_back({first, static_cast<u32>(prototype.triangles.size())});
    if (scene.instances.empty())
        scene.instances.emplace_back();
    const Bounds bounds = bounds_of(prototype);
    for (const glm::dmat4& map : maps) {
        Instance instance = make_instance(map, glm::max(glm::abs(bounds.low), glm::abs(bounds.high)));
        instance.prototype = number;
        instance.object = u32(scene.instances.size());
        scene.instances.push_back(instance);
    }
}

Scene written_out(const Scene& scene) {
    Scene all = scene;
    all.prototypes.clear();
    all.instances.clear();
    all.triangles.resize(own_triangle_count(scene.triangles, scene.prototypes));
    for (size_t i = 1; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Prototype& prototype = scene.prototypes[instance.prototype];
        std::map<u32, u32> places;
        const auto place = [&](u32 v) {
            const auto [known, is_new] = places.try_emplace(v, u32(all.positions.size()));
            if (is_new)
                all.positions.push_back(placed_as_kernels_do(instance, scene.positions[v]));
            return known->second;
        };
        for (u32 k = 0; k < prototype.triangle_count; ++k) {
            Triangle triangle = scene.triangles[prototype.first_triangle + k];
            for (u32* v : {&triangle.v0, &triangle.v1, &triangle.v2})
                *v = place(*v);
            triangle.object = instance.object;
            if (triangle.n0 != NO_INDEX)
                for (u32* n : {&triangle.n0, &triangle.n1, &triangle.n2}) {
                    all.normals.push_back(to_vec4(turned_normal(instance, to_dvec3(all.normals[*n]))));
                    *n = u32(all.normals.size() - 1);
                }
            all.triangles.push_back(triangle);
        }
    }
    return all;
}

float extent_of(const Scene& scene) {
    const Bounds bounds = bounds_of(scene);
    const glm::dvec3 reach = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    return static_cast<float>(std::max({reach.x, reach.y, reach.z}));
}

Core core_of(const Scene& scene) {
    const Bounds bounds = bounds_of(scene);
    const glm::dvec3 edge = bounds.high - bounds.low;
    return {bounds.centre(), 0.5 * std::min({edge.x, edge.y, edge.z})};
}

} // namespace clrt
