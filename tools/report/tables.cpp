#include "tables.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "format.hpp"
#include "svg.hpp"

namespace fastccd::tools::report {
namespace {

class Table {
public:
    Table(const std::string& caption, const std::vector<std::string>& heading)
    {
        html_ = fmt::format("<p class=\"caption\">{}</p>\n<div class=\"scroll\"><table>\n<thead><tr>", caption);
        for (const std::string& cell : heading) html_ += "<th>" + cell + "</th>";
        html_ += "</tr></thead><tbody>\n";
    }

    Table& row(const std::string& attributes = {})
    {
        html_ += attributes.empty() ? "<tr>" : "<tr " + attributes + ">";
        return *this;
    }
    Table& cell(const std::string& content, const std::string& attributes = {})
    {
        html_ += (attributes.empty() ? "<td>" : "<td " + attributes + ">") + content + "</td>";
        return *this;
    }
    /// Of a promise that allows 0 only.
    Table& promise(const Json& number, const char* css_class)
    {
        return cell(count(number), fmt::format("class=\"{}{}\"", css_class, number == 0 ? "" : " broken"));
    }
    /// Missed, late and false alarms, the last one marked if none is allowed.
    Table& judged(const Json& comparison, bool exact)
    {
        promise(comparison.at("missed"), "missed").promise(comparison.at("late"), "late");
        return exact ? promise(comparison.at("false_alarms"), "false-alarms")
                     : cell(count(comparison.at("false_alarms")), "class=\"false-alarms\"");
    }
    /// A value that comes from a timing.
    Table& timed(double value, const Json& timing)
    {
        const double median = timing.at("seconds"), spread = timing.at("most").get<double>() - timing.at("least").get<double>();
        const std::string small =
            timing.at("repeats") == 1 || median <= 0 ? "once" : fmt::format("{:.2g} %", 100 * spread / median);
        return cell(fmt::format("{} <small>{}</small>", figure(value), small), fmt::format("title=\"{}\"", how(timing)));
    }
    Table& speed(const Json& timing) { return timed(million_pairs_per_second(timing), timing); }

