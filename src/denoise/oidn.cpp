// SPDX-License-Identifier: Apache-2.0
#include "denoise/oidn.h"

#include "error.h"

#include <algorithm>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>

namespace clrt {

namespace {

const char* const FILE_NAME = "libOpenImageDenoise.so.2";

/// Numbers of the library's interface, version 2.
constexpr int DEVICE_OF_PROCESSOR = 1, FORMAT_OF_THREE = 3;
constexpr int FEWEST_VERSION = 20000; ///< 10000 major + 100 minor + patch

/// The file to load, and how it was named.
struct LibraryName {
    std::string file, origin;
};

LibraryName library_name(const std::string& path) {
    const char* const variable = std::getenv("CLRT_OIDN");
    LibraryName name{FILE_NAME, "where libraries are"};
    if (!path.empty())
        name = {path, "as --oidn says"};
    else if (variable && *variable)
        name = {variable, "as the variable CLRT_OIDN says"};
    std::error_code error;
    if (std::filesystem::is_directory(name.file, error))
        name.file = (std::filesystem::path(name.file) / FILE_NAME).string();
    return name;
}

} // namespace

/// The functions of the library that are used, by their names there.
struct OidnFunctions {
    void* (*new_device)(int type) = nullptr;
    void (*commit_device)(void* device) = nullptr;
    void (*release_device)(void* device) = nullptr;
    int (*get_device_int)(void* device, const char* name) = nullptr;
    int (*get_device_error)(void* device, const char** message) = nullptr;
    void* (*new_filter)(void* device, const char* type) = nullptr;
    void (*set_image)(void* filter, const char* name, void* pixels, int format, size_t width, size_t height,
                      size_t offset, size_t pixel_stride, size_t row_stride) = nullptr;
    void (*set_bool)(void* filter, const char* name, bool value) = nullptr;
    void (*commit_filter)(void* filter) = nullptr;
    void (*execute_filter)(void* filter) = nullptr;
    void (*release_filter)(void* filter) = nullptr;

    explicit OidnFunctions(const LibraryName& name) {
        void* const library = dlopen(name.file.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!library)
            fail(name, dlerror());
        const auto find = [&](auto& function, const char* symbol) {
            void* const address = dlsym(library, symbol);
            if (!address)
                fail(name, fmt::format("it has no function {}, so it is not Open Image Denoise 2", symbol));
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(address);
        };
        find(new_device, "oidnNewDevice");
        find(commit_device, "oidnCommitDevice");
        find(release_device, "oidnReleaseDevice");
        find(get_device_int, "oidnGetDeviceInt");
        find(get_device_error, "oidnGetDeviceError");
        find(new_filter, "oidnNewFilter");
        find(set_image, "oidnSetSharedFilterImage");
        find(set_bool, "oidnSetFilterBool");
        find(commit_filter, "oidnCommitFilter");
        find(execute_filter, "oidnExecuteFilter");
        find(release_filter, "oidnReleaseFilter");
    }

    [[noreturn]] static void fail(const LibraryName& name, const std::string& why) {
        throw DeviceError(fmt::format(
            "expected Open Image Denoise 2 in '{}', {}, found none: {}. `pip install pyoidn` brings {}: name "
            "it by --oidn FILE or CLRT_OIDN; --denoise=filter needs no library",
            name.file, name.origin, why, FILE_NAME));
    }
};

Oidn::Oidn(const std::string& path) {
    const LibraryName name = library_name(path);
    functions_ = std::make_unique<OidnFunctions>(name);
    device_ = functions_->new_device(DEVICE_OF_PROCESSOR);
    if (!device_)
        OidnFunctions::fail(name, "it has no device for this processor");
    functions_->commit_device(device_);
    check("starting it");
    if (functions_->get_device_int(device_, "version") < FEWEST_VERSION)
        OidnFunctions::fail(name, "it is version " + version());
}

Oidn::~Oidn() {
    if (device_)
        functions_->release_device(device_);
}

std::string Oidn::version() const {
    const int number = functions_->get_device_int(device_, "version");
    return fmt::format("{}.{}.{}", number / 10000, number / 100 % 100, number % 100);
}

/// Throws what the library has to say.
void Oidn::check(const char* doing) {
    const char* message = nullptr;
    if (functions_->get_device_error(device_, &message) != 0)
        throw DeviceError(
            fmt::format("Open Image Denoise, {}: {}", doing, message ? message : "it does not say why"));
}

Pixels Oidn::filter(const char* name, const Pixels& values, const Pixels* albedo, const Pixels* normal,
                    int width, int height) {
    Pixels result(values.size());
    void* const filter = functions_->new_filter(device_, "RT");
    const auto set = [&](const char* image, const Pixels& pixels) {
        functions_->set_image(filter, image, const_cast<float*>(pixels.data()), FORMAT_OF_THREE,
                              size_t(width), size_t(height), 0, 0, 0);
    };
    set(name, values);
    if (albedo && normal) {
        set("albedo", *albedo);
        set("normal", *normal);
        functions_->set_bool(filter, "cleanAux", true);
        functions_->set_bool(filter, "hdr", true);
    }
    set("output", result);
    functions_->commit_filter(filter);
    functions_->execute_filter(filter);
    functions_->release_filter(filter);
    check("filtering");
    return result;
}

DenoiseCandidate Oidn::candidate(const HalfPicture& half) {
    const auto guide = [&](const char* name, Pixels values, float lowest) {
        for (float& value : values)
            value = std::clamp(value, lowest, 1.0f);
        return filter(name, values, nullptr, nullptr, half.width, half.height);
    };
    const Pixels albedo = guide("albedo", half.albedo, 0), normal = guide("normal", half.normal, -1);
    const auto colour = [&](const Pixels& values) {
        return filter("color", values, &albedo, &normal, half.width, half.height);
    };
    return {{colour(half.quarter[0]), colour(half.quarter[1])}, colour(half.mean)};
}

} // namespace clrt
