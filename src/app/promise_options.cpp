// SPDX-License-Identifier: Apache-2.0
// The options of the group "The promises".
#include "app/effect_option.h"
#include "app/integrator_help.h"
#include "app/layer_option.h"
#include "app/option_rows.h"

namespace clrt {

std::vector<OptionSpec> promise_options() {
    const char* const group = "The promises";
    return {
        {group, "", "--explain", "[=json]", "say what would be simulated and why; no rendering",
         [](Options& o, const OptionValue& v) {
             if (!v.text.empty() && v.text != "json")
                 reject_value(v, "--explain or --explain=json");
             o.run.explain = v.text.empty() ? Explain::TABLE : Explain::JSON;
         }},
        {group, "", "--effects", "auto|all|LIST",
         "simulate what the scene needs (auto), with everything compiled in (all; same picture), or only the "
         "effects "
         "listed, such as matte,area-lights; -NAME takes one away: --effects=-refraction (default auto)",
         apply_effects},
        {group, "", "--paths", "EXPR",
         takers(TAKES_PATHS) +
             "simulate only these paths, light to eye: L light (La area, Lp point, Ld sun, Le sky), D matte, "
             "G glossy, S specular (R mirror, T refraction), . any surface, E eye, and | * + ? ( ), such as "
             "'L(D|S)*E' (default: all)",
         [](Options& o, const OptionValue& v) {
             check_paths(v, v.text);
             o.transport.paths = v.text;
         }},
        {group, "", "--ledger", "[=absent]",
         "measure what every effect costs in time and gives in light, by pairs of renders with and without "
         "it; =absent: what the code of effects that the picture does not show would cost, were it compiled "
         "in. --time bounds all of it, and effects that do not fit are named (default: all effects, at most "
         "a minute of pairs beside compiling); writes no picture",
         [](Options& o, const OptionValue& v) {
             if (!v.text.empty() && v.text != "absent")
                 reject_value(v, "--ledger or --ledger=absent");
             o.run.ledger = v.text.empty() ? LedgerOf::SHOWN : LedgerOf::ABSENT;
         },
         Repeat::NO, COMMAND_LINE_ONLY},
        {group, "", "--stats", "FILE",
         "write statistics of the run as JSON, in SI units; - is the standard output, the report then goes "
         "to stderr",
         [](Options& o, const OptionValue& v) { o.output.stats_path = parse_result(v); }},
        {group, "", "--check", "MODE", "non-finite samples: off, count, strict (exit 4) (default count)",
         [](Options& o, const OptionValue& v) { o.run.check = parse_choice<Check>(v); }},
        {group, "", "--pixel", "X,Y",
         "replay one sample of this pixel and print its path, in single and double precision side by side; "
         "-v adds "
         "hexadecimal numbers, --stats writes JSON; no picture",
         [](Options& o, const OptionValue& v) { o.run.pixel = parse_pixel(v); }, Repeat::NO,
         COMMAND_LINE_ONLY},
        {group, "", "--sample", "N", "which sample of --pixel (default 0)",
         [](Options& o, const OptionValue& v) {
             o.run.sample = static_cast<std::uint32_t>(parse_whole(v, 0, LARGEST_U32 - 1));
         },
         Repeat::NO, COMMAND_LINE_ONLY},
    };
}

} // namespace clrt
