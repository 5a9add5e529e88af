// Bounded: the certified search examines no more intervals for a pair than its cap, and a call allocates nothing per pair.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include <tbb/global_control.h>

#include <certified_search.hpp>
#include <kernel_table.hpp>
#include <pair_polynomials.hpp>
#include <separation_search.hpp>

#include "allocation_count.hpp"
#include "amount.hpp"
#include "generators.hpp"
#include "mesh_of_pairs.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_distance.hpp"
#include "test_data.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

/// At the cap, what still waits on the two stacks of intervals (leaves, parts of a leaf) is looked at once, what is wide gets more.
constexpr unsigned stacks = 2 * 128;
constexpr unsigned most_intervals_with_stack =
    scalar::most_intervals + scalar::most_looks_to_skip + scalar::most_extensions * scalar::extension + stacks;
// What the README promises.
static_assert(scalar::most_intervals == 4096 && scalar::most_extensions * scalar::extension == 1024);

/// Enough for every pair that is not degenerate: a path of halvings to a contact, and some on the way.
constexpr unsigned ordinary_intervals = 512;

struct Work {
    unsigned largest = 0, largest_for_roots = 0, most_roots = 0;
    std::size_t pairs = 0, all_intervals = 0, beyond_ordinary = 0, at_cap = 0;

    void add(oracle::Kind kind, const std::vector<oracle::Pair>& set, double tolerance)
    {
        const SearchParameters parameters{tolerance, 1.0, true};
        for (const oracle::Pair& pair : set) {
            const scalar::SearchResult found = scalar::certified_search(pair_kind(kind), pair[0].data(), parameters);
            const unsigned intervals = found.intervals;
            largest = std::max(largest, intervals);
            largest_for_roots = std::max(largest_for_roots, found.root_intervals);
            most_roots = std::max(most_roots, unsigned{found.roots});
            ++pairs;
            all_intervals += intervals;
            beyond_ordinary += intervals > ordinary_intervals;
            at_cap += intervals >= scalar::most_intervals;
        }
    }
    void report(const char* name, double tolerance) const
    {
        std::printf("%-28s E_tol %g: %zu intervals a pair, at most %u; over %u for %zu of %zu pairs, at the cap %zu; for roots %u\n", name,
                    tolerance, all_intervals / pairs, largest, ordinary_intervals, beyond_ordinary, pairs, at_cap, largest_for_roots);
        EXPECT_LE(largest, most_intervals_with_stack) << name;
        EXPECT_LE(largest_for_roots, scalar::most_intervals + stacks) << name;
        EXPECT_LE(most_roots, 3u) << "more than a cubic has: " << name;
    }
};

/// Families with a degeneracy at the very time of contact, where certificates exist on tiny intervals only.
bool may_reach_the_cap(const std::string& family)
{
    for (const char* hard : {"degenerate", "binarygrid", "tinygrid", "mixed_exponent", "grazing", "coplanar", "zero_cubic",
                             "pointpoint", "collinear", "parallel", "resting", "simcloth"})
        if (family.find(hard) != std::string::npos) return true;
    return false;
}

TEST(Bounded, IntervalsOfMadePairs)
{
    std::vector<oracle::Pair> pairs;
    for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
        Work ordinary, hard, thin;
        for (const auto kind : kinds) {
            for (const std::string& family : families()) {
                generate(family, kind, 101, 150, pairs);
                (may_reach_the_cap(family) ? hard : ordinary).add(kind, pairs, tolerance);
            }
            thin.add(kind, ThinPairs{kind, 102}.next(3000), tolerance);
        }
        ordinary.report("families", tolerance);
        hard.report("degenerate families", tolerance);
        thin.report("thin pairs", tolerance);
        EXPECT_EQ(ordinary.beyond_ordinary, 0u);
        EXPECT_LT(hard.at_cap, hard.pairs / 50);
        EXPECT_LE(thin.at_cap, thin.pairs / 1000);
        EXPECT_GT(ordinary.largest, 40u) << "no search went down to a leaf: nothing was tested";
    }
}

/// Thin pairs may be so close for thousands of leaves that directions do not tell them apart: eq. 7 does, of more than a leaf at a time.
TEST(Bounded, LeavesThatOnlyAreasClear)
{
    for (const double tolerance : {1e-12, 1e-15}) {
        Work thin;
        for (const auto kind : kinds) thin.add(kind, ThinPairs{kind, 5}.next(amount(60000)), tolerance);
        thin.report("thin pairs", tolerance);
        EXPECT_LT(thin.largest, 1024u);
    }
}

