// SPDX-License-Identifier: Apache-2.0
// The ledger in words and as JSON.
#include "output/standard_streams.h"
#include "render/kernels.h"
#include "render/ledger.h"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

using Json = nlohmann::ordered_json;

/// "12.3 (11.0 - 14.1)".
std::string percent(const LedgerValue& share) {
    return fmt::format("{:.1f} ({:.1f} - {:.1f})", 100 * share.median, 100 * share.low, 100 * share.high);
}

/// Milliseconds, three digits: pictures take microseconds or minutes.
std::string milliseconds(const LedgerValue& seconds) {
    return fmt::format("{:.3g} ({:.3g} - {:.3g})", 1e3 * seconds.median, 1e3 * seconds.low,
                       1e3 * seconds.high);
}

Json json(const LedgerValue& value) {
    return {{"median", value.median}, {"low", value.low}, {"high", value.high}};
}

Json json(const LedgerProgram& program) {
    return {{"compile_seconds", program.compile_seconds}, {"seconds_per_spp", json(program.seconds)}};
}

Json optional(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

std::string break_even_text(const Ledger& ledger) {
    if (!ledger.break_even)
        return "does not pay here: the full program is not slower";
    return fmt::format(
        "pays after {:.0f} samples a pixel ({:.0f} - {}) where the full program is compiled already{}",
        *ledger.break_even, ledger.break_even_low.value_or(0),
        ledger.break_even_high ? fmt::format("{:.0f}", *ledger.break_even_high) : "never",
        ledger.specialised.compile_seconds <= ledger.full.compile_seconds ? ", at once where neither is"
                                                                          : "");
}

const char* name_of(LedgerClock clock) {
    return clock == LedgerClock::PROCESSOR ? "processor" : "device";
}

const char* name_of(RuleSide side) {
    return side == RuleSide::BELOW ? "below" : side == RuleSide::ABOVE ? "above" : "undecided";
}

/// One line of the table: what, milliseconds, the cost in words, light, compiling, pairs.
std::string table_line(const std::string& what, const std::string& seconds, const std::string& cost,
                       const std::string& light, const std::string& compile, const std::string& pairs) {
    return fmt::format("{:<22} {:<30} {:<31} {:<22} {:<15} {}\n", what, seconds, cost, light, compile, pairs);
}

std::string heading(const Ledger& ledger, const Options& options, const DeviceInfo& device) {
    return fmt::format("Ledger of {}{}: {} x {}, {}, on {}\nPairs of {} spp; {} for one sample a pixel; "
                       "{:.0f} % intervals\n\n",
                       ledger.of == LedgerOf::ABSENT ? "what is not in " : "", input_name(options.scene.path),
                       ledger.width, ledger.height, name_of(options.transport.integrator), device.name,
                       ledger.samples,
                       ledger.clock == LedgerClock::PROCESSOR ? "milliseconds of all threads together"
                                                              : "milliseconds of the device",
                       100 * LEDGER_CONFIDENCE);
}

/// Seconds that compiling another program takes longer, where that is more than the picture's scatters.
std::string compile_text(const Ledger& ledger, double extra) {
    return std::fabs(extra) > ledger.compile_scatter ? fmt::format("{:+.2f}", extra) : "not seen";
}

/// What the absent effects say about the rule for bits.
std::string rule_text(const Ledger& ledger) {
    std::string lines;
    for (const RuleSide side : {RuleSide::ABOVE, RuleSide::BELOW, RuleSide::UNDECIDED}) {
        std::vector<std::string> names;
        for (const LedgerRow& row : ledger.rows)
            if (rule_side(row.time_share) == side)
                names.push_back(row.effect);
        if (!names.empty())
            lines += fmt::format("{} {:g} %: {}.\n",
                                 side == RuleSide::ABOVE   ? "Above"
                                 : side == RuleSide::BELOW ? "Below"
                                                           : "Not told from",
                                 100 * EFFECT_RULE_SHARE, fmt::join(names, ", "));
    }
    return lines;
}

Json row_json(const Ledger& ledger, const LedgerRow& line) {
    Json row = {{"name", line.effect},
                {"seconds_per_spp", json(line.seconds)},
                {"time_share", json(line.time_share)},
                {"cost", describe_cost(line.time_share)},
                {"compile_extra_seconds", line.compile_extra},
                {"pairs", line.pairs}};
    if (ledger.of == LedgerOf::ABSENT) {
        row["rule"] = name_of(rule_side(line.time_share));
        row["with_code"] = json(line.other);
    } else {
        row["light_share"] = json(line.light_share);
        row["without"] = json(line.other);
    }
    return row;
}

} // namespace

