// SPDX-License-Identifier: Apache-2.0
#include "replay/causes.h"

#include "replay/replay_command.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

/// Whether a number of this event is of the kind that the sample is counted as.
bool is_bad(const SampleTrace& trace, const TraceEvent& event, double largest) {
    if (is_choice(event.quantity))
        return false;
    const Quantity& row = quantity(event.quantity);
    const bool is_radiance = event.quantity == TRACE_EMITTED || event.quantity == TRACE_SKY ||
                             event.quantity == TRACE_LIGHT_RADIANCE || event.quantity == TRACE_CONNECTION ||
                             event.quantity == TRACE_ADDED || event.quantity == TRACE_RADIANCE ||
                             event.quantity == TRACE_LAYER;
    for (int i = 0; i < row.values; ++i) {
        const double x = trace_value(trace, event, i);
        if (!std::isfinite(x) || (row.sign == TraceSign::NOT_NEGATIVE && x < 0))
            return true;
        if (trace.fault == COUNT_OVERFLOW && is_radiance && x > largest)
            return true;
    }
    return false;
}

u32 material_at(const SampleTrace& trace, size_t index, const Scene& scene) {
    for (size_t i = index + 1; i-- > 0 && trace.events[i].quantity != TRACE_VERTEX;)
        if (trace.events[i].quantity == TRACE_TRIANGLE && trace.events[i].bits[0] < scene.triangles.size())
            return scene.triangles[trace.events[i].bits[0]].material;
    return NO_INDEX;
}

/// The event where the sample went wrong: an infinite density may do no harm, so only the vertex from which a
/// bad value was carried on counts. Its first bad value is the cause.
size_t cause_index(const SampleTrace& trace, double largest) {
    const size_t count = trace.events.size();
    size_t carried = 0;
    while (carried < count && !(quantity(trace.events[carried].quantity).is_carried &&
                                is_bad(trace, trace.events[carried], largest)))
        ++carried;
    if (carried == count)
        return count;
    // A ray is carried from the vertex before.
    const bool is_ray = trace.events[carried].quantity == TRACE_RAY_ORIGIN ||
                        trace.events[carried].quantity == TRACE_RAY_DIRECTION;
    const u32 bounce = trace_bounce(trace, carried) - (is_ray && trace_bounce(trace, carried) > 1 ? 1 : 0);
    for (size_t i = 0; i < carried; ++i)
        if (trace_bounce(trace, i) >= bounce && is_bad(trace, trace.events[i], largest))
            return i;
    return carried;
}

std::string material_name(const Cause& cause, const Scene& scene) {
    return cause.material < scene.material_names.size() ? scene.material_names[cause.material] : "";
}

/// The quantity in words.
std::string quantity_name(const Cause& cause) {
    if (cause.kind == COUNT_WORDS)
        return "none: good when replayed";
    if (cause.quantity == 0)
        return "film";
    const bool is_ray = cause.quantity == TRACE_RAY_ORIGIN || cause.quantity == TRACE_RAY_DIRECTION;
    return is_ray && cause.bounce == 0 ? "camera ray" : quantity(cause.quantity).name;
}

} // namespace

const char* fault_name(u32 kind) {
    switch (kind) {
    case COUNT_NAN:
        return "NaN";
    case COUNT_INFINITE:
        return "infinite";
    case COUNT_NEGATIVE:
        return "negative";
    case COUNT_OVERFLOW:
        return "overflow";
    default:
        return "good";
    }
}

Cause find_cause(const SampleTrace& trace, const Scene& scene, double largest) {
    Cause cause;
    cause.kind = trace.fault;
    if (trace.fault == COUNT_WORDS)
        return cause;
    const size_t at = cause_index(trace, largest);
    if (at == trace.events.size())
        return cause;
    cause.quantity = trace.events[at].quantity;
    cause.bounce = trace_bounce(trace, at);
    // The sum of all and the camera's ray belong to no vertex.
    if (cause.quantity == TRACE_RADIANCE || cause.quantity == TRACE_LAYER)
        cause.quantity = cause.bounce = 0;
    else if (cause.bounce == 1 &&
             (cause.quantity == TRACE_RAY_ORIGIN || cause.quantity == TRACE_RAY_DIRECTION))
        cause.bounce = 0;
    else
        cause.material = material_at(trace, at, scene);
    return cause;
}

std::vector<CauseCount> count_causes(const std::vector<SampleTrace>& traces, const Scene& scene,
                                     double largest) {
    std::vector<CauseCount> causes;
    for (const SampleTrace& trace : traces) {
        const Cause cause = find_cause(trace, scene, largest);
        const auto same =
            std::find_if(causes.begin(), causes.end(), [&](const CauseCount& c) { return c.cause == cause; });
        if (same == causes.end())
            causes.push_back({cause, 1, trace.address});
        else
            ++same->count;
    }
    std::stable_sort(causes.begin(), causes.end(),
                     [](const auto& a, const auto& b) { return a.count > b.count; });
    return causes;
}

std::vector<CauseCount> find_causes(const PreparedScene& prepared, const RenderCounts& counts) {
    Replay replay(prepared, prepared.planned->options.device.precision);
    std::vector<SampleAddress> addresses;
    for (const auto& [pixel, sample] : counts.bad_samples)
        addresses.push_back({pixel, sample});
    return count_causes(replay.run(addresses), prepared.planned->scene, replay.largest());
}

std::uint64_t replayed_samples(const std::vector<CauseCount>& causes) {
    std::uint64_t samples = 0;
    for (const CauseCount& row : causes)
        samples += row.count;
    return samples;
}

std::string format_causes(const std::vector<CauseCount>& causes, std::uint64_t bad, const Scene& scene,
                          const Options& options) {
    std::string text;
    for (const CauseCount& row : causes) {
        const std::string name = material_name(row.cause, scene);
        text += fmt::format("cause    {} x {}: {}, {}, bounce {}{}\n         {}\n", row.count,
                            fault_name(row.cause.kind), quantity_name(row.cause),
                            name_of(options.transport.integrator), row.cause.bounce,
                            name.empty() ? "" : ", material " + name, replay_command(options, row.example));
    }
    if (!causes.empty() && replayed_samples(causes) < bad)
        text += fmt::format("         of {} bad samples, {} were replayed\n", bad, replayed_samples(causes));
    return text;
}

nlohmann::ordered_json causes_json(const std::vector<CauseCount>& causes, const Scene& scene,
                                   const Options& options) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const CauseCount& row : causes) {
        const std::string name = material_name(row.cause, scene);
        list.push_back(
            {{"kind", fault_name(row.cause.kind)},
             {"quantity", quantity_name(row.cause)},
             {"integrator", name_of(options.transport.integrator)},
             {"bounce", row.cause.bounce},
             {"material", name.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(name)},
             {"count", row.count},
             {"replay", replay_command(options, row.example)}});
    }
    return list;
}

} // namespace clrt
