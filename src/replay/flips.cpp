// SPDX-License-Identifier: Apache-2.0
#include "replay/flips.h"

#include "render/render_params.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

namespace {

/// Bounces from here on share a column of the table.
constexpr u32 LAST_BOUNCE_COLUMN = 6;

std::vector<SampleAddress> all_samples(const Options& options) {
    const Crop window = render_window(options.film);
    std::vector<SampleAddress> addresses;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            for (u32 s = 0; s < options.sampling.spp.value_or(DEFAULT_SPP); ++s)
                addresses.push_back(
                    {u32(y) * u32(options.film.size.x) + u32(x), options.sampling.first_sample + s});
    return addresses;
}

std::array<double, 3> radiance(const SampleTrace& trace) {
    std::array<double, 3> rgb{};
    for (const TraceEvent& event : trace.events)
        if (event.quantity == TRACE_RADIANCE)
            for (int c = 0; c < 3; ++c)
                rgb[size_t(c)] = trace_value(trace, event, c);
    return rgb;
}

Flip make_flip(const SampleTrace& single, const SampleTrace& in_double) {
    const size_t at = compare_twins(single, in_double).decision;
    // A vertex event names the vertex that begins; what differs is how the one before it went on.
    return {single.address, trace_bounce(single, at > 0 ? at - 1 : 0), decision_name(single, in_double, at),
            radiance(single), radiance(in_double)};
}

} // namespace

std::map<std::pair<std::string, u32>, std::uint64_t> FlipStatistics::counts() const {
    std::map<std::pair<std::string, u32>, std::uint64_t> result;
    for (const Flip& flip : flips)
        ++result[{flip.decision, flip.bounce}];
    return result;
}

FlipStatistics find_flips(const PreparedScene& prepared) {
    Replay single(prepared, Precision::SINGLE), in_double(prepared, Precision::DOUBLE);

    // Compare hashes, then replay what differs.
    const std::vector<SampleAddress> addresses = all_samples(prepared.planned->options);
    const std::vector<SampleTrace> a = single.run(addresses, TraceEvents::NONE);
    const std::vector<SampleTrace> b = in_double.run(addresses, TraceEvents::NONE);
    std::vector<SampleAddress> differing;
    for (size_t i = 0; i < addresses.size(); ++i)
        if (a[i].decisions != b[i].decisions)
            differing.push_back(addresses[i]);
    const std::vector<SampleTrace> ways = single.run(differing), other_ways = in_double.run(differing);
    FlipStatistics statistics;
    statistics.samples = addresses.size();
    for (size_t i = 0; i < differing.size(); ++i)
        statistics.flips.push_back(make_flip(ways[i], other_ways[i]));
    return statistics;
}

std::string format_flips(const FlipStatistics& flips) {
    std::map<std::string, std::map<u32, std::uint64_t>> rows;
    for (const auto& [key, count] : flips.counts())
        rows[key.first][std::min(key.second, LAST_BOUNCE_COLUMN)] += count;
    std::string text = fmt::format("{} of {} samples take another path in double: {:.3g} %\n",
                                   flips.flips.size(), flips.samples, 100 * flips.share());
    if (rows.empty())
        return text;
    text += fmt::format("{:<20}{:>8}", "first at bounce", "all");
    for (u32 bounce = 1; bounce <= LAST_BOUNCE_COLUMN; ++bounce)
        text += fmt::format("{:>8}", fmt::format("{}{}", bounce, bounce == LAST_BOUNCE_COLUMN ? "+" : ""));
    text += '\n';
    for (const auto& [decision, counts] : rows) {
        std::uint64_t all = 0;
        for (const auto& [bounce, count] : counts)
            all += count;
        text += fmt::format("{:<20}{:>8}", decision, all);
        for (u32 bounce = 1; bounce <= LAST_BOUNCE_COLUMN; ++bounce)
            text += fmt::format("{:>8}", counts.count(bounce) ? counts.at(bounce) : 0);
        text += '\n';
    }
    return text;
}

} // namespace clrt
