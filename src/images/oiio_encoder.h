// SPDX-License-Identifier: Apache-2.0
// Rows of pixels -> OpenImageIO's encoder -> an output.
#pragma once

#include "images/image_library.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

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

class OiioEncoder : public ImageEncoder {
public:
    OiioEncoder(const std::string& path, const std::string& format, const ImageLayout& layout,
                OutputFile& file);

    void write_rows(int first, int count, const void* pixels) override;
    void finish() override;

private:
    void check(bool done) const;

    std::string path_;
    int top_; ///< the window's first row in the file's coordinates
    OIIO::TypeDesc type_;
    OutputProxy proxy_;
    std::unique_ptr<OIIO::ImageOutput> encoder_; // goes first: its destructor may still write
};

} // namespace clrt
