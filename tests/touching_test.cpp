// Contact at a side, at an end, or next to the end of a leaf, which is reported without halving the leaf (kernels/touching.hpp): the verdict
// that halving would give, times that are not late, the same from lanes as from the search, and meshes on one grid at the lanes' speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>

#include <certified_search.hpp>
#include <kernel_table.hpp>
#include <leaf_search.hpp>

#include "amount.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"
#include "oracle/exact_distance.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

/// All families of hard pairs, and thin ones: look(pairs, name).
template <class Look>
void for_each_family(oracle::Kind kind, std::uint64_t seed, std::size_t count, Look look)
{
    std::vector<oracle::Pair> pairs;
    for (const std::string& family : families()) {
        generate(family, kind, seed, count, pairs);
        look(pairs, family);
    }
    pairs = ThinPairs{kind, seed}.next(count);
    look(pairs, "thin");
}

/// The leaves that hold s and lie on either side of it.
std::vector<scalar::Interval> leaves_around(double s, const SearchParameters& parameters)
{
    std::vector<scalar::Interval> leaves;
    for (int k = -1; k <= 1; ++k) {
        const double left = (std::floor(s * parameters.leaf_count) + k) * parameters.leaf_width;
        if (left > 0.0 && left + parameters.leaf_width <= 1.0) leaves.push_back({left, left + parameters.leaf_width});
    }
    return leaves;
}

/// Whether halving the leaf down to the spacing of doubles leaves a part without any certificate, eq. 7 included.
template <PairKind kind>
bool halving_reports(const scalar::PairPolynomials<kind>& pair, scalar::Interval leaf)
{
    scalar::IntervalStack stack;
    stack.push(leaf);
    for (int looks = 0; !stack.empty(); ++looks) {
        const scalar::Interval i = stack.pop();
        if (looks > 100000) return false;
        if (pair.apart(i) || pair.apart_by_area(i)) continue;
        if (i.width() <= i.a * 0x1p-52) return true;
        stack.push_halves(i);
    }
    return false;
}

template <PairKind kind>
void compare_with_halving(const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters, const std::string& what,
                          std::size_t& touches)
{
    std::mt19937_64 bits{811};
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        if (polynomials.apart()) continue;
        scalar::ExpectedContact expected{polynomials.coefficients(), parameters};
        const double near = expected.from(0.0);
        if (near == expected.nowhere) continue;
        for (const scalar::Interval leaf : leaves_around(near, parameters)) {
            const auto touch = polynomials.touch(leaf);
            if (!touch.present.value) continue;
            ++touches;
            ASSERT_TRUE(leaf.contains(touch.time) && leaf.contains(touch.lower_bound) && touch.lower_bound < touch.time)
                << what << ": " << lossless(pair);
            ASSERT_TRUE(polynomials.apart({leaf.a, touch.lower_bound})) << what << ": " << lossless(pair);
            ASSERT_TRUE(halving_reports(polynomials, leaf)) << what << ": " << lossless(pair);
            for (int k = 0; k < 8; ++k) {
                const double reach = leaf.width() * std::ldexp(1.0, -static_cast<int>(bits() % 40));
                const scalar::Interval around{std::max(touch.time - reach, leaf.a), std::min(touch.time + reach, leaf.b)};
                ASSERT_FALSE(polynomials.apart(around)) << what << ": " << lossless(pair);
            }
        }
    }
}

TEST(Touching, IsReportedByHalvingToo)
{
    for (const auto kind : kinds)
        for (const double tolerance : {1e-4, 1e-9, 1e-12})
            for (const double t_max : {1.0, 0.7}) {
                std::size_t touches = 0;
                const SearchParameters parameters{tolerance, t_max, false};
                for_each_family(kind, 812, amount(300), [&](const std::vector<oracle::Pair>& pairs, const std::string& family) {
                    if (kind == oracle::Kind::vertex_face)
                        compare_with_halving<PairKind::vertex_face>(pairs, parameters, family, touches);
                    else
                        compare_with_halving<PairKind::edge_edge>(pairs, parameters, family, touches);
                });
                std::printf("%s, E_tol %g, t_max %g: %zu leaves in which pairs touch\n", kind_name(kind), tolerance, t_max, touches);
                EXPECT_GT(touches, amount(500));
            }
}

