// SPDX-License-Identifier: Apache-2.0
#include "stability/stability_options.h"

#include "error.h"
#include "output/image.h"
#include "stability/catalogue.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace clrt {

namespace {

constexpr const char* HELP =
    R"(Usage: clrt-stability [options]

Runs the catalogue of hard cases on a device: rays aimed at edges, scenes of any size and place, grazing and critical
angles, roughness near 0, tiny and huge lights, long sums. Each case is judged by a closed form or a law; the kernels
are run in single precision, with relaxed maths (fast), in double where the device has it, and beside them stands the
textbook's formula (naive). Then it times what each robust choice costs.

Options:
  --device NAME    OpenCL device, as for clrt (default: CLRT_DEVICE, else the first GPU, else the CPU)
  --tier TIER      how many inputs: quick (a few minutes), night, long (hours) (default quick)
  --case ID        only cases whose id begins so, such as T or I01; repeatable
  --list           print the catalogue, and what waits for what, and exit
  --no-costs       leave out the timings
  --only-costs     run no case, only take the timings (of those of --case, or all)
  --rounds N       turns in which a timing is taken (default 15, for whole pictures 7)
  --output FILE    write the report as one HTML page
  --stats FILE     write all figures as JSON
  --kernels DIR    take clrt's kernels from here (default: those inside clrt-stability)
  --help           print this page and exit
  --version        print the version and exit

Exit codes:
  0    all cases hold
  1    output file or host memory
  2    wrong command line
  3    no such device, its compiler failed, or it lacks memory
  4    a case does not hold, or a timing failed
)";

Tier parse_tier(const std::string& text) {
    for (const Tier tier : {Tier::QUICK, Tier::NIGHT, Tier::LONG})
        if (text == tier_name(tier))
            return tier;
    throw UsageError("option --tier: expected quick, night or long, found '" + text + "'");
}

void check_cases(const std::vector<std::string>& ids) {
    for (const std::string& id : ids)
        if (chosen_cases({id}).empty())
            throw UsageError("option --case: expected the beginning of a case's id, found '" + id +
                             "'; `clrt-stability --list` prints all");
}

} // namespace

const char* tier_name(Tier tier) {
    constexpr const char* NAMES[] = {"quick", "night", "long"};
    return NAMES[static_cast<size_t>(tier)];
}

StabilityOptions parse_stability_options(int argc, const char* const* argv) {
    StabilityOptions options;
    options.command.assign(argv, argv + argc);
    std::string tier = tier_name(options.tier);
    bool help = false, version = false, no_costs = false, only_costs = false;
    int rounds = 0;
    CLI::App app;
    app.set_help_flag();
    const auto one_value = [](CLI::Option* option) { return option->expected(1)->take_last(); };
    one_value(app.add_option("--device,-d", options.device));
    one_value(app.add_option("--tier", tier));
    app.add_option("--case", options.cases)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    one_value(app.add_option("--output,-o", options.page_path));
    one_value(app.add_option("--stats", options.stats_path));
    one_value(app.add_option("--kernels", options.kernels_folder));
    app.add_flag("--list", options.list);
    app.add_flag("--no-costs", no_costs);
    app.add_flag("--only-costs", only_costs);
    CLI::Option* const rounds_option = one_value(app.add_option("--rounds", rounds));
    app.add_flag("--help,-h", help);
    app.add_flag("--version", version);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        throw UsageError(fmt::format("{}; `clrt-stability --help` lists the options", error.what()));
    }
    if (help)
        options.print = HELP;
    else if (version)
        options.print = "clrt-stability " CLRT_VERSION "\n";
    options.tier = parse_tier(tier);
    if (no_costs && only_costs)
        throw UsageError(
            "options --no-costs and --only-costs: expected one of them, for together nothing is left");
    options.costs = !no_costs;
    options.run_cases = !only_costs;
    if (rounds_option->count() > 0) {
        if (rounds < 1)
            throw UsageError(
                fmt::format("option --rounds: expected a whole number from 1, found {}", rounds));
        options.rounds = rounds;
    }
    check_cases(options.cases);
    for (const std::string* path : {&options.page_path, &options.stats_path})
        if (!path->empty())
            check_output_folder(*path);
    return options;
}

} // namespace clrt
