// SPDX-License-Identifier: Apache-2.0
#include "support/drawn.h"

#include "device/kernel_source.h"

#include <cstdint>

namespace clrt {

size_t drawn_number(size_t count) {
    // FNV-1a (Fowler, Noll and Vo): the same by every library.
    static const std::uint64_t hash = [] {
        std::uint64_t value = 0xcbf29ce484222325u;
        for (const auto& [name, text] : embedded_kernel_files())
            for (const unsigned char c : text)
                value = (value ^ c) * 0x100000001b3u;
        return value;
    }();
    return size_t(hash % count);
}

} // namespace clrt
