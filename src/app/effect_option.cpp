// SPDX-License-Identifier: Apache-2.0
#include "app/effect_option.h"

#include "app/nearest_name.h"
#include "effects/effect_table.h"

namespace clrt {

namespace {

/// The bit of a name, or an error that says which name may have been meant.
EffectMask known_effect(const OptionValue& value, const std::string& name) {
    if (const auto bit = effect_by_name(name))
        return *bit;
    const std::vector<std::string> known = effect_names(EVERY_EFFECT);
    std::string all;
    for (const std::string& effect : known)
        all += " " + effect;
    const std::string nearest =
        name.empty() ? "" : "; the nearest to '" + name + "' is " + nearest_name(name, known);
    reject_value(value, "auto, all or a list such as matte,area-lights or -refraction of" + all + nearest);
}

} // namespace

void apply_effects(Options& options, const OptionValue& value) {
    options.effects.all = false;
    options.effects.list.reset();
    options.effects.off = 0;
    bool is_first = true;
    for (const std::string& part : split_list(value.text)) {
        const bool is_start = part == "auto" || part == "all";
        const bool is_away = !part.empty() && part[0] == '-';
        if (is_start && !is_first)
            reject_value(value, "auto or all before everything else");
        if (part == "all")
            options.effects.all = true;
        else if (is_away)
            options.effects.off |= known_effect(value, part.substr(1));
        else if (!is_start) {
            const EffectMask bit = known_effect(value, part);
            if (!is_first && !options.effects.list)
                reject_value(value, "effects with a '-' after auto, all or another '-', which '" + part +
                                        "' adds nothing to");
            options.effects.list = options.effects.list.value_or(0) | bit;
        }
        is_first = false;
    }
}

} // namespace clrt
