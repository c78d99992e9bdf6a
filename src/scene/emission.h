// SPDX-License-Identifier: Apache-2.0
// The radiance that a material emits, its map included: what lights are chosen by and the film is scaled by.
#pragma once

#include "scene/scene.h"
#include "scene/texture_store.h"

namespace clrt {

/// What a material emits where it has no map, everywhere the same.
EmittedRadiance constant_emission(const Material& material);

/// What a material emits: mean over its map's picture, and the largest of it.
EmittedRadiance emitted_radiance(const Material& material, const TextureStore& textures);

/// Luminance that leaves a surface over pi: the mean, times its coverage, doubled where both sides shine.
double emitted_luminance(const Material& material, const EmittedRadiance& emitted);

} // namespace clrt
