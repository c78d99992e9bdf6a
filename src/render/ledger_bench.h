// SPDX-License-Identifier: Apache-2.0
// What a ledger compares: variants of a picture, compiled once and rendered many times.
#pragma once

#include "render/ledger.h"
#include "render/ledger_pairs.h"
#include "render/ledger_plan.h"
#include "render/prepared_scene.h"
#include "render/render.h"

#include <memory>
#include <string>
#include <vector>

namespace clrt {

/// One way to render the scene.
struct LedgerVariant {
    std::string effect; ///< that is left out, or whose code is added; empty: none
    Options options;
    EffectMask mask = 0;                   ///< of its program
    std::shared_ptr<PlannedScene> planned; ///< made when it is compiled,
    PreparedParts parts;                   ///< and so are these
    double compile_seconds = 0;
};

/// The picture as asked for, the same by the full program, and one variant for each effect to be priced.
std::vector<LedgerVariant> ledger_variants(const Scene& scene, Options options);

/// Renders variants, all of them with the tree of the picture as asked for. Refers to its arguments.
class LedgerBench {
public:
    LedgerBench(const Device& device, const Scene& scene, const Options& options);

    const SceneTree& tree() const { return *tree_; }
    LedgerClock clock() const;

    /// Threads that a second of the clock is shared by.
    double threads() const;

    /// Plans a variant, makes its tree and programs and lets the driver finish them. Compilers work on one
    /// thread, and alone: their seconds are counted. Returns what it took by the wall clock.
    VariantSeconds compile(LedgerVariant& variant) const;

    /// Renders a compiled variant with so many samples a pixel, the random numbers being those of `number`.
    LedgerRun run(LedgerVariant& variant, std::uint32_t number, std::uint32_t samples) const;

private:
    std::shared_ptr<const SceneTree> tree_of(const PlannedScene& planned) const;
    Render render_once(const LedgerVariant& variant) const;

    const Device& device_;
    const Scene& scene_;
    Options options_;        ///< of the picture as asked for, --time and --spp included
    bool is_turned_ = false; ///< its triangles
    std::shared_ptr<const SceneTree> tree_;
};

} // namespace clrt
