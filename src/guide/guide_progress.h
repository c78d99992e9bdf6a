// SPDX-License-Identifier: Apache-2.0
// How far a guided render has come, and what a resumed one goes on from.
#pragma once

#include "guide/guide.h"

#include <array>
#include <optional>

namespace clrt {

enum class GuideStage {
    OFF,   ///< nothing is guided, or not any more
    PILOT, ///< nothing is guided yet: how noisy the picture is will tell
    ON
};

/// The present epoch of a guided render: a range of samples in which the guide stays the same.
struct GuideProgress {
    GuideStage stage = GuideStage::OFF;
    u32 epoch = 0;                    ///< keys the nets of its samples (RenderParams::epoch)
    std::uint64_t begin = 0, end = 0; ///< samples a pixel, of the film, where it does; end 0: there is none
    std::uint64_t pilot_end = 0;      ///< likewise
    std::optional<std::uint64_t> guided_from; ///< samples before any were guided; none: none are
    std::uint64_t guided_to = 0;              ///< where that ended; 0: it has not
    std::optional<double> pilot_error; ///< of a sample before there was a guide, by which it is tried:
                                       ///< guide_error (render/guiding.h), or what bdpt's may be
                                       ///< (render/guide_choice.h)
    double plain_error = 0;                   ///< of a sample where the first guided epoch begins, likewise
    double plain_rays = 0;                    ///< of a sample then
    double taught_rays = 0;                   ///< of a pilot that the guide has been learnt from
    u32 teachers = NO_INDEX;                  ///< the last sample that teaches (RenderParams::guide_learns)
    std::vector<float> weights;   ///< of gains (kernels/path/guide_gain.h), by tile; empty: none is asked for
    double begin_error = 0;       ///< of the film where the epoch begins, by guide_error
    double gain = 0;              ///< sum of those of this epoch's samples, as it was read back last
    std::uint64_t asked_from = 0; ///< samples before any was asked for its gain; 0: none is
    double earlier_gain = 0;      ///< of the epochs before
    u32 judgements = 0;           ///< of guided samples on trial
    std::optional<double> error, work; ///< squared error of a guided sample, and its rays in what they cost
                                       ///< over those of a sample before
    std::optional<Guide> guide;        ///< ON
    std::vector<std::uint64_t> sums;   ///< of its cells, of this epoch, as the film was read back last
};

} // namespace clrt
