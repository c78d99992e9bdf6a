// SPDX-License-Identifier: Apache-2.0
// Rows of pixels -> OpenImageIO's encoder -> a file or the standard output.
#pragma once

#include "images/image_library.h"

#include <memory>
#include <string>

namespace clrt {

/// An image file that is being written, rows from the top. Without finish() no file appears.
class ImageStream {
public:
    /// Opens the output; its name decides the format (image.h). Throws SceneError.
    ImageStream(const std::string& path, const ImageLayout& layout);

    /// Writes rows [first, first + count), counted from 0 at the window's top. Throws SceneError.
    void write_rows(int first, int count, const void* pixels) { encoder_->write_rows(first, count, pixels); }

    /// Ends the file and gives it its name. Throws SceneError.
    void finish();

private:
    std::unique_ptr<OutputFile> file_;
    std::unique_ptr<ImageEncoder> encoder_; // goes first: its destructor may still write
};

} // namespace clrt
