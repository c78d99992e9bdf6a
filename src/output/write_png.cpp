// SPDX-License-Identifier: Apache-2.0
// PNG by libpng alone: the format of --output's default, for which OpenImageIO need not be loaded.
#include "error.h"
#include "output/display_rows.h"
#include "output/standard_streams.h"
#include "output/writers.h"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>
#include <png.h>

namespace clrt {

namespace {

/// Bytes that grow in memory while a FILE is written to (POSIX open_memstream).
class MemoryFile {
public:
    MemoryFile() : file_(open_memstream(&bytes_, &size_)) {
        if (!file_)
            throw std::bad_alloc();
    }
    ~MemoryFile() {
        std::fclose(file_);
        std::free(bytes_);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    FILE* file() const { return file_; }
    /// Copies what was written.
    void write_to(OutputFile& output) const {
        if (std::fflush(file_) != 0)
            throw std::bad_alloc();
        output.write_at(bytes_, size_, 0);
    }

private:
    char* bytes_ = nullptr;
    size_t size_ = 0;
    FILE* file_;
};

} // namespace

void write_png(const Picture& picture, const std::string& path, double exposure_ev, Tonemap tonemap) {
    DisplayRows rows(picture, path, exposure_ev, tonemap);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(size_t(picture.width) * size_t(picture.height) * size_t(rows.channels()));
    for (int y = 0; y < picture.height; ++y)
        rows.append(y, bytes);

    // The simplified interface (libpng manual, section V) reports errors by its result; the other jumps.
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = png_uint_32(picture.width);
    image.height = png_uint_32(picture.height);
    image.format = rows.channels() == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB; // sRGB, as its chunk will say
    const std::unique_ptr<OutputFile> file = open_output(path);
    const MemoryFile encoded;
    if (!png_image_write_to_stdio(&image, encoded.file(), /*convert_to_8_bit=*/0, bytes.data(),
                                  /*row_stride=*/0, /*colormap=*/nullptr))
        throw SceneError(path, 0, std::string("cannot write the image: ") + image.message);
    encoded.write_to(*file);
    file->commit();
}

} // namespace clrt
