// SPDX-License-Identifier: Apache-2.0
#include "http/http_server.h"

#include <dlfcn.h>
#include <stdexcept>

namespace clrt {

namespace {

/// Loads CLRT_HTTP_LIBRARY, a file that is looked for in the folders of the program's run path.
const HttpLibrary& load_http() {
    void* const library = dlopen(CLRT_HTTP_LIBRARY, RTLD_LAZY | RTLD_LOCAL);
    void* const entry = library ? dlsym(library, HTTP_LIBRARY_ENTRY) : nullptr;
    if (!entry)
        throw std::runtime_error(
            std::string("the HTTP server cannot be loaded: ") + dlerror() +
            "; expected it where clrt was built or installed. It is built where libcpp-httplib-dev is there");
    return *reinterpret_cast<HttpLibraryEntry*>(entry)();
}

} // namespace

const HttpLibrary& http_library() {
    static const HttpLibrary& library = load_http();
    return library;
}

} // namespace clrt
