#include "scene_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>

#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <fastccd/fastccd.hpp>

#include "../interrupt.hpp"
#include "../narrow_phase_run.hpp"
#include "../progress.hpp"
#include "../threads.hpp"
#include "frames.hpp"
#include "saved_pairs.hpp"
#include "scene_hits.hpp"
#include "step_mesh.hpp"

namespace fastccd::tools {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The bar over the steps. Within one it follows the broad phase through the vertices, then through the
/// edges, which take about three times as long.
class StepProgress {
public:
    StepProgress(std::size_t steps, bool enabled) : steps_{steps}, bar_{steps * units_per_step, enabled} {}

    void begin(std::size_t step)
    {
        bar_.set_place(fmt::format("step {} of {}", step + 1, steps_));
        step_ = step;
        move_to(0);
    }

    void move(PairKind kind, double share_done)
    {
        constexpr double vertex_face_share = 0.25;
        move_to(kind == PairKind::vertex_face ? vertex_face_share * share_done
                                              : vertex_face_share + (1 - vertex_face_share) * share_done);
    }

private:
    static constexpr std::size_t units_per_step = 1000;

    void move_to(double share)
    {
        const std::size_t now = step_ * units_per_step + static_cast<std::size_t>(share * units_per_step);
        bar_.advance(now - done_);
        done_ = now;
    }

    std::size_t steps_;
    std::size_t step_ = 0;
    std::size_t done_ = 0;
    Progress bar_;
};

/// What tells the two kinds of candidates apart here.
constexpr PairKind kind_of(const VertexFace&) { return PairKind::vertex_face; }
constexpr PairKind kind_of(const EdgeEdge&) { return PairKind::edge_edge; }
double share_done(const Step& step, const VertexFace& last)
{
    return 3.0 * (last.vertex + 1.0) / static_cast<double>(step.positions0.size());
}
double share_done(const Step& step, const EdgeEdge& last)
{
    return (last.edge_a + 1.0) / static_cast<double>(step.edges.size());
}
void find_candidates(const Step& step, const VertexFaceSink& sink) { find_vertex_face(step, sink); }
void find_candidates(const Step& step, const EdgeEdgeSink& sink) { find_edge_edge(step, sink); }

class SceneRun {
public:
    /// `hits`, `saved`: may be null.
    SceneRun(const SceneOptions& options, SceneHits* hits, SavedPairs* saved, StepProgress& progress)
        : options_{options}, hits_{hits}, saved_{saved}, progress_{progress}, piece_size_{tbb::this_task_arena::max_concurrency()}
    {
    }

    StepTotals answer(std::size_t step_number, const Step& step)
    {
        progress_.begin(step_number);
        check_interrupt();
        StepTotals totals;
        const Clock::time_point start = Clock::now();
        const MovingMesh mesh = moving_mesh(step);
        // Part of the narrow phase: a solver that holds its positions otherwise pays it too.
        totals.kinds[0].narrow_seconds = seconds_since(start);
        answer<VertexFace>(step_number, step, mesh, totals.kinds[0]);
        answer<EdgeEdge>(step_number, step, mesh, totals.kinds[1]);
        return totals;
    }

private:
    template <class Pair>
    void answer(std::size_t step_number, const Step& step, const MovingMesh& mesh, KindTotals& totals)
    {
        check_interrupt();
        if (saved_ != nullptr) saved_->begin(step_number, kind_of(Pair{}));
        const Clock::time_point start = Clock::now();
        double seconds_in_sink = 0;
        find_candidates(step, [&](std::span<const Pair> pairs) {
            const Clock::time_point sink_start = Clock::now();
            // Where the mesh is dense there may be many, and Ctrl-C should not wait for all of them.
            while (!pairs.empty()) {
                const std::span<const Pair> piece = pairs.first(std::min(piece_size_.pairs(), pairs.size()));
                pairs = pairs.subspan(piece.size());
                const double before = totals.narrow_seconds;
                answer_piece(step_number, step, mesh, piece, totals);
                piece_size_.took(piece.size(), totals.narrow_seconds - before);
                progress_.move(kind_of(Pair{}), share_done(step, piece.back()));
            }
            seconds_in_sink += seconds_since(sink_start);
        });
        totals.broad_seconds += seconds_since(start) - seconds_in_sink;
        if (saved_ != nullptr) saved_->close();
    }

