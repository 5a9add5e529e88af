#include "page.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "format.hpp"
#include "svg.hpp"
#include "tables.hpp"

namespace fastccd::tools::report {
namespace {

constexpr std::string_view head = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width,initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>fastccd: speed against error</title>
<link rel="icon" href="data:,">
<style>
:root{--surface:#fff;--ink:#1b1f24;--soft:#57606a;--line:#dfe3e8;--broken:#c44900;--panel:#f4f6f8}
@media (prefers-color-scheme:dark){:root{--surface:#14181d;--ink:#e6e9ec;--soft:#a5adb6;--line:#333a42;--broken:#ff7d45;--panel:#1b2026}}
*{box-sizing:border-box}
body{margin:0 auto;max-width:68rem;padding:1rem .75rem 4rem;background:var(--surface);color:var(--ink);
font:16px/1.5 system-ui,-apple-system,"Segoe UI",sans-serif;overflow-wrap:anywhere}
h1{font-size:1.7rem;line-height:1.2;margin:.5rem 0}h2{margin:2.5rem 0 .5rem;font-size:1.3rem;border-top:1px solid var(--line);padding-top:1.2rem}
p,ul{max-width:46rem}.soft,.caption,small{color:var(--soft)}small{font-size:.8em}
.pictures{display:flex;flex-wrap:wrap;gap:1rem;margin:1rem 0}
figure{margin:0;flex:1 1 22rem;max-width:40rem;min-width:0}
figure svg{display:block;width:100%;height:auto;border:1px solid var(--line);border-radius:6px}
.scroll{overflow-x:auto;margin:.75rem 0}
table{border-collapse:collapse;font-size:.85rem;font-variant-numeric:tabular-nums;overflow-wrap:normal}
.caption{font-size:.85rem;margin:1rem 0 -.4rem}
th,td{padding:.2rem .6rem .2rem 0;text-align:right;white-space:nowrap;border-bottom:1px solid var(--line)}
th{white-space:normal;vertical-align:bottom;font-weight:600}
th:first-child,td:first-child{text-align:left}
.paper td{color:var(--soft)}.broken{color:var(--broken);font-weight:700}
details{margin:.75rem 0}summary{cursor:pointer}
.verdict{background:var(--panel);border-radius:6px;padding:.8rem 1rem;max-width:none}
dl{display:grid;grid-template-columns:max-content 1fr;gap:.1rem 1rem;margin:1rem 0}dt{color:var(--soft)}dd{margin:0}
@media (max-width:30rem){dl{grid-template-columns:1fr}dd{margin-bottom:.4rem}}
</style></head><body>
)";

std::string heading(int number, const std::string& text) { return fmt::format("<h2>{}. {}</h2>\n", number, text); }

std::string paragraph(const std::string& text) { return "<p>" + text + "</p>\n"; }

std::string machine_list(const Json& report)
{
    const Json& machine = report.at("machine");
    std::string isas;
    for (const Json& isa : machine.at("isas")) isas += (isas.empty() ? "" : ", ") + isa_label(isa);
    std::string html = "<dl>";
    const auto entry = [&](std::string_view term, const std::string& text) {
        html += fmt::format("<dt>{}</dt><dd>{}</dd>", term, escaped(text));
    };
    entry("processor", fmt::format("{}, {} threads, {:.0f} GB of memory", machine.at("processor").get<std::string>(),
                                   machine.at("threads").get<int>(), 1e-9 * machine.at("memory_bytes").get<double>()));
    entry("system", machine.at("system"));
    entry("build", fmt::format("{}, {}", machine.at("compiler").get<std::string>(), machine.at("flags").get<std::string>()));
    entry("instruction sets", fmt::format("{}; used unless said otherwise: {}", isas, isa_label(machine.at("best_isa"))));
    entry("commit", machine.at("commit"));
    entry("measured", fmt::format("{}, load average {:.1f} at the start{}", machine.at("date").get<std::string>(),
                                  machine.at("load_average").get<double>(),
                                  report.at("quick") == true ? "; quick: fewer pairs and repeats" : ""));
    html += "</dl>\n";
    if (machine.at("load_average").get<double>() < 0.5 * machine.at("threads").get<double>()) return html;
    return html + paragraph(
                      "<b>The machine was busy with other work.</b> Times by the clock, those of several threads above all, "
                      "are longer "
                      "than they need be; processor times and counts are not.");
}

/// All judged answers of this library together.
std::string verdict(const Json& report)
{
    std::size_t pairs = 0, missed = 0, late = 0, alarms = 0, exact_pairs = 0, exact_alarms = 0;
    const auto add = [&](const Json& comparison) {
        pairs += comparison.at("pairs").get<std::size_t>();
        missed += comparison.at("missed").get<std::size_t>();
        late += comparison.at("late").get<std::size_t>();
    };
    for (const char* kind : {"vf", "ee"}) {
        for (const Json& point : report.at("speed_and_error").at(kind).at("points")) {
            add(point);
            alarms += point.at("false_alarms").get<std::size_t>();
        }
    }
    for (const Json& set : report.at("hard_cases").at("sets")) {
        add(set.at("plain"));
        alarms += set.at("plain").at("false_alarms").get<std::size_t>();
        if (set.at("exact").is_null()) continue;
        add(set.at("exact"));
        exact_pairs += set.at("exact").at("pairs").get<std::size_t>();
        exact_alarms += set.at("exact").at("false_alarms").get<std::size_t>();
    }
    return fmt::format(
        "<p class=\"verdict\" data-judged=\"all\">Of {} answers judged by exact truth, <b class=\"missed{}\">{}</b> missed a "
        "contact and <b class=\"late{}\">{}</b> came late. <b class=\"false-alarms\">{}</b> were false alarms, near misses "
        "to within rounding; of the {} answers with the exact verdict, <b class=\"exact-false-alarms{}\">{}</b>.</p>\n",
        count(pairs), missed == 0 ? "" : " broken", count(missed), late == 0 ? "" : " broken", count(late), count(alarms),
        count(exact_pairs), exact_alarms == 0 ? "" : " broken", count(exact_alarms));
}

}  // namespace

std::string html_page(const Json& report, const std::vector<Picture>& pictures)
{
    const auto show = [&](std::initializer_list<const char*> names) {
        std::string html;
        for (const std::string_view name : names) {
            const auto found = std::ranges::find(pictures, name, &Picture::name);
            if (found != pictures.end()) html += fmt::format("<figure id=\"{}\">{}</figure>\n", name, found->svg);
        }
        return "<div class=\"pictures\">\n" + html + "</div>\n";
    };

    std::string html{head};
    html += "<h1>fastccd: speed against error</h1>\n";
    html += paragraph(
        "Narrow phase of continuous collision detection: measured on the machine below, and judged by an exact oracle that "
        "shares no code with the library. Point at a mark in a picture, or open a table, for the figure behind it.");
    html += verdict(report) + machine_list(report);
    html += paragraph(
        "<b>How figures are obtained.</b> Each time is the median of repeated calls, which in parts 1 and 2 take turns with "
        "those "
        "they are compared to; the small figure beside it is the spread, largest minus least over median. Times of one thread "
        "in "
        "parts 1 to 3 are processor time, which other programs on the machine disturb less; all others are by the clock. "
        "<i>Missed</i>: contact in truth, not reported. <i>Late</i>: reported after the exact first contact. <i>False "
        "alarm</i>: reported, no contact in truth. Errors of the time of impact are in units of the step. E_tol is the "
        "tolerance, the only one there is.");

    html += heading(1, "The paper's random test") + show({"figure_1"}) + paper_tables(report.at("paper_table"));

    html += heading(2, "Speed against error");
    html += paragraph(
        "Every mark is one instruction set at one E_tol; figures at marks of the widest set are its E_tol. Right is worse, "
        "up is faster; the dashed line, the Pareto front, joins what nothing else beats in both, by worst error. Results are "
        "the same bits on every instruction set, so that marks of one E_tol are above each other.");
    html += show({"speed_error_vf", "speed_error_ee"});
    html += speed_error_tables(report.at("speed_and_error"), "vf") + speed_error_tables(report.at("speed_and_error"), "ee");

    html += heading(3, "Hard cases");
    html += paragraph(
        "Families of pairs made to break things: grazing, boundary, coplanar, degenerate, resting, extreme sizes. v: "
        "vertex-face, e: edge-edge, first with double, then with float coordinates. The stronger the colour, the more; an "
        "empty frame is 0, and the two columns that promises are about must be empty.");
    html += show({"hard_cases", "hard_cases_public", "hard_cases_queries"}) + hard_case_table(report.at("hard_cases"));

    html += heading(4, "Scenes") + show({"scenes"}) + scene_tables(report.at("scenes"));
    html += heading(5, "Scaling") + show({"threads", "pairs", "memory"}) + scaling_tables(report.at("scaling"));
    return html + "</body></html>\n";
}

}  // namespace fastccd::tools::report
