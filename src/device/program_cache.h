// SPDX-License-Identifier: Apache-2.0
// Compiled programs on disk. An entry that is missing, damaged or from elsewhere is a miss, never an error.
#pragma once

#include "device/program.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// What an entry holds: OpenCL 1.2 gives argument names only for programs built from source, so they are kept
/// beside the binary.
struct CachedProgram {
    std::vector<unsigned char> binary;
    KernelArguments arguments;
};

/// True if our cache is to be used: AUTO is off where the driver caches by itself.
bool uses_program_cache(const ProgramCache& cache, const DeviceInfo& device);

/// The folder of the cache; empty if there is no place for one (no folder given, neither XDG_CACHE_HOME nor
/// HOME set).
std::string program_cache_folder(const ProgramCache& cache);

/// Why nothing can be kept there, in the system's words; empty where it can, or where nothing is to be kept.
/// Makes the folder.
std::string program_cache_obstacle(const ProgramCache& cache);

/// 32 hexadecimal digits: the hash of all that decides about the binary, which is the expanded source, the
/// options, platform, device, driver version, and the version of the entries' layout.
std::string program_cache_key(const DeviceInfo& device, const std::string& source,
                              const std::string& options);

/// The size of the cache: some hundred programs. The least recently used ones go first.
constexpr std::uint64_t PROGRAM_CACHE_BYTES = std::uint64_t(256) << 20;

/// The entry of this key, if there is a sound one; it becomes the most recently used.
std::optional<CachedProgram> read_cached_program(const std::string& folder, const std::string& key);

/// Writes an entry under a temporary name and renames it, so that readers never see half of one. A folder
/// that cannot be written is a debug message. Afterwards removes the least recently used others until all
/// entries together have at most `limit_bytes`, and files that a killed process left. Any number of processes
/// may do so at once.
void write_cached_program(const std::string& folder, const std::string& key, const CachedProgram& program,
                          std::uint64_t limit_bytes = PROGRAM_CACHE_BYTES);

} // namespace clrt
