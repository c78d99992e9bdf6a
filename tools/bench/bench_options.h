// SPDX-License-Identifier: Apache-2.0
// The command line of clrt-bench.
#pragma once

#include "options/options.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// Instruction sets that Embree's side can be held to, by Embree's own names.
inline constexpr const char* EMBREE_ISAS[] = {"sse2", "sse4.2", "avx", "avx2", "avx512"};

enum class BenchMode { SPEED, TREES, WATERTIGHT, ROBUSTNESS };

struct BenchOptions {
    BenchMode mode = BenchMode::SPEED;
    std::uint64_t aimed_rays = 0; ///< of --watertight and --robustness; 0: their defaults
    std::vector<std::string> scenes;
    Options clrt;                     ///< what means the same to clrt: device, bvh, threads, kernels_folder
    std::uint32_t rounds = 9;         ///< measurements of each side
    std::uint32_t rays = 1 << 20;     ///< of each kind
    std::string isa;                  ///< Embree's instruction set, of EMBREE_ISAS; empty: its choice
    bool cpu_time = false;            ///< ratios of CPU seconds instead of wall seconds
    std::string stats_path;           ///< JSON; empty: none
    bool no_sidecar = false;          ///< leaves SCENE.clrt unread
    std::vector<std::string> command; ///< argv as given
    std::optional<std::string> print; ///< text of --help or --version, to print and exit
};

/// Parses argv. Throws UsageError.
BenchOptions parse_bench_options(int argc, const char* const* argv);

/// clrt's own options for a scene (empty: one without a file): its options file, with what the bench was told
/// on top, and a picture of so many pixels that each gives a primary ray. Throws UsageError and SceneError.
Options scene_options(const BenchOptions& bench, const std::string& scene);

} // namespace clrt
