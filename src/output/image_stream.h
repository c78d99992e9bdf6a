// SPDX-License-Identifier: Apache-2.0
// Rows of pixels -> OpenImageIO's encoder -> a file or the standard output.
#pragma once

#include "output/output_file.h"

#include <memory>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <string>

namespace clrt {

/// What an encoder writes to: the bytes of an output. The encoder never sees a failed write; commit() does.
class OutputProxy : public OIIO::Filesystem::IOProxy {
public:
    OutputProxy(const std::string& path, OutputFile& file) : IOProxy(path, Write), file_(file) {}

    const char* proxytype() const override { return "clrt"; }
    size_t read(void* bytes, size_t count) override;
    size_t write(const void* bytes, size_t count) override;
    size_t pread(void* bytes, size_t count, std::int64_t position) override;
    size_t pwrite(const void* bytes, size_t count, std::int64_t position) override;
    size_t size() const override { return static_cast<size_t>(file_.size()); }

private:
    OutputFile& file_;
};

/// An image file that is being written, rows from the top. Without finish() no file appears.
class ImageStream {
public:
    /// Opens the output; its name decides the format (image.h). Throws SceneError.
    ImageStream(const std::string& path, const OIIO::ImageSpec& spec);

    /// Writes rows [first, first + count), counted from 0 at the window's top. Pixels are of type `type`;
    /// UNKNOWN means that each channel has its own type in the file. Throws SceneError.
    void write_rows(int first, int count, OIIO::TypeDesc type, const void* pixels);

    /// Ends the file and gives it its name. Throws SceneError.
    void finish();

private:
    void check(bool done) const;

    std::string path_;
    int top_; ///< the window's first row in the file's coordinates
    std::unique_ptr<OutputFile> file_;
    OutputProxy proxy_;
    std::unique_ptr<OIIO::ImageOutput> encoder_; // goes first: its destructor may still write
};

} // namespace clrt
