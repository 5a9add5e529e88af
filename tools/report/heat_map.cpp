#include "heat_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "format.hpp"
#include "svg.hpp"

namespace fastccd::tools::report {
namespace {

/// What a group of columns shows of a set; nothing where it is not known.
struct Measure {
    const char* heading[2];
    const char* unit;
    std::optional<double> (*value)(const Json& set);
    const char* scale;          ///< Measures with the same one have their colours from one scale.
    bool always_wrong = false;  ///< Anything but 0 breaks a promise.
};

std::optional<double> early(const Json& comparison)
{
    if (comparison.is_null() || comparison.at("signed_error").is_null()) return std::nullopt;
    return std::max(0.0, -comparison.at("signed_error").at("earliest").get<double>());
}

std::optional<double> alarm_share(const Json& comparison)
{
    if (comparison.is_null()) return std::nullopt;
    return 100.0 * comparison.at("false_alarms").get<double>() / std::max(1.0, comparison.at("pairs").get<double>());
}

constexpr std::array<Measure, 7> measures{{
    {{"missed", "or late"},
     "pairs missed or late",
     [](const Json& set) -> std::optional<double> {
         return set.at("plain").at("missed").get<double>() + set.at("plain").at("late").get<double>();
     },
     "missed",
     true},
    {{"false", "alarms"}, "% false alarms", [](const Json& set) { return alarm_share(set.at("plain")); }, "alarms"},
    {{"alarms", "--exact"},
     "% false alarms with --exact",
     [](const Json& set) { return alarm_share(set.at("exact")); },
     "exact alarms",
     true},
    {{"worst", "early"}, "of the step early at worst", [](const Json& set) { return early(set.at("plain")); }, "early"},
    {{"early", "--exact"},
     "of the step early at worst with --exact",
     [](const Json& set) { return early(set.at("exact")); },
     "early"},
    {{"ns per", "pair"},
     "ns per pair",
     [](const Json& set) -> std::optional<double> {
         return 1e9 * set.at("plain").at("timing").at("seconds").get<double>() / std::max(1.0, set.at("pairs").get<double>());
     },
     "time"},
    {{"most in-", "tervals"},
     "intervals at most",
     [](const Json& set) -> std::optional<double> { return set.at("intervals").at("most").get<double>(); },
     "intervals"},
}};

struct Column {
    const char* letter;
    const char* name;
};

struct HeatRow {
    std::string label;
    std::vector<const Json*> sets;  ///< One for each column; null where there is none.
};

/// The ends of the colour scale of a measure: the least and the largest value above 0.
struct Scale {
    double least = HUGE_VAL, most = 0;

