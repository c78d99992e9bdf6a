// SPDX-License-Identifier: Apache-2.0
// Pictures that show nothing: black ones, and those of nothing but sky.
#pragma once

#include "options/options.h"
#include "render/render.h"
#include "scene/scene.h"

#include <optional>
#include <string>

namespace clrt {

/// A picture is dark when fewer of its pixels than this share are lighter than the darkest grey of 8 bits.
constexpr double LIT_SHARE = 0.01;

/// Why a picture shows nothing, and what to do about it, as far as it can be told; nothing where it shows
/// something. Asked of a grid of the scene's surfaces and of lights and materials, only after the film has
/// been found dark or its samples have met nothing.
std::optional<std::string> explain_empty_picture(const Scene& scene, const Options& options,
                                                 const Render& render);

} // namespace clrt
