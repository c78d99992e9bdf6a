// SPDX-License-Identifier: Apache-2.0
#include "render/beside.h"

namespace clrt {

Beside::Beside(const Options& options, const RenderHooks& hooks)
    : options_(options), hooks_(hooks), picture_reminder_(options.output.save_every_seconds),
      film_reminder_(options.film_file.checkpoint_path.empty()
                         ? std::nullopt
                         : std::optional(options.film_file.checkpoint_seconds)) {}

void Beside::begin(const PreparedScene& prepared) const {
    if (hooks_.observer)
        hooks_.observer->begin(prepared);
}

std::chrono::steady_clock::duration Beside::between_launches() const {
    if (!hooks_.observer)
        return {};
    const auto begun = std::chrono::steady_clock::now();
    hooks_.observer->between_launches();
    return std::chrono::steady_clock::now() - begun;
}

bool Beside::waits() {
    RenderObserver* const observer = hooks_.observer;
    const bool has_film = !options_.film_file.checkpoint_path.empty();
    is_asked_ = is_asked_ || (observer && observer->wants_saving());
    saves_film_ |= hooks_.save_film && (film_reminder_.due() || (is_asked_ && has_film));
    saves_picture_ |= hooks_.save_picture && (picture_reminder_.due() || is_asked_);
    shows_ = shows_ || (observer && observer->wants_picture());
    return saves_film_ || saves_picture_ || shows_;
}

void Beside::at_pass(Render& result, const std::function<void()>& read_back) {
    if (!waits())
        return;
    read_back();
    bool is_saved = true;
    if (saves_film_)
        is_saved = hooks_.save_film(result);
    if (saves_picture_ || shows_)
        result.error = film_error(result.film, ErrorPixels::SCENE, options_.sampling.measure());
    if (saves_picture_)
        is_saved = hooks_.save_picture(result) && is_saved;
    if (is_asked_)
        hooks_.observer->saved(is_saved, film_samples(result.film));
    if (shows_)
        hooks_.observer->show(result);
    is_asked_ = saves_film_ = saves_picture_ = shows_ = false;
}

} // namespace clrt