template <PairKind kind>
void compare_with_exact_times(oracle::Kind exact_kind, const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters,
                              const std::string& what, std::size_t& touches)
{
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        const scalar::SearchResult found = scalar::certified_search(kind, pair[0].data(), parameters);
        if (!std::isfinite(found.toi) || !(found.toi > 0.0)) continue;
        const double left = std::floor(found.toi * parameters.leaf_count) * parameters.leaf_width;
        const auto touch = polynomials.touch({left, left + parameters.leaf_width});
        if (!touch.present.value || touch.lower_bound != found.toi) continue;
        const oracle::Verdict exact = oracle::exact_ccd(exact_kind, pair);
        if (!exact.contact) continue;
        ++touches;
        ASSERT_LE(found.toi, exact.t_hi) << what << ": " << lossless(pair);
        ASSERT_LE(exact.t_lo - found.toi, parameters.leaf_width) << what << ": " << lossless(pair);
    }
}

/// Never later than the exact first contact, nor earlier than that by more than the tolerance.
TEST(Touching, TimesAreNeitherLateNorEarly)
{
    for (const auto kind : kinds)
        for (const double tolerance : {1e-4, 1e-9, 1e-12}) {
            std::size_t touches = 0;
            const SearchParameters parameters{tolerance, 1.0, false};
            for (const char* family : {"boundary", "f32_boundary", "f32_near_boundary", "collinear", "zero_cubic", "parallel_vel", "binarygrid"}) {
                std::vector<oracle::Pair> pairs;
                generate(family, kind, 813, amount(300), pairs);
                if (kind == oracle::Kind::vertex_face)
                    compare_with_exact_times<PairKind::vertex_face>(kind, pairs, parameters, family, touches);
                else
                    compare_with_exact_times<PairKind::edge_edge>(kind, pairs, parameters, family, touches);
            }
            std::printf("%s, E_tol %g: %zu pairs touch\n", kind_name(kind), tolerance, touches);
            EXPECT_GT(touches, amount(100));
        }
}

/// Largest exact distance at a touch, relative to the norm of the extents at both ends.
template <PairKind kind>
double farthest_touch(oracle::Kind exact_kind, const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters, std::size_t& touches)
{
    double farthest = 0.0;
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        scalar::ExpectedContact expected{polynomials.coefficients(), parameters};
        for (double near = expected.from(0.0); near != expected.nowhere; near = expected.from(std::nextafter(near, 2.0)))
            for (const scalar::Interval leaf : leaves_around(near, parameters)) {
                const auto touch = polynomials.touch(leaf);
                if (!touch.present.value) continue;
                ++touches;
                double size_squared = 0.0;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    double extent = 0.0;
                    for (const std::size_t end : {0u, 4u})
                        for (std::size_t i = 1; i < 4; ++i) extent = std::max(extent, std::abs(pair[end + i][axis] - pair[end][axis]));
                    size_squared += extent * extent;
                }
                const mpq_class distance_squared = oracle::squared_distance(exact_kind, pair, touch.time);
                farthest = std::max(farthest, std::sqrt(distance_squared.get_d() / size_squared));
            }
    }
    return farthest;
}