/// Volumes and areas vanish next to a moment at which both primitives are points or lines: of thousands of leaves none has a certificate by
/// itself. Directions lead past most of them, and end where the pair is too close for them.
TEST(Bounded, MomentsWithoutAreaAreSkipped)
{
    for (const double tolerance : {1e-9, 1e-12}) {
        Work moments;
        for (const auto kind : kinds)
            for (const char* family : {"momentary_degenerate", "f32_momentary_degenerate"}) {
                std::vector<oracle::Pair> pairs;
                generate(family, kind, 104, amount(2000), pairs);
                moments.add(kind, pairs, tolerance);
            }
        moments.report("moments without area", tolerance);
        if (tolerance == 1e-9) {
            EXPECT_LT(moments.largest, scalar::most_intervals / 2) << "without directions, some of these come to the cap";
        }
        EXPECT_LE(moments.at_cap, moments.pairs / 1000) << "without an end after directions, one in 130 does at 1e-12";
    }
}

/// Two edges of a cloth that glide along one line while they turn, at a distance that rounding hardly hides: the closer, the shorter each
/// direction keeps them apart.
TEST(Bounded, LooksAtGlidingEdges)
{
    const oracle::Pair near{{{0.17323960073256414, 0.097586305795855088, -0.21654835976913106},
                             {0.17484810057854314, 0.096101131038407561, -0.21615714935965044},
                             {0.17472161097628827, 0.0962179242931165, -0.21618791440179136},
                             {0.17583084106762337, 0.095193705319790239, -0.21591811469834263},
                             {0.17327904352360302, 0.097544197387963133, -0.21651791251352784},
                             {0.17487878121926154, 0.096064496113927395, -0.21615986511787338},
                             {0.1747528880492728, 0.096181077765546324, -0.21618834455761379},
                             {0.17585563784474192, 0.095155880040092497, -0.21593414663299498}}};
    const oracle::Pair farther{{{-0.13822061119644283, 0.58720033512563485, -0.49680509457416544},
                                {-0.11231002110212486, 0.59787208979159268, -0.53422490614337437},
                                {-0.15162008075477493, 0.58168209849213393, -0.47745428818951285},
                                {-0.10888856836750724, 0.59928116417554878, -0.53916602148451231},
                                {-0.13872010112784991, 0.58729039464389354, -0.49694100737267183},
                                {-0.11238644142834853, 0.59799831353382171, -0.53409607370008949},
                                {-0.15195191826807367, 0.58165858015676075, -0.47743141399001066},
                                {-0.1089848365971174, 0.59943075197895024, -0.53906016477397145}}};
    const SearchParameters parameters{1e-9, 1.0, false};
    for (const oracle::Pair& pair : {near, farther}) {
        const scalar::PairPolynomials<PairKind::edge_edge> polynomials{pair[0].data(), parameters};
        const unsigned looks = scalar::apart_until(polynomials.coefficients(), parameters, 0.0).intervals;
        EXPECT_GT(looks, 32u) << "nothing was tested";
        EXPECT_LE(looks, 384u) << "where the distance at which they count as touching does not double, thousands";
        // README, Accuracy: after n looks within 2^(11 + n / 16) u of their size, beside what E_tol allows.
        const SearchParameters fine{0x1p-50, 1.0, false};
        const double toi = scalar::certified_search(PairKind::edge_edge, pair[0].data(), fine).toi;
        double excess = 0.0;
        if (std::isfinite(toi)) excess = oracle::excess_of_distance(oracle::Kind::edge_edge, pair, toi, 0, oracle::sum_of_extents(pair)) * 0x1p53;
        EXPECT_LE(excess, std::exp2(std::min(11.0 + looks / 16.0, 28.0)));
        std::printf("gliding edges: %u looks, reported %g u apart\n", looks, excess);
        if (pair == farther) continue;  // comes to the cap with some separations
        // And moved by as little as that: the distance of two of their points tells less well how close they are than what directions show.
        unsigned most = 0;
        std::mt19937_64 bits{106};
        for (int n = 0; n < 2000; ++n) {
            oracle::Pair moved = pair;
            for (auto& point : moved)
                for (double& x : point) x += std::ldexp(static_cast<double>(bits() >> 11), -53 - 40 - n % 15) - std::ldexp(0.5, -40 - n % 15);
            const double d = oracle::sum_of_extents(moved).get_d() * std::ldexp(1.0, -30 - n % 25);
            const SearchParameters within{1e-9, 1.0, false, SeparationParameters{d, 1e-6}};
            most = std::max(most, scalar::separation_search(PairKind::edge_edge, moved[0].data(), within).intervals);
        }
        std::printf("gliding edges with a separation: %u looks at most\n", most);
        EXPECT_LE(most, 1024u);
    }
}

