// SPDX-License-Identifier: Apache-2.0
// The report as a page.
#include "stability/report.h"

#include <fmt/format.h>

namespace clrt {

/// The style that all pages of clrt share (tools/clrt_tools/page.css), embedded at build time.
extern const char* const PAGE_STYLE;

namespace {

std::string escape(const std::string& text) {
    std::string escaped;
    for (const char c : text)
        escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return escaped;
}

std::string cell(const Worst& worst, double limit) {
    if (worst.tried == 0)
        return "<td>&ndash;</td>";
    return fmt::format("<td title=\"{}\"{}>{:.3g}</td>", escape(worst.input), worst.value <= limit ? "" : " class=\"beyond\"",
                       worst.value);
}

std::string case_rows(const CaseResult& result) {
    const StabilityCase& subject = *result.subject;
    std::string rows = fmt::format("<tr><th colspan=\"8\">{} {}<br><span class=\"faint\">{}; against {}. {}.</span></th></tr>\n",
                                   subject.id, subject.name, escape(subject.set_up), escape(subject.oracle),
                                   escape(subject.why));
    for (const Figure& figure : result.figures) {
        rows += fmt::format("<tr><td>{}</td><td>{:.3g}</td>", escape(figure.quantity), double(figure[Build::SINGLE].tried));
        for (const Build build : ALL_BUILDS)
            rows += cell(figure[build], figure.limit);
        rows += fmt::format("<td>{:.3g}</td><td>{}</td></tr>\n", figure.limit, figure.holds() ? "holds" : "<b>fails</b>");
    }
    if (!result.error.empty())
        rows += fmt::format("<tr><td colspan=\"8\"><b>fails</b>: {}</td></tr>\n", escape(result.error));
    return rows;
}

std::string case_tables(const StabilityReport& report) {
    std::string tables;
    for (const CaseGroup& group : catalogue()) {
        std::string rows;
        for (const CaseResult& result : report.cases)
            if (result.subject >= group.cases.data() && result.subject < group.cases.data() + group.cases.size())
                rows += case_rows(result);
        if (!rows.empty())
            tables += fmt::format("<h2>{}</h2>\n<div class=\"scroll\"><table>\n<tr><td>figure</td><td>inputs</td><td>naive</td>"
                                  "<td>single</td><td>fast</td><td>double</td><td>limit</td><td></td></tr>\n{}</table></div>\n",
                                  group.title, rows);
    }
    return tables;
}

std::string cost_table(const StabilityReport& report) {
    if (report.costs.empty())
        return "";
    std::string rows;
    for (const ChoiceCost& cost : report.costs) {
        const Figure* figure = figure_of(report, *cost.choice);
        rows += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f} ({:.2f}&ndash;{:.2f})"
                            "</td>{}{}<td>{}</td></tr>\n",
                            escape(cost.choice->choice), escape(cost.choice->naive), escape(cost.choice->robust),
                            cost.time.naive * 1e9, cost.time.single * 1e9, cost.time.ratio, cost.time.ratio_low,
                            cost.time.ratio_high, figure ? cell((*figure)[Build::NAIVE], figure->limit) : "<td>&ndash;</td>",
                            figure ? cell((*figure)[Build::SINGLE], figure->limit) : "<td>&ndash;</td>",
                            figure ? escape(fmt::format("{} {}", cost.choice->case_id, figure->quantity)) : cost.choice->case_id);
    }
    return "<h2>What robustness costs</h2>\n<p>Nanoseconds an evaluation, taken in turns; the ratio is the median over the "
           "rounds with its quartiles.</p>\n<div class=\"scroll\"><table>\n<tr><td>choice</td><td>naive</td><td>robust</td><td>"
           "naive ns</td><td>ns</td><td>ratio</td><td>naive error</td><td>error</td><td>of</td></tr>\n" +
           rows + "</table></div>\n";
}

std::string waiting_table() {
    std::string rows;
    for (const CaseGroup& group : catalogue())
        for (const StabilityCase& subject : group.cases)
            if (subject.waits_for)
                rows += fmt::format("<tr><td>{} {}</td><td>{}</td><td>{}</td></tr>\n", subject.id, subject.name,
                                    escape(subject.set_up), escape(subject.waits_for));
    if (rows.empty())
        return "";
    return "<h2>Cases that do not apply yet</h2>\n<div class=\"scroll\"><table>\n<tr><td>case</td><td>set-up</td><td>waits for"
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
        "<meta name=\"color-scheme\" content=\"light dark\">\n<title>clrt: numerical stability</title>\n<style>\n{}"
        ".beyond {{ color: #c33; }}\n</style>\n</head>\n<body>\n<h1>Numerical stability</h1>\n"
        "<p class=\"faint\">{}: {}, driver {}, clrt {}</p>\n<p>{}</p>\n"
        "<p>Each figure is the worst of its inputs, or how many of them failed. The limit holds for single and double; naive is the "
        "textbook's formula in float, fast the same kernels with relaxed maths; both are shown for comparison, red where they "
        "are beyond the limit. A cell's tip names its worst input.</p>\n{}{}{}<h2>Command</h2>\n<pre>{}</pre>\n</body>\n</html>\n",
        PAGE_STYLE, escape(report.device.platform), escape(report.device.name), escape(report.device.driver),
        CLRT_VERSION, escape(format_summary(report)), case_tables(report), cost_table(report), waiting_table(),
        escape(command));
}

} // namespace clrt
