// SPDX-License-Identifier: Apache-2.0
#include "console/address_space.h"

#include <sys/mman.h>
#include <sys/resource.h>

namespace clrt {

namespace {

/// True if `bytes` more can be mapped, or if there is no limit.
bool has_address_space(size_t bytes) {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return true;
    void* const room = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED)
        return false;
    munmap(room, bytes);
    return true;
}

} // namespace

std::string address_space_obstacle(size_t bytes, const char* whom) {
    if (has_address_space(bytes))
        return {};
    return "not enough memory: " + std::string(whom) + " needs " + std::to_string(bytes >> 20) +
           " MiB, the limit of the address space (ulimit -v) leaves less: expected a higher limit or none";
}

} // namespace clrt
