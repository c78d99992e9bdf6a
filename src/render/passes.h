// SPDX-License-Identifier: Apache-2.0
// The passes of one render: launches until a rule ends them, measurements and files between them.
#pragma once

#include "film/film_buffers.h"
#include "render/beside.h"
#include "render/denoised_target.h"
#include "render/guiding.h"
#include "render/hit_layers.h"
#include "render/launch_size.h"
#include "render/launcher.h"
#include "render/measurements.h"
#include "render/metropolis.h"
#include "render/render.h"

#include <chrono>
#include <optional>

namespace clrt {

/// A pass is one sample a pixel. Refers to the arguments of its constructor.
class Passes {
public:
    /// Takes all memory that the render will need, and lets the driver finish its compilation. Goes on from
    /// the film in `result`. Throws DeviceError.
    Passes(const PreparedScene& prepared, const RenderParams& params, Progress& progress,
           const RenderHooks& hooks, Render& result);

    /// Runs passes until a rule ends them, then reads everything back. A pass that --time or a signal
    /// interrupts is dropped: the result is that of the passes before it, to the last bit.
    void run();

private:
    using Clock = std::chrono::steady_clock;

    StopRule run_until_stopped();
    RenderState measured_state();
    bool is_worth_measuring() const;
    void look_at_denoised(RenderState& state);
    std::uint32_t next_samples(const RenderState& state) const;
    bool run_launches(std::uint32_t samples);
    template <class Launch>
    bool run_tiles(double samples, double done, Launch&& launch);
    void begin_round();
    void begin_epoch();
    void walk_chains(std::uint32_t samples);
    Launcher& launcher();
    RenderCounts counts() const;
    bool run_adaptive(std::uint64_t end);
    void keep_film(const RenderState& state, std::uint32_t samples);
    bool may_be_interrupted(const RenderState& state, std::uint32_t samples) const;
    std::optional<StopRule> interruption(double seconds_left) const;
    void show(double samples);
    void show_end();
    void read_back();
    void finish();
    void go_to_next_sample();
    bool has_gaps() const;
    void take_host_memory();
    void begin_hits();
    void advance_hits(const char* phase = nullptr);
    void give_up_hits(const DeviceError& error);
    double seconds() const;
    double samples_of_run(double samples) const;

    const PreparedScene& prepared_;
    const Options& options_;
    const RenderParams params_;
    Progress& progress_;
    Render& result_;
    FilmBuffers film_buffers_;
    Launcher launcher_;
    std::optional<Guiding> guiding_;
    std::optional<Metropolis> metropolis_;
    std::optional<HitLayers> hit_layers_;
    StopRules rules_;
    Measurements measurements_;
    std::optional<DenoisedTarget> denoised_target_;
    Beside beside_;
    Clock::time_point start_;
    RenderCounts earlier_counts_;
    double earlier_seconds_ = 0;
    std::uint64_t first_ = 0, samples_ = 0; ///< the next sample's number; samples of the whole film
    std::uint64_t lacking_end_ = 0;         ///< end of the samples that the film lacks from first_ on
    std::uint64_t earlier_samples_ = 0;     ///< of all pixels, from earlier runs
    double first_device_seconds_ = 0;       ///< of the launch without samples
    double launch_seconds_ = 0;             ///< of all launches of this run
    double hit_seconds_ = 0;                ///< of them: for the layers of hits
    LaunchSize launch_size_;
    bool is_kept_ = false;                ///< the result holds the film as of samples_
    std::optional<StopRule> interrupted_; ///< what ended a pass that is not finished
};

} // namespace clrt
