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
        html_ = fmt::format("<div class=\"scroll\"><table><caption>{}</caption>\n<thead><tr>", caption);
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
        promise(comparison["missed"], "missed").promise(comparison["late"], "late");
        return exact ? promise(comparison["false_alarms"], "false-alarms") : cell(count(comparison["false_alarms"]), "class=\"false-alarms\"");
    }
    /// A value that comes from a timing.
    Table& timed(double value, const Json& timing)
    {
        const double median = timing["seconds"], spread = timing["most"].get<double>() - timing["least"].get<double>();
        const std::string small = timing["repeats"] == 1 || median <= 0 ? "once" : fmt::format("{:.2g} %", 100 * spread / median);
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

std::string percent(double part, double whole)
{
    return whole == 0 ? "-" : fmt::format("{:.2g} %", 100 * part / whole);
}

std::string early(const Json& comparison, const char* percentile)
{
    return comparison["signed_error"].is_null() ? "-" : figure(-comparison["signed_error"][percentile].get<double>());
}

}  // namespace

std::string paper_tables(const Json& part)
{
    const std::string isa = isa_label(part["isa"]);
    Table vf{fmt::format("Table 1 of the paper: {} random vertex-face pairs (the paper: {}), {}, roots counted. σ: distance from the paper's "
                         "count, scaled to as many pairs, in standard deviations of the difference of two such samples.",
                         count(part["pairs"]), count(part["paper"]["pairs"]), isa),
             {"E_tol", "seconds, 1 thread", "paper, s", fmt::format("M pairs/s, {} threads", part["threads"].get<int>()), "odd", "paper", "σ",
              "even", "paper", "σ"}};
    for (const Json& row : part["vf"]) {
        vf.row().cell(figure(row["tolerance"])).timed(row["one_thread"]["seconds"], row["one_thread"]).cell(figure(row["paper"]["seconds"]));
        vf.speed(row["all_threads"]);
        for (const char* parity : {"odd", "even"}) {
            vf.cell(count(row[parity])).cell(count(row["paper"][parity])).cell(fmt::format("{:+.2f}", row["deviations"][parity].get<double>()));
        }
    }
    Table ee{fmt::format("{} random edge-edge pairs; the paper has no such table.", count(part["pairs"])),
             {"E_tol", "seconds, 1 thread", fmt::format("M pairs/s, {} threads", part["threads"].get<int>()), "odd", "even", "uncounted"}};
    for (const Json& row : part["ee"]) {
        ee.row().cell(figure(row["tolerance"])).timed(row["one_thread"]["seconds"], row["one_thread"]).speed(row["all_threads"]);
        ee.cell(count(row["odd"])).cell(count(row["even"])).cell(count(row["uncounted"]));
    }
    return vf.str() + ee.str();
}

std::string speed_error_tables(const Json& part, const std::string& kind)
{
    const Json &points = part[kind]["points"], &peers = part[kind]["peers"];
    Table all{fmt::format("{}: {} random pairs timed on one thread, the first {} of them judged by exact truth; errors in units of the step, "
                          "early ones positive.",
                          kind_label(kind), count(part["timed_pairs"]), count(part["truth_pairs"])),
              {"", "E_tol", "M pairs/s", "early, median", "99 %", "worst", "contacts", "missed", "late", "false alarms"}};
    for (const Json& point : points) {
        all.row(fmt::format("data-judged=\"{} {} {:g}\"", kind, point["isa"].get<std::string>(), point["tolerance"].get<double>()));
        all.cell(isa_label(point["isa"])).cell(figure(point["tolerance"])).speed(point["timing"]);
        all.cell(early(point, "median")).cell(early(point, "p1")).cell(early(point, "earliest"));
        all.cell(count(point["contacts"])).judged(point, false);
    }
    std::string html = details(fmt::format("Every instruction set and E_tol, {}", kind_label(kind)), all.str());
    if (peers.empty()) return html;

    Table others{fmt::format("Other libraries on the same {} {} pairs, one thread.", count(part["truth_pairs"]), kind_label(kind)),
                 {"", "M pairs/s", "early at worst", "late at worst", "missed", "late", "false alarms"}};
    for (const Json& peer : peers) {
        const bool no_time = peer["signed_error"].is_null();
        const std::string name = peer["name"];
        others.row(fmt::format("data-judged=\"{} {}\"", kind, name)).cell(name).speed(peer["timing"]).cell(early(peer, "earliest"));
        others.cell(no_time ? "-" : figure(std::max(0.0, peer["signed_error"]["latest"].get<double>())));
        others.cell(count(peer["missed"]), "class=\"missed\"").cell(no_time ? "no time" : count(peer["late"]), "class=\"late\"");
        others.cell(count(peer["false_alarms"]), "class=\"false-alarms\"");
    }
    return others.str() + html;
}

