// SPDX-License-Identifier: Apache-2.0
#include "stability/report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

using Json = nlohmann::ordered_json;

std::string format_worst(const Worst& worst) {
    return worst.tried == 0 ? "-" : fmt::format("{:.3g}", worst.value);
}

/// JSON knows no infinity: null.
Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json figure_json(const Figure& figure) {
    Json json{{"quantity", figure.quantity}, {"limit", figure.limit}, {"holds", figure.holds()}};
    for (const Build build : ALL_BUILDS)
        if (const Worst& worst = figure[build]; worst.tried > 0)
            json[build_name(build)] = {
                {"worst", number(worst.value)}, {"tried", worst.tried}, {"input", worst.input}};
    return json;
}

Json case_json(const CaseResult& result) {
    Json json{{"id", result.subject->id},         {"name", result.subject->name},
              {"set_up", result.subject->set_up}, {"oracle", result.subject->oracle},
              {"why", result.subject->why},       {"holds", result.holds()},
              {"seconds", result.seconds}};
    if (!result.error.empty())
        json["error"] = result.error;
    for (const Figure& figure : result.figures)
        json["figures"].push_back(figure_json(figure));
    return json;
}

/// Adds the figures of a timing, or why there are none; `naive` names the seconds of what it is timed
/// against.
void add_time(const ProbeTime& time, const std::string& error, const char* naive, Json& json) {
    if (!error.empty()) {
        json["error"] = error;
        return;
    }
    json[naive] = time.naive;
    json["seconds"] = time.single;
    json["ratio"] = time.ratio;
    json["ratio_quartiles"] = {time.ratio_low, time.ratio_high};
}

Json choice_cost_json(const ChoiceCost& cost) {
    Json json{{"choice", cost.choice->choice},
              {"naive", cost.choice->naive},
              {"robust", cost.choice->robust},
              {"case", cost.choice->case_id}};
    add_time(cost.time, cost.error, "naive_seconds", json);
    return json;
}

Json render_cost_json(const RenderCost& cost, bool in_cpu_seconds) {
    Json json{{"choice", cost.choice}, {"scene", cost.scene}, {"clock", in_cpu_seconds ? "cpu" : "wall"}};
    add_time(cost.time, cost.error, "clrt_seconds", json);
    if (cost.error.empty()) {
        json["rel_rms_difference"] = cost.difference;
        json["rel_rmse_of_clrt"] = cost.noise;
    }
    return json;
}

std::string format_choice_costs(const StabilityReport& report) {
    if (report.costs.empty())
        return "";
    std::string lines =
        fmt::format("\n{:<52} {:>9} {:>9} {:>18} {:>11} {:>11}  of\n", "what robustness costs, against naive",
                    "naive ns", "ns", "ratio (quartiles)", "naive error", "error");
    for (const ChoiceCost& cost : report.costs) {
        const std::string row = fmt::format("{}: {}", cost.choice->choice, cost.choice->naive);
        if (!cost.error.empty()) {
            lines += fmt::format("{:<52} FAILS: {}\n", row, cost.error);
            continue;
        }
        const Figure* figure = figure_of(report, *cost.choice);
        lines += fmt::format(
            "{:<52} {:>9.2f} {:>9.2f} {:>5.2f} ({:.2f}..{:.2f}) {:>11} {:>11}  {}\n", row,
            cost.time.naive * 1e9, cost.time.single * 1e9, cost.time.ratio, cost.time.ratio_low,
            cost.time.ratio_high, figure ? format_worst((*figure)[Build::NAIVE]) : "-",
            figure ? format_worst((*figure)[Build::SINGLE]) : "-",
            figure ? fmt::format("{} {}", cost.choice->case_id, figure->quantity) : cost.choice->case_id);
    }
    return lines;
}

std::string format_render_costs(const StabilityReport& report) {
    if (report.render_costs.empty())
        return "";
    std::string lines = fmt::format(
        "\n{:<30} {:<14} {:>9} {:>9} {:>18} {:>11} {:>11}\n", "what other kernels would save", "scene",
        takes_cpu_seconds(report) ? "CPU s" : "s", "clrt's", "ratio (quartiles)", "difference", "noise");
    for (const RenderCost& cost : report.render_costs)
        lines += !cost.error.empty()
                     ? fmt::format("{:<30} {:<14} FAILS: {}\n", cost.choice, cost.scene, cost.error)
                     : fmt::format(
                           "{:<30} {:<14} {:>9.3f} {:>9.3f} {:>5.2f} ({:.2f}..{:.2f}) {:>11.2g} {:>11.2g}\n",
                           cost.choice, cost.scene, cost.time.single, cost.time.naive, cost.time.ratio,
                           cost.time.ratio_low, cost.time.ratio_high, cost.difference, cost.noise);
    return lines;
}

} // namespace

