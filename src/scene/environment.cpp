// SPDX-License-Identifier: Apache-2.0
#include "scene/environment.h"

#include "colour.h"
#include "error.h"
#include "scene/alias_table.h"
#include "scene/read_image.h"
#include "scene/vectors.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// A map whose bright texels exceed its mean by less than this share of its light is constant: more is not
/// rounding.
constexpr double SMALLEST_EXCESS = 1e-6;

/// Counts bad texels and remembers the first, for one line in the log.
struct BadTexels {
    size_t count = 0;
    int x = 0, y = 0;

    void note(int at_x, int at_y) {
        if (count++ == 0) {
            x = at_x;
            y = at_y;
        }
    }
};

double luminance_at(const EnvironmentImage& image, int x, int y) {
    return luminance(glm::dvec3(image.texels[size_t(y) * size_t(image.width) + size_t(x)]));
}

/// MIS compensation of weights that are luminance times solid angle and add up to `sum`: leaves of each what
/// exceeds the mean over the sphere. Where next to nothing does, they stay as they are.
void keep_above_mean(std::vector<double>& weights, int width, int height, double sum) {
    const auto above_mean = [&](int x, int y) {
        const double share = texel_solid_angle(y, width, height) / (4 * PI);
        return std::fmax(weights[size_t(y) * size_t(width) + size_t(x)] - sum * share, 0.0);
    };
    double excess = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            excess += above_mean(x, y);
    if (!(excess > SMALLEST_EXCESS * sum))
        return;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            weights[size_t(y) * size_t(width) + size_t(x)] = above_mean(x, y);
}

void check_factor(double factor, double rotation_degrees) {
    if (!(std::isfinite(factor) && factor >= 0))
        throw UsageError(fmt::format("--env-scale: expected a finite number not below 0, found {}", factor));
    if (!std::isfinite(rotation_degrees))
        throw UsageError(
            fmt::format("--env-rotate: expected an angle in degrees, found {}", rotation_degrees));
}

} // namespace

EnvironmentImage read_environment(const std::string& path) {
    const FloatImage pixels = read_float_image(path, ImageEncoding::COLOUR);
    EnvironmentImage image;
    image.width = pixels.width;
    image.height = pixels.height;
    image.texels.resize(pixels.rgba.size());
    for (size_t i = 0; i < pixels.rgba.size(); ++i)
        image.texels[i] = glm::vec3(pixels.rgba[i].x, pixels.rgba[i].y, pixels.rgba[i].z);
    return image;
}

void clean_environment(EnvironmentImage& image, const std::string& path, NoticeList& notices) {
    BadTexels non_finite, negative;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            glm::vec3& texel = image.texels[size_t(y) * size_t(image.width) + size_t(x)];
            if (!std::isfinite(texel.x) || !std::isfinite(texel.y) || !std::isfinite(texel.z)) {
                non_finite.note(x, y);
                texel = glm::vec3(0);
            } else if (texel.x < 0 || texel.y < 0 || texel.z < 0) {
                negative.note(x, y);
                texel = glm::vec3(std::fmax(texel.x, 0.f), std::fmax(texel.y, 0.f), std::fmax(texel.z, 0.f));
            }
        }
    if (non_finite.count)
        notices.add(fmt::format("{} texels are NaN or infinite and became black, the first at {},{}",
                                non_finite.count, non_finite.x, non_finite.y),
                    {path, 0});
    if (negative.count)
        notices.add(fmt::format("{} texels have negative channels, which became 0, the first at {},{}",
                                negative.count, negative.x, negative.y),
                    {path, 0});
}

