// SPDX-License-Identifier: Apache-2.0
#include "view/page_board.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace clrt {

namespace {

/// A page that has not looked for so long is closed, or out of sight.
constexpr std::chrono::seconds WATCHING{3};
/// Pages that are remembered; more than one person opens.
constexpr size_t MOST_WATCHERS = 64;

constexpr const char* NO_ANSWERS = "paths are known while the picture is rendered";

} // namespace

void PageBoard::set_title(const std::string& title) {
    const std::lock_guard lock(mutex_);
    state_.title = title;
}

void PageBoard::set_progress(const ProgressState& progress, double seconds) {
    const std::lock_guard lock(mutex_);
    state_.progress = progress;
    state_.phase_seconds = seconds;
}

void PageBoard::set_snapshot(SnapshotPointer snapshot, double exposure_ev) {
    const std::lock_guard lock(mutex_);
    state_.snapshot = std::move(snapshot);
    state_.exposure_ev = exposure_ev;
    ++state_.version;
}

void PageBoard::set_message(const std::string& message) {
    const std::lock_guard lock(mutex_);
    state_.message = message;
}

void PageBoard::set_end(const std::string& text) {
    const std::lock_guard lock(mutex_);
    state_.end = text;
    state_.is_stopping = false;
}

void PageBoard::set_answering(bool answers) {
    const std::lock_guard lock(mutex_);
    answers_ = answers;
    if (answers)
        return;
    for (OpenQuestion& open : questions_)
        open.answer.set_value({"", "", NO_ANSWERS});
    questions_.clear();
}

/// Whether pages look; `in_sight`: only those in sight count.
bool PageBoard::has_watchers(bool in_sight) const {
    const auto now = Clock::now();
    return std::any_of(watchers_.begin(), watchers_.end(), [&](const auto& page) {
        return now - page.second.last < WATCHING && !(in_sight && page.second.is_out_of_sight);
    });
}

bool PageBoard::is_watched() {
    const std::lock_guard lock(mutex_);
    return has_watchers(true);
}

bool PageBoard::take_saving() {
    const std::lock_guard lock(mutex_);
    return std::exchange(saving_, false);
}

void PageBoard::answer_questions(const std::function<PathAnswer(const PathQuestion&)>& answer) {
    std::unique_lock lock(mutex_);
    while (!questions_.empty()) {
        OpenQuestion open = std::move(questions_.front());
        questions_.pop_front();
        lock.unlock();
        open.answer.set_value(answer(open.question));
        lock.lock();
    }
}

void PageBoard::wait_for_question(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, time, [&] { return !questions_.empty() || state_.is_stopping; });
}

bool PageBoard::wait_for_goodbyes(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, time, [&] { return !has_watchers(false); });
}

PageState PageBoard::look(const std::string& page, bool is_out_of_sight) {
    const std::lock_guard lock(mutex_);
    if (watchers_.size() >= MOST_WATCHERS && !watchers_.count(page))
        watchers_.clear();
    watchers_[page] = {Clock::now(), is_out_of_sight};
    return state_;
}

void PageBoard::goodbye(const std::string& page) {
    const std::lock_guard lock(mutex_);
    watchers_.erase(page);
    changed_.notify_all();
}

void PageBoard::ask_to_stop() {
    const std::lock_guard lock(mutex_);
    state_.is_stopping = true;
    changed_.notify_all();
}

void PageBoard::ask_to_save() {
    const std::lock_guard lock(mutex_);
    saving_ = true;
    state_.message = "";
}

PathAnswer PageBoard::ask(const PathQuestion& question) {
    std::future<PathAnswer> answer;
    {
        const std::lock_guard lock(mutex_);
        if (!answers_)
            return {"", "", NO_ANSWERS};
        questions_.push_back({question, {}});
        answer = questions_.back().answer.get_future();
        changed_.notify_all();
    }
    return answer.get();
}

} // namespace clrt
