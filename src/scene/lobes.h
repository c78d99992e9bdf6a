// SPDX-License-Identifier: Apache-2.0
// The table of lobes (kernels/shared/lobes.h) for the host.
#pragma once

#include "kernels/shared/lobes.h"
#include "kernels/shared/types.h"

namespace clrt {

/// One row; letters are bits LETTER_BIT.
struct LobeSpec {
    u32 bit;                ///< LOBE_*
    const char* name;       ///< in reports
    EffectMask effect;      ///< EFFECT_* that compiles it in
    unsigned letters;       ///< that it writes where it has a density
    unsigned delta_letters; ///< that it writes where it is a delta function
    const char* absent;     ///< what --explain says where no material has it
};

#define LOBE_SPEC(NAME, name, effect, letters, delta_letters, absent)                                        \
    {LOBE_##NAME, #name, effect, letters, delta_letters, absent},
/// All lobes, in the order of their bits.
inline constexpr LobeSpec LOBE_SPECS[] = {LOBE_TABLE(LOBE_SPEC)};
#undef LOBE_SPEC

/// The effects of all lobes.
constexpr EffectMask lobe_effects() {
    EffectMask effects = 0;
    for (const LobeSpec& lobe : LOBE_SPECS)
        effects |= lobe.effect;
    return effects;
}

} // namespace clrt