std::string describe_cost(const LedgerValue& share) {
    const auto interval = [](double middle, double low, double high) {
        return fmt::format("{:.1f} % ({:.1f} - {:.1f})", 100 * middle, 100 * low, 100 * high);
    };
    if (share.low > 0)
        return "costs " + interval(share.median, share.low, share.high);
    if (share.high < 0)
        return "saves " + interval(-share.median, -share.high, -share.low);
    return fmt::format("no cost seen (at most {:.1f} %)", 100 * share.high);
}

RuleSide rule_side(const LedgerValue& share) {
    return share.high < EFFECT_RULE_SHARE  ? RuleSide::BELOW
           : share.low > EFFECT_RULE_SHARE ? RuleSide::ABOVE
                                           : RuleSide::UNDECIDED;
}

std::string format_ledger(const Ledger& ledger, const Options& options, const DeviceInfo& device) {
    std::string out = heading(ledger, options, device);
    const bool of_absent = ledger.of == LedgerOf::ABSENT;
    out += table_line(of_absent ? "code of" : "", "ms", "of the picture's time",
                      of_absent ? "" : "% of light", "compile s", "pairs");
    for (const LedgerRow& line : ledger.rows)
        out += table_line(line.effect, milliseconds(line.seconds), describe_cost(line.time_share),
                          of_absent ? "" : percent(line.light_share),
                          compile_text(ledger, line.compile_extra), std::to_string(line.pairs));
    out += table_line(
        "the picture", milliseconds(ledger.specialised.seconds), "", "",
        fmt::format("{:.2f} (+-{:.2f})", ledger.specialised.compile_seconds, ledger.compile_scatter), "");
    out += table_line("by the full program", milliseconds(ledger.full.seconds),
                      describe_cost(ledger.full_extra_share), "",
                      compile_text(ledger, ledger.full_compile_extra), std::to_string(ledger.full_pairs));
    out += "\n" + (of_absent ? rule_text(ledger) : "");
    out += fmt::format("Compiling for the scene {}.\n", break_even_text(ledger));
    out += fmt::format("The ledger took {:.1f} s, {:.1f} s of it compiling.\n", ledger.seconds,
                       ledger.compile_seconds);
    if (!ledger.not_measured.empty())
        out += fmt::format(
            "Not measured, for want of time: {}. Compiled programs are kept: another run gets further.\n",
            fmt::join(ledger.not_measured, ", "));
    return out;
}

std::string ledger_json(const Ledger& ledger, const Options& options, const DeviceInfo& device) {
    Json root;
    root["version"] = CLRT_VERSION;
    root["scene"] = input_name(options.scene.path);
    root["integrator"] = name_of(options.transport.integrator);
    root["device"] = {{"platform", device.platform}, {"name", device.name}, {"driver", device.driver}};
    root["width"] = ledger.width;
    root["height"] = ledger.height;
    root["bvh"] = {{"quality", name_of(ledger.bvh_quality)}, {"reason", ledger.bvh_reason}};
    root["seconds"] = ledger.seconds;
    root["compile_seconds"] = ledger.compile_seconds;
    root["not_measured"] = ledger.not_measured;
    root["spp"] = ledger.samples;
    root["confidence"] = LEDGER_CONFIDENCE;
    root["clock"] = name_of(ledger.clock);
    root["picture"] = json(ledger.specialised);
    root["picture"]["compile_scatter_seconds"] = ledger.compile_scatter;
    root["full_program"] = json(ledger.full);
    root["full_program"]["extra_share"] = json(ledger.full_extra_share);
    root["full_program"]["compile_extra_seconds"] = ledger.full_compile_extra;
    root["full_program"]["pairs"] = ledger.full_pairs;
    root["break_even_spp"] = {{"median", optional(ledger.break_even)},
                              {"low", optional(ledger.break_even_low)},
                              {"high", optional(ledger.break_even_high)}};
    Json& rows = root[ledger.of == LedgerOf::ABSENT ? "absent_effects" : "effects"] = Json::array();
    for (const LedgerRow& line : ledger.rows)
        rows.push_back(row_json(ledger, line));
    return root.dump(2) + "\n";
}

} // namespace clrt
