// SPDX-License-Identifier: Apache-2.0
// The report as a page.
#include "stability/report.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

/// The style that all pages of clrt share (tools/clrt_tools/page.css), embedded at build time.
extern const char* const PAGE_STYLE;

namespace {

std::string escape(const std::string& text) {
    std::string escaped;
    for (const char c : text)
        switch (c) {
        case '&':
            escaped += "&amp;";
            break;
        case '<':
            escaped += "&lt;";
            break;
        case '>':
            escaped += "&gt;";
            break;
        case '"':
            escaped += "&quot;";
            break;
        default:
            escaped += c;
        }
    return escaped;
}

/// A figure with its worst input as the tip, red where it is beyond the limit.
std::string value_span(const Worst& worst, double limit) {
    return fmt::format("<span title=\"{}\"{}>{:.3g}</span>", escape(worst.input),
                       worst.value <= limit ? "" : " class=\"beyond\"", worst.value);
}

std::string cell(const Worst& worst, double limit) {
    return "<td>" + (worst.tried == 0 ? "&ndash;" : value_span(worst, limit)) + "</td>";
}

/// What the textbook's way gives and what clrt gives instead.
std::string arrow_cell(const Figure& figure) {
    const std::string naive =
        figure[Build::NAIVE].tried == 0 ? "" : value_span(figure[Build::NAIVE], figure.limit) + " &rarr; ";
    const Worst& single = figure[Build::SINGLE];
    return "<td>" + naive + "<b>" + (single.tried == 0 ? "&ndash;" : value_span(single, figure.limit)) +
           "</b></td>";
}

/// The end of a row whose figures are missing.
std::string failed_cell(int columns, const std::string& error) {
    return fmt::format("<td colspan=\"{}\"><b class=\"beyond\">fails</b>: {}</td></tr>\n", columns,
                       escape(error));
}

std::string case_rows(const CaseResult& result) {
    const StabilityCase& subject = *result.subject;
    std::string rows = fmt::format(
        "<tr id=\"{0}\"><th colspan=\"7\">{0} {1}<br><span class=\"faint\">{2}; against {3}. Limit: {4}."
        "</span></th></tr>\n",
        subject.id, subject.name, escape(subject.set_up), escape(subject.oracle), escape(subject.why));
    for (const Figure& figure : result.figures)
        rows +=
            fmt::format("<tr><td>{}</td><td>{:.3g}</td>{}{}{}<td>{:.3g}</td><td>{}</td></tr>\n",
                        escape(figure.quantity), double(figure[Build::SINGLE].tried), arrow_cell(figure),
                        cell(figure[Build::FAST], figure.limit), cell(figure[Build::DOUBLE], figure.limit),
                        figure.limit, figure.holds() ? "holds" : "<b class=\"beyond\">fails</b>");
    if (!result.error.empty())
        rows += "<tr>" + failed_cell(7, result.error);
    return rows;
}

std::vector<const CaseResult*> results_of(const StabilityReport& report, const CaseGroup& group) {
    std::vector<const CaseResult*> results;
    for (const CaseResult& result : report.cases)
        if (result.subject >= group.cases.data() && result.subject < group.cases.data() + group.cases.size())
            results.push_back(&result);
    return results;
}

/// The groups with how many of their cases hold, as links.
std::string contents(const StabilityReport& report) {
    std::string items;
    for (const CaseGroup& group : catalogue()) {
        const std::vector<const CaseResult*> results = results_of(report, group);
        const auto holding = std::count_if(results.begin(), results.end(),
                                           [](const CaseResult* result) { return result->holds(); });
        if (!results.empty())
            items += fmt::format("<li><a href=\"#group-{}\">{}</a>: {} of {}</li>\n", group.letter,
                                 group.title, holding, results.size());
    }
    return items.empty() ? "" : "<ul class=\"contents\">\n" + items + "</ul>\n";
}

std::string case_tables(const StabilityReport& report) {
    std::string tables;
    for (const CaseGroup& group : catalogue()) {
        std::string rows;
        for (const CaseResult* result : results_of(report, group))
            rows += case_rows(*result);
        if (!rows.empty())
            tables += fmt::format(
                "<h2 id=\"group-{}\">{}</h2>\n<div class=\"scroll\"><table "
                "class=\"cases\">\n<tr><td>figure</td><td>"
                "inputs</td><td>naive &rarr; <b>single</b></td><td>fast</td><td>double</td><td>limit</td>"
                "<td></td></tr>\n{}</table></div>\n",
                group.letter, group.title, rows);
    }
    return tables;
}

/// A ratio with its quartiles.
std::string ratio_cell(const ProbeTime& time) {
    return fmt::format("<td>{:.2f} ({:.2f}&ndash;{:.2f})</td>", time.ratio, time.ratio_low, time.ratio_high);
}

std::string cost_table(const StabilityReport& report) {
    if (report.costs.empty())
        return "";
    std::string rows;
    for (const ChoiceCost& cost : report.costs) {
        rows += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td>", escape(cost.choice->choice),
                            escape(cost.choice->naive), escape(cost.choice->robust));
        if (!cost.error.empty()) {
            rows += failed_cell(5, cost.error);
            continue;
        }
        const Figure* figure = figure_of(report, *cost.choice);
        rows += fmt::format("<td>{:.2f}</td><td>{:.2f}</td>{}{}<td>{}</td></tr>\n", cost.time.naive * 1e9,
                            cost.time.single * 1e9, ratio_cell(cost.time),
                            figure ? arrow_cell(*figure) : "<td>&ndash;</td>",
                            figure ? escape(fmt::format("{} {}", cost.choice->case_id, figure->quantity))
                                   : cost.choice->case_id);
    }
    return "<h2 id=\"costs\">What robustness costs</h2>\n<p>Nanoseconds an evaluation" +
           std::string(takes_cpu_seconds(report) ? " (CPU time of all threads)" : "") +
           ", taken in turns; the ratio is the median "
           "over the rounds with its quartiles.</p>\n<div "
           "class=\"scroll\"><table>\n<tr><td>choice</td><td>naive</td><td>robust"
           "</td><td>naive ns</td><td>ns</td><td>ratio</td><td>error, naive &rarr; "
           "<b>robust</b></td><td>of</td></tr>\n" +
           rows + "</table></div>\n";
}

