// SPDX-License-Identifier: Apache-2.0
// Sets of effects to test, and for each a small scene that calls for exactly these.
#pragma once

#include "effects/effect_table.h"
#include "probes/scratch_scene.h"

#include <string>
#include <vector>

namespace clrt {

/// True if every effect has those that it cannot be without: some scene calls for exactly these.
bool is_permitted(EffectMask effects);

/// Every effect with just those that it cannot be without.
std::vector<EffectMask> single_effects();

/// All effects but one and those that imply it, for every effect.
std::vector<EffectMask> all_but_one_effect();

/// A covering array: for every two effects, each of "both", "one", "the other" and "neither" that a scene can
/// call for occurs in some set. Found greedily, always the same.
std::vector<EffectMask> pairwise_effects();

/// The three families together, each set once.
std::vector<EffectMask> all_effect_sets();

/// Names for messages.
std::string describe_effects(EffectMask effects);

/// Has all uses of a picture read second texture coordinates: u and v exchanged.
void read_by_second_uvs(const std::string& file, Scene& scene);

/// A scene that calls for exactly these effects, each of which shows where light and lobes allow; 16 x 16
/// pixels.
class SceneOfEffects : public ScratchScene {
public:
    explicit SceneOfEffects(EffectMask effects);

private:
    bool has(EffectMask effect) const { return (effects_ & effect) != 0; }
    void add_materials();
    void add_bodies();
    void add_rare_bodies();
    void add_lights();
    const EffectMask effects_;
};

} // namespace clrt
