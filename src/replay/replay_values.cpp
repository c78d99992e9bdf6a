// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_values.h"

#include "kernels/shared/path_types.h"
#include "scene/lobes.h"
#include "scene/scene.h"

#include <fmt/format.h>

namespace clrt {

namespace {

std::string triangle_text(std::uint64_t index, std::uint64_t instance, const Scene& scene) {
    if (index >= scene.triangles.size())
        return "none: leaves the scene";
    const Triangle& triangle = scene.triangles[index];
    const auto name = [](const std::vector<std::string>& names, u32 i) {
        return i < names.size() ? names[i] : "";
    };
    const bool is_shared = instance > 0 && instance < scene.instances.size();
    const std::string object =
        name(scene.object_names, is_shared ? scene.instances[instance].object : triangle.object);
    return fmt::format("{}{}{}, {}", index, is_shared ? fmt::format(" of instance {}", instance) : "",
                       object.empty() ? "" : " of " + object, name(scene.material_names, triangle.material));
}

/// The name of a lobe; of one that reflects and refracts, with the way that was taken.
std::string lobe_text(std::uint64_t recorded) {
    const bool refracts = (recorded & TRACE_LOBE_REFRACTS) != 0;
    const std::uint64_t lobe = recorded & ~std::uint64_t(TRACE_LOBE_REFRACTS);
    for (const LobeSpec& row : LOBE_SPECS) {
        if (lobe != row.bit)
            continue;
        if (row.bit & LOBES_GLASS)
            return fmt::format("{}, {}", row.name, refracts ? "refracted" : "reflected");
        return row.name;
    }
    return lobe == 0 ? "none" : fmt::format("lobe {}", lobe); // one without a name of its own
}

std::string light_text(std::uint64_t kind) {
    switch (kind) {
    case 0:
        return "none found";
    case KIND_AREA:
        return "emissive triangle";
    case KIND_POINT:
        return "point light";
    case KIND_SUN:
        return "sun";
    case KIND_SKY:
        return "environment";
    default:
        return "a light";
    }
}

} // namespace

std::string choice_text(const TraceEvent& event, const Scene& scene) {
    const std::uint64_t word = event.bits[0];
    switch (event.quantity) {
    case TRACE_VERTEX:
        return event.bits[1] ? fmt::format("{}, ray {} of the tree", word, event.bits[1])
                             : std::to_string(word);
    case TRACE_TRIANGLE:
        return triangle_text(word, event.bits[1], scene);
    case TRACE_FRONT:
        return word ? "front" : "back";
    case TRACE_LOBE:
        return lobe_text(word);
    case TRACE_SURVIVES:
        return word ? "goes on" : "ends the path";
    case TRACE_CUT:
        return "cuts the path";
    case TRACE_LIGHT_KIND:
        return light_text(word);
    case TRACE_CONTINUES:
    case TRACE_CONNECTS:
    case TRACE_VISIBLE:
        return word ? "yes" : "no";
    default:
        return std::to_string(word);
    }
}

std::vector<double> event_values(const SampleTrace& trace, const TraceEvent& event, const Scene& scene) {
    const Quantity& row = quantity(event.quantity);
    const Normalisation& frame = scene.normalisation;
    std::vector<double> values;
    for (int i = 0; i < row.values; ++i) {
        const double x = trace_value(trace, event, i);
        if (row.unit == TraceUnit::NONE)
            values.push_back(x);
        else
            values.push_back(x / frame.scale + (row.unit == TraceUnit::POSITION ? frame.centre[i] : 0));
    }
    return values;
}

std::vector<std::string> event_hex(const SampleTrace& trace, const TraceEvent& event) {
    std::vector<std::string> texts;
    for (int i = 0; i < quantity(event.quantity).values; ++i)
        texts.push_back(fmt::format("{:a}", trace_value(trace, event, i)));
    return texts;
}

} // namespace clrt
