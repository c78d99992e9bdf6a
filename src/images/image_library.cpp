// SPDX-License-Identifier: Apache-2.0
#include "images/image_library.h"

#include "console/address_space.h"
#include "own_library.h"

#include <stdexcept>

namespace clrt {

namespace {

/// Stays loaded, which OpenImageIO needs: its threads run until the end.
const ImageLibrary& load() {
    const std::string obstacle =
        address_space_obstacle(IMAGE_LIBRARY_BYTES, "loading the library of picture formats");
    if (!obstacle.empty())
        throw std::runtime_error(obstacle);
    return load_own_library<ImageLibrary>(CLRT_IMAGE_LIBRARY, IMAGE_LIBRARY_ENTRY,
                                          "the library of picture formats",
                                          "; expected it where clrt was built or installed. Pictures in .png "
                                          "and .pfm are written without it");
}

} // namespace

const ImageLibrary& image_library() {
    static const ImageLibrary& library = load();
    return library;
}

} // namespace clrt