/// Who touches is as close as pairs of ordinary shape are where they are reported (README): of pairs whose volumes and areas are lost
/// in rounding nothing is concluded from them.
TEST(Touching, IsNoFartherThanRoundingHides)
{
    for (const auto kind : kinds) {
        double farthest = 0.0;
        std::size_t touches = 0;
        const SearchParameters parameters{1e-9, 1.0, false};
        const auto look = [&](const std::vector<oracle::Pair>& pairs) {
            const double here = kind == oracle::Kind::vertex_face
                                    ? farthest_touch<PairKind::vertex_face>(kind, pairs, parameters, touches)
                                    : farthest_touch<PairKind::edge_edge>(kind, pairs, parameters, touches);
            farthest = std::max(farthest, here);
        };
        look(ThinPairs{kind, 815}.next(amount(60000)));
        std::vector<oracle::Pair> pairs;
        for (const char* family : {"near_boundary", "parallel_slide", "momentary_degenerate", "collinear", "t1_contact", "grazing"}) {
            generate(family, kind, 816, amount(2000), pairs);
            look(pairs);
        }
        std::printf("%s: %zu touches, at a distance of %.2g u of the pair's size or less\n", kind_name(kind), touches, farthest * 0x1p53);
        EXPECT_LE(farthest, 0x1p10 * 0x1p-53);
        EXPECT_GT(touches, amount(3000));
    }
}

/// The two edges of a pair, and the ends of each, are in no particular order.
TEST(Touching, ShapeDoesNotDependOnTheOrderOfEdges)
{
    const SearchParameters parameters{1e-9, 1.0, false};
    std::size_t with_area = 0, without = 0, both = 0;
    std::mt19937_64 bits{817};
    for_each_family(oracle::Kind::edge_edge, 818, amount(200), [&](const std::vector<oracle::Pair>& pairs, const std::string&) {
        constexpr std::size_t orders[][4] = {{0, 1, 2, 3}, {2, 3, 0, 1}, {1, 0, 2, 3}, {3, 2, 0, 1}};
        for (const oracle::Pair& pair : pairs) {
            const double s = std::ldexp(static_cast<double>(bits() >> 11), -53);
            unsigned shaped = 0;
            for (const auto& order : orders) {
                oracle::Pair other;
                for (std::size_t i = 0; i < 4; ++i) other[i] = pair[order[i]], other[4 + i] = pair[4 + order[i]];
                shaped += scalar::PairPolynomials<PairKind::edge_edge>{other[0].data(), parameters}.has_area(s);
            }
            ++(shaped == 4 ? with_area : shaped == 0 ? without : both);
        }
    });
    std::printf("%zu pairs of edges with an area, %zu without, %zu as they are written\n", with_area, without, both);
    // What the area is compared with does depend on which end comes first: on the differences to it.
    EXPECT_LT(20 * both, with_area + without);
    EXPECT_GT(without, amount(1000));
}

struct Compared {
    std::size_t asked = 0, reported = 0, in_next = 0, proven = 0;
};

/// Asks lanes for the leaf that the search answers with, and for the one before it.
template <PairKind kind>
void compare_lanes(const KernelTable& kernels, const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters,
                   const std::string& what, Compared& seen)
{
    LeafAnswers answers;
    alignas(64) double block[pair_coordinates][block_pairs];
    std::vector<const oracle::Pair*> asked;
    std::vector<scalar::SearchResult> expected;
    const auto compare = [&] {
        for (std::size_t lane = 0; lane < block_pairs; ++lane) {
            const std::size_t i = std::min(lane, asked.size() - 1);
            for (std::size_t c = 0; c < pair_coordinates; ++c) block[c][lane] = (*asked[i])[c / 3][c % 3];
            if (lane > i) answers.left[lane] = answers.left[i];
        }
        kernels.contact_in_leaves(kind, block[0], parameters, answers);
        for (std::size_t i = 0; i < asked.size(); ++i) {
            ++seen.asked;
            if ((answers.reported >> i & 1) == 0) continue;
            const bool proven = (answers.proven >> i & 1) != 0;
            ASSERT_EQ(parameters.time(answers.time[i]), expected[i].toi) << what << ": " << lossless(*asked[i]);
            ASSERT_EQ(proven, expected[i].proof != scalar::Proof::none) << what << ": " << lossless(*asked[i]);
            ++seen.reported;
            seen.in_next += answers.time[i] >= answers.left[i] + parameters.leaf_width;
            seen.proven += proven;
        }
        asked.clear();
        expected.clear();
    };
    for (const oracle::Pair& pair : pairs) {
        const scalar::SearchResult found = scalar::certified_search(kind, pair[0].data(), parameters);
        // Of a pair that is apart, where contact would be.
        const double near = std::isfinite(found.toi)
                                ? found.toi / parameters.t_max
                                : scalar::ExpectedContact{scalar::PairPolynomials<kind>{pair[0].data(), parameters}.coefficients(), parameters}.from(0.0);
        if (!std::isfinite(near)) continue;
        for (const scalar::Interval leaf : leaves_around(near, parameters)) {
            if (parameters.time(leaf.a) > found.toi) continue;  // lanes ask only where the search comes to
            answers.left[asked.size()] = leaf.a;
            asked.push_back(&pair);
            expected.push_back(found);
            if (asked.size() == block_pairs) compare();
            if (::testing::Test::HasFatalFailure()) return;
        }
    }
    if (!asked.empty()) compare();
}

