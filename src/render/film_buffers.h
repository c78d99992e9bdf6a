// SPDX-License-Identifier: Apache-2.0
// The buffers that a render writes to, and their way back into a Film.
#pragma once

#include "device/device.h"
#include "device/program.h"
#include "kernels/shared/render_types.h"
#include "render/render.h"

namespace clrt {

/// Halves the number of replicates kept apart until their sums fit the device.
int fitting_replicates(const Device& device, const RenderParams& params);

/// Film, ray counts and counters on the device.
class FilmBuffers {
public:
    /// Zeroed buffers for params.film_replicates replicates of the window.
    FilmBuffers(const Device& device, const RenderParams& params);
    /// Binds the outputs of a render kernel.
    void bind(Kernel& kernel) const;
    /// Starts from the sums of an earlier run.
    void write_sums(const Film& film);
    /// Reads the sums, from the device's tiles into the film's rows.
    void read_sums(Film& film) const;
    /// Reads the counts since the start; primary rays are the caller's to count.
    RenderCounts read_counts() const;

private:
    /// Calls action(index of a pixel's sums on the device, its index in the film) for every pixel and replicate.
    template <class Action>
    void for_each_pixel(Action&& action) const;

    const Device& device_;
    RenderParams params_;
    size_t slots_; ///< pixels of whole tiles
    cl::Buffer film_, pixel_rays_, counters_;
};

} // namespace clrt
