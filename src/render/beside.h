// SPDX-License-Identifier: Apache-2.0
// What happens beside the passes of a render: files are saved, and somebody looks on.
#pragma once

#include "render/reminder.h"
#include "render/render.h"

#include <chrono>
#include <functional>

namespace clrt {

/// Calls the hooks of one render when it is time to. Refers to the arguments of its constructor.
class Beside {
public:
    Beside(const Options& options, const RenderHooks& hooks);

    void begin(const PreparedScene& prepared) const;
    /// Lets the observer work between two launches. Returns how long that took.
    std::chrono::steady_clock::duration between_launches() const;
    /// Whether something waits for a whole pass: a file that is due, or whoever looks on.
    bool waits();
    /// Saves film and picture so far, and shows it, as far as that waits. To be called at whole passes;
    /// `read_back` brings `result` to the film, and is called where that is needed.
    void at_pass(Render& result, const std::function<void()>& read_back);

private:
    const Options& options_;
    const RenderHooks& hooks_;
    Reminder picture_reminder_, film_reminder_;
    bool is_asked_ = false, saves_film_ = false, saves_picture_ = false, shows_ = false;
};

} // namespace clrt
