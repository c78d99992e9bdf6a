// SPDX-License-Identifier: Apache-2.0
// The loop of launches that fills the film.
#pragma once

#include "console/progress.h"
#include "denoise/denoise.h"
#include "film/hit_sums.h"
#include "film/render_progress.h"
#include "render/crew.h"
#include "render/error_price.h"
#include "render/prepared_scene.h"
#include "render/stop_rules.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace clrt {

/// What was forecast of --error while a render went on.
struct RenderForecast {
    std::uint64_t samples = 0; ///< a pixel, when it was made,
    double seconds = 0;        ///< and seconds of this run
    ErrorPrice price;          ///< beyond them
};

/// What a look at the denoised picture for --denoised-error saw.
struct DenoisedLook {
    std::uint64_t samples = 0; ///< a pixel
    double seconds = 0;        ///< of denoising
    DenoisedError error;
};

/// Steps of Markov chains (kernels/integrators/mlt.h), and how many of them were taken.
struct ChainCounts {
    std::uint64_t small = 0, large = 0, taken_small = 0, taken_large = 0;
};

/// What one of several devices did.
struct DeviceShare {
    DeviceInfo device;
    CrewShare work;
};

/// What a render gives: film, counts, history and seconds of the whole picture, the rest of this run.
struct Render : RenderProgress {
    HitSums hits;                     ///< empty if no file wants layers of them
    std::string hits_error;           ///< why they had to be given up, else empty
    std::optional<Denoised> denoised; ///< of the film as it is in the end, where that is asked for
    std::vector<DenoisedLook> looks;  ///< for --denoised-error, in this run
    std::string denoise_error;        ///< why it could not be done, else empty
    std::uint64_t passes = 0;         ///< samples a pixel in this run
    ChainCounts chains;               ///< of this run; none but with `mlt`
    double first_launch_seconds = 0;  ///< what the driver still compiles at the first launch
    double run_seconds = 0;           ///< of this run's render stage, first_launch_seconds not included
    double device_seconds = 0;        ///< of this run's launches, as run_groups counts them
    double check_seconds = 0;         ///< of them: reading the film and measuring its error
    double dropped_seconds = 0; ///< of them: for a pass that was interrupted and dropped; not in `seconds`
    double overrun_seconds = 0; ///< beyond --time
    double longest_launch_seconds = 0;
    std::optional<FilmError> error;        ///< of the film as it is
    std::vector<DeviceShare> shares;       ///< of several devices; empty: there was one
    std::vector<RenderForecast> forecasts; ///< of --error, at doublings
    StopRule stop = StopRule::SPP;         ///< what ended it
    std::string stop_text;                 ///< the same in words
    int stop_signal = 0;                   ///< the signal that ended it early, or 0
};

/// Sees a render from within: called by its thread, which waits, so whoever sees it is to be quick.
class RenderObserver {
public:
    virtual ~RenderObserver() = default;
    /// The render begins.
    virtual void begin(const PreparedScene& prepared) = 0;
    /// Between two launches; the seconds that this takes are not the render's.
    virtual void between_launches() = 0;
    /// At a whole pass: whether the picture so far is to be shown now.
    virtual bool wants_picture() = 0;
    /// Shows the picture so far, with its error.
    virtual void show(const Render& render) = 0;
    /// At a whole pass: whether picture and film are to be saved now, although it is not yet time to.
    virtual bool wants_saving() = 0;
    /// They were, with so many samples a pixel; or this failed.
    virtual void saved(bool done, std::uint64_t samples) = 0;
};

/// What happens beside a render. Saving is told to return whether all was saved.
struct RenderHooks {
    const RenderProgress* resume = nullptr;          ///< goes on from here
    std::function<bool(const Render&)> save_picture; ///< every --save-every seconds, at a whole pass
    std::function<bool(const Render&)> save_film;    ///< every --checkpoint seconds, at a whole pass
    RenderObserver* observer = nullptr;              ///< none: nobody
};

/// Renders until samples, time, error or a signal end it (stop_rules.h); always ends at a whole pass (one
/// sample a pixel). The scene is prepared with programs. Throws DeviceError, and UsageError for more samples
/// than the film can hold.
Render render(const PreparedScene& prepared, Progress& progress, const RenderHooks& hooks = {});

/// A render without a launch: the black picture of a scene in which no path is accepted.
Render render_nothing(const PlannedScene& planned);

} // namespace clrt
