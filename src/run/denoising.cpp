// SPDX-License-Identifier: Apache-2.0
#include "run/denoising.h"

#include "denoise/oidn.h"
#include "error.h"
#include "options/options.h"
#include "render/error_text.h"

#include <algorithm>
#include <fmt/format.h>
#include <new>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <stdexcept>

namespace clrt {

namespace {

/// "from 21.0 % to 6.0 % (5.4 to 6.7)", or what can be said where the noise hides the error.
std::string change_text(const DenoisedError& error) {
    if (!(error.low > 0))
        return fmt::format("from {} to {} at most", percent_text(error.raw), percent_text(error.high));
    return fmt::format("from {} to {} (with 95 % confidence {} to {})", percent_text(error.raw),
                       percent_text(error.denoised), percent_text(error.low), percent_text(error.high));
}

nlohmann::ordered_json error_json(const DenoisedError& error) {
    return {
        {"raw_rel_rmse", error.raw}, {"rel_rmse", error.denoised}, {"low", error.low}, {"high", error.high}};
}

} // namespace

void check_denoiser(const Options& options) {
    if (options.denoise.denoiser == Denoiser::OIDN)
        try {
            const Oidn oidn(options.denoise.oidn_path);
        } catch (const std::runtime_error& error) {
            throw UsageError(fmt::format("option --denoise=oidn: {}", error.what()));
        }
    const std::vector<std::string>& files = options.output.files;
    if (options.denoise.denoiser && options.denoise.png_from == PngFrom::RAW &&
        std::none_of(files.begin(), files.end(), is_layered_output))
        spdlog::warn("no file will hold the denoised picture: add -o FILE.exr, or --png-from denoised");
}

void denoise_render(const Device& device, const Options& options, Progress& progress, Render& render) {
    if (!options.denoise.denoiser || film_samples(render.film) == 0)
        return;
    const auto give_up = [&](const std::string& why) {
        progress.finish();
        render.denoise_error = why;
        spdlog::warn("the picture is not denoised: {}", why);
    };
    if (const std::optional<std::string> obstacle = denoise_obstacle(render.film, render.hits))
        return give_up(*obstacle);
    progress.update({"denoise", -1, 0, -1, -1});
    try {
        render.denoised = denoise(device, render.film, render.hits,
                                  {options.denoise,
                                   options.sampling.measure(),
                                   options.device.kernels_folder,
                                   {options.device.cache, options.device.cache_folder}});
    } catch (const DeviceError& error) {
        give_up(error.what());
    } catch (const std::bad_alloc&) {
        give_up("not enough memory");
    }
    progress.finish();
}

std::string format_denoised(const Render& render) {
    if (!render.denoised)
        return "";
    const Denoised& denoised = *render.denoised;
    if (!denoised.errors)
        return fmt::format("denoised by {}; its error is not known\n", denoised.method);
    const DenoisedErrors& errors = *denoised.errors;
    std::string text =
        fmt::format("denoised {}: denoising lowers the error {}\n", denoised.method, change_text(errors.all));
    text += fmt::format("         without the {} worst pixels ({:g} %) {}\n", errors.worst_pixels,
                        100 * WORST_SHARE, change_text(errors.without_worst));
    if (denoised.noisy_share > 0)
        text +=
            fmt::format("         {} of it is left as noisy as it was, where denoising does harm; {:.1f} s\n",
                        percent_text(denoised.noisy_share), denoised.seconds);
    return text;
}

nlohmann::ordered_json denoised_json(const Render& render) {
    if (!render.denoised)
        return nullptr;
    const Denoised& denoised = *render.denoised;
    nlohmann::ordered_json json;
    json["method"] = denoised.method;
    json["error"] = nullptr;
    json["without_worst"] = nullptr;
    if (denoised.errors) {
        json["error"] = error_json(denoised.errors->all);
        json["without_worst"] = error_json(denoised.errors->without_worst);
        json["without_worst"]["pixels"] = denoised.errors->worst_pixels;
    }
    json["noisy_share"] = denoised.noisy_share;
    json["seconds"] = denoised.seconds;
    return json;
}

void add_denoised_metadata(const Render& render, Metadata& metadata) {
    if (!render.denoised)
        return;
    const auto add = [&](const char* name, double value) {
        metadata.emplace_back(name, fmt::format("{:.6g}", value));
    };
    metadata.emplace_back("denoised.method", render.denoised->method);
    if (!render.denoised->errors)
        return;
    add("denoised.error", render.denoised->errors->all.denoised);
    add("denoised.error.low", render.denoised->errors->all.low);
    add("denoised.error.high", render.denoised->errors->all.high);
    add("denoised.error.without_worst", render.denoised->errors->without_worst.denoised);
}

} // namespace clrt
