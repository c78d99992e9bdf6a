// SPDX-License-Identifier: Apache-2.0
#include "support/render_scene.h"

#include <utility>

namespace clrt {

TestScene::TestScene() {
    options.effects.all = !tests_take_needed_effects();
}

Render TestScene::render() const {
    return ScratchScene::render(test_device());
}

Render render_loaded(Scene scene, Options options) {
    return render_loaded(test_device(), std::move(scene), std::move(options));
}

} // namespace clrt