std::vector<double> cell_luminance(const EnvironmentImage& image) {
    const int width = image.width, height = image.height;
    std::vector<double> result(image.texels.size());
    tbb::parallel_for(0, height, [&](int y) {
        // Over its own cell a bilinear tent has the mean 6/8, over each neighbour's 1/8.
        const int rows[3] = {std::max(y - 1, 0), y, std::min(y + 1, height - 1)};
        std::vector<double> column(static_cast<size_t>(width));
        for (int x = 0; x < width; ++x)
            column[size_t(x)] = 0.125 * luminance_at(image, x, rows[0]) +
                                0.75 * luminance_at(image, x, rows[1]) +
                                0.125 * luminance_at(image, x, rows[2]);
        for (int x = 0; x < width; ++x) {
            const double left = column[size_t(x == 0 ? width - 1 : x - 1)];
            const double right = column[size_t(x == width - 1 ? 0 : x + 1)];
            result[size_t(y) * size_t(width) + size_t(x)] =
                0.125 * left + 0.75 * column[size_t(x)] + 0.125 * right;
        }
    });
    return result;
}

double texel_solid_angle(int row, int width, int height) {
    // cos a - cos b = 2 sin((a+b)/2) sin((b-a)/2): no cancellation at the poles.
    const double middle = PI * (row + 0.5) / height, half = 0.5 * PI / height;
    return 2 * PI / width * 2 * std::sin(middle) * std::sin(half);
}

SkySampling sky_sampling(Integrator integrator) {
    return integrator == Integrator::PATH ? SkySampling::BY_TABLE_AND_BSDF : SkySampling::BY_TABLE;
}

Environment map_environment(const EnvironmentImage& image, double factor, double rotation_degrees,
                            SkySampling sampling, NoticeList& notices) {
    check_factor(factor, rotation_degrees);
    std::vector<double> weights = cell_luminance(image);
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
        const double solid_angle = texel_solid_angle(y, image.width, image.height);
        for (int x = 0; x < image.width; ++x)
            sum += weights[size_t(y) * size_t(image.width) + size_t(x)] *= solid_angle;
    }
    if (!(sum > 0)) {
        notices.add("the environment map is black: it gives no light");
        return {};
    }
    if (sampling == SkySampling::BY_TABLE_AND_BSDF)
        keep_above_mean(weights, image.width, image.height, sum);

    const AliasTable table = build_alias_table(weights);
    Environment environment;
    environment.radiance = glm::dvec3(factor);
    environment.width = image.width;
    environment.height = image.height;
    environment.rotation_degrees = rotation_degrees;
    environment.mean_radiance = factor * sum / (4 * PI);
    environment.texels.resize(image.texels.size());
    tbb::parallel_for(size_t(0), image.texels.size(), [&](size_t i) {
        const glm::vec3& texel = image.texels[i];
        environment.texels[i].radiance = {texel.x, texel.y, texel.z, float(table.probability[i])};
        environment.texels[i].alias = table.entries[i].alias;
        environment.texels[i].threshold = table.entries[i].threshold;
    });
    return environment;
}

Environment constant_environment(const glm::dvec3& radiance) {
    for (int c = 0; c < 3; ++c)
        if (!(std::isfinite(radiance[c]) && radiance[c] >= 0))
            throw UsageError(
                fmt::format("--env: expected a radiance of finite numbers not below 0, found {},{},{}",
                            radiance.x, radiance.y, radiance.z));
    Environment environment;
    environment.radiance = radiance;
    environment.mean_radiance = luminance(radiance);
    return environment;
}

Environment load_environment(const LightOptions& options, bool scene_has_light, SkySampling sampling,
                             NoticeList& notices) {
    const double factor = options.environment_scale;
    check_factor(factor, options.environment_rotation_degrees);
    if (!options.environment_file.empty()) {
        EnvironmentImage image = read_environment(options.environment_file);
        clean_environment(image, options.environment_file, notices);
        return map_environment(image, factor, options.environment_rotation_degrees, sampling, notices);
    }
    if (options.environment)
        return constant_environment(*options.environment * factor);
    if (scene_has_light)
        return {};
    notices.add("no light in the scene: white sky of radiance 1 (--env 1,1,1)");
    return constant_environment(glm::dvec3(factor));
}

} // namespace clrt
