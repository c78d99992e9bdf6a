// SPDX-License-Identifier: Apache-2.0
// The numbers behind the header of a PLY file, one after the other.
#pragma once

#include "scene/readers/ply_header.h"

#include <string>
#include <string_view>

namespace clrt {

class PlyValues {
public:
    /// `header`, `bytes` and `path` outlive this.
    PlyValues(const PlyHeader& header, std::string_view bytes, const std::string& path)
        : header_(header), bytes_(bytes), path_(path), at_(header.bytes), line_(header.lines + 1) {}

    /// The next number. Throws SceneError (file:line in a text, byte in a binary file): expected, found.
    double next(PlyType type);

    /// The length of a list.
    size_t next_count(PlyType type);

    /// "file:line: expected ..., found ...", with the byte in binary files.
    [[noreturn]] void fail(const std::string& expected, const std::string& found) const;

    /// How far through the file, 0 to 1.
    double progress() const { return double(at_) / double(bytes_.size()); }

private:
    double next_word();
    double next_binary(PlyType type);

    const PlyHeader& header_;
    std::string_view bytes_;
    const std::string& path_;
    size_t at_, line_;
};

} // namespace clrt
