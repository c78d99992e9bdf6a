// SPDX-License-Identifier: Apache-2.0
// Path guiding over the epochs of a render (kernels/path/guide.h).
//
// An epoch is a range of samples whose guide stays the same and was learnt in the epochs before. Each is as
// long as all before it that taught, and has nets of its own: so, whatever the guide, the mean of every
// sample is the truth given all that was before, replicates stay uncorrelated, and their spread is the error.
// All samples weigh the same. Where there are more than it needs, only some samples of an epoch teach the
// guide.
//
// --guide auto begins with what pilots have found out (render/guide_choice.h). Without them bdpt is not
// guided; of path and path+light the picture's first samples are the pilot, and where they are noisy an epoch
// half as long teaches. The guided samples that follow are a trial: they tell what the variance would have
// been without the guide (kernels/path/guide_gain.h), and the guide goes where that gains less than its work
// costs. Of paths that serve several pixels the film's noise is compared with what it was before, instead.
// Work is counted in rays, never measured in seconds: the same picture comes out everywhere.
#pragma once

#include "film/film_buffers.h"
#include "guide/guide_buffers.h"
#include "options/toggle.h"
#include "render/launcher.h"
#include "render/render.h"

#include <optional>

namespace clrt {

/// Squared error of one sample from which on a guide is tried, by guide_error. Below it light is found
/// without one (Cornell box: .5), and nothing is compiled. Rooms lit through windows have 4 to 12, one behind
/// a door ajar 80.
constexpr double WORTHWHILE_GUIDE_ERROR = 4;
/// The same of paths that serve several pixels, which leave less to gain. By a guide, with its work, gained
/// at 3.5 (lamps in shades) 1.0, at 5 (a garage) .8, at 7 to 13 (an attic under the sun) 1.6, at 13 (stairs
/// under a skylight) 1.2, behind a door ajar 2.7.
constexpr double WORTHWHILE_SHARED_GUIDE_ERROR = 6;
/// Which of both is asked for.
double worthwhile_guide_error(const Options& options);

/// The squared error of a sample without a guide that decides whether one is tried: the geometric mean of
/// both measures, but at most four times the relative one without the noisiest hundredth of the pixels
/// (trimmed_sample_error). Where caustics decide the error a guide makes all else noisier: stones of glass
/// and metal, 64 spp, had 2.5 times the squared error in the other pixels.
double guide_error(double mse, double relative, double trimmed);

/// Refers to the arguments of its constructor.
class Guiding {
public:
    /// Goes on from render.guide, where the film has samples. Throws DeviceError and KernelBuildError.
    Guiding(const PreparedScene& prepared, const RenderParams& params, const FilmBuffers& film,
            Render& render);

    /// Samples a pixel, of the film, before which nothing changes.
    std::uint64_t end() const;
    /// Begins the next epoch when the film has end() samples a pixel; `counts` are those of the whole film.
    void advance(std::uint64_t samples, const RenderCounts& counts);
    /// Of the guided program; null: nothing is guided at present.
    Launcher* launcher();
    /// Keys the samples of the program that does not guide.
    u32 epoch() const { return progress_.epoch; }
    /// Reads what was learnt in this epoch into render.guide.
    void read_back();
    /// Of guided launches, as run_groups counts them.
    double device_seconds() const { return launcher_ ? launcher_->device_seconds() : 0; }

private:
    void start();
    void switch_on();
    void start_gains();
    void begin_epoch(std::uint64_t samples);
    std::uint64_t epoch_end(std::uint64_t samples) const;
    u32 next_teachers(std::uint64_t length) const;
    void end_pilot(std::uint64_t samples);
    void end_epoch(std::uint64_t samples, const RenderCounts& counts);
    bool guides_hits_alone() const;
    bool is_trial() const;
    bool has_learnt_enough(std::uint64_t samples, const RenderCounts& counts) const;
    void judge(std::uint64_t samples, const RenderCounts& counts);
    double told_error(std::uint64_t samples) const;
    double measured_error(std::uint64_t samples) const;

    const PreparedScene& prepared_;
    const RenderParams& params_;
    const FilmBuffers& film_;
    Render& render_;
    GuideProgress& progress_;
    std::optional<Program> program_;
    std::optional<Launcher> launcher_;
    std::optional<GuideBuffers> buffers_;
    double earlier_gain_ = 0; ///< of this epoch, from earlier runs
};

/// What a picture begins with that learns a guide from its first sample on; squared error of one of its
/// samples without a guide.
GuideProgress untaught_guide(int replicates, double error);
/// What one begins with after a pilot has learnt, or has found the guide not worth its work.
GuideProgress taught_guide(const GuideProgress& pilot, int replicates, double rays);

/// What a guide did for the picture, in words; empty where there is nothing to say.
std::string guide_text(const GuideProgress& guide, const Options& options);

} // namespace clrt