TEST(Touching, LanesReportWhatTheSearchDoes)
{
    for (const Isa isa : isas_to_test())
        for (const auto kind : kinds) {
            Compared seen;
            for (const double tolerance : {1e-4, 1e-9, 1e-12, 0x1p-44})
                for (const double t_max : {1.0, 0.7}) {
                    const SearchParameters parameters{tolerance, t_max, false};
                    for_each_family(kind, 814, amount(160), [&](const std::vector<oracle::Pair>& pairs, const std::string& family) {
                        if (kind == oracle::Kind::vertex_face)
                            compare_lanes<PairKind::vertex_face>(*kernel_table(isa), pairs, parameters, family, seen);
                        else
                            compare_lanes<PairKind::edge_edge>(*kernel_table(isa), pairs, parameters, family, seen);
                    });
                    if (HasFatalFailure()) return;
                }
            std::printf("%s, %s: %zu of %zu reported, %zu of them in the leaf after, %zu proven\n", name(isa), kind_name(kind), seen.reported,
                        seen.asked, seen.in_next, seen.proven);
            EXPECT_GT(seen.reported, amount(10000));
            EXPECT_GT(seen.in_next, amount(1000));
            EXPECT_GT(seen.proven, amount(1000));
        }
}

/// A square grid of points in the plane z = 0, turned and moved.
struct Grid {
    int side;
    std::vector<double> start, end;
    std::vector<std::int32_t> faces, edges;

    /// Two of them, the upper one, moved by `shift` along its rows, falls through the lower one; `turn` about the vertical axis.
    Grid(int points, double turn, double shift, double fall, bool single) : side{points}
    {
        for (int sheet = 0; sheet < 2; ++sheet) {
            const auto base = static_cast<std::int32_t>(sheet * side * side);
            for (int i = 0; i < side; ++i)
                for (int j = 0; j < side; ++j) {
                    const auto put = [&](std::vector<double>& to, double x) { to.push_back(single ? static_cast<float>(x) : x); };
                    const double row = i + sheet * shift;
                    const double x = std::cos(turn) * row - std::sin(turn) * j, y = std::sin(turn) * row + std::cos(turn) * j;
                    for (std::vector<double>* ends : {&start, &end}) {
                        put(*ends, x);
                        put(*ends, y);
                        put(*ends, sheet == 0 ? 0.0 : ends == &start ? 1.0 : 1.0 - fall);
                    }
                    const std::int32_t k = base + i * side + j;
                    if (i + 1 < side) edges.insert(edges.end(), {k, k + side});
                    if (j + 1 < side) edges.insert(edges.end(), {k, k + 1});
                    if (i + 1 < side && j + 1 < side) {
                        edges.insert(edges.end(), {k + 1, k + side});
                        faces.insert(faces.end(), {k, k + 1, k + side, k + 1, k + side + 1, k + side});
                    }
                }
        }
    }

    [[nodiscard]] MovingMesh mesh() const
    {
        const std::size_t vertices = start.size() / 3;
        return {PositionView::rows(start.data(), vertices), PositionView::rows(end.data(), vertices),
                IndexView::rows(faces.data(), faces.size() / 3, 3), IndexView::rows(edges.data(), edges.size() / 2, 2)};
    }
};

