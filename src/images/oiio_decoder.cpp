// SPDX-License-Identifier: Apache-2.0
#include "images/oiio_decoder.h"

#include "error.h"
#include "images/png_cut.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

namespace clrt {

namespace {

/// A texture is addressed by 32-bit words; a larger picture is refused before its memory is asked for.
constexpr std::uint64_t MOST_VALUES = (std::uint64_t(1) << 32) - 1;
/// Rows of a picture without tiles that are read at a time.
constexpr int BLOCK_ROWS = 64;
/// Deflate writes at most 258 bytes for 2 bits, a PNG at least one bit a pixel.
constexpr std::uint64_t MOST_PNG_PIXELS_A_BYTE = 258 * 4 * 8;

/// A message of OpenImageIO, which may have several lines.
std::string one_line(std::string message) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    return message;
}

/// Why a picture could not be opened: what the system says of its file, else what OpenImageIO does.
std::string reason_not_opened(const std::string& path, bool is_in_memory) {
    const std::string reason = one_line(OIIO::geterror());
    if (is_in_memory || std::ifstream(path))
        return reason;
    return std::generic_category().message(errno);
}

/// Reads the rows [begin, end), counted from the top of the file's window.
bool read_rows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int begin, int end, OIIO::TypeDesc type,
               void* values) {
    begin += spec.y;
    end += spec.y;
    return spec.tile_width ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, begin, end, spec.z,
                                              spec.z + 1, 0, spec.nchannels, type, values)
                           : input.read_scanlines(0, 0, begin, end, spec.z, 0, spec.nchannels, type, values);
}

/// Reads all pixels. Memory is filled as rows arrive, and asked for once the first have: a short file that
/// claims to be a huge picture costs nothing.
template <typename T>
std::vector<T> read_values(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                           const std::string& path) {
    const size_t row = size_t(spec.width) * size_t(spec.nchannels);
    const int step = spec.tile_width ? spec.tile_height : BLOCK_ROWS;
    std::vector<T> values;
    for (int begin = 0, end = 0; begin < spec.height; begin = end) {
        end = step < spec.height - begin ? begin + step : spec.height;
        values.resize(row * size_t(end));
        if (!read_rows(input, spec, begin, end, type, &values[row * size_t(begin)]))
            throw SceneError(path, 0, "the picture cannot be read: " + one_line(input.geterror()));
        values.reserve(row * size_t(spec.height));
    }
    return values;
}

/// Throws SceneError for a PNG that is cut off, before libpng says so on stderr.
void check_png(const std::string& path, const std::string* bytes) {
    std::error_code error;
    const std::uint64_t size = bytes ? bytes->size() : std::filesystem::file_size(path, error);
    if (error)
        return;
    std::unique_ptr<std::istream> file;
    if (bytes)
        file = std::make_unique<std::istringstream>(*bytes);
    else
        file = std::make_unique<std::ifstream>(path, std::ios::binary);
    if (const std::optional<std::string> cut = png_cut(*file, size))
        throw SceneError(path, 0, "the picture is cut off: " + *cut + "; copy or export it again");
}

/// The name that makes OpenImageIO choose the decoder of a picture in memory.
std::string name_by_format(const std::string& bytes, const std::string& path) {
    const std::pair<std::string, const char*> formats[] = {
        {"\x89PNG", "picture.png"}, {"\xff\xd8\xff", "picture.jpg"}, {"RIFF", "picture.webp"}};
    for (const auto& [start, name] : formats)
        if (bytes.compare(0, start.size(), start) == 0)
            return name;
    throw SceneError(path, 0, "expected a PNG, JPEG or WebP picture, found other bytes");
}

void check_size(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const std::string& path,
                const std::string* memory) {
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
        throw SceneError(path, 0, "the picture has no pixels");
    const std::uint64_t pixels = std::uint64_t(spec.width) * std::uint64_t(spec.height);
    const std::string size = std::to_string(spec.width) + "x" + std::to_string(spec.height);
    if (pixels > MOST_VALUES / std::uint64_t(spec.nchannels))
        throw SceneError(path, 0,
                         "the picture is too large: " + size + " pixels, expected fewer than 2^32 values");
    // An interlaced PNG is unpacked as a whole before its first row is there.
    std::error_code error;
    const std::uint64_t bytes = memory ? memory->size() : std::filesystem::file_size(path, error);
    if (!error && std::strcmp(input.format_name(), "png") == 0 && pixels / MOST_PNG_PIXELS_A_BYTE > bytes)
        throw SceneError(path, 0,
                         "the picture is cut off: " + size + " pixels are not in " + std::to_string(bytes) +
                             " bytes");
}

} // namespace

StoredImage read_by_oiio(const std::string& path, const std::string* bytes) {
    check_png(path, bytes);
    // Without this OpenImageIO multiplies the colours of PNG and others by alpha.
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    std::optional<OIIO::Filesystem::IOMemReader> memory;
    OIIO::Filesystem::IOProxy* proxy = nullptr;
    if (bytes) {
        proxy = &memory.emplace(bytes->data(), bytes->size());
        config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    }
    const auto input = OIIO::ImageInput::open(bytes ? name_by_format(*bytes, path) : path, &config, proxy);
    if (!input)
        throw SceneError(path, 0,
                         "the picture cannot be opened: " + reason_not_opened(path, bytes != nullptr));
    const OIIO::ImageSpec spec = input->spec();
    check_size(*input, spec, path, bytes);

    StoredImage image;
    image.width = spec.width;
    image.height = spec.height;
    image.channels = spec.nchannels;
    image.alpha_channel = spec.alpha_channel;
    image.is_floating_point = spec.format.is_floating_point();
    if (spec.format == OIIO::TypeDesc::UINT8)
        image.bytes = read_values<std::uint8_t>(*input, spec, OIIO::TypeDesc::UINT8, path);
    else
        image.floats = read_values<float>(*input, spec, OIIO::TypeDesc::FLOAT, path);
    return image;
}

} // namespace clrt
