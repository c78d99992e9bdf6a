// SPDX-License-Identifier: Apache-2.0
// The report in words: first what everybody asks, and whatever is wrong; the rest with -v. Scripts read the
// JSON.
#include "output/file_name.h"
#include "paths/path_report.h"
#include "render/error_text.h"
#include "render/guiding.h"
#include "render/metropolis.h"
#include "render/render_params.h"
#include "run/denoising.h"
#include "run/report.h"
#include "run/report_facts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

constexpr double BYTES_OF_A_MEGABYTE = 1e6;

/// Files, pixels, samples and what ended the render.
std::string picture_line(const Report& report) {
    const Film& film = report.render.film;
    std::string samples = fmt::format("{} spp", film_samples(film));
    if (is_adaptive(film)) {
        const TileSpread spread = tile_spread(film);
        samples += fmt::format(" on average, {} to {} by tiles of {} x {}", spread.fewest, spread.most,
                               ADAPTIVE_TILE_SIZE, ADAPTIVE_TILE_SIZE);
    }
    std::vector<std::string> files;
    for (const std::string& name : report.options.output.files) {
        const std::string file = expand_file_name(
            name, {report.options.sampling.seed, film_samples(film), report.options.camera.frame});
        if (std::count(report.lost_files.begin(), report.lost_files.end(), file) == 0)
            files.push_back(file);
    }
    return fmt::format("picture  {}, {} x {}, {}; {}\n",
                       files.empty() ? "none" : fmt::format("{}", fmt::join(files, ", ")), film.width,
                       film.height, samples, report.render.stop_text);
}

/// Results that are not there although they were asked for.
std::string lost_line(const Report& report) {
    return report.lost_files.empty()
               ? ""
               : fmt::format("lost     {}: could not be written\n", fmt::join(report.lost_files, ", "));
}

std::string adaptive_line(const Report& report) {
    const AdaptiveRound& round = report.render.round;
    return expected_gain(round) > 0 ? fmt::format("adaptive {}\n", gain_text(round)) : "";
}

std::string choice_line(const Report& report) {
    const std::string text = choice_text(report.choice);
    return text.empty() ? "" : fmt::format("chosen   {}\n", text);
}

std::string portal_line(const Report& report) {
    const Environment& sky = report.scene.environment;
    if (sky.portals.empty())
        return "";
    return fmt::format("portals  {:.0f} % of the light samples of the sky go through {} window{}\n",
                       100 * sky.portal_share, sky.portals.size(), sky.portals.size() == 1 ? "" : "s");
}

std::string slab_line(const Report& report) {
    const std::vector<std::string> names = crossed_slabs(report.scene, report.options);
    if (names.empty())
        return "";
    return fmt::format("slabs    light behind panes of {} is connected to through them\n",
                       fmt::join(names, ", "));
}

std::string reuse_line(const Report& report) {
    if (report.options.transport.path_reuse != Toggle::ON)
        return "";
    return fmt::format("reuse    what a path finds behind its second vertex serves {} pixels\n",
                       REUSE_PIXELS);
}

std::string light_line(const Report& report) {
    const int samples = light_samples(report.scene, report.options);
    return samples > 1 ? fmt::format("lights   {} samples of them at the first vertex of a path\n", samples)
                       : "";
}

std::string outline_line(const Report& report) {
    if (report.render.counts.outline_pixels == 0)
        return "";
    return fmt::format("outlines of lights may cross {} pixels, which see them by {} camera rays a sample\n",
                       report.render.counts.outline_pixels, report.options.transport.emission_rays);
}

std::string guide_line(const Report& report) {
    const std::string text = guide_text(report.render.guide, report.options);
    return text.empty() ? "" : fmt::format("guide    {}\n", text);
}

std::string chain_line(const Report& report) {
    const std::string text = chain_text(report.render.chains);
    return text.empty() ? "" : fmt::format("chains   {}\n", text);
}

std::string time_line(const Report& report) {
    return fmt::format("time     {:.1f} s, {:.1f} s of it rendering, on {}\n", report.total_seconds,
                       report.render.run_seconds,
                       report.render.shares.empty() ? report.device.name
                                                    : fmt::format("{} devices", report.render.shares.size()));
}

/// What each of several devices did.
std::string share_lines(const Report& report) {
    std::string text;
    for (const auto& [device, work] : report.render.shares)
        text += fmt::format("device   {} spp in {:.1f} s by {}:{} {}{}\n", work.samples, work.seconds,
                            device.platform_index, device.device_index, device.name,
                            work.failure.empty() ? "" : ", which failed and was left out");
    return text;
}

