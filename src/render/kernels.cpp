// SPDX-License-Identifier: Apache-2.0
#include "render/kernels.h"

#include "denoise/denoise.h"
#include "device/kernel_source.h"
#include "film/film_buffers.h"
#include "kernels/shared/render_types.h"
#include "options/summed_layers.h"
#include "output/image.h"
#include "render/layer_table.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <limits>

namespace clrt {

namespace {

/// Samples of a pixel that layers of hits are means over where nobody has asked for them.
constexpr std::uint64_t UNASKED_HIT_SAMPLES = 16;

/// The programs of the layers of hits and of ways out, and what tells the programs of a replay, of guided
/// paths and of a pilot from the picture's.
const std::string HIT_LAYERS_PROGRAM = "aov", ESCAPE_PROGRAM = "escapes", REPLAY_ENDING = "_replay",
                  GUIDED_ENDING = "_guided", PILOT_ENDING = "_pilot";

/// Vertices that are kept of a light path: they wait in private memory for those of the path from the eye.
constexpr int MOST_KEPT_VERTICES = 30;

/// For programs that do not simulate several samples of a pixel side by side (kernels/integrators/pixel.h).
const std::string SAMPLES_AT_ONCE = "SAMPLES_AT_ONCE=", ONE_SAMPLE_AT_ONCE = SAMPLES_AT_ONCE + "1";

void append(std::vector<std::string>& defines, const std::vector<std::string>& more) {
    defines.insert(defines.end(), more.begin(), more.end());
}

/// What every program of integrators/NAME.cl is built with.
ProgramRequest make_request(const KernelFiles& files, const std::string& name, const Options& options,
                            EffectMask effects, BvhLayout layout) {
    ProgramRequest request;
    request.name = name;
    request.source = expand_kernel_source(files, "integrators/" + name + ".cl");
    request.defines = {fmt::format("CLRT_EFFECTS={:#x}u", effects),
                       fmt::format("BVH_LAYOUT={}", int(layout))};
    if (options.sampling.sampler == SamplerChoice::INDEPENDENT)
        request.defines.push_back("CLRT_SAMPLER=SAMPLER_INDEPENDENT");
    request.precision = options.device.precision;
    request.dump_folder = options.device.dump_folder;
    request.cache = {options.device.cache, options.device.cache_folder};
    return request;
}

/// The same for programs that simulate as many samples of a pixel side by side as the device likes.
ProgramRequest launched_request(const Device& device, const KernelFiles& files, const std::string& name,
                                const Options& options, EffectMask effects, BvhLayout layout,
                                const std::vector<std::string>& defines) {
    ProgramRequest request = make_request(files, name, options, effects, layout);
    // A CPU's core fills the waits of one with the others, a GPU has other work-items for that; sums of
    // strategies are large.
    const bool is_said = std::any_of(defines.begin(), defines.end(), [](const std::string& define) {
        return define.rfind(SAMPLES_AT_ONCE, 0) == 0;
    });
    if (!is_said && (device.info.type != "CPU" || strategy_segments(options) > 0))
        request.defines.push_back(ONE_SAMPLE_AT_ONCE);
    append(request.defines, defines);
    return request;
}

/// What tells a program that it reuses paths: several of several pixels side by side.
std::vector<std::string> reuse_defines(const Device& device, const TransportOptions& transport) {
    if (transport.path_reuse != Toggle::ON || !takes_option(transport.integrator, TAKES_PATH_REUSE))
        return {};
    std::vector<std::string> defines = {"PATH_REUSE=1"};
    if (device.info.type != "CPU")
        defines.push_back(SAMPLES_AT_ONCE + std::to_string(REUSE_PIXELS));
    return defines;
}

/// Whether pictures say which share of their samples hit something.
bool wants_alpha(const Options& options) {
    const auto& outputs = options.output.files;
    return has_transparent_background(options.light) &&
           std::any_of(outputs.begin(), outputs.end(), can_hold_alpha);
}

/// What the program of the picture is built with besides.
std::vector<std::string> picture_defines(const Device& device, const Options& options,
                                         const PathPlan& paths) {
    std::vector<std::string> defines = path_defines(paths);
    append(defines, waiting_defines(options.transport));
    append(defines, vertex_defines(options.transport));
    append(defines, strategy_defines(options));
    append(defines, film_defines(device.info, integrator_row(options.transport.integrator).film));
    return defines;
}

/// What the program of the layers is built with where they have mattes.
std::vector<std::string> matte_defines(const Options& options) {
    return wants_mattes(options) ? std::vector<std::string>{"AOV_MATTES=1"} : std::vector<std::string>{};
}

} // namespace

std::vector<std::string> waiting_defines(const TransportOptions& transport) {
    if (!takes_option(transport.integrator, TAKES_GLOSS_RAYS))
        return {};
    const int most =
        effective_max_depth(transport) + std::max(transport.gloss_rays, transport.translucent_rays);
    int waiting = 16; // as many as wait by default
    while (waiting < most)
        waiting *= 2;
    return {fmt::format("DISTRIBUTION_WAITING={}", waiting)};
}

std::vector<std::string> vertex_defines(const TransportOptions& transport) {
    if (transport.integrator != Integrator::BDPT)
        return {};
    // A path has the segments to both vertices of a connection, and the connection. Shorter ones than the
    // usual share its program.
    const bool is_usual = effective_max_depth(transport) <= USUAL_BDPT_DEPTH;
    return {fmt::format("BDPT_VERTICES={}", is_usual ? USUAL_BDPT_DEPTH - 2 : MOST_KEPT_VERTICES)};
}

std::vector<std::string> strategy_defines(const Options& options) {
    const int segments = strategy_segments(options);
    if (segments == 0)
        return {};
    return {fmt::format("STRATEGY_SEGMENTS={}u", segments)};
}

BvhLayout choose_layout(std::optional<BvhLayout> choice, const DeviceInfo& device) {
    return choice.value_or(device.type == "CPU" ? BvhLayout::BVH8 : BvhLayout::BVH2);
}

bool wants_layers(const Options& options) {
    if (options.denoise.denoiser || wants_alpha(options))
        return true;
    const auto& outputs = options.output.files;
    const bool has_exr = std::any_of(outputs.begin(), outputs.end(), is_layered_output);
    if (!has_exr || !options.output.aovs)
        return has_exr;
    return std::any_of(options.output.aovs->begin(), options.output.aovs->end(),
                       [](const std::string& name) { return find_layer(name)->source != LayerSource::FILM; });
}

std::uint64_t most_hit_samples(const Options& options) {
    return options.denoise.denoiser || wants_alpha(options) || options.output.aovs
               ? std::numeric_limits<std::uint64_t>::max()
               : UNASKED_HIT_SAMPLES;
}

bool wants_mattes(const Options& options) {
    const auto& outputs = options.output.files;
    const auto& aovs = options.output.aovs;
    return aovs && std::any_of(outputs.begin(), outputs.end(), is_layered_output) &&
           std::any_of(aovs->begin(), aovs->end(), [](const std::string& name) {
               return find_layer(name)->source == LayerSource::MATTES;
           });
}

ProgramRequest picture_request(const Device& device, const Options& options, EffectMask effects,
                               BvhLayout layout, const PathPlan& paths) {
    std::vector<std::string> defines = picture_defines(device, options, paths);
    append(defines, reuse_defines(device, options.transport));
    return launched_request(device, kernel_files(options.device.kernels_folder),
                            integrator_stem(options.transport.integrator), options, effects, layout, defines);
}

RenderPrograms build_render_programs(const Device& device, const Options& options, EffectMask effects,
                                     BvhLayout layout, const PathPlan& paths) {
    const auto start = std::chrono::steady_clock::now();
    RenderPrograms programs;
    programs.picture = build_program(device, picture_request(device, options, effects, layout, paths));
    if (wants_layers(options))
        programs.layers = build_program(
            device, launched_request(device, kernel_files(options.device.kernels_folder), HIT_LAYERS_PROGRAM,
                                     options, effects, layout, matte_defines(options)));
    programs.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return programs;
}

ProgramRequest guided_request(const Device& device, const Options& options, EffectMask effects,
                              BvhLayout layout, const PathPlan& paths) {
    std::vector<std::string> defines = picture_defines(device, options, paths);
    append(defines, reuse_defines(device, options.transport));
    append(defines, {"PATH_GUIDE=1", fmt::format("FILM_INT64_ATOMICS={}", int(device.info.int64_atomics))});
    ProgramRequest request =
        launched_request(device, kernel_files(options.device.kernels_folder),
                         integrator_stem(options.transport.integrator), options, effects, layout, defines);
    request.name += GUIDED_ENDING;
    return request;
}

Program build_escape_program(const Device& device, const Options& options, EffectMask effects,
                             BvhLayout layout) {
    return build_program(device, make_request(kernel_files(options.device.kernels_folder), ESCAPE_PROGRAM,
                                              options, effects, layout));
}

ProgramRequest pilot_request(const Device& device, const Options& options, EffectMask effects,
                             BvhLayout layout, const PathPlan& paths) {
    std::vector<std::string> defines = picture_defines(device, options, paths);
    defines.emplace_back("FILM_MOMENTS=1");
    ProgramRequest request =
        launched_request(device, kernel_files(options.device.kernels_folder),
                         integrator_stem(options.transport.integrator), options, effects, layout, defines);
    request.name += PILOT_ENDING;
    return request;
}

Program build_replay_program(const Device& device, const Options& options, Precision precision,
                             EffectMask effects, BvhLayout layout, const PathPlan& paths) {
    ProgramRequest request =
        make_request(kernel_files(options.device.kernels_folder),
                     integrator_stem(options.transport.integrator), options, effects, layout);
    request.defines.push_back(ONE_SAMPLE_AT_ONCE);
    request.name += REPLAY_ENDING;
    request.precision = precision;
    request.defines.emplace_back("CLRT_TRACE=1");
    append(request.defines, picture_defines(device, options, paths));
    return build_program(device, request);
}

std::vector<std::string> dumped_files(const Options& options) {
    std::vector<std::string> paths;
    if (options.device.dump_folder.empty())
        return paths;
    const std::string integrator = integrator_stem(options.transport.integrator);
    for (const std::string& name :
         {integrator, HIT_LAYERS_PROGRAM, ESCAPE_PROGRAM, std::string(DENOISE_PROGRAM),
          integrator + REPLAY_ENDING, integrator + GUIDED_ENDING, integrator + PILOT_ENDING}) {
        const auto [source, flags] = dump_paths(options.device.dump_folder, name);
        paths.insert(paths.end(), {source, flags});
    }
    return paths;
}

} // namespace clrt
