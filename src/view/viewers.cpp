// SPDX-License-Identifier: Apache-2.0
#include "view/viewers.h"

#include "console/signals.h"
#include "output/exposure.h"
#include "output/standard_streams.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <new>
#include <spdlog/spdlog.h>
#include <utility>

namespace clrt {

namespace {

/// The end of a run waits no longer for pages to get the last picture.
constexpr std::chrono::milliseconds LONGEST_GOODBYE{3000};
/// How often a page that stays looks whether a signal has come.
constexpr std::chrono::milliseconds SIGNAL_INTERVAL{100};

/// What a run's picture is called: the scene's file, and the picture of a turn.
std::string picture_title(const Options& options) {
    const std::string& path = options.scene.path;
    const std::string name =
        is_standard_input(path) ? "standard input" : std::filesystem::path(path).filename().string();
    return options.camera.frame > 0 ? fmt::format("{}, frame {}", name, options.camera.frame) : name;
}

PageFacts page_facts(const Options& options) {
    PageFacts facts;
    facts.tonemap = options.output.tonemap;
    facts.error = options.sampling.error;
    facts.can_save = !options.film_file.checkpoint_path.empty() ||
                     std::any_of(options.output.files.begin(), options.output.files.end(),
                                 [](const std::string& name) { return !is_standard_output(name); });
    facts.stays = options.view.serve_stays;
    if (walks_chains(options.transport.integrator))
        facts.no_paths =
            fmt::format("{} has no paths of single samples: a step of a chain needs all before it",
                        name_of(options.transport.integrator));
    return facts;
}

} // namespace

Viewers::Viewers(const Options& options, Progress& progress) : progress_(progress) {
    if (options.view.display_server)
        tev_ = std::make_unique<TevViewer>(*options.view.display_server);
    if (!options.view.serve_port)
        return;
    page_ = std::make_unique<Page>(*options.view.serve_port, page_facts(options));
    page_->board().set_title(picture_title(options));
    progress.watch([board = &page_->board()](const ProgressState& state, double seconds) {
        board->set_progress(state, seconds);
    });
    // With -q as well: whoever asks for the page needs its address.
    fmt::print(stderr, "the picture is in view at {}\n", page_->url());
}

Viewers::~Viewers() {
    progress_.watch({});
}

RenderObserver* Viewers::observer() {
    return tev_ || page_ ? this : nullptr;
}

void Viewers::begin(const PreparedScene& prepared) {
    prepared_.emplace(prepared);
    replayer_.reset();
    pace_ = ShowPace();
    if (!page_)
        return;
    page_->board().set_title(picture_title(prepared.planned->options));
    page_->board().set_answering(true);
}

void Viewers::between_launches() {
    drop_lost_viewer();
    answer_questions();
}

bool Viewers::wants_picture() {
    const bool wants =
        pace_.is_due() && ((tev_ && tev_->is_free()) || (page_ && page_->board().is_watched()));
    if (wants)
        pace_.begin();
    return wants;
}

void Viewers::show(const Render& render) {
    show_snapshot(render, prepared_->planned->options);
    pace_.end();
}

/// Where the memory does not hold a snapshot, what was shown stays.
void Viewers::show_snapshot(const Render& render, const Options& options) try {
    const SnapshotPointer snapshot = make_snapshot(render, options);
    if (tev_ && tev_->is_free())
        tev_->show(snapshot, picture_title(options));
    if (page_)
        page_->board().set_snapshot(snapshot, chosen_exposure_ev(options.output, snapshot->rgb));
} catch (const std::bad_alloc&) {
    if (!std::exchange(lacks_memory_, true)) {
        progress_.finish();
        spdlog::warn("not enough memory to show the picture so far; the render goes on");
    }
}

bool Viewers::wants_saving() {
    return page_ && page_->board().take_saving();
}

void Viewers::saved(bool done, std::uint64_t samples) {
    if (page_)
        page_->board().set_message(done ? fmt::format("saved at {} samples a pixel", samples)
                                        : "saving failed; the log tells why");
}

void Viewers::show_finished(const Render& render, const Options& options) {
    if (!observer())
        return;
    if (tev_)
        tev_->finish(); // else it might not be free
    show_snapshot(render, options);
    if (tev_)
        tev_->finish();
    drop_lost_viewer();
}

void Viewers::end(const std::string& text) {
    if (!page_)
        return;
    PageBoard& board = page_->board();
    board.set_end(text);
    if (!page_->facts().stays || stop_signal() != 0) {
        board.set_answering(false);
        board.wait_for_goodbyes(LONGEST_GOODBYE);
        return;
    }
    fmt::print(stderr, "the picture stays in view at {} until Ctrl-C\n", page_->url());
    while (stop_signal() == 0) {
        board.wait_for_question(SIGNAL_INTERVAL);
        answer_questions();
    }
}

/// Says once that a viewer is gone.
void Viewers::drop_lost_viewer() {
    if (!tev_)
        return;
    const std::string loss = tev_->loss();
    if (loss.empty())
        return;
    progress_.finish();
    spdlog::warn("the viewer of --display-server is left: {}; the render goes on", loss);
    tev_.reset();
}

void Viewers::answer_questions() {
    if (page_)
        page_->board().answer_questions([this](const PathQuestion& question) { return answer(question); });
}

/// The first question compiles.
PathAnswer Viewers::answer(const PathQuestion& question) {
    try {
        if (!replayer_)
            replayer_ = std::make_unique<PixelReplayer>(*prepared_, ReplayTwin::NO);
        const u32 width = u32(prepared_->planned->options.film.size.x);
        const PixelReplay replay =
            replayer_->replay({u32(question.y) * width + u32(question.x), question.sample});
        return {replay.text, replay.json, ""};
    } catch (const std::exception& error) {
        return {"", "", error.what()};
    }
}

} // namespace clrt
