// The boxes of a mesh's primitives: apart only with a gap at both ends, in exact numbers, and the same bits with them as without.
#include <gtest/gtest.h>

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <lane.hpp>
#include <mesh_boxes.hpp>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "amount.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

using Random = std::mt19937_64;

/// Coordinate `axis` of a vertex, at the start (0) and the end (1) of the step; `at` is a random point of [-1, 1]^3 near which
/// the primitive of the vertex lies.
using Coordinate = std::function<double(Random&, const double (&at)[3], int axis, int end)>;

double uniform(Random& random, double low, double high) { return std::uniform_real_distribution<double>{low, high}(random); }

double spread(Random& random, const double (&at)[3], int axis, int) { return at[axis] + uniform(random, -0.1, 0.1); }

struct Style {
    const char* name;
    Coordinate coordinate;
};

const Style styles[] = {
    {"spread", spread},
    {"integers, touching", [](Random& random, const double (&at)[3], int axis, int) {
         return std::round(4 * at[axis]) + std::round(uniform(random, -1, 1));
     }},
    {"on and beside the lines of the grid", [](Random&, const double (&at)[3], int axis, int) {
         // Primitives that are points, the outermost at -1.25 and 1.25: lines are at multiples of a cell.
         if (axis != 0) return 0.0;
         if (std::abs(at[0]) > 0.9) return std::copysign(1.25, at[0]);
         constexpr double beside[] = {0.0, 1e-9, 0.3, 0.5, 0.999, -1e-9};
         return (std::round(2 * at[1]) + beside[static_cast<std::size_t>(std::abs(at[2]) * 5.99)]) * (1.25 / grid_cells);
     }},
    {"far from the origin", [](Random& random, const double (&at)[3], int axis, int end) {
         return 1e6 + 1e-7 * spread(random, at, axis, end);
     }},
    {"a different scale along each axis", [](Random& random, const double (&at)[3], int axis, int end) {
         return spread(random, at, axis, end) * (axis == 0 ? 1e-250 : axis == 1 ? 1.0 : 1e300);
     }},
    {"flat", [](Random& random, const double (&at)[3], int axis, int end) { return axis == 2 ? 0.25 : spread(random, at, axis, end); }},
    {"too small for a grid", [](Random& random, const double (&at)[3], int axis, int end) {
         return 1e-306 * spread(random, at, axis, end);
     }},
    {"as wide as double", [](Random& random, const double (&at)[3], int axis, int end) {
         return std::clamp(1.7e308 * spread(random, at, axis, end), -1.7e308, 1.7e308);
     }},
    {"fast, passing one another", [](Random& random, const double (&at)[3], int axis, int end) {
         return (axis == end ? -1.0 : 1.0) * spread(random, at, axis, end);
     }},
};

/// Separate primitives, and more pairs of them, picked at random, than there are primitives.
struct Soup {
    oracle::Kind kind;
    std::vector<double> start, end;            // n x 3
    std::vector<std::int32_t> primitives;      // 3 a face, 2 an edge
    std::vector<std::array<std::int32_t, 2>> pairs;

    Soup(oracle::Kind k, const Coordinate& coordinate, std::uint64_t seed, std::int32_t count = 60) : kind{k}
    {
        Random random{seed};
        const std::int32_t corners = kind == oracle::Kind::vertex_face ? 3 : 2;
        for (std::int32_t i = 0; i < count; ++i) {
            const double at[3] = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
            for (std::int32_t corner = 0; corner < corners; ++corner) {
                primitives.push_back(corners * i + corner);
                for (int axis = 0; axis < 3; ++axis) start.push_back(coordinate(random, at, axis, 0));
                for (int axis = 0; axis < 3; ++axis) end.push_back(coordinate(random, at, axis, 1));
            }
        }
        pick_pairs(random);
    }

