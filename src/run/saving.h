// SPDX-License-Identifier: Apache-2.0
// What a render writes: pictures and films on the way, and all its files at the end.
#pragma once

#include "console/progress.h"
#include "error.h"
#include "film/checkpoint.h"
#include "film/film_identity.h"
#include "run/report.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// An output's name with the render's numbers in the place of {seed}, {spp} and {frame}.
std::string output_name(const std::string& name, const Options& options, const Film& film);

/// Writes the files at the end of a render. One that cannot be written is said at once and must cost neither
/// the others nor the report.
class FinalFiles {
public:
    void write(const std::string& path, const std::function<void()>& writer);
    /// Notes what is wrong with a file that is written all the same.
    void fail(const SceneError& error);
    /// What could not be written, in the order of the attempts.
    const std::vector<std::string>& lost() const { return lost_; }
    /// Whether every file is there as asked.
    bool complete() const { return complete_; }

private:
    std::vector<std::string> lost_;
    bool complete_ = true;
};

/// Says which of these files cannot show a transparent picture's background, and why.
void warn_of_lost_alpha(const Picture& picture, const std::vector<std::string>& paths);

/// Pictures and the statistics of a finished render; chooses the exposure first and puts it, and what
/// could not be written, into the report.
void write_outputs(Report& report, FinalFiles& files);

/// Film files and pictures beside a render, and the film that it goes on from. Refers to the arguments of its
/// constructor. A save on the way that fails does not end the render: a full disk may have room later.
struct Saving {
    FilmIdentity identity;
    std::optional<RenderProgress> resumed;
    RenderHooks hooks;

    Saving(const Scene& scene, const PathPlan& paths, const Options& options, const DeviceInfo& device,
           Progress& progress);
    Saving(const Saving&) = delete;
    Saving& operator=(const Saving&) = delete;

    /// Whether --checkpoint is still to be written at the end: a resumed film that has gained nothing is
    /// whole.
    bool needs_film(const Render& render) const;
    /// Writes the film of --checkpoint. Throws SceneError, also where the film that is there holds what this
    /// one lacks and --force is not given.
    void write_film(const Render& render) const;

private:
    void resume();

    const Scene& scene_;
    const PathPlan& paths_;
    const Options& options_;
    const DeviceInfo& device_;
};

} // namespace clrt
