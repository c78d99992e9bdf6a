// SPDX-License-Identifier: Apache-2.0
#include "http/http_server.h"

#include "own_library.h"

namespace clrt {

const HttpLibrary& http_library() {
    static const HttpLibrary& library = load_own_library<HttpLibrary>(
        CLRT_HTTP_LIBRARY, HTTP_LIBRARY_ENTRY, "the HTTP server",
        "; expected it where clrt was built or installed. It is built where libcpp-httplib-dev is there");
    return library;
}

} // namespace clrt
