// SPDX-License-Identifier: Apache-2.0
#include "support/render_scene.h"

#include "effects/effects.h"

#include <gtest/gtest.h>
#include <utility>

namespace clrt {

TestScene::TestScene() {
    options.effects.all = !tests_take_needed_effects();
}

Render TestScene::render() const {
    if (shared_effects == 0)
        return ScratchScene::render(test_device());
    Scene scene = load();
    Options shared = options;
    shared.effects = {};
    EXPECT_EQ(find_effects(scene, shared).mask & ~shared_effects, 0u) << "effects that the program lacks";
    shared.effects.list = shared_effects;
    return render_loaded(std::move(scene), shared);
}

Render render_loaded(Scene scene, Options options) {
    return render_loaded(test_device(), std::move(scene), std::move(options));
}

} // namespace clrt