    /// Of the points of generated pairs of every family: four vertices each.
    Soup(oracle::Kind k, std::uint64_t seed) : kind{k}
    {
        Random random{seed};
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> made;
            generate(family, kind, seed, 3, made);
            for (const oracle::Pair& pair : made) {
                const auto base = static_cast<std::int32_t>(start.size() / 3);
                for (std::size_t p = 0; p < 4; ++p) {
                    start.insert(start.end(), pair[p].begin(), pair[p].end());
                    end.insert(end.end(), pair[4 + p].begin(), pair[4 + p].end());
                }
                if (kind == oracle::Kind::vertex_face) {
                    pairs.push_back({base, static_cast<std::int32_t>(primitives.size() / 3)});
                    primitives.insert(primitives.end(), {base + 1, base + 2, base + 3});
                } else {
                    const auto edge = static_cast<std::int32_t>(primitives.size() / 2);
                    pairs.push_back({edge, edge + 1});
                    primitives.insert(primitives.end(), {base, base + 1, base + 2, base + 3});
                }
            }
        }
        pick_pairs(random);
    }

    [[nodiscard]] std::size_t vertex_count() const { return start.size() / 3; }
    [[nodiscard]] std::size_t corners() const { return kind == oracle::Kind::vertex_face ? 3 : 2; }
    [[nodiscard]] IndexView rows() const
    {
        return IndexView::rows(primitives.data(), primitives.size() / corners(), static_cast<int>(corners()));
    }
    [[nodiscard]] MovingMesh mesh() const
    {
        return {PositionView::rows(start.data(), vertex_count()), PositionView::rows(end.data(), vertex_count()),
                kind == oracle::Kind::vertex_face ? rows() : IndexView{}, kind == oracle::Kind::vertex_face ? IndexView{} : rows()};
    }
    [[nodiscard]] IndexedSource source(const MovingMesh& mesh) const
    {
        return {mesh.records(), pairs[0].data(), primitives.data(), static_cast<std::ptrdiff_t>(corners()), 1, vertex_count(),
                primitives.size() / corners(), {}};
    }

    /// Vertices of the first (0) or second (1) primitive of a pair.
    [[nodiscard]] std::vector<std::size_t> vertices(const std::array<std::int32_t, 2>& pair, std::size_t which) const
    {
        const auto id = static_cast<std::size_t>(pair[which]);
        if (kind == oracle::Kind::vertex_face && which == 0) return {id};
        std::vector<std::size_t> result;
        for (std::size_t k = 0; k < corners(); ++k) result.push_back(static_cast<std::size_t>(primitives[corners() * id + k]));
        return result;
    }

    [[nodiscard]] std::vector<oracle::Pair> packed() const
    {
        std::vector<oracle::Pair> result;
        for (const auto& pair : pairs) {
            std::vector<std::size_t> points = vertices(pair, 0);
            for (const std::size_t vertex : vertices(pair, 1)) points.push_back(vertex);
            oracle::Pair& made = result.emplace_back();
            for (std::size_t p = 0; p < 4; ++p)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    made[p][axis] = start[3 * points[p] + axis];
                    made[4 + p][axis] = end[3 * points[p] + axis];
                }
        }
        return result;
    }

    [[nodiscard]] Answer answer(const Options& options) const
    {
        Answer found;
        found.toi.resize(pairs.size());
        found.roots.resize(pairs.size());
        const MovingMesh moving = mesh();
        const auto call = [&]<class Pair>(std::vector<Pair> list) {
            for (const auto& pair : pairs) list.push_back({pair[0], pair[1]});
            const Status status = time_of_impact(moving, std::span<const Pair>{list}, options, found.toi, &found.summary, found.roots);
            EXPECT_TRUE(status.ok()) << message(status.error);
        };
        if (kind == oracle::Kind::vertex_face)
            call(std::vector<VertexFace>{});
        else
            call(std::vector<EdgeEdge>{});
        return found;
    }

private:
    void pick_pairs(Random& random)
    {
        const std::size_t count = 4 * (vertex_count() + primitives.size() / corners());
        const auto any_below = [&](std::size_t size) { return static_cast<std::int32_t>(random() % size); };
        while (pairs.size() < count) {
            const std::size_t first_size = kind == oracle::Kind::vertex_face ? vertex_count() : primitives.size() / 2;
            pairs.push_back({any_below(first_size), any_below(primitives.size() / corners())});
        }
        std::shuffle(pairs.begin(), pairs.end(), random);
    }
};

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