    template <class Pair>
    void answer_piece(std::size_t step_number, const Step& step, const MovingMesh& mesh, std::span<const Pair> piece,
                      KindTotals& totals)
    {
        check_interrupt();
        contacts_.clear();
        Summary summary;
        const Clock::time_point start = Clock::now();
        throw_unless_ok(find_contacts(mesh, piece, options_.common.narrow_phase, contacts_, nullptr, &summary));
        totals.narrow_seconds += seconds_since(start);
        // What is not finite is in no candidate; dropping such a pair in silence would be a miss.
        if (summary.invalid != 0) throw std::logic_error("a candidate with a coordinate that is not finite");

        const PairKind kind = kind_of(Pair{});
        // Pieces come in order, so that of two equal times the first stays.
        if (summary.earliest.toi < (totals.earliest ? totals.earliest->toi : HUGE_VAL)) {
            const std::size_t i = summary.earliest.pair;
            totals.earliest = SceneContact{.step = step_number,
                                           .kind = kind,
                                           .candidate = totals.candidates + i,
                                           .vertices = pair_vertices(step, piece[i]),
                                           .toi = summary.earliest.toi};
        }
        totals.candidates += piece.size();
        totals.contacts += contacts_.size();
        totals.proven += summary.proven;
        totals.at_start += summary.at_start;
        totals.scalar_pairs += summary.scalar_pairs;
        if (hits_ != nullptr) {
            for (const Contact& contact : contacts_) {
                hits_->append(step_number, kind, pair_vertices(step, piece[contact.pair]), contact);
            }
        }
        if (saved_ != nullptr) saved_->append(step, piece);
    }

    const SceneOptions& options_;
    SceneHits* hits_;
    SavedPairs* saved_;
    StepProgress& progress_;
    PieceSize piece_size_;
    std::vector<Contact> contacts_;  // of the current piece; kept to reuse its memory
};

void note_invalid_vertices(std::size_t step_number, const Step& step, SceneTotals& totals)
{
    const std::vector<std::int32_t> vertices = non_finite_vertices(step.positions0, step.positions1);
    totals.steps.back().invalid = vertices.size();
    for (const std::int32_t vertex : vertices) totals.invalid.push_back({.step = step_number, .vertex = vertex});
}

SceneTotals answer_steps(const SceneOptions& options)
{
    SceneTotals totals;
    totals.isa = resolve_isa(options.common.narrow_phase);
    totals.threads = tbb::this_task_arena::max_concurrency();

    Clock::time_point read_start = Clock::now();
    Frames frames{options.frames};
    totals.read_seconds = seconds_since(read_start);
    totals.frames = frames.paths();
    totals.vertices = frames.vertex_count();
    totals.faces = frames.faces().size() / 3;
    totals.edges = frames.edges().size();

    const std::string& hits_path = options.common.hits;
    std::optional<SavedPairs> saved;  // its folder may be created here, and be that of the hits
    if (!options.save_pairs.empty()) saved.emplace(options.save_pairs, frames.step_count());
    std::optional<SceneHits> hits;
    if (!hits_path.empty()) hits.emplace(hits_path, options.common.proof);
    // Rows on a terminal are progress enough, and would run into the bar.
    const bool rows_on_terminal = OutputFile::is_standard_output(hits_path) && ::isatty(STDOUT_FILENO) != 0;
    StepProgress progress{frames.step_count(), !options.common.quiet && !rows_on_terminal};
    SceneRun run{options, hits ? &*hits : nullptr, saved ? &*saved : nullptr, progress};

    for (std::size_t step_number = 0; step_number < frames.step_count(); ++step_number) {
        read_start = Clock::now();
        Step step = frames.next_step();
        step.separation = options.common.narrow_phase.minimum_separation;
        totals.read_seconds += seconds_since(read_start);
        totals.steps.push_back(run.answer(step_number, step));
        note_invalid_vertices(step_number, step, totals);
    }
    check_interrupt();
    // The pairs are on the disk already and need no more than their names: the hits may still fail.
    if (hits) hits->commit();
    if (saved) saved->commit();
    return totals;
}

}  // namespace

SceneTotals run_scene(const SceneOptions& options)
{
    SceneTotals totals;
    on_threads(options.common.threads, [&] { totals = answer_steps(options); });
    return totals;
}

}  // namespace fastccd::tools
