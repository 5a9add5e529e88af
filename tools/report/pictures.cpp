#include "pictures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "format.hpp"
#include "heat_map.hpp"
#include "svg.hpp"

namespace fastccd::tools::report {
namespace {

Series series_of_isa(const std::string& isa)
{
    if (isa == "avx512") return Series::blue;
    if (isa == "avx2" || isa == "neon") return Series::green;
    return isa == "sse2" ? Series::orange : Series::grey;
}

/// The least and the most of what is to be in a picture. A rate of 0 stands for none (million_pairs_per_second), as of a scene
/// without candidates of a kind: it has no place on a logarithmic axis.
class Extent {
public:
    void add(double value)
    {
        if (!(value > 0) || !std::isfinite(value)) return;
        least_ = std::min(least_, value);
        most_ = std::max(most_, value);
    }
    [[nodiscard]] double least() const { return most_ > 0 ? least_ : 1; }
    [[nodiscard]] double most() const { return most_ > 0 ? most_ : 1; }

private:
    double least_ = HUGE_VAL, most_ = 0;
};

/// Points of one series with their curve and legend.
void draw(Chart& chart, const std::vector<Point>& points, Series series, bool dashed, const std::string& name,
          const std::vector<std::string>& tooltips)
{
    chart.curve(points, series, dashed);
    chart.points(points, series, tooltips);
    chart.legend(series, name);
}

/// Figure 1 of the paper: time against E_tol, for ten million pairs.
Picture figure_1(const Json& table)
{
    constexpr double paper_pairs = 1e7;
    const auto seconds = [&](const Json& row, const char* threads) {
        return row.at(threads).at("seconds").get<double>() * paper_pairs / table.at("pairs").get<double>();
    };
    const double exact = table.at("paper").at("exactCCD_seconds"), safe = table.at("paper").at("safeCCD_seconds");
    Extent extent;
    extent.add(exact);
    for (const char* kind : {"vf", "ee"}) {
        for (const Json& row : table.at(kind)) extent.add(seconds(row, "all_threads")), extent.add(seconds(row, "one_thread"));
    }
    Axis x = log_axis("E_tol, in units of the step", 1e-13, 1e-6);
    std::swap(x.low, x.high);  // as in the paper: finer to the right
    Chart chart{"Time for 10 million random pairs against E_tol",
                "Figure 1 of the paper, on this machine",
                std::move(x),
                log_axis("seconds", extent.least(), extent.most()),
                400,
                3};
    chart.level(exact, fmt::format("exactCCD, {:g} s (2014)", exact), Series::grey);
    chart.level(safe, fmt::format("safeCCD, {:g} s (2014)", safe), Series::grey);

    const auto add = [&](const char* kind, Series series, bool dashed, auto value, const std::string& name) {
        std::vector<Point> points;
        std::vector<std::string> tooltips;
        for (const Json& row : table.at(kind)) {
            points.push_back({row.at("tolerance"), value(row)});
            tooltips.push_back(fmt::format("{}: {:.3g} s at E_tol {:g}", name, points.back().y, points.back().x));
        }
        draw(chart, points, series, dashed, name, tooltips);
    };
    const auto one = [&](const Json& row) { return seconds(row, "one_thread"); };
    const auto all = [&](const Json& row) { return seconds(row, "all_threads"); };
    const std::string threads = fmt::format("{} threads", table.at("threads").get<int>());
    add(
        "vf", Series::vermilion, true, [](const Json& row) { return row.at("paper").at("seconds").get<double>(); },
        "the paper, vertex-face (2014)");
    add("vf", Series::blue, false, one, "vertex-face, 1 thread");
    add("vf", Series::sky, false, all, "vertex-face, " + threads);
    add("ee", Series::green, false, one, "edge-edge, 1 thread");
    add("ee", Series::orange, false, all, "edge-edge, " + threads);
    return {"figure_1", chart.str()};
}

double error(const Json& comparison, const char* which)
{
    constexpr double least = 1e-17;  // nearer than doubles can tell
    return std::max(least, comparison.at("absolute_error").at(which).get<double>());
}

Picture speed_error(const Json& part, const std::string& kind)
{
    const Json &points = part.at(kind).at("points"), &peers = part.at(kind).at("peers");
    Extent speeds, errors;
    std::vector<SpeedError> all;
    for (const Json* const list : {&points, &peers}) {
        for (const Json& point : *list) {
            speeds.add(million_pairs_per_second(point.at("timing")));
            if (point.at("absolute_error").is_null()) continue;
            errors.add(error(point, "median"));
            errors.add(error(point, "worst"));
            all.push_back({million_pairs_per_second(point.at("timing")), error(point, "worst")});
        }
    }
    if (all.empty()) errors.add(1e-9);  // so few pairs that none touches
    Axis x = log_axis("error of the time of impact: median, and line to the worst", errors.least(), errors.most());
    const double right_end = x.high;
    Chart chart{fmt::format("Speed against error: {} pairs", kind_label(kind)),
                "Pairs per second on one thread against the error of the time of impact, for every instruction set and E_tol",
                std::move(x),
                log_axis("million pairs per second, one thread", 0.9 * speeds.least(), 1.25 * speeds.most()),
                400 + 18.0 * static_cast<double>(peers.size()),
                2 + peers.size()};

    std::vector<Point> front;
    for (const SpeedError& point : pareto_front(all)) {
        if (!front.empty()) front.push_back({point.error, front.back().y});
        front.push_back({point.error, point.million_pairs_per_second});
    }
    chart.curve(front, Series::grey, true);

    const auto mark = [&](const Json& point, Series series, const std::string& name) {
        const double rate = million_pairs_per_second(point.at("timing"));
        if (!(rate > 0)) return;  // too short for the clock
        const std::string tooltip =
            fmt::format("{}: {:.3g} M pairs/s ({}); {}", name, rate, how(point.at("timing")), wrong_answers(point));
        if (point.at("absolute_error").is_null())
            return chart.points({{right_end, rate}}, series, {tooltip + "; gives no time"});
        const double median = error(point, "median"), worst = error(point, "worst");
        chart.svg().whisker(chart.at(median, rate), chart.at(worst, rate), series);
        chart.points({{median, rate}}, series, {fmt::format("{}; error median {:.2g}, worst {:.2g}", tooltip, median, worst)});
    };
    const std::string best = last(points).at("isa");
    std::vector<std::string> named;
    for (const Json& point : points) {
        const std::string isa = point.at("isa");
        const double tolerance = point.at("tolerance");
        mark(point, series_of_isa(isa), fmt::format("{}, E_tol {:g}", isa_label(isa), tolerance));
        if (std::ranges::find(named, isa) == named.end()) {
            named.push_back(isa);
            chart.legend(series_of_isa(isa), isa_label(isa));
        }
        const int exponent = static_cast<int>(std::lround(std::log10(tolerance)));
        if (isa != best || exponent % 2 == 0 || point.at("absolute_error").is_null())
            continue;  // every second: side by side they overlap
        const Point at = chart.at(error(point, "median"), million_pairs_per_second(point.at("timing")));
        chart.svg().text({at.x, at.y - 10}, power_of_ten(exponent), Anchor::middle, "soft");
    }
    std::size_t missed = 0, late = 0, false_alarms = 0;
    for (const Json& point : points) {
        missed += point.at("missed").get<std::size_t>();
        late += point.at("late").get<std::size_t>();
        false_alarms += point.at("false_alarms").get<std::size_t>();
    }
    chart.legend_note(
        fmt::format("each at E_tol 10⁻⁶, 10⁻⁷ … 10⁻¹³: {} missed, {} late, {} false alarms", missed, late, false_alarms));
    for (const Json& peer : peers) {
        const std::string name = peer.at("name");
        const Series series = name.starts_with("bullet") ? Series::sky
                              : name.ends_with("newton") ? Series::purple
                                                         : Series::vermilion;
        mark(peer, series, name);
        chart.legend(
            series, fmt::format("{}: {}{}", name, peer.at("absolute_error").is_null() ? "no time, " : "", wrong_answers(peer)));
    }
    return {"speed_error_" + kind, chart.str()};
}

Picture scene_speeds(const Json& part)
{
    struct Row {
        std::string label;
        std::vector<std::pair<Series, const Json*>> timings;
        double paper = 0;
    };
    std::vector<Row> rows;
    Extent extent;
    const int all_threads = part.at("threads");
    for (const Json& scene : part.at("scenes")) {
        for (const char* kind : {"vf", "ee"}) {
            Row row{fmt::format("{}, {}", scene.at("name").get<std::string>(), kind), {}};
            for (const Json& point : last(scene.at("steps")).at(kind).at("speeds")) {
                const bool best = point.at("isa") == part.at("isa") && point.at("threads") == all_threads && all_threads > 1;
                if (point.at("threads") != 1 && !best) continue;
                row.timings.emplace_back(best ? Series::purple : series_of_isa(point.at("isa")), &point.at("timing"));
                extent.add(million_pairs_per_second(point.at("timing")));
            }
            rows.push_back(std::move(row));
        }
    }
    for (const Json& scene : part.at("paper")) {
        const double rate = 1e-6 * scene.at("candidates").get<double>() / scene.at("seconds").get<double>();
        rows.push_back({fmt::format("paper: {}", scene.at("name").get<std::string>()), {}, rate});
        extent.add(rate);
    }

    constexpr double left = 176, row_height = 22, top = 38;
    const double floor = top + row_height * static_cast<double>(rows.size());
    const Axis x = log_axis("million pairs per second", extent.least(), extent.most());
    const auto place = [&](double rate) { return left + x.share(rate) * (Svg::width - 22 - left); };
    Svg svg{"Scenes: speed of every instruction set", "Pairs per second on candidates of scenes, and the paper's own",
            floor + 84};
    for (const auto& [value, name] : x.ticks) {
        svg.line({place(value), top}, {place(value), floor}, "grid");
        svg.text({place(value), floor + 16}, name, Anchor::middle, "soft");
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double y = top + row_height * (static_cast<double>(i) + 0.5);
        svg.line({left, y}, {Svg::width - 22, y}, "grid");
        svg.text({left - 8, y + 4}, rows[i].label, Anchor::end);
        for (const auto& [series, timing] : rows[i].timings) {
            const double rate = million_pairs_per_second(*timing);
            if (!(rate > 0)) continue;  // no candidates of this kind
            svg.marker({place(rate), y}, series, fmt::format("{}: {:.3g} M pairs/s ({})", rows[i].label, rate, how(*timing)));
        }
        if (rows[i].paper > 0)
            svg.marker({place(rows[i].paper), y}, Series::vermilion, fmt::format("{:.3g} M pairs/s", rows[i].paper));
    }
    svg.text({(left + Svg::width) / 2, floor + 34}, x.label, Anchor::middle);
    Legend legend{svg, 14, floor + 58};
    for (const Json& point : last(part.at("scenes").at(0).at("steps")).at("vf").at("speeds")) {
        if (point.at("threads") == 1) legend.add(series_of_isa(point.at("isa")), isa_label(point.at("isa")));
    }
    if (all_threads > 1) legend.add(Series::purple, fmt::format("{}, {} threads", isa_label(part.at("isa")), all_threads));
    legend.add(Series::vermilion, "the paper (2014)");
    return {"scenes", svg.str()};
}

Picture threads(const Json& part)
{
    Extent extent;
    const Json& over = part.at("over_threads");
    for (const Json& series : over) {
        for (const Json& point : series.at("points")) extent.add(million_pairs_per_second(point.at("timing")));
        extent.add(part.at("threads").get<double>() * million_pairs_per_second(series.at("points").at(0).at("timing")));
    }
    const int most = part.at("threads");
    Axis x{0.5, most + 0.5, false, "threads", {}};
    for (const Json& point : over.at("random_vf").at("points"))
        x.ticks.emplace_back(point.at("threads").get<double>(), std::to_string(point.at("threads").get<int>()));
    Chart chart{"Threads",    "Pairs per second against the number of threads",
                std::move(x), linear_axis("million pairs per second", extent.most()),
                320,          2};
    const auto add = [&](const char* key, Series series, const std::string& name) {
        std::vector<Point> points;
        std::vector<std::string> tooltips;
        for (const Json& point : over.at(key).at("points")) {
            points.push_back({point.at("threads"), million_pairs_per_second(point.at("timing"))});
            tooltips.push_back(fmt::format("{}: {:.3g} M pairs/s ({})", name, points.back().y, how(point.at("timing"))));
        }
        chart.curve({{points[0].x, points[0].y}, {points.back().x, points.back().x * points[0].y}}, Series::grey, true);
        draw(chart, points, series, false, name, tooltips);
    };
    add("random_vf", Series::blue, "random vertex-face, packed");
    add("cloth_ee_indexed", Series::green, "cloth edge-edge, indexed");
    chart.legend_note("dashed: as many times one thread");
    return {"threads", chart.str()};
}

/// Of both ways to answer many pairs.
Picture against_pairs(const Json& part, const char* name, const char* title, const char* label, auto value)
{
    const Json& over = part.at("over_pairs");
    Extent pairs, values;
    for (const char* key : {"in_memory", "piece_by_piece"}) {
        for (const Json& point : over.at(key)) pairs.add(point.at("pairs")), values.add(value(point));
    }
    Chart chart{title,
                "Against the number of random vertex-face pairs",
                log_axis("pairs", pairs.least(), pairs.most()),
                log_axis(label, values.least(), values.most()),
                320,
                2};
    const auto add = [&](const char* key, Series series, const char* legend) {
        std::vector<Point> points;
        std::vector<std::string> tooltips;
        for (const Json& point : over.at(key)) {
            points.push_back({point.at("pairs"), value(point)});
            tooltips.push_back(fmt::format("{} pairs: {:.3g} {} ({})", count(point.at("pairs")), points.back().y, label,
                                           how(point.at("timing"))));
        }
        if (!points.empty()) draw(chart, points, series, false, legend, tooltips);
    };
    add("in_memory", Series::blue, "all in one buffer");
    add("piece_by_piece", Series::orange, fmt::format("piece by piece, {} at a time", count(over.at("piece"))).c_str());
    return {name, chart.str()};
}

}  // namespace

std::vector<SpeedError> pareto_front(std::vector<SpeedError> points)
{
    std::ranges::sort(points, [](const SpeedError& a, const SpeedError& b) {
        return a.error != b.error ? a.error < b.error : a.million_pairs_per_second > b.million_pairs_per_second;
    });
    std::vector<SpeedError> front;
    for (const SpeedError& point : points) {
        if (front.empty() || point.million_pairs_per_second > front.back().million_pairs_per_second) front.push_back(point);
    }
    return front;
}

std::vector<Picture> draw_pictures(const Json& report)
{
    std::vector<Picture> pictures{figure_1(report.at("paper_table")), speed_error(report.at("speed_and_error"), "vf"),
                                  speed_error(report.at("speed_and_error"), "ee")};
    for (Picture& picture : heat_maps(report.at("hard_cases"))) pictures.push_back(std::move(picture));
    pictures.push_back(scene_speeds(report.at("scenes")));
    const Json& scaling = report.at("scaling");
    pictures.push_back(threads(scaling));
    pictures.push_back(against_pairs(
        scaling, "pairs", "Time per pair against the number of pairs", "nanoseconds per pair", [](const Json& point) {
            return 1e9 * point.at("timing").at("seconds").get<double>() / point.at("pairs").get<double>();
        }));
    pictures.push_back(against_pairs(scaling, "memory", "Resident memory against the number of pairs", "megabytes",
                                     [](const Json& point) { return 1e-6 * point.at("resident_bytes").get<double>(); }));
    return pictures;
}

}  // namespace fastccd::tools::report