    [[nodiscard]] std::string str() const { return html_ + "</tbody></table></div>\n"; }

private:
    std::string html_;
};

std::string details(const std::string& summary, const std::string& content)
{
    return fmt::format("<details><summary>{}</summary>\n{}</details>\n", summary, content);
}

std::string percent(double part, double whole) { return whole == 0 ? "-" : fmt::format("{:.2g} %", 100 * part / whole); }

/// Of a table or of a point in it.
std::string isa_of(const Json& measured) { return escaped(isa_label(measured.at("isa"))); }

std::string early(const Json& comparison, const char* percentile)
{
    return comparison.at("signed_error").is_null() ? "-" : figure(-comparison.at("signed_error").at(percentile).get<double>());
}

}  // namespace

std::string paper_tables(const Json& part)
{
    const std::string isa = isa_of(part);
    Table vf{fmt::format("Table 1 of the paper: {} random vertex-face pairs (the paper: {}), {}, roots counted. σ: distance "
                         "from the paper's "
                         "count, scaled to as many pairs, in standard deviations of the difference of two such samples.",
                         count(part.at("pairs")), count(part.at("paper").at("pairs")), isa),
             {"E_tol", "seconds, 1 thread", "paper, s", fmt::format("M pairs/s, {} threads", part.at("threads").get<int>()),
              "odd", "paper", "σ", "even", "paper", "σ"}};
    for (const Json& row : part.at("vf")) {
        vf.row()
            .cell(figure(row.at("tolerance")))
            .timed(row.at("one_thread").at("seconds"), row.at("one_thread"))
            .cell(figure(row.at("paper").at("seconds")));
        vf.speed(row.at("all_threads"));
        for (const char* parity : {"odd", "even"}) {
            vf.cell(count(row.at(parity)))
                .cell(count(row.at("paper").at(parity)))
                .cell(fmt::format("{:+.2f}", row.at("deviations").at(parity).get<double>()));
        }
    }
    Table ee{fmt::format("{} random edge-edge pairs; the paper has no such table.", count(part.at("pairs"))),
             {"E_tol", "seconds, 1 thread", fmt::format("M pairs/s, {} threads", part.at("threads").get<int>()), "odd", "even",
              "uncounted"}};
    for (const Json& row : part.at("ee")) {
        ee.row()
            .cell(figure(row.at("tolerance")))
            .timed(row.at("one_thread").at("seconds"), row.at("one_thread"))
            .speed(row.at("all_threads"));
        ee.cell(count(row.at("odd"))).cell(count(row.at("even"))).cell(count(row.at("uncounted")));
    }
    return vf.str() + ee.str();
}

std::string speed_error_tables(const Json& part, const std::string& kind)
{
    const Json &points = part.at(kind).at("points"), &peers = part.at(kind).at("peers");
    Table all{
        fmt::format(
            "{}: {} random pairs timed on one thread, the first {} of them judged by exact truth; errors in units of the step, "
            "early ones positive.",
            kind_label(kind), count(part.at("timed_pairs")), count(part.at("truth_pairs"))),
        {"", "E_tol", "M pairs/s", "early, median", "99 %", "worst", "contacts", "missed", "late", "false alarms"}};
    for (const Json& point : points) {
        all.row(fmt::format("data-judged=\"{} {} {:g}\"", kind, escaped(point.at("isa").get<std::string>()),
                            point.at("tolerance").get<double>()));
        all.cell(isa_of(point)).cell(figure(point.at("tolerance"))).speed(point.at("timing"));
        all.cell(early(point, "median")).cell(early(point, "p1")).cell(early(point, "earliest"));
        all.cell(count(point.at("contacts"))).judged(point, false);
    }
    std::string html = details(fmt::format("Every instruction set and E_tol, {}", kind_label(kind)), all.str());
    if (peers.empty()) return html;

    Table others{
        fmt::format("Other libraries on the same {} {} pairs, one thread.", count(part.at("truth_pairs")), kind_label(kind)),
        {"", "M pairs/s", "early at worst", "late at worst", "missed", "late", "false alarms"}};
    for (const Json& peer : peers) {
        const bool no_time = peer.at("signed_error").is_null();
        const std::string name = escaped(peer.at("name").get<std::string>());
        others.row(fmt::format("data-judged=\"{} {}\"", kind, name))
            .cell(name)
            .speed(peer.at("timing"))
            .cell(early(peer, "earliest"));
        others.cell(no_time ? "-" : figure(std::max(0.0, peer.at("signed_error").at("latest").get<double>())));
        others.cell(count(peer.at("missed")), "class=\"missed\"")
            .cell(no_time ? "no time" : count(peer.at("late")), "class=\"late\"");
        others.cell(count(peer.at("false_alarms")), "class=\"false-alarms\"");
    }
    return others.str() + html;
}

std::string hard_case_table(const Json& part)
{
    Table table{fmt::format("E_tol {:g}, one thread, {}. First without, then with the exact verdict. Intervals: examined by "
                            "the certified search "
                            "of a pair, which stops at {}.",
                            part.at("tolerance").get<double>(), isa_of(part), count(part.at("most_intervals"))),
                {"set", "", "pairs", "contacts", "missed", "late", "false alarms", "worst early", "ns/pair", "intervals, mean",
                 "most"}};
    for (const Json& set : part.at("sets")) {
        for (const bool exact : {false, true}) {
            const Json& answer = set.at(exact ? "exact" : "plain");
            if (answer.is_null()) continue;
            const std::string name = escaped(set.at("name").get<std::string>());
            table.row(fmt::format("data-judged=\"{}{}\"", name, exact ? " exact" : ""));
            table.cell(exact ? "" : name)
                .cell(exact ? "exact" : "")
                .cell(count(answer.at("pairs")))
                .cell(count(answer.at("contacts")));
            table.judged(answer, exact).cell(early(answer, "earliest"));
            table.timed(1e9 * answer.at("timing").at("seconds").get<double>() / std::max(1.0, answer.at("pairs").get<double>()),
                        answer.at("timing"));
            table.cell(exact ? "" : figure(set.at("intervals").at("mean")))
                .cell(exact ? "" : count(set.at("intervals").at("most")));
        }
    }
    return details(fmt::format("All {} sets", part.at("sets").size()), table.str());
}

std::string scene_tables(const Json& part)
{
    Table sums{
        fmt::format(
            "All steps of each scene; {}, {} threads, E_tol {:g}. Degenerate: all coefficients of the cubic are zero to within "
            "rounding; no t³: that one is (the paper's ZeroA). Seconds: the sum over the steps of median times.",
            isa_of(part), part.at("threads").get<int>(), part.at("tolerance").get<double>()),
        {"scene", "steps", "kind", "candidates", "contacts", "proven", "degenerate", "no t³", "broad phase, s",
         "narrow phase, s", "M pairs/s"}};
    Table steps{"Step by step; small: spread.",
                {"scene", "step", "kind", "candidates", "contacts", "certified search", "broad phase, s", "narrow phase, s",
                 "M pairs/s"}};
    Table speeds{"Last step of each scene, M pairs/s; small: spread.", {"scene", "kind", "", "threads", "M pairs/s"}};
    for (const Json& scene : part.at("scenes")) {
        const std::string name = escaped(scene.at("name").get<std::string>());
        for (const std::string kind : {"vf", "ee"}) {
            double broad = 0, narrow = 0;
            std::size_t candidates = 0, contacts = 0, proven = 0, all_zero = 0, no_cube = 0, number = 0;
            for (const Json& step : scene.at("steps")) {
                const Json& k = step.at(kind);
                candidates += k.at("candidates").get<std::size_t>();
                contacts += k.at("contacts").get<std::size_t>();
                proven += k.at("proven").get<std::size_t>();
                all_zero += k.at("all_zero").get<std::size_t>();
                no_cube += k.at("no_cube").get<std::size_t>();
                broad += k.at("broad_phase").at("seconds").get<double>();
                narrow += k.at("narrow_phase").at("seconds").get<double>();
                steps.row()
                    .cell(name)
                    .cell(count(number++))
                    .cell(kind)
                    .cell(count(k.at("candidates")))
                    .cell(count(k.at("contacts")));
                steps.cell(count(k.at("certified_search"))).timed(k.at("broad_phase").at("seconds"), k.at("broad_phase"));
                steps.timed(k.at("narrow_phase").at("seconds"), k.at("narrow_phase")).speed(k.at("narrow_phase"));
            }
            const auto total = static_cast<double>(candidates);
            sums.row()
                .cell(name)
                .cell(count(scene.at("steps").size()))
                .cell(kind)
                .cell(count(candidates))
                .cell(count(contacts))
                .cell(count(proven));
            sums.cell(percent(static_cast<double>(all_zero), total)).cell(percent(static_cast<double>(no_cube), total));
            sums.cell(figure(broad)).cell(figure(narrow)).cell(narrow > 0 ? figure(1e-6 * total / narrow) : "-");
            for (const Json& point : last(scene.at("steps")).at(kind).at("speeds")) {
                speeds.row()
                    .cell(name)
                    .cell(kind)
                    .cell(isa_of(point))
                    .cell(count(point.at("threads")))
                    .speed(point.at("timing"));
            }
        }
    }
    for (const Json& scene : part.at("paper")) {
        const double candidates = scene.at("candidates"), seconds = scene.at("seconds");
        sums.row("class=\"paper\"")
            .cell("paper: " + escaped(scene.at("name").get<std::string>()))
            .cell(count(scene.at("frames")))
            .cell("vf");
        sums.cell(count(scene.at("candidates")))
            .cell(count(scene.at("contacts")))
            .cell("-")
            .cell(percent(scene.at("all_zero_share"), 1));
        sums.cell(percent(scene.at("no_cube_share"), 1))
            .cell("-")
            .cell(figure(seconds))
            .cell(figure(1e-6 * candidates / seconds));
    }
    return sums.str() + details("Every instruction set, on one and on all threads", speeds.str()) +
           details("Every step", steps.str());
}

std::string scaling_tables(const Json& part)
{
    Table threads{fmt::format("{}; random vertex-face pairs packed, edge-edge candidates of the cloth indexed; small: spread.",
                              isa_of(part)),
                  {"threads", "random, M pairs/s", "times one thread", "cloth, M pairs/s", "times one thread"}};
    const Json &random = part.at("over_threads").at("random_vf").at("points"),
               &cloth = part.at("over_threads").at("cloth_ee_indexed").at("points");
    const auto gain = [](const Json& points, std::size_t i) {
        const double one = million_pairs_per_second(points.at(0).at("timing"));
        return one > 0 ? fmt::format("{:.2f}", million_pairs_per_second(points.at(i).at("timing")) / one) : std::string{"-"};
    };
    for (std::size_t i = 0; i < random.size(); ++i) {
        threads.row().cell(count(random.at(i).at("threads"))).speed(random.at(i).at("timing")).cell(gain(random, i));
        threads.speed(cloth.at(i).at("timing")).cell(gain(cloth, i));
    }
    Table pairs{
        fmt::format("Random vertex-face pairs on {} threads. In one buffer: one call; up to a quarter of this machine's "
                    "memory. Piece by "
                    "piece: as the command answers files and generated pairs. Resident: of the whole process, after the call.",
                    part.at("threads").get<int>()),
        {"pairs", "", "ns/pair", "resident, MB"}};
    for (const auto& [key, label] : {std::pair{"in_memory", "one buffer"}, std::pair{"piece_by_piece", "piece by piece"}}) {
        for (const Json& point : part.at("over_pairs").at(key)) {
            pairs.row().cell(count(point.at("pairs"))).cell(label);
            pairs.timed(1e9 * point.at("timing").at("seconds").get<double>() / point.at("pairs").get<double>(),
                        point.at("timing"));
            pairs.cell(figure(1e-6 * point.at("resident_bytes").get<double>()));
        }
    }
    return threads.str() + pairs.str();
}

}  // namespace fastccd::tools::report