std::string hard_case_table(const Json& part)
{
    Table table{fmt::format("E_tol {:g}, one thread, {}. First without, then with the exact verdict. Intervals: examined by the certified search "
                            "of a pair, which stops at {}.",
                            part["tolerance"].get<double>(), isa_label(part["isa"]), count(part["most_intervals"])),
                {"set", "", "pairs", "contacts", "missed", "late", "false alarms", "worst early", "ns/pair", "intervals, mean", "most"}};
    for (const Json& set : part["sets"]) {
        for (const bool exact : {false, true}) {
            const Json& answer = set[exact ? "exact" : "plain"];
            if (answer.is_null()) continue;
            const std::string name = escaped(set["name"].get<std::string>());
            table.row(fmt::format("data-judged=\"{}{}\"", name, exact ? " exact" : ""));
            table.cell(exact ? "" : name).cell(exact ? "exact" : "").cell(count(answer["pairs"])).cell(count(answer["contacts"]));
            table.judged(answer, exact).cell(early(answer, "earliest"));
            table.timed(1e9 * answer["timing"]["seconds"].get<double>() / std::max(1.0, answer["pairs"].get<double>()), answer["timing"]);
            table.cell(exact ? "" : figure(set["intervals"]["mean"])).cell(exact ? "" : count(set["intervals"]["most"]));
        }
    }
    return details(fmt::format("All {} sets", part["sets"].size()), table.str());
}

