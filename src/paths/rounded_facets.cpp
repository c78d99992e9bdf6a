// SPDX-License-Identifier: Apache-2.0
#include "paths/rounded_facets.h"

#include "kernels/shared/flat_facet.h"
#include "scene/material_table.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace clrt {

namespace {

/// The smallest cosine between the plane of a triangle and its corner normals, which lean to one side of it;
/// 1 for triangles without area.
double smallest_cosine(const Scene& scene, const Triangle& triangle) {
    const glm::dvec3 p0 = to_dvec3(scene.positions[triangle.v0]);
    const glm::dvec3 across =
        glm::cross(to_dvec3(scene.positions[triangle.v1]) - p0, to_dvec3(scene.positions[triangle.v2]) - p0);
    const double length = glm::length(across);
    if (!(length > 0))
        return 1;
    double sum = 0, smallest = 1, largest = -1;
    for (const u32 n : {triangle.n0, triangle.n1, triangle.n2}) {
        const double cosine = glm::dot(glm::normalize(to_dvec3(scene.normals[n])), across) / length;
        sum += cosine;
        smallest = std::min(smallest, cosine);
        largest = std::max(largest, cosine);
    }
    return sum < 0 ? -largest : smallest;
}

} // namespace

std::optional<BlindSpot> find_rounded_facets(const Scene& scene, Integrator integrator) {
    const IntegratorRow& row = integrator_row(integrator);
    if (row.film != FilmAccess::SPLAT || row.connections != Connections::NO_LIGHT)
        return std::nullopt;
    double smallest = FLAT_FACET_COS;
    const Triangle* most = nullptr;
    for (const Triangle& triangle : scene.triangles)
        if (triangle.n0 != NO_INDEX)
            if (const double cosine = smallest_cosine(scene, triangle); cosine < smallest) {
                smallest = cosine;
                most = &triangle;
            }
    if (!most)
        return std::nullopt;
    BlindSpot spot;
    spot.paths = fmt::format("part of {}", row.paths.by_connection);
    spot.cause = fmt::format(
        "facets that corner normals round are lit from below their planes too; most, by {:.2g} "
        "degrees, in {}",
        glm::degrees(std::acos(std::max(smallest, -1.0))), describe_material(scene, most->material));
    const SourcePlace& place = scene.material_places[most->material];
    if (place.line)
        spot.where = fmt::format("{}:{}", place.file, place.line);
    return spot;
}

} // namespace clrt
