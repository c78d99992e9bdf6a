// SPDX-License-Identifier: Apache-2.0
// Renders small scenes in process on the test device.
#pragma once

#include "effects/effect_table.h"
#include "probes/scratch_scene.h"
#include "support/test_device.h"

namespace clrt {

/// A scratch scene on the test device.
class TestScene : public ScratchScene {
public:
    /// With the full program, unless tests_take_needed_effects().
    TestScene();
    /// Loads and renders.
    Render render() const;

    /// Not 0: render() takes the small program of these effects, which scenes that differ in what they call
    /// for can share. That a scene calls for none but these is expected.
    EffectMask shared_effects = 0;
};

/// Renders a loaded scene on the test device.
Render render_loaded(Scene scene, Options options);

} // namespace clrt
