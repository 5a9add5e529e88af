// The pipeline on a portable lane type of 8 pairs: the logic of the widest batches, on machines without them.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <packed_pairs.hpp>
#include <pipeline.hpp>
#include <separation_pipeline.hpp>
#include <strided_pairs.hpp>

#include "array_lane.hpp"
#include "generators.hpp"
#include "guarded_array.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

using Lanes = FASTCCD_KERNEL_NAMESPACE::Array<double, 8>;

template <PairKind kind, class Number>
void run_tile_of(const TileRequest& request, TileScratch& scratch)
{
    using namespace FASTCCD_KERNEL_NAMESPACE;
    switch (request.source->view->layout()) {
        case PairView::Layout::blocked: return Pipeline<kind, Lanes, PackedPairs<Lanes, InBlocks, Number>>::run_tile(request, scratch);
        case PairView::Layout::interleaved: return Pipeline<kind, Lanes, PackedPairs<Lanes, Interleaved, Number>>::run_tile(request, scratch);
        case PairView::Layout::strided: return Pipeline<kind, Lanes, StridedPairs<Lanes, Number>>::run_tile(request, scratch);
    }
}

/// What run_tile.hpp does of packed pairs, without a minimum separation. All of that would take twice as long to compile.
void run_tile(const TileRequest& request, TileScratch& scratch)
{
    const bool floats = request.source->view->scalar() == PairView::Scalar::float32;
    if (request.kind == PairKind::vertex_face)
        floats ? run_tile_of<PairKind::vertex_face, float>(request, scratch) : run_tile_of<PairKind::vertex_face, double>(request, scratch);
    else
        floats ? run_tile_of<PairKind::edge_edge, float>(request, scratch) : run_tile_of<PairKind::edge_edge, double>(request, scratch);
}

/// With one, of blocks.
template <PairKind kind>
void run_tile_with_separation(const TileRequest& request, TileScratch& scratch)
{
    using namespace FASTCCD_KERNEL_NAMESPACE;
    SeparationPipeline<kind, Lanes, PackedPairs<Lanes, InBlocks, double>>::run_tile(request, scratch);
}

/// Pairs that the lanes decide, as the certified search does; the others are its own.
std::size_t expect_decided_as_searched(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, const std::string& family, double t_max = 1.0)
{
    const auto scratch = std::make_unique<TileScratch>();
    const SearchParameters parameters{1e-9, t_max, true};
    const PairBuffer buffer = to_buffer(pairs);
    Options options;
    options.reference = true;
    options.t_max = t_max;
    const Answer expected = answer(kind, buffer.view(), options);
    std::size_t decided = 0;
    // Blocks and records read in place, and no farther than they reach, and blocks filled anew for every group.
    std::array<const double*, pair_coordinates> columns{};
    for (std::size_t c = 0; c < pair_coordinates; ++c) columns[c] = &pairs[0][c / 3][c % 3];
    const GuardedArray<oracle::Pair> records{pairs, Side::end};
    std::vector<PairView> views{buffer.view(), PairView::interleaved(&records.data()[0][0][0], pairs.size()),
                                PairView::strided(columns, static_cast<std::ptrdiff_t>(pair_coordinates), pairs.size())};
    std::vector<float> floats, float_blocks(buffer.block_count() * block_coordinates);
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (std::size_t c = 0; c < pair_coordinates; ++c) {
            floats.push_back(static_cast<float>(pairs[i][c / 3][c % 3]));
            float_blocks[blocked_index(i, c)] = floats.back();
        }
    const GuardedArray<float> float_records{floats, Side::end};
    if (family.starts_with("f32")) {
        views.push_back(PairView::interleaved(float_records.data(), pairs.size()));
        views.push_back(PairView::blocked(float_blocks.data(), pairs.size()));
    }
    for (const PairView& view : views) {
        const PairSource source{&view, {}, view.size()};
        // Either way to go about it, whichever this machine takes.
        for (const Preferences& preferences : {Preferences{CacheLevel::first, false}, Preferences{CacheLevel::second, true}}) {
            run_tile({pair_kind(kind), &source, 0, pairs.size(), &parameters, 1.0, preferences}, *scratch);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if (is_set(scratch->is_undecided, i)) continue;
                ++decided;
                EXPECT_EQ(parameters.time(scratch->time[i]), expected.toi[i]) << family << ' ' << t_max << ' ' << lossless(pairs[i]);
                if (expected.toi[i] <= 1.0) {
                    EXPECT_EQ(scratch->roots[i], expected.roots[i]) << family;
                }
            }
        }
    }
    return decided;
}

TEST(WideLanes, DecideWhatTheCertifiedSearchDecides)
{
    std::size_t decided = 0;
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 41, 509, pairs);
            for (const double t_max : {1.0, 0.37}) decided += expect_decided_as_searched(kind, pairs, family, t_max);
            if (HasFailure()) return;
        }
    EXPECT_GT(decided, 120000u);
}

// As in a scene, where few pairs of a group are left after screening, and wait for those of the next one.
TEST(WideLanes, DecideTheFewThatAreNotClearlyApart)
{
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge}) {
        std::vector<oracle::Pair> pairs;
        generate("f32_uniform", kind, 42, 3005, pairs);
        const std::size_t first_primitive = kind == oracle::Kind::vertex_face ? 1 : 2;  // points
        const auto move = [](double& x) { x = static_cast<float>(x + 8.0); };
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (i % 5 == 4) continue;
            for (std::size_t point = 0; point < first_primitive; ++point) {
                move(pairs[i][point][0]);
                move(pairs[i][4 + point][0]);
            }
        }
        EXPECT_GT(expect_decided_as_searched(kind, pairs, "f32, mostly apart"), 23600u);
    }
}

TEST(WideLanes, KeepADistanceAsTheScalarSearchDoes)
{
    const auto scratch = std::make_unique<TileScratch>();
    std::size_t decided = 0;
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 42, 509, pairs);
            const PairBuffer buffer = to_buffer(pairs);
            const PairView view = buffer.view();
            const PairSource source{&view, {}, view.size()};
            Options options;
            options.reference = true;
            options.minimum_separation = 1e-2;
            const SearchParameters parameters{options.tolerance, 1.0, false,
                                              SeparationParameters{options.minimum_separation, options.distance_tolerance}};
            const Answer expected = answer(kind, view, options);
            const TileRequest request{pair_kind(kind), &source, 0, pairs.size(), &parameters, 1.0};
            if (kind == oracle::Kind::vertex_face)
                run_tile_with_separation<PairKind::vertex_face>(request, *scratch);
            else
                run_tile_with_separation<PairKind::edge_edge>(request, *scratch);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if (is_set(scratch->is_undecided, i)) continue;
                ++decided;
                ASSERT_EQ(scratch->time[i], expected.toi[i]) << family << ' ' << lossless(pairs[i]);
            }
        }
    EXPECT_GT(decided, 50000u);
}

}  // namespace
}  // namespace fastccd::testing
