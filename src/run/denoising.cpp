// SPDX-License-Identifier: Apache-2.0
#include "run/denoising.h"

#include "denoise/oidn.h"
#include "error.h"
#include "options/options.h"
#include "render/denoised_target.h"
#include "render/error_text.h"

#include <algorithm>
#include <fmt/format.h>
#include <new>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// What denoising does to an error, as far as its interval tells.
std::string change_text(const DenoisedError& error, bool is_untrusted) {
    const std::string raw = percent_text(error.raw), high = percent_text(error.high);
    if (is_untrusted) // the interval knows nothing of light that is still to come
        return fmt::format("the error of {} is {} after denoising, or more", raw,
                           percent_text(error.denoised));
    if (error.high >= error.raw)
        return fmt::format("the error of {} is {} at most after denoising: these samples cannot tell whether "
                           "it is lower",
                           raw, high);
    if (!(error.low > 0))
        return fmt::format("denoising lowers the error from {} to {} at most, with 95 % confidence", raw,
                           high);
    return fmt::format("denoising lowers the error from {} to {}; with 95 % confidence {} to {}", raw,
                       percent_text(error.denoised), percent_text(error.low), high);
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
        } catch (const DeviceError& error) {
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
    if (render.denoised && render.denoised->samples == film_samples(render.film))
        return; // the last look of --denoised-error
    render.denoised.reset();
    progress.update({"denoise", -1, 0, -1, -1});
    try {
        render.denoised = FilmDenoiser(device, denoise_request(options)).denoise(render.film, render.hits);
    } catch (const DeviceError& error) {
        give_up(error.what());
    } catch (const std::bad_alloc&) {
        give_up("not enough memory");
    }
    progress.finish();
}

std::string format_denoised(const Render& render, bool is_untrusted) {
    if (!render.denoised)
        return "";
    const Denoised& denoised = *render.denoised;
    if (!denoised.errors)
        return fmt::format("denoised by {}; its error is not known\n", denoised.method);
    const DenoisedErrors& errors = *denoised.errors;
    std::string text = fmt::format("denoised {}\n", change_text(errors.all, is_untrusted));
    if (is_untrusted)
        text += "         how much more is not known: a few bright samples decide it, and more are still to "
                "come\n";
    text += fmt::format("         without the worst {:g} % of the pixels: {}\n", 100 * WORST_SHARE,
                        change_text(errors.without_worst, is_untrusted));
    text += fmt::format(
        "         by {} in {:.1f} s; {} of the picture is left as it was, where smoothing does harm\n",
        denoised.method, denoised.seconds, percent_text(denoised.noisy_share));
    if (!render.looks.empty()) {
        double seconds = 0;
        for (const DenoisedLook& look : render.looks)
            seconds += look.seconds;
        text += fmt::format("         --denoised-error looked {} times, first at {} spp; {:.1f} s in all\n",
                            render.looks.size(), render.looks.front().samples, seconds);
    }
    return text;
}

nlohmann::ordered_json denoised_json(const Render& render, bool is_untrusted) {
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
        json["without_worst"]["pixels"] = denoised.errors->worst.size();
    }
    json["interval_trusted"] = !is_untrusted;
    json["noisy_share"] = denoised.noisy_share;
    json["seconds"] = denoised.seconds;
    json["looks"] = nlohmann::ordered_json::array();
    for (const DenoisedLook& look : render.looks) {
        json["looks"].push_back(error_json(look.error));
        json["looks"].back()["at_spp"] = look.samples;
        json["looks"].back()["seconds"] = look.seconds;
    }
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