/// What the picture lacks although the scene calls for it.
std::string left_out_lines(const Report& report) {
    std::string text;
    std::vector<std::string> effects;
    for (const Effect& effect : report.effects.list)
        if (report.effects.left_out & effect.bit)
            effects.push_back(effect.name);
    if (!effects.empty())
        text += fmt::format("left out {}, by --effects\n", fmt::join(effects, ", "));
    const IntegratorRow& integrator = integrator_row(report.options.transport.integrator);
    if (integrator.omitted)
        text += fmt::format("left out {}, by --integrator {}\n", integrator.omitted, integrator.name);
    if (report.effects.paths.is_asked)
        text += fmt::format("paths    {}\n", path_summary(report.effects.paths));
    if (!text.empty())
        return text;
    return is_complete(report.error) ? "left out nothing that the scene calls for\n"
                                     : "left out nothing but what the lines above name\n";
}

/// What the error of the picture does not show.
std::string bias_line(const Report& report) {
    if (!(report.effects.needed & ~report.effects.left_out & EFFECT_TEXTURE_FILTER))
        return "";
    const double last = std::max(1.0, double(film_samples(report.render.film)) -
                                          double(report.options.sampling.replicates) + 1);
    return fmt::format(
        "biased   textures are averaged over a pixel in the first samples, over 1/{:.3g} of its width "
        "in the last: the error does not count it\n",
        std::sqrt(last));
}

/// Samples that were not fit to be added, and why.
std::string bad_lines(const Report& report) {
    const RenderCounts& counts = report.render.counts;
    if (counts.bad() == 0)
        return "";
    return fmt::format("bad      {} samples count as black: NaN {}, infinite {}, negative {}, overflow {}\n",
                       counts.bad(), counts.nan, counts.infinite, counts.negative, counts.overflow) +
           format_causes(report.causes, counts.bad(), report.scene, report.options);
}

std::string missed_line(const Report& report) {
    const std::optional<ErrorTarget> target = error_target(report);
    return !target || target->reached ? "" : fmt::format("missed   {}\n", missed_text(*target));
}

/// How the work was done.
std::string work_lines(const Report& report) {
    const Render& render = report.render;
    const double samples = double(render.counts.primary);
    std::string text = fmt::format("by       {}, seed {}, {} sampler, {} replicates\n",
                                   name_of(report.options.transport.integrator), report.options.sampling.seed,
                                   name_of(report.options.sampling.sampler), render.film.replicates);
    text += fmt::format("stages   load {:.2f} s, pilots {:.2f} s, bvh {:.2f} s, compile {:.2f} + {:.2f} s, "
                        "render {:.2f} s\n",
                        report.load_seconds, report.pilots_seconds, report.bvh.seconds,
                        report.compile_seconds, render.first_launch_seconds, render.run_seconds);
    text +=
        fmt::format("rays     {:.2f} a sample, {:.2f} Mrays/s, {:.2f} Msamples/s\n",
                    samples > 0 ? double(render.counts.rays()) / samples : 0, rays_per_second(render) * 1e-6,
                    render.seconds > 0 ? samples / render.seconds * 1e-6 : 0);
    if (!report.bvh.nodes.empty())
        text += fmt::format("tree     {} {} ({}), SAH cost {:.1f}\n", name_of(report.bvh.layout),
                            name_of(report.bvh.quality), report.bvh_reason, report.bvh.sah_cost);
    return text;
}

std::string proof_lines(const Report& report) {
    const RenderCounts& counts = report.render.counts;
    return fmt::format("checked  NaN {}, infinite {}, negative {}, overflow {}\n", counts.nan,
                       counts.infinite, counts.negative, counts.overflow) +
           fmt::format("absent   {}\n", fmt::join(names_of_effects(report.effects, false), ", "));
}

} // namespace

std::string format_report(const Report& report) {
    std::string text =
        picture_line(report) + lost_line(report) + choice_line(report) + adaptive_line(report) +
        portal_line(report) + slab_line(report) + reuse_line(report) + light_line(report) +
        outline_line(report) + guide_line(report) + chain_line(report) + time_line(report) +
        share_lines(report) + format_error_report(report.error) +
        format_denoised(report.render, verdict_on(report.error) == Verdict::UNTRUSTED) + missed_line(report) +
        fmt::format("memory   {:.0f} MB at most\n", double(peak_memory_bytes()) / BYTES_OF_A_MEGABYTE) +
        bias_line(report) + left_out_lines(report) + bad_lines(report);
    if (report.options.run.verbosity > 0)
        text += work_lines(report) + format_error_details(report.error) + proof_lines(report);
    return text;
}

} // namespace clrt
