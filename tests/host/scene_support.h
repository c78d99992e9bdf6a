// SPDX-License-Identifier: Apache-2.0
// Input files that a test of the scene's loading makes for itself.
#pragma once

#include "scene/notices.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <OpenImageIO/imageio.h>
#include <string>
#include <unistd.h>
#include <vector>

namespace clrt {

/// An empty folder that is removed with everything in it.
class TemporaryFolder {
public:
    TemporaryFolder() {
        static std::atomic<int> count{0};
        folder_ = std::filesystem::temp_directory_path() /
                  ("clrt-scene-" + std::to_string(getpid()) + "-" + std::to_string(count++));
        std::filesystem::create_directories(folder_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    /// Writes a text file, with the folders it needs, and returns its path.
    std::string write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(path(name), std::ios::binary) << text;
        return path(name);
    }

    /// Writes a picture of `channels` values a pixel, rows from the top; `type` is how the file stores them.
    template <typename T>
    std::string write_image(const std::string& name, int width, int height, int channels,
                            const std::vector<T>& values, OIIO::TypeDesc type) const {
        const OIIO::TypeDesc from(OIIO::BaseTypeFromC<T>::value);
        OIIO::ImageSpec spec(width, height, channels, type);
        spec["oiio:UnassociatedAlpha"] = 1;
        const auto output = OIIO::ImageOutput::create(path(name));
        if (!output || !output->open(path(name), spec) || !output->write_image(from, values.data()) ||
            !output->close())
            ADD_FAILURE() << "cannot write " << path(name);
        return path(name);
    }

private:
    std::filesystem::path folder_;
};

/// How many of the notices hold `text`.
inline int count_notices(const std::vector<std::string>& lines, const std::string& text) {
    int count = 0;
    for (const std::string& line : lines)
        count += line.find(text) != std::string::npos;
    return count;
}

inline int count_notices(const NoticeList& notices, const std::string& text) {
    return count_notices(notices.lines(), text);
}

} // namespace clrt
