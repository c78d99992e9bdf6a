// SPDX-License-Identifier: Apache-2.0
// The Markov chains of `mlt` over the epochs of a render (kernels/integrators/mlt.h).
//
// An epoch is as long as all samples before it together, up to a limit. It begins with new paths of each
// replicate's own: their mean score is what its chains count, and chains start at some of them. So a
// replicate's mean is the truth in expectation whatever its length, replicates share nothing but what the
// picture was before, by which paths are scored, and the error falls as in any other render. A render that is
// resumed begins an epoch: chains are not kept, because new ones are as good.
#pragma once

#include "film/film_buffers.h"
#include "kernels/shared/chain_types.h"
#include "render/launcher.h"
#include "render/render.h"

#include <vector>

namespace clrt {

/// Refers to the arguments of its constructor.
class Metropolis {
public:
    /// Takes the chains' memory. Throws DeviceError.
    Metropolis(const PreparedScene& prepared, const RenderParams& params, const FilmBuffers& film,
               Render& render);

    /// Samples a pixel, of the film, at which the next epoch begins.
    std::uint64_t end() const { return end_; }
    /// Begins the next epoch when the film has end() samples a pixel, the last of them number `next` - 1.
    void advance(std::uint64_t samples, std::uint64_t next);
    /// Takes the chains through `count` samples of every pixel from number `first` on.
    void walk(std::uint64_t first, std::uint32_t count);
    /// Brings render.chains up to date.
    void read_back();
    /// Of all launches, as run_groups counts them.
    double device_seconds() const { return device_seconds_; }

private:
    void find_paths();
    void choose_starts_of_replicates();
    void write_importance(std::uint64_t samples);
    void launch(u32 task, u32 first, u32 items);

    const PreparedScene& prepared_;
    RenderParams params_;
    const FilmBuffers& film_;
    Render& render_;
    Kernel kernel_;
    ChainLaunch launch_{};
    ChainCounts ended_; ///< of chains of earlier epochs
    cl::Buffer chains_, words_, scores_, starts_, scales_, importance_;
    std::uint64_t end_ = 0;
    double device_seconds_ = 0;
};

/// What became of the steps, in words.
std::string chain_text(const ChainCounts& counts);

} // namespace clrt
