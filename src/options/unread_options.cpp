// SPDX-License-Identifier: Apache-2.0
#include "options/unread_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clrt {

namespace {

bool is_on_command_line(const Options& options, const char* name) {
    const auto given = options.run.given.find(name);
    return given != options.run.given.end() && given->second.empty();
}

/// Whether an option of integrators asks for more than what all others do.
bool asks(const Options& options, IntegratorOption option) {
    switch (option) {
    case TAKES_GUIDE:
    case TAKES_PATH_REUSE:
        return false; // on is refused
    case TAKES_LIGHT_SAMPLES:
        return options.transport.light_samples > 1;
    case TAKES_EMISSION_RAYS:
        return options.transport.emission_rays > 1;
    default:
        return true;
    }
}

} // namespace

std::vector<std::string> unread_options(const Options& options) {
    std::vector<std::string> unread;
    const Integrator integrator = options.transport.integrator;
    for (const auto& [option, name] : NAMES<IntegratorOption>)
        if (is_on_command_line(options, name) && !takes_option(integrator, option) && asks(options, option))
            unread.push_back(fmt::format("{} changes nothing with --integrator {}: it is for {}", name,
                                         name_of(integrator), fmt::join(integrators_with(option), ", ")));
    const LightOptions& light = options.light;
    if (is_on_command_line(options, "--env-rotate") && light.environment_file.empty())
        unread.emplace_back("--env-rotate changes nothing: there is no --env FILE to be turned");
    if (is_on_command_line(options, "--env-scale") && !light.environment && light.environment_file.empty() &&
        !light.sky)
        unread.emplace_back("--env-scale changes nothing: there is no --env or --sky");
    const CameraOptions& camera = options.camera;
    if (is_on_command_line(options, "--camera") && (camera.eye || camera.at || camera.view))
        unread.emplace_back("--camera changes nothing: --eye, --at or --view place the camera");
    return unread;
}

} // namespace clrt
