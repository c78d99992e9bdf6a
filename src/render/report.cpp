// SPDX-License-Identifier: Apache-2.0
#include "render/report.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace clrt {

namespace {

using Json = nlohmann::ordered_json;

/// The command line as one could type it again.
std::string command_text(const Options& options) {
    std::string text;
    for (const std::string& word : options.command) {
        const bool plain = word.find_first_of(" \t'\"\\$&|;<>()*?") == std::string::npos && !word.empty();
        text += (text.empty() ? "" : " ") + (plain ? word : "'" + word + "'");
    }
    return text;
}

double rays_per_second(const Render& render) {
    return render.seconds > 0 ? double(render.counts.rays()) / render.seconds : 0;
}

std::vector<std::string> effect_names(const Effects& effects, bool present) {
    std::vector<std::string> names;
    for (const Effect& effect : effects.list)
        if (effect.present == present)
            names.push_back(effect.name);
    return names;
}

std::string format_error(const std::optional<FilmError>& error) {
    if (!error)
        return "not known (fewer than two replicates have samples, or the picture is black)";
    std::string text = fmt::format("{:.2f} % relative RMSE", 100 * error->relative_rmse);
    if (error->low && error->high)
        text += fmt::format(" (95 %: {:.2f} - {:.2f})", 100 * *error->low, 100 * *error->high);
    return text;
}

Json optional_number(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json error_json(const std::optional<FilmError>& error) {
    if (!error)
        return {{"rel_rmse", nullptr}, {"low", nullptr}, {"high", nullptr}};
    return {{"rel_rmse", error->relative_rmse},
            {"low", optional_number(error->low)},
            {"high", optional_number(error->high)}};
}

Json effects_json(const Effects& effects) {
    Json list = Json::array();
    for (const Effect& effect : effects.list)
        list.push_back({{"name", effect.name},
                        {"present", effect.present},
                        {"compiled", (effects.mask & effect.bit) != 0},
                        {"witness", effect.witness}});
    return list;
}

} // namespace

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024; // Linux counts in KiB
}

namespace {

const char* quality_name(BvhQuality quality) {
    return quality == BvhQuality::HIGH ? "high" : "fast";
}

} // namespace

std::string format_report(const Report& report) {
    const Render& render = report.render;
    const RenderCounts& counts = render.counts;
    const double samples = double(render.film.width) * render.film.height * double(render.passes);
    std::string text;
    text += fmt::format("{} x {}, {} spp, {}, seed {}, on {}\n", render.film.width, render.film.height, render.passes,
                        integrator_name(report.options.integrator), report.options.seed, report.device.name);
    text += fmt::format("seconds  load {:.2f}  bvh {:.2f}  compile {:.2f} + {:.2f}  render {:.2f}  total {:.2f}\n",
                        report.load_seconds, report.bvh.seconds, report.compile_seconds, render.first_launch_seconds,
                        render.seconds, report.total_seconds);
    text += fmt::format("rays     {:.2f} a sample, {:.2f} Mrays/s, {:.2f} Msamples/s\n",
                        samples > 0 ? double(counts.rays()) / samples : 0, rays_per_second(render) * 1e-6,
                        render.seconds > 0 ? samples / render.seconds * 1e-6 : 0);
    text += fmt::format("tree     {} ({}), SAH cost {:.1f}\n", quality_name(report.bvh.quality), report.bvh_reason,
                        report.bvh.sah_cost);
    text += fmt::format("error    {}\n", format_error(report.error));
    text += fmt::format("checked  NaN {}, infinite {}, negative {}, overflow {}\n", counts.nan, counts.infinite,
                        counts.negative, counts.overflow);
    text += fmt::format("absent   {}\n", fmt::join(effect_names(report.effects, false), ", "));
    return text;
}

