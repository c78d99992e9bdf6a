// SPDX-License-Identifier: Apache-2.0
#include "render/prepared_scene.h"

#include "device/compile_ahead.h"
#include "render/render_params.h"

#include <future>
#include <utility>

namespace clrt {

namespace {

BvhLayout layout_of(const DeviceInfo& device, const PlannedScene& planned) {
    return choose_layout(planned.options.bvh.layout, device);
}

/// The parts with a tree in the layout of this device.
PreparedParts with_tree(const DeviceInfo& device, const PlannedScene& planned, PreparedParts parts) {
    if (!parts.tree || parts.tree->bvh.layout != layout_of(device, planned))
        parts.tree = plan_tree(device, planned);
    return parts;
}

ProgramRequest planned_picture(const Device& device, const PlannedScene& planned) {
    return picture_request(device, planned.options, planned.effects.mask, layout_of(device.info, planned),
                           planned.effects.paths);
}

ProgramRequest planned_guide(const Device& device, const PlannedScene& planned) {
    return guided_request(device, planned.options, planned.effects.mask, layout_of(device.info, planned),
                          planned.effects.paths);
}

ProgramRequest planned_pilot(const Device& device, const PlannedScene& planned, const Options& options,
                             PathPlan paths) {
    // It tells of path, which may find what the integrator at hand does not.
    Options of_path = options;
    of_path.transport.integrator = Integrator::PATH;
    paths.are_lamps_behind_slabs = finds_lamps_behind_slabs(planned.scene, of_path);
    return pilot_request(device, options, planned.effects.mask, layout_of(device.info, planned), paths);
}

} // namespace

std::shared_ptr<const SceneTree> plan_tree(const DeviceInfo& device, const PlannedScene& planned) {
    return std::make_shared<SceneTree>(
        build_scene_tree(planned.scene, planned.options, layout_of(device, planned)));
}

void expect_no_other(const Device& device, const PlannedScene& planned) {
    if (device.ahead)
        device.ahead->forget_all_but(planned_picture(device, planned));
}

void expect_program(const Device& device, const PlannedScene& planned, bool is_guided) {
    if (!device.ahead || planned.effects.paths.is_empty)
        return;
    device.ahead->expect(is_guided ? planned_guide(device, planned) : planned_picture(device, planned),
                         integrator_kernel(planned.options.transport.integrator));
}

void expect_pilot(const Device& device, const PlannedScene& planned, const Options& options) {
    if (device.ahead && !planned.effects.paths.is_empty)
        device.ahead->expect(planned_pilot(device, planned, options, plan_paths(planned.scene, options)),
                             integrator_kernel(options.transport.integrator));
}

std::shared_ptr<const RenderPrograms> plan_programs(const Device& device, const PlannedScene& planned) {
    return std::make_shared<RenderPrograms>(
        build_render_programs(device, planned.options, planned.effects.mask, layout_of(device.info, planned),
                              planned.effects.paths));
}

PreparedScene prepare_scene(const Device& device, std::shared_ptr<const PlannedScene> planned,
                            PreparedParts parts) {
    parts = with_tree(device.info, *planned, std::move(parts));
    SceneBuffers buffers =
        upload_scene(device, planned->scene, parts.tree->bvh, path_tables(planned->effects.paths));
    return {device,
            std::move(planned),
            std::move(parts.tree),
            std::move(buffers),
            std::move(parts.programs),
            std::move(parts.guide)};
}

PreparedScene prepare_render(const Device& device, std::shared_ptr<const PlannedScene> planned,
                             PreparedParts parts) {
    if (parts.programs)
        return prepare_scene(device, std::move(planned), std::move(parts));
    auto compiling = std::async(std::launch::async, [&] { return plan_programs(device, *planned); });
    parts = with_tree(device.info, *planned, std::move(parts));
    parts.programs = compiling.get(); // before anything takes memory on the device
    return prepare_scene(device, std::move(planned), std::move(parts));
}

Program build_guided_program(const PreparedScene& prepared) {
    const PlannedScene& planned = *prepared.planned;
    return build_program(prepared.device, planned_guide(prepared.device, planned));
}

Program build_escape_program(const PreparedScene& prepared) {
    const PlannedScene& planned = *prepared.planned;
    return build_escape_program(prepared.device, planned.options, planned.effects.mask,
                                prepared.tree->bvh.layout);
}

Program build_pilot_program(const PreparedScene& prepared) {
    const PlannedScene& planned = *prepared.planned;
    return build_program(prepared.device,
                         planned_pilot(prepared.device, planned, planned.options, planned.effects.paths));
}

Program build_replay_program(const PreparedScene& prepared, Precision precision) {
    const PlannedScene& planned = *prepared.planned;
    return build_replay_program(prepared.device, planned.options, precision, planned.effects.mask,
                                prepared.tree->bvh.layout, planned.effects.paths);
}

RenderParams launch_params(const PlannedScene& planned) {
    RenderParams params = make_render_params(planned.scene, planned.options, film_scale(planned.scene));
    restrict_to_paths(planned.effects.paths, params);
    return params;
}

} // namespace clrt
