// SPDX-License-Identifier: Apache-2.0
// Chooses the writer by extension.
#include "output/image.h"

#include "error.h"
#include "images/image_library.h"
#include "output/standard_streams.h"
#include "output/writers.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>

namespace clrt {

namespace {

enum class Kind { UNKNOWN, EXR, PNG, DISPLAY, LINEAR, PFM };

/// 16-bit sizes of TGA; JPEG_MAX_DIMENSION of libjpeg.
constexpr int LARGEST_SIDE = 65535, LARGEST_JPEG_SIDE = 65500;

Kind kind_of(const std::string& path) {
    static const std::vector<std::pair<std::string, Kind>> KINDS = {
        {"exr", Kind::EXR},     {"png", Kind::PNG},     {"jpg", Kind::DISPLAY}, {"jpeg", Kind::DISPLAY},
        {"bmp", Kind::DISPLAY}, {"tga", Kind::DISPLAY}, {"ppm", Kind::DISPLAY}, {"tif", Kind::LINEAR},
        {"tiff", Kind::LINEAR}, {"hdr", Kind::LINEAR},  {"pfm", Kind::PFM}};
    const std::string format = output_format(path);
    for (const auto& [known, kind] : KINDS)
        if (format == known)
            return kind;
    return Kind::UNKNOWN;
}

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// The renderer's duty, not the user's.
void assert_consistent([[maybe_unused]] const Picture& picture) {
    assert(picture.width > 0 && picture.height > 0 && !picture.layers.empty());
    assert(picture.layers[0].channel_names.size() == 3);
    for ([[maybe_unused]] const Layer& layer : picture.layers)
        assert(layer.values.size() == static_cast<size_t>(picture.width) *
                                          static_cast<size_t>(picture.height) * layer.channel_names.size());
}

} // namespace

std::string output_format(const std::string& path) {
    if (is_standard_output(path))
        return lower_case(path.substr(0, path.find(':')));
    const std::string extension = std::filesystem::path(path).extension().string();
    return lower_case(extension.substr(extension.empty() ? 0 : 1));
}

std::string expected_output() {
    return std::string("a file name that ends in ") + OUTPUT_EXTENSIONS +
           ", or a format for the standard output: png:-, exr:- and so on";
}

bool is_output_path(const std::string& path) {
    return kind_of(path) != Kind::UNKNOWN;
}

bool is_layered_output(const std::string& path) {
    return kind_of(path) == Kind::EXR;
}

bool is_display_output(const std::string& path) {
    const Kind kind = kind_of(path);
    return kind == Kind::PNG || kind == Kind::DISPLAY;
}

bool can_hold_alpha(const std::string& path) {
    const std::string format = output_format(path);
    return format == "png" || format == "tga" || format == "tif" || format == "tiff" || format == "exr";
}

void check_output_path(const std::string& path) {
    if (!is_output_path(path))
        throw UsageError("output '" + path + "': expected " + expected_output());
}

void prepare_output(const std::string& path) {
    const Kind kind = kind_of(path);
    if (kind == Kind::EXR || kind == Kind::DISPLAY || kind == Kind::LINEAR)
        image_library();
}

int largest_output_side(const std::string& path) {
    const std::string format = output_format(path);
    return format == "jpg" || format == "jpeg" ? LARGEST_JPEG_SIDE : LARGEST_SIDE;
}

void check_output_folder(const std::string& path) {
    if (is_standard_output(path))
        return;
    const std::filesystem::path parent = std::filesystem::path(path).parent_path();
    const std::string folder = parent.empty() ? "." : parent.string();
    const std::string inside = folder + "/."; // a file in the folder's place is refused, too
    if (faccessat(AT_FDCWD, inside.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
        throw SceneError(path, 0,
                         "cannot write into the folder '" + folder + "': " + std::strerror(errno) +
                             (errno == ENOENT ? "; make it first" : "; choose another one"));
}

const std::vector<float>* picture_coverage(const Picture& picture) {
    for (const Layer& layer : picture.layers)
        if (picture.is_transparent && layer.is_coverage)
            return &layer.values;
    return nullptr;
}

void write_picture(const Picture& picture, const std::string& path, double exposure_ev, Tonemap tonemap) {
    check_output_path(path);
    assert_consistent(picture);
    const int limit = largest_output_side(path);
    if (picture.width > limit || picture.height > limit)
        throw SceneError(path, 0,
                         "expected at most " + std::to_string(limit) + " pixels a side, found " +
                             std::to_string(picture.width) + "x" + std::to_string(picture.height));
    switch (kind_of(path)) {
    case Kind::EXR:
        return write_exr(picture, path);
    case Kind::PNG:
        return write_png(picture, path, exposure_ev, tonemap);
    case Kind::DISPLAY:
        return write_display(picture, path, exposure_ev, tonemap);
    case Kind::LINEAR:
        return write_linear(picture, path);
    case Kind::PFM:
        return write_pfm(picture, path);
    case Kind::UNKNOWN:
        break;
    }
}

void write_text_file(const std::string& path, const std::string& text) {
    const std::unique_ptr<OutputFile> file = open_output(path);
    file->write_at(text.data(), text.size(), 0);
    file->commit();
}

} // namespace clrt