bool takes_cpu_seconds(const StabilityReport& report) {
    return report.device.type == "CPU";
}

const Figure* figure_of(const StabilityReport& report, const RobustChoice& choice) {
    for (const CaseResult& result : report.cases)
        if (result.subject->id == std::string(choice.case_id) &&
            size_t(choice.figure) < result.figures.size())
            return &result.figures[size_t(choice.figure)];
    return nullptr;
}

size_t count_broken(const StabilityReport& report) {
    return size_t(std::count_if(report.cases.begin(), report.cases.end(),
                                [](const CaseResult& result) { return !result.holds(); }));
}

size_t count_failed_costs(const StabilityReport& report) {
    const auto failed = [](const auto& cost) { return !cost.error.empty(); };
    return size_t(std::count_if(report.costs.begin(), report.costs.end(), failed) +
                  std::count_if(report.render_costs.begin(), report.render_costs.end(), failed));
}

std::string format_case_head() {
    return fmt::format("{:<4} {:<44} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}  verdict\n", "case", "figure",
                       "inputs", "naive", "single", "fast", "double", "limit");
}

std::string format_case(const CaseResult& result) {
    std::string lines;
    const char* id = result.subject->id;
    for (const Figure& figure : result.figures) {
        lines += fmt::format("{:<4} {:<44} {:>9.3g} {:>9} {:>9} {:>9} {:>9} {:>9.3g}  {}\n", id,
                             figure.quantity, double(figure[Build::SINGLE].tried),
                             format_worst(figure[Build::NAIVE]), format_worst(figure[Build::SINGLE]),
                             format_worst(figure[Build::FAST]), format_worst(figure[Build::DOUBLE]),
                             figure.limit, figure.holds() ? "holds" : "FAILS");
        if (!figure.holds())
            lines += fmt::format("     worst in single: {}; in double: {}\n", figure[Build::SINGLE].input,
                                 figure[Build::DOUBLE].input);
        id = "";
    }
    if (!result.error.empty())
        lines += fmt::format("{:<4} {}  FAILS: {}\n", id, result.subject->name, result.error);
    return lines;
}

std::string format_costs(const StabilityReport& report) {
    return format_choice_costs(report) + format_render_costs(report);
}

std::string format_summary(const StabilityReport& report) {
    const size_t broken = count_broken(report), failed = count_failed_costs(report);
    const std::string cases =
        report.cases.empty()
            ? std::string("no case ran")
            : fmt::format("{} of {} cases hold", report.cases.size() - broken, report.cases.size());
    const size_t timings = report.costs.size() + report.render_costs.size();
    return fmt::format("{}{}{}, {} tier, {:.1f} s\n", cases, broken ? fmt::format(", {} FAIL", broken) : "",
                       failed ? fmt::format(", {} of {} timings FAIL", failed, timings) : "",
                       tier_name(report.tier), report.seconds);
}

std::string format_catalogue() {
    std::string lines;
    for (const CaseGroup& group : catalogue()) {
        std::map<std::string, std::string> by_id;
        for (const StabilityCase& c : group.cases)
            by_id[c.id] = fmt::format("  {} {}: {}; against {}\n", c.id, c.name, c.set_up, c.oracle);
        for (const WaitingCase& c : waiting_cases())
            if (c.id[0] == group.letter)
                by_id[c.id] = fmt::format("  {} {}: {}; waits for {}\n", c.id, c.name, c.set_up, c.waits_for);
        lines += fmt::format("{}\n", group.title);
        for (const auto& [id, line] : by_id)
            lines += line;
    }
    return lines;
}

std::string report_json(const StabilityReport& report) {
    Json json{{"version", CLRT_VERSION},
              {"command", report.command},
              {"device",
               {{"platform", report.device.platform},
                {"name", report.device.name},
                {"driver", report.device.driver}}},
              {"tier", tier_name(report.tier)},
              {"seconds", report.seconds},
              {"holds", count_broken(report) == 0}};
    for (const CaseResult& result : report.cases)
        json["cases"].push_back(case_json(result));
    for (const ChoiceCost& cost : report.costs)
        json["costs"].push_back(choice_cost_json(cost));
    for (const RenderCost& cost : report.render_costs)
        json["render_costs"].push_back(render_cost_json(cost, takes_cpu_seconds(report)));
    for (const WaitingCase& waiting : waiting_cases())
        json["waiting"].push_back({{"id", waiting.id}, {"name", waiting.name}, {"for", waiting.waits_for}});
    return json.dump(2) + "\n";
}

} // namespace clrt
