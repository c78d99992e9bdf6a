// SPDX-License-Identifier: Apache-2.0
#include "run/turntable.h"

#include "exit_code.h"
#include "render/error_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <iterator>

namespace clrt {

Camera turned_camera(const Camera& camera, int frame, int frames) {
    if (frame == 1) // the same bits
        return camera;
    const double angle = 2 * glm::pi<double>() * (frame - 1) / frames;
    const glm::dvec3 up = glm::normalize(camera.up);
    const auto turn_arm = [&](const glm::dvec3& arm) { // Rodrigues' formula
        return arm * std::cos(angle) + glm::cross(up, arm) * std::sin(angle) +
               up * glm::dot(up, arm) * (1 - std::cos(angle));
    };
    const auto turn = [&](const glm::dvec3& point) { return camera.at + turn_arm(point - camera.at); };
    Camera turned = camera;
    turned.eye = turn(camera.eye);
    if (camera.end) {
        const glm::dvec3 end_up = camera.end->up == camera.up ? camera.up : turn_arm(camera.end->up);
        turned.end = CameraPose{turn(camera.end->eye), turn(camera.end->at), end_up};
    }
    return turned;
}

std::string format_frame(const Report& report) {
    const std::optional<FilmError>& error = report.error.error;
    const Verdict verdict = verdict_on(report.error);
    const bool is_doubtful = verdict == Verdict::INCOMPLETE || verdict == Verdict::UNTRUSTED;
    return fmt::format("frame {} of {}: {} spp, {}{:.2f} s\n", report.options.camera.frame,
                       *report.options.camera.frames, film_samples(report.render.film),
                       error ? fmt::format("error {}{}, ", percent_text(error->relative_rmse),
                                           is_doubtful ? fmt::format(" ({})", verdict_name(verdict)) : "")
                             : "",
                       report.render.run_seconds);
}

int graver_exit(int a, int b) {
    constexpr int GRAVITY[] = {EXIT_DONE, EXIT_ERROR_NOT_REACHED, EXIT_CHECK, EXIT_DEVICE, EXIT_SCENE};
    const auto rank = [&](int code) { return std::find(std::begin(GRAVITY), std::end(GRAVITY), code); };
    return rank(a) < rank(b) ? b : a; // signals, at the end, are gravest
}

} // namespace clrt