/// Largest gap along any axis, in one and the same order at both ends, and its axis; exact. -1 if there is none.
struct Gap {
    mpq_class size = -1;
    std::size_t axis = 0;
};

Gap largest_gap(const Soup& soup, const std::array<std::int32_t, 2>& pair)
{
    Gap best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto gap = [&](std::size_t below, std::size_t above, const std::vector<double>& positions) {
            const auto of = [&](std::size_t which) {
                std::vector<double> values;
                for (const std::size_t vertex : soup.vertices(pair, which)) values.push_back(positions[3 * vertex + axis]);
                return values;
            };
            const auto lower = of(below), upper = of(above);
            return mpq_class{mpq_class{*std::min_element(upper.begin(), upper.end())} - mpq_class{*std::max_element(lower.begin(), lower.end())}};
        };
        for (const std::size_t below : {0u, 1u}) {
            const mpq_class smaller = std::min(gap(below, 1 - below, soup.start), gap(below, 1 - below, soup.end));
            if (smaller > best.size) best = {smaller, axis};
        }
    }
    return best;
}

/// A cell of the grid along an axis.
mpq_class cell(const Soup& soup, std::size_t axis)
{
    double low = soup.start[axis], high = low;
    for (const auto* positions : {&soup.start, &soup.end})
        for (std::size_t i = axis; i < positions->size(); i += 3) {
            low = std::min(low, (*positions)[i]);
            high = std::max(high, (*positions)[i]);
        }
    return (mpq_class{high} - mpq_class{low}) / mpq_class{2 * grid_cells};
}

/// Whether the grid tells primitives apart along an axis.
bool counts(const Soup& soup, std::size_t axis, double distance)
{
    const mpq_class step = cell(soup, axis), longest = std::max({cell(soup, 0), cell(soup, 1), cell(soup, 2)});
    return step > mpq_class{0x1p-890} / grid_cells &&
           (distance == 0.0 || (mpq_class{distance} < 32000 * step && step > 2 * mpq_class{shortest_axis} * longest));
}

void expect_apart_only_with_a_gap(const Soup& soup, double distance, std::size_t& apart)
{
    const MovingMesh mesh = soup.mesh();
    const PairKind kind = pair_kind(soup.kind);
    MeshBoxes boxes;
    const BoxScreen screen = boxes.screen(kind, soup.source(mesh), soup.pairs.size(), distance);
    ASSERT_NE(screen.first, nullptr);
    for (const auto& pair : soup.pairs) {
        using One = portable::Lane<double>;
        const bool found = One::apart(One::first_box(screen.first[pair[0]], screen.separation), screen.second[pair[1]]);
        const Gap gap = largest_gap(soup, pair);
        const mpq_class beyond = gap.size - mpq_class{distance}, step = cell(soup, gap.axis);
        if (found) {
            ++apart;
            EXPECT_GT(beyond, 0.99 * step);
        } else if (counts(soup, gap.axis, distance)) {
            EXPECT_LT(beyond, 3.01 * step);  // a gap of three cells is always seen
        }
    }
}

TEST(Boxes, ApartOnlyWithAGapAtBothEnds)
{
    for (const auto kind : kinds)
        for (const Style& style : styles)
            for (const double distance : {0.0, 1e-12, 7.8e-5, 1.17e-4, 0.01, 0.2, 1e10}) {
                SCOPED_TRACE(style.name);
                std::size_t apart = 0;
                expect_apart_only_with_a_gap(Soup{kind, style.coordinate, 11}, distance, apart);
                if (style.name == std::string{"spread"} && distance < 0.1) {
                    EXPECT_GT(apart, 100u);
                }
            }
}

