// SPDX-License-Identifier: Apache-2.0
// One of several devices that render a film together: its buffers, its kernel, and the way of its sums to the
// film that all share.
#pragma once

#include "film/film_buffers.h"
#include "render/crew.h"
#include "render/launch_size.h"
#include "render/launcher.h"
#include "render/prepared_scene.h"

namespace clrt {

/// Refers to the arguments of its constructor, which may go when it will not be asked to add anything more.
class FilmWorker : public CrewMember {
public:
    /// Takes the device's memory and lets its driver finish its compilation. `shared` has the size and the
    /// replicates of `params`. Throws DeviceError.
    FilmWorker(const PreparedScene& prepared, const RenderParams& params, RenderProgress& shared);

    bool render(const SampleRange& range, const std::function<bool(double)>& goes_on) override;
    void fetch() override;
    /// Besides sums and marks of pixels in the film, its counts grow.
    void add() override;

    /// Of what was delivered; primary rays are the caller's to count.
    const RenderCounts& counts() const { return counts_; }
    const PreparedScene& prepared() const { return prepared_; }
    FilmBuffers& buffers() { return buffers_; }
    double longest_launch_seconds() const { return longest_launch_seconds_; }

private:
    const PreparedScene& prepared_;
    const Device device_; ///< its own handles: whoever prepared the scene may go while the device hangs
    RenderProgress& shared_;
    RenderProgress fetched_; ///< with sums only between fetch() and add()
    FilmBuffers buffers_;
    Launcher launcher_;
    LaunchSize launch_size_;
    u32 tile_count_;
    RenderCounts counts_;
    double longest_launch_seconds_ = 0;
};

} // namespace clrt
