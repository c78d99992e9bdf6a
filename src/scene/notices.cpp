// SPDX-License-Identifier: Apache-2.0
#include "scene/notices.h"

namespace clrt {

void NoticeList::add(const std::string& text, const SourcePlace& place) {
    const auto [found, is_new] = index_.emplace(text, entries_.size());
    if (is_new)
        entries_.push_back({text, place});
    else
        ++entries_[found->second].count;
}

void NoticeList::add_line(const std::string& line) {
    entries_.push_back({line, {}});
}

std::vector<std::string> NoticeList::lines() const {
    std::vector<std::string> lines;
    for (const Entry& entry : entries_) {
        std::string line;
        if (!entry.place.file.empty())
            line +=
                entry.place.file + (entry.place.line ? ":" + std::to_string(entry.place.line) : "") + ": ";
        line += entry.text;
        if (entry.count > 1)
            line += " (and " + std::to_string(entry.count - 1) + " more)";
        lines.push_back(line);
    }
    return lines;
}

} // namespace clrt
