// SPDX-License-Identifier: Apache-2.0
// Fallbacks taken while loading: every kind is one line with the place where it came first and a count.
#pragma once

#include "scene/scene.h"

#include <map>
#include <string>
#include <vector>

namespace clrt {

class NoticeList {
public:
    /// Notes a fallback. The same text again only raises the count of the first.
    void add(const std::string& text, const SourcePlace& place = {});
    /// Appends a line that is already complete.
    void add_line(const std::string& line);
    /// "file:line: text (and N more)", in the order in which they came first.
    std::vector<std::string> lines() const;

private:
    struct Entry {
        std::string text;
        SourcePlace place;
        size_t count = 1;
    };
    std::vector<Entry> entries_;
    std::map<std::string, size_t> index_; // of a text in entries_
};

} // namespace clrt
