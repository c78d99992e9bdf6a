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

/// Refers to the arguments of its constructor.
class FilmWorker : public CrewMember {
public:
    /// Takes the device's memory and lets its driver finish its compilation. `shared` has the size and the
    /// replicates of `params`. Throws DeviceError.
    FilmWorker(const PreparedScene& prepared, const RenderParams& params, RenderProgress& shared);

    bool render(const SampleRange& range, const std::function<bool(double)>& goes_on) override;
    /// Besides sums and marks of pixels in the film, its counts grow.
    void deliver() override;

    /// Of what was delivered; primary rays are the caller's to count.
    const RenderCounts& counts() const { return counts_; }
    const PreparedScene& prepared() const { return prepared_; }
    FilmBuffers& buffers() { return buffers_; }
    double longest_launch_seconds() const { return longest_launch_seconds_; }

private:
    const PreparedScene& prepared_;
    RenderProgress& shared_;
    FilmBuffers buffers_;
    Launcher launcher_;
    LaunchSize launch_size_;
    u32 tile_count_;
    RenderCounts counts_;
    double longest_launch_seconds_ = 0;
};

} // namespace clrt
