// SPDX-License-Identifier: Apache-2.0
// Every effect once: its name, the effects that it is a kind of, and what a picture without it shows. Plan,
// --explain,
// --effects, --ledger and the tests read this table.
#pragma once

#include "kernels/shared/effects.h"
#include "kernels/shared/types.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// Effects that every program simulates and a run-time value switches off, because --max-depth decides it: a
/// loop that ends costs no code. Their bits are apart from those of kernels/shared/effects.h.
constexpr EffectMask EFFECT_INTERREFLECTION = EFFECT_BIT(0x01000000);
/// All effects: those that decide about the program, and the others.
constexpr EffectMask EVERY_EFFECT = EFFECT_ALL | EFFECT_INTERREFLECTION;

/// One effect. A scene that shows it also shows the effects that it implies.
struct EffectSpec {
    EffectMask bit;      ///< EFFECT_*
    const char* name;    ///< as in messages, reports and files; hyphens for blanks on the command line
    EffectMask implies;  ///< bits of the effects without which it cannot be
    EffectMask one_of;   ///< at least one of these is there too; 0: it needs none
    const char* without; ///< what a scene that calls for it looks like with the effect switched off
};

/// All effects, in the order of their bits.
const std::vector<EffectSpec>& effect_table();

/// Adds all that the effects imply.
EffectMask with_implied(EffectMask effects);

/// Takes effects away, and those that imply them.
EffectMask without_effects(EffectMask effects, EffectMask taken);

/// The bit of an effect by its name, blanks or hyphens between its words; nothing if there is none of this
/// name.
std::optional<EffectMask> effect_by_name(const std::string& name);

/// Names of effects in the order of the table, as --effects takes them ("rough-refraction").
std::vector<std::string> effect_names(EffectMask effects);

} // namespace clrt
