// SPDX-License-Identifier: Apache-2.0
// clrt-stability: the catalogue of hard cases on a device.
#include "app/log.h"
#include "app/run_program.h"
#include "console/progress.h"
#include "exit_code.h"
#include "output/image.h"
#include "stability/report.h"

#include <chrono>
#include <cstdio>
#include <fmt/format.h>

namespace clrt {

namespace {

/// Opens the device for the kernels that were asked for.
ProbeDevice open_chosen_device(const StabilityOptions& options) {
    std::string notice;
    const DeviceInfo info = choose_device(list_platforms(), options.device, notice);
    return ProbeDevice(open_device(info), options.kernels_folder);
}

/// Times a choice; what it throws becomes its error, so that one that fails does not cost the report.
ChoiceCost measure_choice(const RobustChoice& choice, const ProbeDevice& device, int rounds) {
    ChoiceCost cost;
    cost.choice = &choice;
    try {
        cost.time = choice.time(device, rounds);
    } catch (const std::exception& error) {
        cost.error = error.what();
    }
    return cost;
}

void measure_costs(const StabilityOptions& options, const ProbeDevice& device, Progress& progress,
                   StabilityReport& report) {
    for (const RobustChoice& choice : robust_choices())
        if (is_asked_for(choice.case_id, options.cases)) {
            progress.update({fmt::format("cost: {} against {}", choice.choice, choice.naive)});
            report.costs.push_back(measure_choice(choice, device, options.rounds.value_or(CHOICE_ROUNDS)));
        }
    // Whole pictures belong to no case.
    if (options.cases.empty())
        report.render_costs =
            measure_render_costs(device, options.rounds.value_or(PICTURE_ROUNDS),
                                 [&](const std::string& next) { progress.update({"cost: " + next}); });
    progress.finish();
}

void run_cases(const StabilityOptions& options, const ProbeDevice& device, Progress& progress,
               StabilityReport& report) {
    const std::vector<const StabilityCase*> subjects = chosen_cases(options.cases);
    fmt::print("{}", format_case_head());
    std::fflush(stdout);
    for (const StabilityCase* subject : subjects) {
        progress.update({fmt::format("{} {}", subject->id, subject->name),
                         double(report.cases.size()) / double(subjects.size())});
        report.cases.push_back(run_case(*subject, device, options.tier));
        progress.finish();
        fmt::print("{}", format_case(report.cases.back()));
        std::fflush(stdout);
    }
}

StabilityReport run_catalogue(const StabilityOptions& options, const ProbeDevice& device) {
    const auto start = std::chrono::steady_clock::now();
    StabilityReport report;
    report.device = device.info;
    report.tier = options.tier;
    report.command = options.command;
    Progress progress(Toggle::AUTO, /*quiet=*/false);
    if (options.run_cases)
        run_cases(options, device, progress, report);
    if (options.costs)
        measure_costs(options, device, progress, report);
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

int run(int argc, const char* const* argv) {
    const StabilityOptions options = parse_stability_options(argc, argv);
    if (options.print || options.list) {
        fmt::print("{}", options.print ? *options.print : format_catalogue());
        return EXIT_DONE;
    }
    start_log(0);
    const StabilityReport report = run_catalogue(options, open_chosen_device(options));
    fmt::print("{}", format_costs(report));
    if (!options.page_path.empty())
        write_text_file(options.page_path, report_page(report));
    if (!options.stats_path.empty())
        write_text_file(options.stats_path, report_json(report));
    fmt::print("{}", format_summary(report));
    return count_broken(report) + count_failed_costs(report) == 0 ? EXIT_DONE : EXIT_CHECK;
}

} // namespace

} // namespace clrt

int main(int argc, char** argv) {
    using namespace clrt;
    return run_program("clrt-stability", [&] { return run(argc, argv); });
}