/// Of the upper sheet against what begins in the same cell of the lower one or next to it, by the first vertex of primitive i.
template <class Pair>
std::vector<Pair> neighbours(const Grid& grid, std::size_t first_begin, std::size_t first_end, std::size_t second_end, auto first_vertex,
                             auto second_vertex)
{
    std::vector<Pair> pairs;
    const int sheet = grid.side * grid.side;
    for (std::size_t a = first_begin; a < first_end; ++a)
        for (std::size_t b = 0; b < second_end; ++b) {
            const int v = first_vertex(a) - sheet, w = second_vertex(b);
            if (v < 0 || w >= sheet) continue;
            if (std::abs(v / grid.side - w / grid.side) > 1 || std::abs(v % grid.side - w % grid.side) > 1) continue;
            pairs.push_back({static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)});
        }
    return pairs;
}

template <class Pairs>
void expect_no_search(const Grid& grid, const Pairs& pairs, double tolerance, double t_max, const std::string& what)
{
    Options options;
    options.tolerance = tolerance;
    options.t_max = t_max;
    options.reference = true;
    std::vector<double> expected(pairs.size()), found(pairs.size());
    const MovingMesh mesh = grid.mesh();
    Summary searched, summary;
    ASSERT_TRUE(time_of_impact(mesh, pairs, options, expected, &searched).ok());
    EXPECT_GT(searched.contacts, pairs.size() / 16) << what;
    options.reference = false;
    for (const Isa isa : isas_to_test()) {
        options.isa = isa;
        ASSERT_TRUE(time_of_impact(mesh, pairs, options, found, &summary).ok());
        EXPECT_EQ(0, std::memcmp(expected.data(), found.data(), found.size() * sizeof(double))) << what << ' ' << name(isa);
        EXPECT_EQ(searched.proven, summary.proven) << what << ' ' << name(isa);
        EXPECT_LE(100 * summary.scalar_pairs, pairs.size()) << what << ' ' << name(isa) << ": of " << searched.contacts << " contacts";
    }
}

/// Each of these contacts is at a side, an end, or along a whole edge: a microsecond each, if they were left to the search.
TEST(Touching, MeshesOnOneGridAreDecidedByLanes)
{
    struct Place {
        double turn, shift;
    };
    for (const bool single : {false, true})
        for (const auto& [turn, shift] : {Place{0.0, 0.0}, {0.3, 0.0}, {0.0, 0.5}, {0.0, 0.25}})
            for (const double fall : {2.0, 1.7})  // at 0.5, between two leaves, and anywhere
                for (const double tolerance : {1e-6, 1e-9, 1e-12})
                    for (const double t_max : {1.0, 0.9}) {
                        const Grid grid{12, turn, shift, fall, single};
                        const std::string what = "turn " + std::to_string(turn) + ", shift " + std::to_string(shift) + ", fall " +
                                                 std::to_string(fall) + ", E_tol " + std::to_string(std::log10(tolerance)) + ", t_max " +
                                                 std::to_string(t_max);
                        const auto sheet = static_cast<std::size_t>(grid.side * grid.side);
                        const auto edge_start = [&](std::size_t e) { return grid.edges[2 * e]; };
                        const auto vf = neighbours<VertexFace>(grid, sheet, 2 * sheet, grid.faces.size() / 3,
                                                               [](std::size_t v) { return static_cast<int>(v); },
                                                               [&](std::size_t f) { return grid.faces[3 * f]; });
                        const auto ee = neighbours<EdgeEdge>(grid, 0, grid.edges.size() / 2, grid.edges.size() / 2, edge_start, edge_start);
                        expect_no_search(grid, vf, tolerance, t_max, "vertex-face " + what);
                        expect_no_search(grid, ee, tolerance, t_max, "edge-edge " + what);
                    }
}

}  // namespace
}  // namespace fastccd::testing