void expect_same_bits(const Soup& soup, Options options)
{
    const auto packed = soup.packed();
    options.reference = true;
    const Answer expected = answer(soup.kind, interleaved(packed), options);
    options.reference = false;
    for (const Isa isa : isas_to_test()) {
        options.isa = isa;
        const Answer found = soup.answer(options);
        const std::size_t i = first_difference(expected, found);
        EXPECT_EQ(i, packed.size()) << name(isa) << ": " << lossless(packed[i]);
        EXPECT_EQ(expected.summary.contacts, found.summary.contacts);
        EXPECT_EQ(expected.summary.proven, found.summary.proven);
        EXPECT_EQ(expected.summary.invalid, found.summary.invalid);
        EXPECT_EQ(expected.summary.earliest.pair, found.summary.earliest.pair);
    }
}

std::vector<Soup> soups(oracle::Kind kind)
{
    std::vector<Soup> made;
    for (const Style& style : styles) made.emplace_back(kind, style.coordinate, 12);
    made.emplace_back(kind, 13);
    return made;
}

TEST(Boxes, SameBitsAsTheCertifiedSearch)
{
    for (const auto kind : kinds)
        for (const Soup& soup : soups(kind))
            for (const double t_max : {1.0, 0.3}) {
                Options options;
                options.t_max = t_max;
                expect_same_bits(soup, options);
            }
}

TEST(Boxes, SameBitsWithAMinimumSeparation)
{
    for (const auto kind : kinds)
        for (const Soup& soup : soups(kind))
            for (const double distance : {1e-300, 1e-9, 0.05, 1.0, 1e300}) {
                Options options;
                options.minimum_separation = distance;
                SCOPED_TRACE(distance);
                expect_same_bits(soup, options);
            }
}

TEST(Boxes, CoordinatesThatAreNotFiniteAreNamedAsWithoutBoxes)
{
    for (const auto kind : kinds)
        for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity()})
            for (const bool at_end : {false, true}) {
                Soup soup{kind, spread, 14};
                (at_end ? soup.end : soup.start)[100] = bad;
                Options options;
                options.reference = true;
                EXPECT_GT(answer(kind, interleaved(soup.packed()), options).summary.invalid, 0u);
                expect_same_bits(soup, {});
            }
}

/// The vertices of a large mesh are looked at in parts, by several threads.
TEST(Boxes, EveryPartOfALargeMeshCounts)
{
    const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, 4};
    Soup soup{oracle::Kind::vertex_face, spread, 16, 20'000};
    // The outermost, and the one that is not finite, are of the last parts.
    for (int axis = 0; axis < 3; ++axis) {
        soup.end[soup.end.size() - 3 - 6000 - static_cast<std::size_t>(axis)] = -10.0;
        soup.end[soup.end.size() - 3 - static_cast<std::size_t>(axis)] = 10.0;
    }
    Soup other = soup;
    other.start.back() = std::numeric_limits<double>::quiet_NaN();
    const MovingMesh mesh = soup.mesh(), not_finite = other.mesh();
    const IndexedSource source = soup.source(mesh), source_not_finite = other.source(not_finite);
    const auto screen = [&](const IndexedSource& asked, int threads) {
        MeshBoxes boxes;
        return tbb::task_arena{threads}.execute([&] { return boxes.screen(PairKind::vertex_face, asked, 1'000'000, 0.125); });
    };
    const BoxScreen expected = screen(source, 1);
    for (std::size_t i = 0; i < amount(400); ++i) {
        const BoxScreen found = screen(source, 4);
        for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(found.separation[axis], expected.separation[axis]);
        ASSERT_EQ(screen(source_not_finite, 4).first, nullptr);
    }
}

TEST(Boxes, MadeWhenACallBringsManyPairsAndKept)
{
    const Soup soup{oracle::Kind::vertex_face, spread, 15};
    const MovingMesh mesh = soup.mesh();
    const IndexedSource source = soup.source(mesh);
    MeshBoxes boxes;
    EXPECT_EQ(boxes.screen(PairKind::vertex_face, source, soup.vertex_count(), 0.0).first, nullptr);
    const GridBox* const made = boxes.screen(PairKind::vertex_face, source, soup.pairs.size(), 0.0).first;
    ASSERT_NE(made, nullptr);
    EXPECT_EQ(boxes.screen(PairKind::vertex_face, source, 1, 0.1).first, made);
}

}  // namespace
}  // namespace fastccd::testing
