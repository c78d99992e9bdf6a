// SPDX-License-Identifier: Apache-2.0
#include "scene/environment.h"

#include "colour.h"
#include "error.h"
#include "scene/read_image.h"
#include "scene/sky_table.h"
#include "scene/vectors.h"

#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace clrt {
namespace {

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

Environment map_environment(const EnvironmentImage& image, double factor, double rotation_degrees,
                            NoticeList& notices) {
    check_factor(factor, rotation_degrees);
    Environment environment;
    environment.radiance = glm::dvec3(factor);
    environment.width = image.width;
    environment.height = image.height;
    environment.rotation_degrees = rotation_degrees;
    for (const glm::vec3& texel : image.texels)
        environment.texels.push_back({{texel.x, texel.y, texel.z, 0}, 0, 0, 0, 0});
    const std::vector<double> weights = texel_weights(environment);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(sum > 0)) {
        notices.add("the environment map is black: it gives no light");
        return {};
    }
    environment.mean_radiance = factor * sum / (4 * PI);
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

Environment load_environment(const LightOptions& options, bool scene_has_light, NoticeList& notices) {
    const double factor = options.environment_scale;
    check_factor(factor, options.environment_rotation_degrees);
    if (!options.environment_file.empty()) {
        EnvironmentImage image = read_environment(options.environment_file);
        clean_environment(image, options.environment_file, notices);
        return map_environment(image, factor, options.environment_rotation_degrees, notices);
    }
    if (options.environment)
        return constant_environment(*options.environment * factor);
    if (scene_has_light)
        return {};
    notices.add("no light in the scene: white sky of radiance 1 (--env 1,1,1)");
    return constant_environment(glm::dvec3(factor));
}

} // namespace clrt
