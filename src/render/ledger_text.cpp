// SPDX-License-Identifier: Apache-2.0
// The ledger in words and as JSON.
#include "output/standard_streams.h"
#include "render/kernels.h"
#include "render/ledger.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

using Json = nlohmann::ordered_json;

/// "12.3 (11.0 - 14.1)", all times `factor`.
std::string text(const LedgerValue& value, double factor) {
    return fmt::format("{:6.1f} ({:.1f} - {:.1f})", factor * value.median, factor * value.low,
                       factor * value.high);
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

} // namespace

std::string format_ledger(const Ledger& ledger, const Options& options, const DeviceInfo& device) {
    std::string out =
        fmt::format("Ledger of {}: {} x {}, {}, on {}\n{} rounds of {} spp; {} for one sample a pixel; "
                    "medians with 96 % intervals\n\n",
                    input_name(options.scene.path), ledger.width, ledger.height,
                    name_of(options.transport.integrator), device.name, LEDGER_ROUNDS, ledger.samples,
                    ledger.is_processor_time ? "milliseconds of all threads together" : "milliseconds");
    const char* const row = "{:<22}  {:<26} {:<24} {:<24} {}\n";
    out += fmt::format(fmt::runtime(row), "", "    ms", "     % of time", "     % of light",
                       "compile s without it");
    for (const LedgerRow& line : ledger.rows)
        out +=
            fmt::format(fmt::runtime(row), line.effect, text(line.seconds, 1e3), text(line.time_share, 100),
                        text(line.light_share, 100), fmt::format("{:.2f}", line.without.compile_seconds));
    out += fmt::format(fmt::runtime(row), "the picture", text(ledger.specialised.seconds, 1e3), "", "",
                       fmt::format("{:.2f}", ledger.specialised.compile_seconds));
    out += fmt::format(fmt::runtime(row), "by the full program", text(ledger.full.seconds, 1e3),
                       text(ledger.full_extra_share, 100) + " more", "",
                       fmt::format("{:.2f}", ledger.full.compile_seconds));
    out += fmt::format("\nCompiling for the scene {}.\n", break_even_text(ledger));
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
    root["rounds"] = LEDGER_ROUNDS;
    root["spp"] = ledger.samples;
    root["confidence"] = 0.961;
    root["clock"] = ledger.is_processor_time ? "processor" : "wall";
    root["picture"] = json(ledger.specialised);
    root["full_program"] = json(ledger.full);
    root["full_program"]["extra_share"] = json(ledger.full_extra_share);
    root["break_even_spp"] = {{"median", optional(ledger.break_even)},
                              {"low", optional(ledger.break_even_low)},
                              {"high", optional(ledger.break_even_high)}};
    root["effects"] = Json::array();
    for (const LedgerRow& line : ledger.rows)
        root["effects"].push_back({{"name", line.effect},
                                   {"seconds_per_spp", json(line.seconds)},
                                   {"time_share", json(line.time_share)},
                                   {"light_share", json(line.light_share)},
                                   {"without", json(line.without)}});
    return root.dump(2) + "\n";
}

} // namespace clrt
