// SPDX-License-Identifier: Apache-2.0
// Libraries of the program's own, beside it or in the folders of its run path, that are loaded when they are
// needed. They stay loaded.
#pragma once

#include <dlfcn.h>
#include <stdexcept>
#include <string>

namespace clrt {

/// The functions of a library, from what it calls `entry`: a function of type Functions*(). Throws
/// std::runtime_error "`what` cannot be loaded: ..." with `advice` behind.
template <class Functions>
const Functions& load_own_library(const char* file, const char* entry, const std::string& what,
                                  const std::string& advice = "") {
    void* const library = dlopen(file, RTLD_LAZY | RTLD_LOCAL);
    void* const found = library ? dlsym(library, entry) : nullptr;
    if (!found)
        throw std::runtime_error(what + " cannot be loaded: " + dlerror() + advice);
    return *reinterpret_cast<const Functions* (*)()>(found)();
}

} // namespace clrt
