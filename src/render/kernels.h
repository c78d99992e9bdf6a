// SPDX-License-Identifier: Apache-2.0
// The programs of a render: which entry point, with which defines.
#pragma once

#include "bvh/bvh.h"
#include "device/program.h"
#include "options/options.h"
#include "paths/path_plan.h"

#include <optional>

namespace clrt {

/// The compiled programs of one run.
struct RenderPrograms {
    Program picture;
    std::optional<Program> layers; ///< auxiliary layers, when a file wants them
    double seconds = 0;            ///< wall time of building both
};

/// The tree's layout: as chosen, else bvh8 on CPUs, where it is the fastest that was measured, and bvh2
/// elsewhere: the simpler of the two layouts for GPUs, until bvh2 and cwbvh have been measured on one.
BvhLayout choose_layout(std::optional<BvhLayout> choice, const DeviceInfo& device);

/// True if some output file can hold auxiliary layers and the options want one, or the picture is denoised,
/// which they guide.
bool wants_layers(const Options& options);

/// How many of a pixel's samples the layers of the primary hits are means over, at most. Those that are there
/// unasked are means over 16: enough for the edges of what is seen first, where rays for all samples would
/// take a fifth of a render's time. Alpha is that of the picture and has all samples; so has what --aov
/// names.
std::uint64_t most_hit_samples(const Options& options);

/// True if they have mattes besides (output/cryptomatte.h).
bool wants_mattes(const Options& options);

/// Literal of the rays of a tree that can wait (kernels/integrators/distribution_ray.h), a power of two, so
/// that few programs serve all; none where the integrator does not branch so.
std::vector<std::string> waiting_defines(const TransportOptions& transport);

/// Literal of the vertices that are kept of a light path (kernels/path/light_vertices.h); none where none is.
std::vector<std::string> vertex_defines(const TransportOptions& transport);

/// Literal of the segments up to which strategies are told apart (kernels/path/strategies.h); none where they
/// are not.
std::vector<std::string> strategy_defines(const Options& options);

/// What --dump-kernels may write, a replay included; empty without it.
std::vector<std::string> dumped_files(const Options& options);

/// What is compiled for the picture: the integrator with this effects mask and, where paths are told apart,
/// the automaton of the plan.
ProgramRequest picture_request(const Device& device, const Options& options, EffectMask effects,
                               BvhLayout layout, const PathPlan& paths);

/// The same integrator so that it guides paths (kernels/path/guide.h).
ProgramRequest guided_request(const Device& device, const Options& options, EffectMask effects,
                              BvhLayout layout, const PathPlan& paths);

/// Compiles the picture's program, and that of the layers where they are wanted.
RenderPrograms build_render_programs(const Device& device, const Options& options, EffectMask effects,
                                     BvhLayout layout, const PathPlan& paths = {});

/// Compiles what finds ways out of the scene (kernels/integrators/escapes.cl).
Program build_escape_program(const Device& device, const Options& options, EffectMask effects,
                             BvhLayout layout);

/// The same integrator, path+light or bdpt, so that it sums the moments of its samples
/// (kernels/film/moments.h).
ProgramRequest pilot_request(const Device& device, const Options& options, EffectMask effects,
                             BvhLayout layout, const PathPlan& paths);

/// Compiles the same integrator so that it records what single samples do (kernels/trace), in a precision of
/// its own.
Program build_replay_program(const Device& device, const Options& options, Precision precision,
                             EffectMask effects, BvhLayout layout, const PathPlan& paths);

} // namespace clrt
