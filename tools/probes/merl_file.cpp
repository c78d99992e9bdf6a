// SPDX-License-Identifier: Apache-2.0
#include "probes/merl_file.h"

#include "scene/vectors.h"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

namespace clrt {

namespace {

template <typename T>
void append(T value, std::string& bytes) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof raw);
}

/// The BRDF of the pair of directions at these angles.
glm::dvec3 value_at(const BrdfFunction& brdf, double half_angle, double difference_angle, double azimuth) {
    const glm::dvec3 h(std::sin(half_angle), 0, std::cos(half_angle));
    const glm::dvec3 across(std::cos(half_angle), 0, -std::sin(half_angle)), aside(0, 1, 0);
    const glm::dvec3 wi =
        std::cos(difference_angle) * h +
        std::sin(difference_angle) * (std::cos(azimuth) * across + std::sin(azimuth) * aside);
    const glm::dvec3 wo = 2 * glm::dot(wi, h) * h - wi;
    return wi.z > 0 && wo.z > 0 ? brdf(wo, wi) : glm::dvec3(-1);
}

double smith_lambda(const glm::dvec3& w, double alpha) {
    const double tangent_squared = (1 - w.z * w.z) / (w.z * w.z);
    return (std::sqrt(1 + alpha * alpha * tangent_squared) - 1) / 2;
}

} // namespace

std::string merl_file(const BrdfFunction& brdf, const MerlCounts& counts) {
    std::string bytes;
    for (const i32 count : {counts.half, counts.difference, counts.azimuth})
        append(count, bytes);
    std::string channels[3];
    for (i32 i = 0; i < counts.half; ++i)
        for (i32 j = 0; j < counts.difference; ++j)
            for (i32 k = 0; k < counts.azimuth; ++k) {
                const double root = (i + 0.5) / counts.half;
                const glm::dvec3 value =
                    value_at(brdf, PI / 2 * root * root, PI / 2 * (j + 0.5) / counts.difference,
                             PI * (k + 0.5) / counts.azimuth);
                append(value.x * 1500, channels[0]);
                append(value.y * 1500 / 1.15, channels[1]);
                append(value.z * 1500 / 1.66, channels[2]);
            }
    return bytes + channels[0] + channels[1] + channels[2];
}

BrdfFunction matte_and_glossy(const glm::dvec3& matte, const glm::dvec3& specular, double alpha) {
    return [=](const glm::dvec3& wo, const glm::dvec3& wi) {
        if (alpha == 0)
            return matte / PI;
        const glm::dvec3 h = glm::normalize(wo + wi);
        const double a2 = alpha * alpha, base = 1 + (a2 - 1) * h.z * h.z, d = a2 / (PI * base * base);
        const double shadowed = (1 + smith_lambda(wo, alpha)) * (1 + smith_lambda(wi, alpha));
        return matte / PI + specular * (d / (shadowed * 4 * wo.z * wi.z));
    };
}

} // namespace clrt
