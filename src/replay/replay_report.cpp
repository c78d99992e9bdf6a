// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_report.h"

#include "render/render_params.h"
#include "replay/causes.h"
#include "replay/replay_values.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

namespace {

constexpr size_t LABEL = 20, COLUMN = 40;

std::string event_text(const SampleTrace& trace, size_t at, const Scene& scene, bool hex) {
    const TraceEvent& event = trace.events[at];
    if (is_choice(event.quantity))
        return hex ? "" : choice_text(event, scene);
    if (hex)
        return fmt::format("{}", fmt::join(event_hex(trace, event), " "));
    const std::vector<double> values = event_values(trace, event, scene);
    std::string text;
    for (const double value : values)
        text += fmt::format("{}{:.{}g}", text.empty() ? "" : " ", value, values.size() == 1 ? 9 : 7);
    return text;
}

/// A line; `right` and `remark` may be empty.
std::string line(const char* label, const std::string& left, const std::string& right,
                 const std::string& remark) {
    std::string text =
        fmt::format("  {:<{}}{:<{}}  {:<{}}  {}", label, LABEL, left, COLUMN, right, COLUMN, remark);
    text.erase(text.find_last_not_of(' ') + 1);
    return text + "\n";
}

/// The lines of one event, of both records where there are two.
std::string event_lines(const ReplayReport& report, size_t at, const std::string& remark, bool hex) {
    const bool has_twin = report.twin && at < report.twin->events.size();
    const auto both = [&](bool as_hex) {
        return std::pair(event_text(report.first, at, report.scene, as_hex),
                         has_twin ? event_text(*report.twin, at, report.scene, as_hex) : "");
    };
    const TraceEvent& event = report.first.events[at];
    const auto [left, right] = both(false);
    if (event.quantity == TRACE_VERTEX && remark.empty())
        return fmt::format("vertex {}\n", left);
    std::string text = line(quantity(event.quantity).name, left, right, remark);
    if (hex && !is_choice(event.quantity)) {
        const auto [left_hex, right_hex] = both(true);
        text += line("", left_hex, right_hex, "");
    }
    return text;
}

/// What one record alone has from an event on.
std::string rest_lines(const ReplayReport& report, const SampleTrace& trace, size_t from, bool hex) {
    std::string text = fmt::format("{} alone, from there on\n", name_of(trace.precision));
    ReplayReport alone{report.options, report.scene, report.device, report.quantum, trace, std::nullopt};
    for (size_t at = from; at < trace.events.size(); ++at)
        text += event_lines(alone, at, "", hex);
    return text;
}

std::string film_text(const SampleTrace& trace, double quantum) {
    if (trace.fault != COUNT_WORDS)
        return fmt::format("counted as {}, adds 0", fault_name(trace.fault));
    std::string text;
    for (const std::int64_t sum : trace.film)
        text += fmt::format("{}{:.9g}", text.empty() ? "" : " ", double(float(double(sum) * quantum)));
    return text;
}

std::string header(const ReplayReport& report) {
    const Options& options = report.options;
    const u32 width = u32(options.film.size.x), pixel = report.first.address.pixel;
    std::string text =
        fmt::format("sample {} of pixel {},{}: {} x {}, {}, seed {}, on {}\n", report.first.address.sample,
                    pixel % width, pixel / width, options.film.size.x, options.film.size.y,
                    name_of(options.transport.integrator), options.sampling.seed, report.device.name);
    if (const int samples = light_samples(report.scene, options); samples > 1)
        text += fmt::format(
            "{} light samples at the first vertex: weights are of so many times their density\n", samples);
    if (options.device.precision == Precision::FAST)
        text += "relaxed maths: this program's last bits may differ from the picture's\n";
    if (!report.twin && !report.device.fp64)
        text += "the device has no fp64: single precision alone\n";
    return text + line("", name_of(report.first.precision),
                       report.twin ? name_of(report.twin->precision) : "", "difference");
}

std::string summary(const ReplayReport& report, const TwinDifference& difference) {
    std::string text;
    if (!report.twin)
        return text;
    const SampleTrace &a = report.first, &b = *report.twin;
    if (difference.has_decision()) {
        const size_t at = difference.decision;
        text += fmt::format("the two part at bounce {}: {}\n", trace_bounce(a, at > 0 ? at - 1 : 0),
                            decision_name(a, b, at));
    } else
        text += "both precisions take the same decisions\n";
    if (difference.has_largest())
        text += fmt::format("largest relative difference{}: {:.2g}, {} at bounce {}\n",
                            difference.has_decision() ? " before that" : "", difference.largest_relative,
                            quantity(a.events[difference.largest].quantity).name,
                            trace_bounce(a, difference.largest));
    return text;
}

} // namespace

std::string format_replay(const ReplayReport& report, bool hex) {
    const SampleTrace& a = report.first;
    const TwinDifference difference = report.twin ? compare_twins(a, *report.twin) : TwinDifference();
    const size_t common = std::min(difference.decision, a.events.size());
    std::string text = header(report);
    for (size_t at = 0; at < common; ++at) {
        std::string remark;
        if (report.twin && !is_choice(a.events[at].quantity))
            remark = fmt::format("{:.2g}{}", trace_difference(a, at, *report.twin, at),
                                 difference.largest == at ? "  <- the largest" : "");
        text += event_lines(report, at, remark, hex);
    }
    if (difference.has_decision()) {
        const bool same_quantity = common < a.events.size() && common < report.twin->events.size() &&
                                   a.events[common].quantity == report.twin->events[common].quantity;
        if (same_quantity)
            text += event_lines(report, common, "<- they decide differently", hex);
        text += rest_lines(report, a, common + same_quantity, hex) +
                rest_lines(report, *report.twin, common + same_quantity, hex);
    }
    text += "film\n" + line("adds", film_text(a, report.quantum),
                            report.twin ? film_text(*report.twin, report.quantum) : "", "");
    return text + summary(report, difference);
}

} // namespace clrt
