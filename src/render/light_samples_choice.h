// SPDX-License-Identifier: Apache-2.0
// How many light samples paths take at their first vertex (kernels/path/light_samples.h).
//
// Where there are many lights, and walls between them, which light is sampled is most of the noise, and more
// samples pay; where noise comes from elsewhere they are lost time. Pilots with one and with several samples
// tell both parts of the noise, and thereby what any number is worth. Work is counted in rays, never in
// seconds: the same picture comes out everywhere. A part of a picture (--first-sample) takes one, and a film
// that is gone on with as many as it began with.
#pragma once

#include "render/reuse_choice.h"

namespace clrt {

/// What a number of light samples must gain to be taken, in squared error times work, as pilots tell: they
/// overrate it where the picture takes more samples, whose nets even out those of lights most.
constexpr double WORTHWHILE_LIGHT_SAMPLES_GAIN = 1.3;

/// A number of light samples, and how many times less the squared error times work of a path is than with
/// one.
struct LightSamplesGain {
    int samples = 1;
    double gain = 1;
};

/// The best number, by the squared errors and rays of a sample in pilots with one light sample and with so
/// many; one where none gains enough.
LightSamplesGain best_light_samples(double error_of_one, double rays_of_one, double error_of_many,
                                    double rays_of_many, int many);

/// Decides `--light-samples auto` of a plan and leaves the number in its options. `parts` are those of the
/// plan that are there; what the pilots needed is added. `single`: what choose_path_reuse has gone by, if
/// there were pilots. Where it has decided against reuse, and several light samples are taken, it is decided
/// once more: what is left of the noise may be what reuse lowers. Throws DeviceError, KernelBuildError and
/// SceneError.
void choose_light_samples(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                          PreparedParts& parts, const std::optional<ReusePilots>& single, Progress& progress);

} // namespace clrt