std::string scene_tables(const Json& part)
{
    Table sums{fmt::format("All steps of each scene; {}, {} threads, E_tol {:g}. Degenerate: all coefficients of the cubic are zero to within "
                           "rounding; no t³: that one is (the paper's ZeroA). Seconds: the sum over the steps of median times.",
                           isa_label(part["isa"]), part["threads"].get<int>(), part["tolerance"].get<double>()),
               {"scene", "steps", "kind", "candidates", "contacts", "proven", "degenerate", "no t³", "broad phase, s", "narrow phase, s", "M pairs/s"}};
    Table steps{"Step by step; small: spread.",
                {"scene", "step", "kind", "candidates", "contacts", "certified search", "broad phase, s", "narrow phase, s", "M pairs/s"}};
    Table speeds{"Last step of each scene, M pairs/s; small: spread.", {"scene", "kind", "", "threads", "M pairs/s"}};
    for (const Json& scene : part["scenes"]) {
        const std::string name = escaped(scene["name"].get<std::string>());
        for (const std::string kind : {"vf", "ee"}) {
            double broad = 0, narrow = 0;
            std::size_t candidates = 0, contacts = 0, proven = 0, all_zero = 0, no_cube = 0, number = 0;
            for (const Json& step : scene["steps"]) {
                const Json& k = step[kind];
                candidates += k["candidates"].get<std::size_t>();
                contacts += k["contacts"].get<std::size_t>();
                proven += k["proven"].get<std::size_t>();
                all_zero += k["all_zero"].get<std::size_t>();
                no_cube += k["no_cube"].get<std::size_t>();
                broad += k["broad_phase"]["seconds"].get<double>();
                narrow += k["narrow_phase"]["seconds"].get<double>();
                steps.row().cell(name).cell(count(number++)).cell(kind).cell(count(k["candidates"])).cell(count(k["contacts"]));
                steps.cell(count(k["certified_search"])).timed(k["broad_phase"]["seconds"], k["broad_phase"]);
                steps.timed(k["narrow_phase"]["seconds"], k["narrow_phase"]).speed(k["narrow_phase"]);
            }
            const auto total = static_cast<double>(candidates);
            sums.row().cell(name).cell(count(scene["steps"].size())).cell(kind).cell(count(candidates)).cell(count(contacts)).cell(count(proven));
            sums.cell(percent(static_cast<double>(all_zero), total)).cell(percent(static_cast<double>(no_cube), total));
            sums.cell(figure(broad)).cell(figure(narrow)).cell(narrow > 0 ? figure(1e-6 * total / narrow) : "-");
            for (const Json& point : scene["steps"].back()[kind]["speeds"]) {
                speeds.row().cell(name).cell(kind).cell(isa_label(point["isa"])).cell(count(point["threads"])).speed(point["timing"]);
            }
        }
    }
    for (const Json& scene : part["paper"]) {
        const double candidates = scene["candidates"], seconds = scene["seconds"];
        sums.row("class=\"paper\"").cell("paper: " + scene["name"].get<std::string>()).cell(count(scene["frames"])).cell("vf");
        sums.cell(count(scene["candidates"])).cell(count(scene["contacts"])).cell("-").cell(percent(scene["all_zero_share"], 1));
        sums.cell(percent(scene["no_cube_share"], 1)).cell("-").cell(figure(seconds)).cell(figure(1e-6 * candidates / seconds));
    }
    return sums.str() + details("Every instruction set, on one and on all threads", speeds.str()) + details("Every step", steps.str());
}

std::string scaling_tables(const Json& part)
{
    Table threads{fmt::format("{}; random vertex-face pairs packed, edge-edge candidates of the cloth indexed; small: spread.", isa_label(part["isa"])),
                  {"threads", "random, M pairs/s", "times one thread", "cloth, M pairs/s", "times one thread"}};
    const Json &random = part["over_threads"]["random_vf"]["points"], &cloth = part["over_threads"]["cloth_ee_indexed"]["points"];
    const auto gain = [](const Json& points, std::size_t i) {
        const double one = million_pairs_per_second(points[0]["timing"]);
        return one > 0 ? fmt::format("{:.2f}", million_pairs_per_second(points[i]["timing"]) / one) : std::string{"-"};
    };
    for (std::size_t i = 0; i < random.size(); ++i) {
        threads.row().cell(count(random[i]["threads"])).speed(random[i]["timing"]).cell(gain(random, i));
        threads.speed(cloth[i]["timing"]).cell(gain(cloth, i));
    }
    Table pairs{fmt::format("Random vertex-face pairs on {} threads. In one buffer: one call; up to a quarter of this machine's memory. Piece by "
                            "piece: as the command answers files and generated pairs. Resident: of the whole process, after the call.",
                            part["threads"].get<int>()),
                {"pairs", "", "ns/pair", "resident, MB"}};
    for (const auto& [key, label] : {std::pair{"in_memory", "one buffer"}, std::pair{"piece_by_piece", "piece by piece"}}) {
        for (const Json& point : part["over_pairs"][key]) {
            pairs.row().cell(count(point["pairs"])).cell(label);
            pairs.timed(1e9 * point["timing"]["seconds"].get<double>() / point["pairs"].get<double>(), point["timing"]);
            pairs.cell(figure(1e-6 * point["resident_bytes"].get<double>()));
        }
    }
    return threads.str() + pairs.str();
}

}  // namespace fastccd::tools::report