std::string report_json(const Report& report) {
    const Render& render = report.render;
    const RenderCounts& counts = render.counts;
    Json json;
    json["version"] = CLRT_VERSION;
    json["command"] = command_text(report.options);
    json["integrator"] = integrator_name(report.options.integrator);
    json["width"] = render.film.width;
    json["height"] = render.film.height;
    json["spp"] = render.film.samples;
    json["passes"] = render.passes;
    json["seed"] = report.options.seed;
    json["replicates"] = render.film.replicates;
    json["triangles"] = report.scene.triangles.size();
    json["seconds"] = {{"load", report.load_seconds},
                       {"bvh", report.bvh.seconds},
                       {"compile", report.compile_seconds},
                       {"first_launch", render.first_launch_seconds},
                       {"render", render.seconds},
                       {"total", report.total_seconds}};
    json["rays"] = {{"primary", counts.primary}, {"shadow", counts.shadow}, {"secondary", counts.secondary}};
    json["rays_per_second"] = rays_per_second(render);
    json["peak_memory_bytes"] = peak_memory_bytes();
    json["error"] = error_json(report.error);
    json["nonfinite"] = {{"nan", counts.nan},
                         {"infinite", counts.infinite},
                         {"negative", counts.negative},
                         {"overflow", counts.overflow}};
    json["bad_samples"] = Json::array();
    for (const auto& [pixel, sample] : counts.bad_samples)
        json["bad_samples"].push_back({{"x", pixel % u32(report.options.size.x)},
                                       {"y", pixel / u32(report.options.size.x)},
                                       {"sample", sample}});
    json["device"] = {{"platform", report.device.platform},
                      {"name", report.device.name},
                      {"driver", report.device.driver}};
    json["bvh"] = {{"layout", layout_name(report.bvh.layout)},
                   {"quality", quality_name(report.bvh.quality)},
                   {"reason", report.bvh_reason},
                   {"depth", report.bvh.depth},
                   {"references", report.bvh.reference_count},
                   {"sah_cost", report.bvh.sah_cost},
                   {"bytes", 4 * (report.bvh.nodes.size() + report.bvh.leaves.size())}};
    json["load"] = {{"obj_bytes", report.scene.statistics.obj_bytes},
                    {"obj_seconds", report.scene.statistics.obj_seconds},
                    {"texture_seconds", report.scene.statistics.texture_seconds}};
    json["effects"] = effects_json(report.effects);
    json["notices"] = report.scene.notices;
    return json.dump(2) + "\n";
}

Metadata report_metadata(const Report& report) {
    const Render& render = report.render;
    const auto seconds = [](double value) { return fmt::format("{:.3f}", value); };
    Metadata metadata{{"version", CLRT_VERSION},
                      {"command", command_text(report.options)},
                      {"integrator", integrator_name(report.options.integrator)},
                      {"device", report.device.platform + ": " + report.device.name},
                      {"driver", report.device.driver},
                      {"seed", std::to_string(report.options.seed)},
                      {"first_sample", std::to_string(report.options.first_sample)},
                      {"spp", std::to_string(render.passes)},
                      {"seconds.load", seconds(report.load_seconds)},
                      {"seconds.bvh", seconds(report.bvh.seconds)},
                      {"seconds.compile", seconds(report.compile_seconds)},
                      {"seconds.first_launch", seconds(render.first_launch_seconds)},
                      {"seconds.render", seconds(render.seconds)},
                      {"effects", fmt::format("{}", fmt::join(effect_names(report.effects, true), ", "))},
                      {"effects_mask", fmt::format("{:#x}", report.effects.mask)},
                      {"nan", std::to_string(render.counts.nan)},
                      {"infinite", std::to_string(render.counts.infinite)},
                      {"negative", std::to_string(render.counts.negative)},
                      {"overflow", std::to_string(render.counts.overflow)}};
    if (report.error)
        metadata.emplace_back("error", fmt::format("{:.6g}", report.error->relative_rmse));
    return metadata;
}

} // namespace clrt
