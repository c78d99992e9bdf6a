// SPDX-License-Identifier: Apache-2.0
// Who sees a run: what its render tells goes to the viewers that the options name.
#pragma once

#include "options/options.h"
#include "replay/replay_pixel.h"
#include "view/page.h"
#include "view/show_pace.h"
#include "view/tev_viewer.h"

#include <memory>
#include <optional>
#include <string>

namespace clrt {

/// The viewers of a run. Does nothing, and costs nothing, where the options name none.
class Viewers final : public RenderObserver {
public:
    /// Connects and listens; prints where. Throws UsageError where that fails. Follows `progress`, which must
    /// outlive it.
    Viewers(const Options& options, Progress& progress);
    ~Viewers() override;
    Viewers(const Viewers&) = delete;
    Viewers& operator=(const Viewers&) = delete;

    /// For a render's hooks: null where nobody looks.
    RenderObserver* observer();
    /// Shows a finished picture.
    void show_finished(const Render& render, const Options& options);
    /// The run has ended so: gives the viewers time to get the last picture. With --serve PORT,stay it goes
    /// on answering until a signal or the page ends that; not where a signal ended the run already.
    void end(const std::string& text);

    void begin(const PreparedScene& prepared) override;
    void between_launches() override;
    bool wants_picture() override;
    void show(const Render& render) override;
    bool wants_saving() override;
    void saved(bool done, std::uint64_t samples) override;

private:
    void show_snapshot(const Render& render, const Options& options);
    void drop_lost_viewer();
    void answer_questions();
    PathAnswer answer(const PathQuestion& question);

    Progress& progress_;
    std::unique_ptr<TevViewer> tev_;
    std::unique_ptr<Page> page_;
    ShowPace pace_;
    bool lacks_memory_ = false;             ///< which was said
    std::optional<PreparedScene> prepared_; ///< that is rendered, a copy: its parts are shared
    std::unique_ptr<PixelReplayer> replayer_;
};

} // namespace clrt