std::string render_cost_table(const StabilityReport& report) {
    if (report.render_costs.empty())
        return "";
    std::string rows;
    for (const RenderCost& cost : report.render_costs) {
        rows += fmt::format("<tr><td>{}</td><td>{}</td>", escape(cost.choice), escape(cost.scene));
        if (!cost.error.empty()) {
            rows += failed_cell(5, cost.error);
            continue;
        }
        rows += fmt::format("<td>{:.3f}</td><td>{:.3f}</td>{}<td>{:.2g}</td><td>{:.2g}</td></tr>\n",
                            cost.time.single, cost.time.naive, ratio_cell(cost.time), cost.difference,
                            cost.noise);
    }
    return fmt::format(
        "<h2>Whole pictures by other kernels</h2>\n<p>{} seconds of a picture by kernels that are built "
        "otherwise, "
        "in turns with clrt's own. Difference: root of the mean squared difference over the mean, with the "
        "same random numbers; noise: relative error of clrt's picture.</p>\n<div class=\"scroll\"><table>\n"
        "<tr><td>kernels</td><td>scene</td><td>s</td><td>clrt's "
        "s</td><td>ratio</td><td>difference</td><td>noise"
        "</td></tr>\n{}</table></div>\n",
        takes_cpu_seconds(report) ? "CPU" : "Wall", rows);
}

std::string waiting_table() {
    std::string rows;
    for (const WaitingCase& waiting : waiting_cases())
        rows += fmt::format("<tr><td>{} {}</td><td>{}</td><td>{}</td></tr>\n", waiting.id, waiting.name,
                            escape(waiting.set_up), escape(waiting.waits_for));
    if (rows.empty())
        return "";
    return "<h2>Cases that do not apply yet</h2>\n<div "
           "class=\"scroll\"><table>\n<tr><td>case</td><td>set-up</td><td>waits for"
           "</td></tr>\n" +
           rows + "</table></div>\n";
}

} // namespace

std::string report_page(const StabilityReport& report) {
    std::string command;
    for (const std::string& word : report.command)
        command += (command.empty() ? "" : " ") + word;
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n<title>clrt: numerical "
        "stability</title>\n<style>\n{}"
        ".beyond {{ color: #c33; }}\n.cases td:nth-child(n+2):nth-child(-n+6) {{ text-align: right; }}\n"
        ".cases th {{ white-space: normal; padding-top: 1em; }}\n.cases .faint {{ font-weight: normal; }}\n"
        ".contents {{ columns: 14em; padding-left: 1.2em; }}\n</style>\n</head>\n<body>\n<h1>Numerical "
        "stability</h1>\n"
        "<p class=\"faint\">{}: {}, driver {}, clrt {}</p>\n<p>{}</p>\n"
        "<p>Each figure is the worst of its inputs, or how many of them failed. The limit holds for single "
        "and double; naive is the "
        "textbook's formula in float, fast the same kernels with relaxed maths; both are shown for "
        "comparison, red where they "
        "are beyond the limit. A cell's tip names its worst "
        "input.</p>\n{}{}{}{}{}<h2>Command</h2>\n<pre>{}</pre>\n</body>\n</html>\n",
        PAGE_STYLE, escape(report.device.platform), escape(report.device.name), escape(report.device.driver),
        CLRT_VERSION, escape(format_summary(report)), contents(report), case_tables(report),
        cost_table(report), render_cost_table(report), waiting_table(), escape(command));
}

} // namespace clrt