    [[nodiscard]] std::size_t level(double value) const
    {
        if (most <= least) return 4;
        const double share = std::log(value / least) / std::log(most / least);
        return static_cast<std::size_t>(std::clamp(share * 9, 0.0, 8.0));
    }
};

/// As short as can be: "0.3", "20", "2e4", "9e-10".
std::string one_digit(double value)
{
    if (value >= 1 && value < 999.5) return fmt::format("{:.0f}", value);
    std::string text = fmt::format("{:.1g}", value);
    if (const std::size_t plus = text.find("e+0"); plus != std::string::npos) text.erase(plus + 1, 2);
    if (const std::size_t zero = text.find("e-0"); zero != std::string::npos) text.erase(zero + 2, 1);
    return text;
}

Scale scale_of(const Measure& one, const std::vector<HeatRow>& rows)
{
    Scale scale;
    for (const Measure& measure : measures) {
        if (std::string_view{measure.scale} != one.scale) continue;
        for (const HeatRow& row : rows) {
            for (const Json* const set : row.sets) {
                const std::optional<double> value = set == nullptr ? std::nullopt : measure.value(*set);
                if (!value || *value <= 0) continue;
                scale.least = std::min(scale.least, *value);
                scale.most = std::max(scale.most, *value);
            }
        }
    }
    return scale;
}

Picture heat_map(const std::string& name, const std::string& title, const std::vector<Column>& columns,
                 const std::vector<HeatRow>& rows)
{
    constexpr double top = 84, row_height = 15, gap = 5;
    std::size_t longest = 0;
    for (const HeatRow& row : rows) longest = std::max(longest, row.label.size());
    const double left = std::max(90.0, 16 + 7.2 * static_cast<double>(longest));
    std::vector<const Measure*> shown;  // those that are known of any set
    for (const Measure& measure : measures) {
        const auto known = [&](const Json* set) { return set != nullptr && measure.value(*set); };
        if (std::ranges::any_of(rows, [&](const HeatRow& row) { return std::ranges::any_of(row.sets, known); }))
            shown.push_back(&measure);
    }
    const double group = (Svg::width - 6 - left) / static_cast<double>(shown.size());
    const double cell = (group - gap) / static_cast<double>(columns.size());
    const double floor = top + row_height * static_cast<double>(rows.size());
    Svg svg{title, "Heat map of hard pairs: rows are families, columns what goes wrong or costs", floor + 46};
    for (std::size_t m = 0; m < shown.size(); ++m) {
        const Measure& measure = *shown[m];
        const double begin = left + group * static_cast<double>(m);
        const Scale scale = scale_of(measure, rows);
        svg.text({begin, top - 38}, measure.heading[0]);
        svg.text({begin, top - 23}, measure.heading[1]);
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const double x = begin + cell * static_cast<double>(c);
            svg.text({x + cell / 2, top - 6}, columns[c].letter, Anchor::middle, "soft");
            for (std::size_t r = 0; r < rows.size(); ++r) {
                const Json* const set = rows[r].sets[c];
                const std::optional<double> value = set == nullptr ? std::nullopt : measure.value(*set);
                if (!value) continue;
                const std::string css = *value <= 0            ? "none"
                                        : measure.always_wrong ? "wrong"
                                                               : fmt::format("h{}", scale.level(*value));
                const std::string tooltip =
                    fmt::format("{}, {}: {} {}", rows[r].label, columns[c].name, figure(*value), measure.unit);
                svg.rectangle({x + 0.5, top + row_height * static_cast<double>(r) + 0.5}, cell - 1, row_height - 1, css,
                              tooltip);
            }
        }
        svg.text({begin, floor + 17}, scale.most > 0 ? one_digit(scale.least) : "all 0", Anchor::start, "soft");
        if (scale.most > scale.least) svg.text({begin, floor + 33}, one_digit(scale.most), Anchor::start, "soft");
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
        svg.text({left - 6, top + row_height * static_cast<double>(r) + 11.5}, rows[r].label, Anchor::end);
    }
    svg.text({left - 6, floor + 17}, "palest", Anchor::end, "soft");
    svg.text({left - 6, floor + 33}, "strongest", Anchor::end, "soft");
    return {name, svg.str()};
}

/// The row of that label, made if need be.
HeatRow& row_of(std::vector<HeatRow>& rows, const std::string& label, std::size_t columns)
{
    const auto found = std::ranges::find(rows, label, &HeatRow::label);
    if (found != rows.end()) return *found;
    return rows.emplace_back(HeatRow{label, std::vector<const Json*>(columns, nullptr)});
}

std::string without_prefix(const std::string& text, std::string_view prefix)
{
    return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

}  // namespace

std::vector<Picture> heat_maps(const Json& hard_cases)
{
    const std::vector<Column> by_numbers{
        {"v", "vertex-face, double"}, {"e", "edge-edge, double"}, {"v", "vertex-face, float"}, {"e", "edge-edge, float"}};
    const std::vector<Column> by_kind{{"vf", "vertex-face"}, {"ee", "edge-edge"}};
    std::vector<HeatRow> made, published, queries;
    for (const Json& set : hard_cases.at("sets")) {
        std::string name = set.at("name");
        const std::size_t kind = set.at("kind") == "vf" ? 0 : 1;
        if (name.starts_with("queries/")) {  // queries/SCENE/vertex-face/data_0_1.csv
            const std::size_t slash = name.find('/', 8), file = name.rfind("data_");
            const std::string number = file == std::string::npos ? "" : name.substr(file + 4, 4);
            row_of(queries, without_prefix(without_prefix(name.substr(8, slash - 8), "erleben-"), "cube-") + number, 2)
                .sets.at(kind) = &set;
            continue;
        }
        std::vector<HeatRow>& rows = set.at("source") == "generated" ? made : published;
        name = without_prefix(name, "hardcases/");
        const bool single = name.starts_with("f32_");
        const std::string family = without_prefix(name, "f32_").substr(0, name.size() - (single ? 7 : 3));
        row_of(rows, family == "momentary_degenerate" ? "momentary_deg." : family, 4).sets[kind + (single ? 2 : 0)] = &set;
    }
    std::vector<Picture> pictures{
        heat_map("hard_cases", "Hard cases: made here, truth from the exact oracle", by_numbers, made)};
    if (!published.empty())
        pictures.push_back(heat_map("hard_cases_public", "Hard cases: public data, published truth", by_numbers, published));
    if (!queries.empty())
        pictures.push_back(
            heat_map("hard_cases_queries", "Handcrafted queries: public data, published truth", by_kind, queries));
    return pictures;
}

}  // namespace fastccd::tools::report
