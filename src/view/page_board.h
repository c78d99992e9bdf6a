// SPDX-License-Identifier: Apache-2.0
// What the render's thread and the page's threads tell each other.
#pragma once

#include "console/progress.h"
#include "view/snapshot.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace clrt {

/// A sample whose path is asked for.
struct PathQuestion {
    int x = 0, y = 0; ///< of the whole picture
    std::uint32_t sample = 0;
};

/// Its record, or why there is none.
struct PathAnswer {
    std::string text, json; ///< empty with an error
    std::string error;
};

/// What is known now.
struct PageState {
    std::string title;      ///< of the scene, or its turn's picture
    ProgressState progress; ///< empty phase: none yet
    double phase_seconds = 0;
    int version = 0; ///< of the snapshot; 0: there is none
    SnapshotPointer snapshot;
    double exposure_ev = 0;         ///< of the snapshot's PNG
    bool is_stopping = false;       ///< stop was asked for
    std::string message;            ///< of what was done last
    std::optional<std::string> end; ///< how the run ended
};

/// Any thread may call it.
class PageBoard {
public:
    // From the render's thread.

    void set_title(const std::string& title);
    void set_progress(const ProgressState& progress, double seconds);
    void set_snapshot(SnapshotPointer snapshot, double exposure_ev);
    void set_message(const std::string& message);
    void set_end(const std::string& text);
    /// Whether questions about paths are answered from now on; those that wait are refused when it ends.
    void set_answering(bool answers);
    /// Whether a page in sight has looked within the last seconds.
    bool is_watched();
    /// Whether saving was asked for since the last call.
    bool take_saving();
    /// Calls `answer` for every question that waits.
    void answer_questions(const std::function<PathAnswer(const PathQuestion&)>& answer);
    /// Waits for a question, until the time is over.
    void wait_for_question(std::chrono::milliseconds time);
    /// Waits until every page that looks has said goodbye, or the time is over; whether all have.
    bool wait_for_goodbyes(std::chrono::milliseconds time);

    // From the page's threads.

    /// Notes that a page looks, by the name it has given itself; one that is out of sight wants no pictures,
    /// but the end.
    PageState look(const std::string& page, bool is_out_of_sight = false);
    void goodbye(const std::string& page);
    void ask_to_stop();
    void ask_to_save();
    /// Waits for the render to answer.
    PathAnswer ask(const PathQuestion& question);

private:
    using Clock = std::chrono::steady_clock;
    struct OpenQuestion {
        PathQuestion question;
        std::promise<PathAnswer> answer;
    };

    struct Watcher {
        Clock::time_point last;
        bool is_out_of_sight = false;
    };

    bool has_watchers(bool in_sight) const;

    std::mutex mutex_;
    std::condition_variable changed_;
    PageState state_;
    std::map<std::string, Watcher> watchers_;
    std::deque<OpenQuestion> questions_;
    bool answers_ = false, saving_ = false;
};

} // namespace clrt