/// Found by hill climbing: the cubic stays within its rounding near a double root, in and out of it again and again. They came
/// to 4,295 and 4,257 intervals and 15 and 9 roots when leaves had a cap of their own.
TEST(Bounded, NoNumberOfRootsAtTheCap)
{
    const oracle::Pair vertex_face{{{-0x1.9f4aeffffffffp-2, -0x1.bf9de8p-1, 0x1.e57c000000001p-3},
                                    {0x1.a54beffffffffp-2, -0x1.7960200000009p-2, 0x1.0cba5bfffffffp+0},
                                    {-0x1.2d1438p-1, -0x1.9e6c9p+0, 0x1.6532c00000002p-3},
                                    {-0x1.8df5ep-2, -0x1.11612b83e8ae9p-1, -0x1.b6ddffffffff9p-7},
                                    {0x1.44e90ffffffffp-2, -0x1.0b17f3fffffffp+0, 0x1.619fp-1},
                                    {-0x1.4ea0400000005p-4, -0x1.4a5207ffffff8p+0, 0x1.2cd57690096d6p-2},
                                    {0x1.a02b9p-2, -0x1.5c012p-1, 0x1.7148afffffffep-1},
                                    {0x1.3c722p-2, -0x1.359edp+0, 0x1.a03e88p-1}}};
    const oracle::Pair edge_edge{{{-0x1.2c07ffffffffcp-5, 0x1.1fa3000000d1p-3, -0x1.77733ffffffffp-1},
                                  {-0x1.7929000010d52p-1, -0x1.e4fb00000000fp-2, -0x1.65a000033f695p+0},
                                  {-0x1.7b0000000000bp-4, 0x1.a8a5ffffffff8p-3, -0x1.3bf0cp+0},
                                  {-0x1.1261ffffffffbp-3, -0x1.a639ffffe2d4cp-2, -0x1.8ef4bfffffffep-1},
                                  {-0x1.e1ec800000001p-1, -0x1.83aa000000007p-4, -0x1.a3214p-1},
                                  {-0x1.0ae1000000001p-1, 0x1.185cffffffffcp-2, -0x1.ae7fffffffff7p-2},
                                  {-0x1.d0cp-1, -0x1.140a000000002p-3, -0x1.09457ffffffffp-1},
                                  {-0x1.c404800000001p-1, 0x1.e566690d49c96p-3, -0x1.9506c00038d5ep-1}}};
    for (const auto& [kind, pair] : {std::pair{PairKind::vertex_face, vertex_face}, std::pair{PairKind::edge_edge, edge_edge}})
        for (const double tolerance : {1e-6, 1e-9}) {
            const scalar::SearchResult found = scalar::certified_search(kind, pair[0].data(), SearchParameters{tolerance, 1.0, true});
            EXPECT_LE(found.toi, 1.0);
            EXPECT_EQ(found.roots, 0);
            EXPECT_GT(found.root_intervals, scalar::most_intervals - stacks) << "does not come to the cap: nothing was tested";
            EXPECT_LE(found.root_intervals, scalar::most_intervals + stacks);
        }
}

TEST(Bounded, IntervalsOfPublicData)
{
    const auto data = data_directory();
    if (!data) GTEST_SKIP() << no_data_message;
    Work queries, hardcases;
    for (const QuerySet& set : load_queries(*data)) queries.add(set.kind, set.pairs, 1e-9);
    for (const QuerySet& set : load_hardcases(*data)) hardcases.add(set.kind, set.pairs, 1e-9);
    queries.report("queries", 1e-9);
    hardcases.report("hardcases", 1e-9);
    EXPECT_EQ(hardcases.at_cap, 0u);
}

/// Allocations of the second of two equal calls: threads and their memory are there by then.
template <class Call>
std::size_t allocations_of(Call call)
{
    call();
    const std::size_t before = allocations();
    call();
    return allocations() - before;
}

