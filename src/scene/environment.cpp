// SPDX-License-Identifier: Apache-2.0
#include "scene/environment.h"

#include "colour.h"
#include "error.h"
#include "images/image_library.h"
#include "scene/sky_table.h"
#include "scene/sky_texels.h"
#include "scene/vectors.h"

#include <cmath>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

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
    const StoredImage stored = image_library().read(path, nullptr);
    const bool decodes = !stored.is_floating_point, is_grey = stored.channels <= 2;
    const auto channel = [&](size_t i) {
        const float value = stored.bytes.empty() ? stored.floats[i] : float(stored.bytes[i]) / 255.f;
        return decodes ? float(srgb_to_linear(double(value))) : value;
    };
    EnvironmentImage image;
    image.width = stored.width;
    image.height = stored.height;
    image.texels.resize(size_t(stored.width) * size_t(stored.height));
    tbb::parallel_for(size_t(0), image.texels.size(), [&](size_t i) {
        const size_t first = i * size_t(stored.channels);
        image.texels[i] = is_grey ? glm::vec3(channel(first))
                                  : glm::vec3(channel(first), channel(first + 1), channel(first + 2));
    });
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
    environment.rotation_degrees = rotation_degrees;
    const double of_texels = store_sky_texels(image, environment);
    if (of_texels != 1)
        notices.add(fmt::format("the environment map of {} x {} texels is kept in halves: each channel is "
                                "rounded by 1/4096 of itself at most",
                                image.width, image.height));
    environment.radiance = glm::dvec3(factor * of_texels);
    const double light = light_of_map(environment);
    if (!(light > 0)) {
        notices.add("the environment map is black: it gives no light");
        return {};
    }
    environment.mean_radiance = factor * of_texels * light / (4 * PI);
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
