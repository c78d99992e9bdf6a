// SPDX-License-Identifier: Apache-2.0
// Sums over the primary hits, kept up with the film while it grows: the same camera rays again, in launches
// of their own. Rays of their own cost less than they seem to (the first of many segments), and a film that
// is resumed has no sums of its earlier samples, so that a second way would be needed in any case.
#pragma once

#include "film/film_buffers.h"
#include "film/hit_sums.h"
#include "render/launch_size.h"
#include "render/launcher.h"
#include "render/matte_buffer.h"
#include "render/prepared_scene.h"

#include <functional>
#include <optional>

namespace clrt {

/// The buffers, the kernel and the sums of one render.
class HitLayers {
public:
    /// Takes all memory that it will need: the sums of the window on the host, and on the device a buffer for
    /// the tiles of one launch, fewer where memory is scarce. Throws DeviceError where not even one tile
    /// fits. `by_halves`: the sums are those of halves of the replicates, as an adaptive film needs and a
    /// denoised picture. `has_mattes`: the program counts samples by object and material.
    HitLayers(const Device& device, const Program& program, const RenderParams& params, bool by_halves,
              const SceneBuffers& scene, FilmBuffers& film_buffers, HitSums& sums, bool has_mattes = false);

    /// Those of a scene that is prepared with a program for them, as its options want them.
    HitLayers(const PreparedScene& prepared, const RenderParams& params, FilmBuffers& film_buffers,
              HitSums& sums);

    /// Adds the samples that the film has and the sums are to have and lack, in launches of LAUNCH_SECONDS;
    /// `report` is told after each which share of all samples is there. After a signal it leaves out what
    /// takes more than one launch.
    void advance(const Film& film, const std::function<void(double)>& report);

private:
    void make_buffers();
    void advance_equally(const Film& film, const std::function<void(double)>& report);
    void advance_halves(std::uint64_t first, std::uint64_t end);
    void advance_tiles(const Film& film, const std::function<void(double)>& report);
    template <class Launch>
    void run_tiles(size_t half, double samples, Launch&& launch);
    void add_launch(size_t half, u32 first_tile, u32 end_tile);

    const Device& device_;
    const RenderParams params_;
    FilmBuffers& film_buffers_;
    HitSums& sums_;
    Launcher launcher_;
    LaunchSize launch_size_;
    u32 largest_launch_; ///< tiles that the buffers hold
    bool has_mattes_;
    cl::Buffer values_, words_;
    std::optional<MatteBuffer> mattes_;
    std::vector<std::int64_t> read_values_;
    std::vector<u32> read_words_;
};

} // namespace clrt