TEST(Bounded, NoAllocationPerPair)
{
    constexpr std::size_t few = 16 * 1024, many = 512 * 1024;
    for (const unsigned threads : {1u, 2u}) {
        const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, threads};
        for (const auto kind : kinds) {
            std::vector<oracle::Pair> pairs;
            generate("simcloth", kind, 103, 4096, pairs);  // contacts, near misses and undecided pairs in plenty
            PairBuffer buffer{many};
            for (std::size_t i = 0; i < many; ++i) buffer.set(i, std::span<const double, 24>{pairs[i % pairs.size()][0].data(), 24});
            std::vector<double> toi(many);
            std::vector<std::uint8_t> roots(many);
            const auto dense = [&](std::size_t n) {
                return allocations_of([&] {
                    const Status status = time_of_impact(pair_kind(kind), PairView::blocked(buffer.data(), n), {},
                                                         std::span(toi).first(n), nullptr, std::span(roots).first(n));
                    ASSERT_TRUE(status.ok());
                });
            };
            const std::size_t for_few = dense(few), for_many = dense(many);
            std::printf("%s, %u threads: %zu allocations for %zu pairs, %zu for %zu\n", kind_name(kind), threads, for_few, few,
                        for_many, many);
            // What TBB allocates depends on how often work was stolen, not on the pairs.
            EXPECT_LE(for_few, 64u);
            EXPECT_LE(for_many, 64u);
            std::vector<Contact> contacts;
            contacts.reserve(many);
            const std::size_t compact = allocations_of([&] {
                contacts.clear();
                ASSERT_TRUE(find_contacts(pair_kind(kind), buffer.view(), {}, contacts).ok());
            });
            EXPECT_GT(contacts.size(), 1000u);
            EXPECT_GE(compact, 1u) << "the list of tiles is not counted: nothing is";
            EXPECT_LE(compact, 64u + 2 * 20 * threads + many / tile_pairs) << "lists grow by doubling, and a tile takes room for its contacts at most once";
        }
    }
}

/// Other ways to ask, of fewer pairs.
TEST(Bounded, NoAllocationPerPairInAnyCall)
{
    constexpr std::size_t size = 16 * 1024;
    const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, 2};
    for (const auto kind : kinds) {
        std::vector<oracle::Pair> pairs;
        generate("simcloth", kind, 103, size, pairs);
        const PairBuffer blocks = to_buffer(pairs);
        std::vector<double> arrays(pair_coordinates * (size + 8));
        std::array<const double*, pair_coordinates> columns{};
        for (std::size_t c = 0; c < pair_coordinates; ++c) columns[c] = &arrays[c * (size + 8)];
        std::vector<float> floats;
        for (std::size_t i = 0; i < size; ++i) {
            for (std::size_t c = 0; c < pair_coordinates; ++c) arrays[c * (size + 8) + i] = pairs[i][c / 3][c % 3];
            for (const auto& point : pairs[i])
                for (const double x : point) floats.push_back(static_cast<float>(x));
        }
        // So many pairs for each vertex, face and edge that boxes of theirs are made.
        constexpr std::size_t in_mesh = 1024;
        MeshOfPairs made{{pairs.begin(), pairs.begin() + in_mesh}};
        made.pair_with_others(size / in_mesh, 1);
        const MovingMesh mesh = made.mesh();
        std::vector<double> toi(size);
        const auto times = [&](const PairView& view, const Options& options) {
            return [&toi, view, options, kind] { ASSERT_TRUE(time_of_impact(pair_kind(kind), view, options, toi).ok()); };
        };
        Options separated, reference;
        separated.minimum_separation = 1e-6;
        reference.reference = true;
        const std::pair<const char*, std::function<void()>> calls[] = {
            {"interleaved", times(interleaved(pairs), {})},
            {"floats", times(PairView::interleaved(floats.data(), size), {})},
            {"strided", times(PairView::strided(columns, 1, size), {})},
            {"with a separation", times(blocks.view(), separated)},
            {"the certified search alone", times(blocks.view(), reference)},
            {"earliest",
             [&] {
                 Contact contact;
                 ASSERT_TRUE(earliest_contact(pair_kind(kind), blocks.view(), {}, contact).ok());
             }},
            {"indexed",
             [&] {
                 ASSERT_TRUE((kind == oracle::Kind::vertex_face ? time_of_impact(mesh, made.vertex_face, {}, toi)
                                                                : time_of_impact(mesh, made.edge_edge, {}, toi))
                                 .ok());
             }},
            {"step",
             [&] {
                 CollisionFreeStep step;
                 ASSERT_TRUE(collision_free_step(mesh, made.vertex_face, made.edge_edge, {}, step).ok());
             }},
        };
        for (const auto& [name, call] : calls) EXPECT_LE(allocations_of(call), 64u) << kind_name(kind) << ' ' << name;

        const std::size_t one_by_one = allocations_of([&] {
            for (const oracle::Pair& pair : pairs) {
                Point x0[4], x1[4];
                for (std::size_t p = 0; p < 4; ++p) x0[p] = pair[p], x1[p] = pair[4 + p];
                ASSERT_TRUE((kind == oracle::Kind::vertex_face ? vertex_face_toi(x0, x1) : edge_edge_toi(x0, x1)).status.ok());
            }
        });
        EXPECT_EQ(one_by_one, 0u) << kind_name(kind);
    }
}

}  // namespace
}  // namespace fastccd::testing
