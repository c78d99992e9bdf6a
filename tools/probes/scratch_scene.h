// SPDX-License-Identifier: Apache-2.0
// Small scenes that are written where they are used, and their renders in process.
#pragma once

#include "options/options.h"
#include "probes/probe_device.h"
#include "probes/scene_builder.h"
#include "probes/scratch_folder.h"
#include "render/prepared_scene.h"
#include "render/render.h"
#include "scene/scene.h"

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

namespace clrt {

/// A scene of one test or case: text, textures in a folder of its own, and the options it is rendered with.
/// The options start with 16 x 16 pixels, 1024 samples in 64 replicates and the full kernel, so that all
/// scenes of an integrator share one program; and without the studio, so that a scene without light has a
/// white sky.
class ScratchScene {
public:
    ScratchScene();

    /// Points the camera at a point; angle of view in degrees.
    void look(const glm::dvec3& eye, const glm::dvec3& at, double fov_degrees);
    /// Points the camera at a surface point so closely that the whole picture shows one radiance: its side
    /// is a thousandth of the distance.
    void look_at_point(const glm::dvec3& eye, const glm::dvec3& at);

    /// Writes a texture of floats (EXR), `channels` values a pixel, rows from the top.
    void texture(const std::string& name, int width, int height, int channels,
                 const std::vector<float>& values);
    /// Writes a texture of 8-bit values (PNG).
    void texture8(const std::string& name, int width, int height, int channels,
                  const std::vector<unsigned char>& values);

    /// Loads the scene's files and finishes the scene.
    Scene load() const;
    /// Loads and renders.
    Render render(const ProbeDevice& device) const;

    SceneBuilder build;
    Options options;
    ScratchFolder folder;
    std::function<void(Scene&)> finish; ///< what no file can say; empty: nothing
    double scale = 1;                   ///< of positions in the OBJ file
};

/// The plan of a scene, by the device's kernels unless the options name a folder of kernels themselves.
std::shared_ptr<PlannedScene> plan_loaded(const ProbeDevice& device, Scene scene, Options options);

/// The same on the device, with programs of its own.
PreparedScene prepare_loaded(const ProbeDevice& device, Scene scene, Options options);

/// Renders without a progress line.
Render render_silently(const PreparedScene& prepared);

/// Renders a loaded scene as the options' effects want it. Programs are compiled once a device for each
/// integrator, mask, layout, precision, sampler and automaton.
Render render_loaded(const ProbeDevice& device, Scene scene, Options options);

/// The same by a program that is built for this call, with the options' program cache; says whether it came
/// from there.
Render render_afresh(const ProbeDevice& device, Scene scene, Options options, bool* from_cache);

} // namespace clrt
