// SPDX-License-Identifier: Apache-2.0
#include "images/image_library.h"

#include "console/address_space.h"

#include <dlfcn.h>
#include <stdexcept>

namespace clrt {

namespace {

/// Loads CLRT_IMAGE_LIBRARY, a file that is looked for in the folders of the program's run path. It stays
/// loaded: OpenImageIO's threads run until the end.
const ImageLibrary& load() {
    const std::string obstacle =
        address_space_obstacle(IMAGE_LIBRARY_BYTES, "loading the library of picture formats");
    if (!obstacle.empty())
        throw std::runtime_error(obstacle);
    void* const library = dlopen(CLRT_IMAGE_LIBRARY, RTLD_LAZY | RTLD_LOCAL);
    void* const entry = library ? dlsym(library, IMAGE_LIBRARY_ENTRY) : nullptr;
    if (!entry)
        throw std::runtime_error(
            std::string("the library of picture formats cannot be loaded: ") + dlerror() +
            "; expected it where clrt was built or installed. Pictures in .png and .pfm are "
            "written without it");
    return *reinterpret_cast<ImageLibraryEntry*>(entry)();
}

} // namespace

const ImageLibrary& image_library() {
    static const ImageLibrary& library = load();
    return library;
}

} // namespace clrt
