// SPDX-License-Identifier: Apache-2.0
// The encoders and decoders of OpenImageIO. Its 250 libraries take longer to load than a small scene to
// render, so they are loaded when the first picture needs them: all but PNG and PFM, which we write without
// it.
#pragma once

#include "images/output_file.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace clrt {

/// How a channel is stored and handed over.
enum class ChannelType { UINT8, UINT32, FLOAT };

struct ImageChannel {
    std::string name;
    ChannelType type;
};

/// What an encoder is told of a picture before its rows.
struct ImageLayout {
    int width = 0, height = 0;           ///< of the window that is stored
    int x = 0, y = 0;                    ///< the window's place in the whole picture
    int full_width = 0, full_height = 0; ///< of the whole picture
    std::vector<ImageChannel> channels;
    bool unassociated_alpha = false; ///< the last channel is alpha, by which the others are not multiplied
    std::vector<std::pair<std::string, std::string>> attributes; ///< by OpenImageIO's names
};

/// A picture that is being encoded. Errors of the output itself are its own (OutputFile).
class ImageEncoder {
public:
    virtual ~ImageEncoder() = default;
    /// Encodes rows [first, first + count), counted from 0 at the window's top, channels side by side pixel
    /// by pixel. Throws SceneError.
    virtual void write_rows(int first, int count, const void* pixels) = 0;
    /// Encodes what is left. Throws SceneError.
    virtual void finish() = 0;

protected:
    ImageEncoder() = default;
    ImageEncoder(const ImageEncoder&) = delete;
    ImageEncoder& operator=(const ImageEncoder&) = delete;
};

/// A picture as its file holds it, rows from the top, channels side by side; alpha is not multiplied into the
/// others.
struct StoredImage {
    int width = 0, height = 0, channels = 0;
    int alpha_channel = -1;          ///< -1: none is said to be alpha
    bool is_floating_point = false;  ///< in the file
    std::vector<std::uint8_t> bytes; ///< of a file of 8 bits a channel, else empty
    std::vector<float> floats;       ///< of any other; integers become 0 to 1
};

/// What the loaded library offers.
class ImageLibrary {
public:
    /// Begins a picture of the format that an extension means, such as "exr". `path` is for messages. Throws
    /// SceneError.
    virtual std::unique_ptr<ImageEncoder> encode(const std::string& path, const std::string& format,
                                                 const ImageLayout& layout, OutputFile& file) const = 0;
    /// Reads a file's first picture; `bytes`: the file itself, which `path` only names, or null. Throws
    /// SceneError.
    virtual StoredImage read(const std::string& path, const std::string* bytes) const = 0;

protected:
    ~ImageLibrary() = default;
};

/// The library, loaded at the first call; threads may call it. Throws std::runtime_error where it is not
/// there or the address space is too small for it.
const ImageLibrary& image_library();

/// The only function that the loaded file exports, of this type and name. The number changes with this
/// header.
using ImageLibraryEntry = const ImageLibrary*();
constexpr const char* IMAGE_LIBRARY_ENTRY = "clrt_image_library_2";

} // namespace clrt
