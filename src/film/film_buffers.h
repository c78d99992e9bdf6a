// SPDX-License-Identifier: Apache-2.0
// The buffers that a render writes to, and their way back into a Film.
#pragma once

#include "device/device.h"
#include "device/program.h"
#include "film/render_progress.h"
#include "kernels/shared/render_types.h"
#include "options/integrators.h"

namespace clrt {

/// What the programs of an integrator that splats are built with; of one that gathers, nothing
/// (kernels/film/sum.h).
std::vector<std::string> film_defines(const DeviceInfo& device, FilmAccess access);

/// Halves the number of replicates kept apart until their sums and those of `layers` layers of paths fit the
/// device. Throws DeviceError where not even one does.
int fitting_replicates(const Device& device, const RenderParams& params, size_t layers);

/// Film, ray counts and counters on the device.
class FilmBuffers {
public:
    /// Zeroed buffers for params.film_replicates replicates of the window, and behind them `layers` layers of
    /// paths.
    FilmBuffers(const Device& device, const RenderParams& params, size_t layers);
    /// Binds the outputs of a render kernel.
    void bind(Kernel& kernel) const;
    /// Binds the sums only.
    void bind_sums(Kernel& kernel) const;
    /// Whence the emission comes that the window's pixels see, EMISSION_* row by row; empty: all from paths.
    void write_emission(const std::vector<std::uint8_t>& states) const;
    /// Binds the samples of adaptive tiles only.
    void bind_ranges(Kernel& kernel) const;
    /// The samples of each adaptive tile that the next launches take: those in `to` but not in `from`.
    void write_tile_ranges(const std::vector<std::uint32_t>& from, const std::vector<std::uint32_t>& to);
    /// Starts from the sums of an earlier run.
    void write_sums(const RenderProgress& render);
    /// Starts anew from sums of 0; counts and marks stay.
    void clear_sums();
    /// Reads the sums, from the device's tiles into the rows of film and layers. Full ones are INT64_MAX.
    void read_sums(RenderProgress& render) const;
    /// Marks the pixels in which a camera ray has hit the scene since the start, where the film knows that of
    /// its earlier samples.
    void read_shown(Film& film) const;
    /// Reads the counts since the start; primary rays are the caller's to count.
    RenderCounts read_counts() const;

private:
    /// Some rows of tiles.
    struct Band {
        size_t first, count;
    };
    /// All rows of tiles, in bands of which a plane's sums are small.
    std::vector<Band> bands() const;
    /// Slots of the device's film from which a band of a plane starts, and how many it has.
    size_t first_slot(size_t plane, const Band& band) const;
    size_t slot_count(const Band& band) const;
    /// Calls action(index of a pixel's sums in the band, its index in the plane of a film).
    template <class Action>
    void for_each_pixel(const Band& band, Action&& action) const;
    /// One plane's sums, by way of a small copy; null: zeros.
    void write_plane(size_t plane, const std::int64_t* sums) const;
    void read_plane(size_t plane, std::int64_t* sums) const;

    /// Pixel (y width + x of the whole picture) of a slot.
    u32 pixel_of_slot(size_t slot) const;

    const Device& device_;
    RenderParams params_;
    size_t slots_;  ///< pixels of whole tiles
    size_t layers_; ///< of paths
    cl::Buffer film_, pixel_rays_, counters_;
};

} // namespace clrt
