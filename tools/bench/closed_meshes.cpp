// SPDX-License-Identifier: Apache-2.0
#include "bench/closed_meshes.h"

#include "probes/meshes.h"
#include "scene/normalise.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <random>

namespace clrt {

namespace {

/// Where distant meshes are: no axis is special there.
const glm::dvec3 AWAY = glm::normalize(glm::dvec3(148376, 1234, -223423));

ClosedMesh make_mesh(const std::string& name) {
    ClosedMesh mesh;
    mesh.name = name;
    mesh.scene = make_empty_scene();
    mesh.scene.material_names.emplace_back("opaque");
    mesh.scene.material_places.emplace_back();
    mesh.scene.material_rules.emplace_back();
    return mesh;
}

/// Adds the two triangles of a cell of the grid of `columns` vertices a row that starts at `first`; columns
/// close.
void add_cell(Scene& scene, u32 first, u32 columns, u32 row, u32 next_row, u32 column) {
    const u32 a = first + row * columns + column, b = first + row * columns + (column + 1) % columns;
    const u32 c = first + next_row * columns + column,
              d = first + next_row * columns + (column + 1) % columns;
    add_triangle(scene, a, c, d);
    add_triangle(scene, a, d, b);
}

/// Turns a profile of (radius, height), from top to bottom without the poles, about the z axis and closes it
/// by poles.
void add_lathe(Scene& scene, const std::vector<glm::dvec2>& profile, double top, double bottom, u32 slices) {
    const u32 north = add_position(scene, {0, 0, top}), south = add_position(scene, {0, 0, bottom});
    const u32 first = u32(scene.positions.size());
    for (const glm::dvec2& point : profile)
        for (u32 slice = 0; slice < slices; ++slice) {
            const double phi = 2 * PI * slice / slices;
            add_position(scene, {point.x * std::cos(phi), point.x * std::sin(phi), point.y});
        }
    const u32 rows = u32(profile.size());
    for (u32 slice = 0; slice < slices; ++slice) {
        const u32 next = (slice + 1) % slices, last = first + (rows - 1) * slices;
        add_triangle(scene, north, first + slice, first + next);
        add_triangle(scene, south, last + next, last + slice);
        for (u32 row = 0; row + 1 < rows; ++row)
            add_cell(scene, first, slices, row, row + 1, slice);
    }
}

void add_sphere(Scene& scene, double radius) {
    constexpr u32 ROWS = 32, SLICES = 32;
    std::vector<glm::dvec2> profile;
    for (u32 row = 1; row < ROWS; ++row)
        profile.emplace_back(radius * std::sin(PI * row / ROWS), radius * std::cos(PI * row / ROWS));
    add_lathe(scene, profile, radius, -radius, SLICES);
}

/// Adds a torus of radius 1 about the z axis, whose tube's radius varies at random by a share of `noise`.
void add_noise_torus(Scene& scene, u32 rows, u32 columns, double noise) {
    constexpr double TUBE = 0.4;
    const u32 first = u32(scene.positions.size());
    std::mt19937 random(1);
    for (u32 row = 0; row < rows; ++row) {
        const double phi = 2 * PI * row / rows;
        const glm::dvec3 outward(std::cos(phi), std::sin(phi), 0);
        for (u32 column = 0; column < columns; ++column) {
            const double theta = 2 * PI * column / columns;
            const double radius = TUBE * (1 + noise * (double(random()) / 2147483648.0 - 1));
            add_position(scene, outward * (1 + radius * std::cos(theta)) +
                                    glm::dvec3(0, 0, radius * std::sin(theta)));
            add_cell(scene, first, columns, row, (row + 1) % rows, column);
        }
    }
}

Bounds bounds_of(const Scene& scene) {
    Bounds bounds{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
    for (const vec4& p : scene.positions) {
        bounds.low = glm::min(bounds.low, to_dvec3(p));
        bounds.high = glm::max(bounds.high, to_dvec3(p));
    }
    return bounds;
}

/// How large a mesh of about unit size is made, and how far from the origin it is put.
struct Placement {
    const char* name;
    double size, distance;
};

/// A million away floats are 1/16 apart: a sphere of size 1 would have corners on one line there.
constexpr Placement PLACEMENTS[] = {
    {"at the origin", 1, 0}, {"size 4, 1e6 away", 4, 1e6}, {"size 1e-6", 1e-6, 0}, {"size 1e6", 1e6, 0}};

/// The mesh in its place, rounded to float; with `normalise`, then in the loader's frame. Sets Scene::extent.
ClosedMesh placed(ClosedMesh mesh, const Placement& placement, bool normalise) {
    const double size = placement.size;
    const glm::dvec3 place = AWAY * placement.distance;
    mesh.place = std::string(placement.name) + (normalise ? ", in the loader's frame" : "");
    Scene& scene = mesh.scene;
    for (vec4& p : scene.positions)
        p = to_vec4(to_dvec3(p) * size + place);
    for (vec4& core : mesh.cores)
        core = to_vec4(to_dvec3(core) * size + place, double(core.w) * size);
    if (normalise) {
        scene.normalisation = fit_normalisation(bounds_of(scene));
        for (vec4& p : scene.positions)
            p = to_vec4(to_normalised(scene.normalisation, to_dvec3(p)));
        for (vec4& core : mesh.cores)
            core = to_vec4(to_normalised(scene.normalisation, to_dvec3(core)),
                           double(core.w) * scene.normalisation.scale);
    }
    const Bounds bounds = bounds_of(scene);
    const glm::dvec3 reach = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    scene.extent = float(std::max({reach.x, reach.y, reach.z}));
    return mesh;
}

} // namespace

ClosedMesh make_sphere() {
    ClosedMesh mesh = make_mesh("sphere");
    add_sphere(mesh.scene, 1);
    mesh.cores = {{0, 0, 0, 0.8f}};
    return mesh;
}

ClosedMesh make_needle_fans() {
    ClosedMesh mesh = make_mesh("needle fans");
    add_lathe(mesh.scene, {{1, 0}}, 16, -16, 1024);
    mesh.cores = {{0, 0, 0, 0.8f}};
    return mesh;
}

ClosedMesh make_noise_torus() {
    constexpr u32 ROWS = 64;
    ClosedMesh mesh = make_mesh("noise torus");
    add_noise_torus(mesh.scene, ROWS, 24, 0.25);
    // The tube's inner radius, less what chords cut off, is 0.29.
    for (u32 row = 0; row < ROWS; ++row) {
        const double phi = 2 * PI * row / ROWS;
        mesh.cores.push_back(to_vec4({std::cos(phi), std::sin(phi), 0}, 0.2));
    }
    return mesh;
}

Scene make_rough_scene() {
    Scene scene = make_mesh("").scene;
    add_noise_torus(scene, 512, 256, 0.02);
    add_sphere(scene, 4);
    scene.camera.eye = {0, -2.5, 1.5};
    scene.camera.at = {0, 0, 0};
    scene.camera.up = {0, 0, 1};
    scene.environment.radiance = glm::dvec3(1);
    scene.environment.mean_radiance = 1;
    scene.extent = 4;
    return scene;
}

std::vector<ClosedMesh> watertight_meshes() {
    std::vector<ClosedMesh> meshes;
    for (const ClosedMesh& mesh : {make_sphere(), make_needle_fans(), make_noise_torus()})
        for (const Placement& placement : PLACEMENTS)
            for (const bool normalise : {false, true})
                meshes.push_back(placed(mesh, placement, normalise));
    return meshes;
}

bool is_closed_by_areas(const Scene& scene) {
    return std::none_of(scene.triangles.begin(), scene.triangles.end(), [&](const Triangle& triangle) {
        const glm::dvec3 a = to_dvec3(scene.positions[triangle.v0]),
                         b = to_dvec3(scene.positions[triangle.v1]),
                         c = to_dvec3(scene.positions[triangle.v2]);
        return a != b && b != c && a != c && glm::cross(b - a, c - a) == glm::dvec3(0);
    });
}

} // namespace clrt
