#include "scene_report.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <fastccd/isa.hpp>

#include "../output_file.hpp"
#include "../report_totals.hpp"

namespace fastccd::tools {
namespace {

using Json = nlohmann::ordered_json;

/// By the warning; --json names all.
constexpr std::size_t most_invalid_vertices_named = 10;

constexpr PairKind both_kinds[] = {PairKind::vertex_face, PairKind::edge_edge};

std::string what_touches(const SceneContact& contact)
{
    const auto& v = contact.vertices;
    return contact.kind == PairKind::vertex_face
               ? fmt::format("vertex {} and face {} {} {}", v[0], v[1], v[2], v[3])
               : fmt::format("edges {} {} and {} {}", v[0], v[1], v[2], v[3]);
}

std::string contacts_in_candidates(const KindTotals& totals)
{
    return fmt::format("{} in {}", counted(totals.contacts, "contact"), counted(totals.candidates, "candidate"));
}

/// One in the middle of three frames is listed for two steps, and is one vertex.
std::size_t count_invalid(const SceneTotals& totals)
{
    std::set<std::int32_t> vertices;
    for (const InvalidVertex& invalid : totals.invalid) vertices.insert(invalid.vertex);
    return vertices.size();
}

std::string left_out(const SceneTotals& totals)
{
    const std::size_t count = count_invalid(totals);
    return fmt::format("{} with NaN or infinity, left out with all that {} part of", counted(count, "vertex", "vertices"),
                       count == 1 ? "it is" : "they are");
}

std::string invalid_vertices(const SceneTotals& totals)
{
    const std::size_t named = std::min(totals.invalid.size(), most_invalid_vertices_named);
    std::string text;
    for (std::size_t i = 0; i < named; ++i) {
        const InvalidVertex& invalid = totals.invalid[i];
        const bool new_step = i == 0 || invalid.step != totals.invalid[i - 1].step;
        text += new_step ? fmt::format("{}step {}: {}", i == 0 ? "" : "; ", invalid.step, invalid.vertex)
                         : fmt::format(", {}", invalid.vertex);
    }
    if (totals.invalid.size() > named) text += " and more, which --json lists";
    return text;
}

Json json_contact(const std::optional<SceneContact>& contact)
{
    if (!contact) return nullptr;
    return {{"toi", contact->toi},
            {"step", contact->step},
            {"kind", short_name(contact->kind)},
            {"vertices", contact->vertices},
            {"candidate", contact->candidate}};
}

/// The fields that a kind, a step and the whole have in common.
void add_sums(Json& json, const KindTotals& totals)
{
    json["candidates"] = totals.candidates;
    json["contacts"] = totals.contacts;
    json["proven"] = totals.proven;
    json["possible"] = totals.contacts - totals.proven;
    json["at_start"] = totals.at_start;
    json["earliest"] = json_contact(totals.earliest);
    json["broad_phase_seconds"] = totals.broad_seconds;
    json["broad_phase_candidates_per_second"] = rate(totals.candidates, totals.broad_seconds);
    json["narrow_phase_seconds"] = totals.narrow_seconds;
    json["narrow_phase_pairs_per_second"] = rate(totals.candidates, totals.narrow_seconds);
    json["scalar_pairs"] = totals.scalar_pairs;
}

/// The sums of both kinds, then each alone.
void add_kinds(Json& json, const KindTotals& vertex_face, const KindTotals& edge_edge)
{
    add_sums(json, vertex_face + edge_edge);
    add_sums(json["vf"], vertex_face);
    add_sums(json["ee"], edge_edge);
}

}  // namespace

std::string scene_text_report(const SceneOptions& options, const SceneTotals& totals)
{
    fmt::memory_buffer out;
    const auto line = [&out](std::string_view label, std::string_view text) { append_line(out, label, text); };
    const Options& asked = options.common.narrow_phase;
    const std::size_t steps = totals.steps.size();
    line("scene", fmt::format("{} to {}, {}", totals.frames.front(), totals.frames.back(), counted(steps, "step")));
    line("mesh", fmt::format("{}, {}, {}", counted(totals.vertices, "vertex", "vertices"), counted(totals.faces, "face"),
                             counted(totals.edges, "edge")));
    line("asked", what_was_asked(asked, " of every step"));

    fmt::format_to(std::back_inserter(out), "\n{:>5} {:<4} {:>13} {:>11} {:>9} {:>9} {:>9}  {}\n", "step", "kind",
                   "candidates", "contacts", "broad, s", "narrow, s", "M pairs/s", "earliest contact");
    for (std::size_t step = 0; step < steps; ++step) {
        for (const PairKind kind : both_kinds) {
            const KindTotals& sums = totals.steps[step].kinds[static_cast<std::size_t>(kind)];
            fmt::format_to(std::back_inserter(out), "{:>5} {:<4} {:>13} {:>11} {:>9.4f} {:>9.4f} {:>9.1f}  {}\n", step,
                           short_name(kind), with_commas(sums.candidates), with_commas(sums.contacts),
                           sums.broad_seconds, sums.narrow_seconds, rate(sums.candidates, sums.narrow_seconds) * 1e-6,
                           sums.earliest ? fmt::format("toi {:.6g}, {}", sums.earliest->toi, what_touches(*sums.earliest))
                                         : "-");
        }
    }
    fmt::format_to(std::back_inserter(out), "\n");

    KindTotals all;
    for (const PairKind kind : both_kinds) {
        const KindTotals sums = sum(totals, kind);
        all = all + sums;
        line(kind_name(kind), contacts_in_candidates(sums));
    }
    line("all", contacts_in_candidates(all));
    line("  proven", with_commas(all.proven));
    line("  possible", with_commas(all.contacts - all.proven));
    if (asked.minimum_separation > 0.0) line("  at the start", with_commas(all.at_start));
    if (all.earliest) {
        line("earliest", fmt::format("toi {:.17g} in step {}, {}", all.earliest->toi, all.earliest->step,
                                     what_touches(*all.earliest)));
    }
    line("invalid", totals.invalid.empty() ? "0 vertices" : left_out(totals));
    line("certified search", counted(all.scalar_pairs, "pair"));
    line("reading", fmt::format("{:.3g} s", totals.read_seconds));
    line("broad phase", fmt::format("{:.3g} s, {:.3g} million candidates/s", all.broad_seconds,
                                    rate(all.candidates, all.broad_seconds) * 1e-6));
    line("narrow phase", narrow_phase_speed(all.candidates, all.narrow_seconds, totals.isa, totals.threads));
    return fmt::to_string(out);
}

std::string scene_json_report(const SceneOptions& options, const SceneTotals& totals)
{
    const Options& asked = options.common.narrow_phase;
    Json json;
    json["frames"] = totals.frames;
    json["vertices"] = totals.vertices;
    json["faces"] = totals.faces;
    json["edges"] = totals.edges;
    add_kinds(json, sum(totals, PairKind::vertex_face), sum(totals, PairKind::edge_edge));
    json["invalid"] = count_invalid(totals);
    json["invalid_vertices"] = Json::array();
    for (const InvalidVertex& invalid : totals.invalid) {
        json["invalid_vertices"].push_back({{"step", invalid.step}, {"vertex", invalid.vertex}});
    }
    json["read_seconds"] = totals.read_seconds;
    add_asked(json, asked, totals.isa, totals.threads);
    json["steps"] = Json::array();
    for (std::size_t number = 0; number < totals.steps.size(); ++number) {
        const StepTotals& step = totals.steps[number];
        Json item{{"step", number}};
        add_kinds(item, step.kinds[0], step.kinds[1]);
        item["invalid"] = step.invalid;
        json["steps"].push_back(std::move(item));
    }
    // File names need not be UTF-8, JSON has to be.
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void print_scene_report(const SceneOptions& options, const SceneTotals& totals)
{
    const bool to_error = OutputFile::is_standard_output(options.common.hits);
    const int descriptor = to_error ? STDERR_FILENO : STDOUT_FILENO;
    const char* const stream = to_error ? "standard error" : "standard output";
    if (options.common.json) {
        write_all(descriptor, scene_json_report(options, totals), stream);
    } else if (!options.common.quiet) {
        write_all(descriptor, scene_text_report(options, totals), stream);
    }
    // Not where JSON is, which names them, too, and is to be one object.
    if (!totals.invalid.empty() && !(options.common.json && to_error)) {
        write_all(STDERR_FILENO,
                  fmt::format("fastccd: warning: {}: {}\n", left_out(totals), invalid_vertices(totals)), "standard error");
    }
}

}  // namespace fastccd::tools
