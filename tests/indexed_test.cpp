// Indexed pairs: the same bits as packed ones, from any storage of the positions; the earliest contact; errors.
#include <gtest/gtest.h>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "generators.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

/// A mesh made of the four points of every generated pair, twice over: vertices of both kinds of pairs, faces
/// (x1 x2 x3) and edges (x0 x1), (x2 x3), and candidate pairs in a shuffled order that share vertices.
struct MadeMesh {
    std::vector<double> start, end;  // n x 3
    std::vector<std::int32_t> faces, edges;
    std::vector<VertexFace> vertex_face;
    std::vector<EdgeEdge> edge_edge;

    explicit MadeMesh(std::uint64_t seed, std::size_t per_family = 23)
    {
        std::mt19937_64 random{seed};
        for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
            for (const std::string& family : families()) {
                std::vector<oracle::Pair> pairs;
                generate(family, kind, seed, per_family, pairs);
                for (const oracle::Pair& pair : pairs) add(kind, pair);
            }
        std::shuffle(vertex_face.begin(), vertex_face.end(), random);
        std::shuffle(edge_edge.begin(), edge_edge.end(), random);
    }

    [[nodiscard]] std::size_t vertices() const { return start.size() / 3; }
    [[nodiscard]] IndexView face_view() const { return IndexView::rows(faces.data(), faces.size() / 3, 3); }
    [[nodiscard]] IndexView edge_view() const { return IndexView::rows(edges.data(), edges.size() / 2, 2); }
    [[nodiscard]] MovingMesh mesh() const
    {
        return {PositionView::rows(start.data(), vertices()), PositionView::rows(end.data(), vertices()), face_view(), edge_view()};
    }

    template <class Pairs>
    [[nodiscard]] std::vector<oracle::Pair> packed(const Pairs& pairs) const
    {
        std::vector<oracle::Pair> result;
        for (const auto& pair : pairs) result.push_back(points(vertices_of(pair)));
        return result;
    }

private:
    void add(oracle::Kind kind, const oracle::Pair& pair)
    {
        const auto base = static_cast<std::int32_t>(vertices());
        for (std::size_t p = 0; p < 4; ++p)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                start.push_back(pair[p][axis]);
                end.push_back(pair[4 + p][axis]);
            }
        if (kind == oracle::Kind::vertex_face) {
            vertex_face.push_back({base, static_cast<std::int32_t>(faces.size() / 3)});
            faces.insert(faces.end(), {base + 1, base + 2, base + 3});
        } else {
            const auto edge = static_cast<std::int32_t>(edges.size() / 2);
            edges.insert(edges.end(), {base, base + 1, base + 2, base + 3});
            edge_edge.push_back({edge, edge + 1});
        }
    }
    [[nodiscard]] std::array<std::int32_t, 4> vertices_of(VertexFace pair) const
    {
        const auto f = 3 * static_cast<std::size_t>(pair.face);
        return {pair.vertex, faces[f], faces[f + 1], faces[f + 2]};
    }
    [[nodiscard]] std::array<std::int32_t, 4> vertices_of(EdgeEdge pair) const
    {
        const auto a = 2 * static_cast<std::size_t>(pair.edge_a), b = 2 * static_cast<std::size_t>(pair.edge_b);
        return {edges[a], edges[a + 1], edges[b], edges[b + 1]};
    }
    [[nodiscard]] oracle::Pair points(const std::array<std::int32_t, 4>& vertex) const
    {
        oracle::Pair pair;
        for (std::size_t p = 0; p < 4; ++p)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                pair[p][axis] = start[3 * static_cast<std::size_t>(vertex[p]) + axis];
                pair[4 + p][axis] = end[3 * static_cast<std::size_t>(vertex[p]) + axis];
            }
        return pair;
    }
};

template <class Pair>
constexpr oracle::Kind kind_of = std::is_same_v<Pair, VertexFace> ? oracle::Kind::vertex_face : oracle::Kind::edge_edge;

template <class Pair>
Answer indexed_answer(const MovingMesh& mesh, const std::vector<Pair>& pairs, const Options& options)
{
    Answer found;
    found.toi.resize(pairs.size());
    found.roots.resize(pairs.size());
    const Status status = time_of_impact(mesh, std::span<const Pair>{pairs}, options, found.toi, &found.summary, found.roots);
    EXPECT_TRUE(status.ok()) << message(status.error);
    return found;
}

template <class Pair>
void expect_same_as_packed(const MadeMesh& made, const MovingMesh& mesh, const std::vector<Pair>& pairs)
{
    const auto packed = made.packed(pairs);
    for (const Isa isa : isas_to_test()) {
        Options options;
        options.isa = isa;
        const Answer expected = answer(kind_of<Pair>, interleaved(packed), options);
        const Answer found = indexed_answer(mesh, pairs, options);
        EXPECT_EQ(first_difference(expected, found), pairs.size()) << name(isa);
        EXPECT_EQ(expected.summary.contacts, found.summary.contacts);

        std::vector<Contact> contacts;
        ASSERT_TRUE(find_contacts(mesh, std::span<const Pair>{pairs}, options, contacts).ok());
        EXPECT_EQ(contacts.size(), expected.summary.contacts);
        for (const Contact& contact : contacts) EXPECT_EQ(contact.toi, expected.toi[contact.pair]);
    }
}

TEST(Indexed, SameBitsAsPacked)
{
    const MadeMesh made{61};
    const MovingMesh mesh = made.mesh();
    ASSERT_TRUE(mesh.status().ok());
    expect_same_as_packed(made, mesh, made.vertex_face);
    expect_same_as_packed(made, mesh, made.edge_edge);
    for (const std::size_t size : {1u, 3u, 7u, 8u, 9u, 1023u, 1025u})
        expect_same_as_packed(made, mesh, std::vector<VertexFace>(made.vertex_face.begin(), made.vertex_face.begin() + static_cast<std::ptrdiff_t>(size)));
}

TEST(Indexed, AnyStorageOfPositionsAndIndices)
{
    const MadeMesh made{62};
    const std::size_t n = made.vertices();
    std::vector<double> start(3 * n), end(3 * n);
    std::vector<float> float_start(3 * n), float_end(3 * n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            start[axis * n + i] = made.start[3 * i + axis];
            end[axis * n + i] = made.end[3 * i + axis];
        }
    std::vector<std::int32_t> faces(made.faces.size()), edges(made.edges.size());
    const std::size_t face_count = faces.size() / 3, edge_count = edges.size() / 2;
    for (std::size_t k = 0; k < faces.size(); ++k) faces[(k % 3) * face_count + k / 3] = made.faces[k];
    for (std::size_t k = 0; k < edges.size(); ++k) edges[(k % 2) * edge_count + k / 2] = made.edges[k];

    const MovingMesh columns{PositionView::columns(start.data(), n), PositionView::columns(end.data(), n),
                             IndexView::columns(faces.data(), face_count), IndexView::columns(edges.data(), edge_count)};
    expect_same_as_packed(made, columns, made.vertex_face);
    expect_same_as_packed(made, columns, made.edge_edge);
    // Backwards in memory, through pointers and a negative stride.
    std::vector<double> reversed(made.start.rbegin(), made.start.rend());
    const double* last = reversed.data() + reversed.size() - 1;
    const MovingMesh strided{PositionView::xyz(last, last - 1, last - 2, -3, n), PositionView::rows(made.end.data(), n),
                             made.face_view(), made.edge_view()};
    expect_same_as_packed(made, strided, made.vertex_face);
}

TEST(Indexed, FloatPositionsWidenExactly)
{
    const MadeMesh made{63};
    MadeMesh narrow = made;
    const std::size_t n = made.vertices();
    std::vector<float> start(3 * n), end(3 * n);
    for (std::size_t k = 0; k < 3 * n; ++k) {
        // Beyond the range of float the widened value would be infinite: keep the test about rounding.
        const auto to_float = [](double x) { return std::abs(x) < 1e30 ? static_cast<float>(x) : 1.0F; };
        narrow.start[k] = start[k] = to_float(made.start[k]);
        narrow.end[k] = end[k] = to_float(made.end[k]);
    }
    const MovingMesh mesh{PositionView::rows(start.data(), n), PositionView::rows(end.data(), n), made.face_view(), made.edge_view()};
    expect_same_as_packed(narrow, mesh, narrow.vertex_face);
    expect_same_as_packed(narrow, mesh, narrow.edge_edge);
}

template <class Pair>
void expect_earliest_is_the_minimum(const MovingMesh& mesh, const std::vector<Pair>& pairs, const Options& options)
{
    const Contact expected = indexed_answer(mesh, pairs, options).summary.earliest;
    Contact found{7, 7.0};
    Summary summary;
    ASSERT_TRUE(earliest_contact(mesh, std::span<const Pair>{pairs}, options, found, &summary).ok());
    EXPECT_EQ(found.pair, expected.pair);
    EXPECT_EQ(found.toi, expected.toi);
    EXPECT_EQ(summary.earliest.pair, expected.pair);
}

TEST(Earliest, IsTheMinimumOfTheDenseAnswer)
{
    for (const std::uint64_t seed : {64u, 65u, 66u}) {
        const MadeMesh made{seed};
        const MovingMesh mesh = made.mesh();
        // Contact at time 0 is frequent in these pairs: also without it, and without early contacts at all.
        const std::vector<double> dense = indexed_answer(mesh, made.vertex_face, {}).toi;
        const std::vector<double> dense_edges = indexed_answer(mesh, made.edge_edge, {}).toi;
        for (const double least : {0.0, 1e-12, 1e-3, 0.5, 0.99, 2.0}) {
            std::vector<VertexFace> faces;
            std::vector<EdgeEdge> edges;
            for (std::size_t i = 0; i < dense.size(); ++i)
                if (!(dense[i] < least)) faces.push_back(made.vertex_face[i]);
            for (std::size_t i = 0; i < dense_edges.size(); ++i)
                if (!(dense_edges[i] < least)) edges.push_back(made.edge_edge[i]);
            for (const Isa isa : isas_to_test())
                for (const double t_max : {1.0, 0.6}) {
                    Options options;
                    options.isa = isa;
                    options.t_max = t_max;
                    expect_earliest_is_the_minimum(mesh, faces, options);
                    expect_earliest_is_the_minimum(mesh, edges, options);
                }
        }
    }
}

TEST(Earliest, TiesGoToTheSmallerIndexOnAnyThreadCount)
{
    // Many copies of pairs that touch at the same time, spread over many tiles, behind pairs that touch later.
    std::vector<oracle::Pair> pairs;
    generate("uniform", oracle::Kind::vertex_face, 67, 30000, pairs);
    const Answer dense = answer(oracle::Kind::vertex_face, interleaved(pairs), {});
    const oracle::Pair first = pairs[dense.summary.earliest.pair];
    for (std::size_t i = 5000; i < pairs.size(); i += 777) pairs[i] = first;
    const Answer expected = answer(oracle::Kind::vertex_face, interleaved(pairs), {});
    for (const std::size_t threads : {1u, 2u, 5u}) {
        tbb::global_control limit{tbb::global_control::max_allowed_parallelism, threads};
        tbb::task_arena arena{static_cast<int>(threads)};
        arena.execute([&] {
            for (int repeat = 0; repeat < 10; ++repeat) {
                Contact found{};
                ASSERT_TRUE(earliest_contact(PairKind::vertex_face, interleaved(pairs), {}, found).ok());
                EXPECT_EQ(found.pair, expected.summary.earliest.pair);
                EXPECT_EQ(found.toi, expected.summary.earliest.toi);
            }
        });
    }
}

TEST(Indexed, NoPairs)
{
    const MadeMesh made{69, 1};
    const MovingMesh mesh = made.mesh();
    Summary summary;
    ASSERT_TRUE(time_of_impact(mesh, std::span<const VertexFace>{}, {}, {}, &summary).ok());
    EXPECT_EQ(summary.pairs, 0u);
    std::vector<Contact> contacts;
    ASSERT_TRUE(find_contacts(mesh, std::span<const EdgeEdge>{}, {}, contacts).ok());
    EXPECT_TRUE(contacts.empty());
}

TEST(Earliest, NoContactAndNoPairs)
{
    Contact found{};
    ASSERT_TRUE(earliest_contact(PairKind::edge_edge, PairBuffer{}.view(), {}, found).ok());
    EXPECT_EQ(found.pair, std::numeric_limits<std::size_t>::max());
    EXPECT_EQ(found.toi, std::numeric_limits<double>::infinity());
}

TEST(Indexed, IndicesOutOfRangeAreNamedBeforeAnyWork)
{
    const MadeMesh made{68, 40};
    const MovingMesh mesh = made.mesh();
    const auto vertices = static_cast<std::int32_t>(made.vertices());
    const auto faces = static_cast<std::int32_t>(made.faces.size() / 3);
    const auto edges = static_cast<std::int32_t>(made.edges.size() / 2);

    const auto expect = [&](const auto& pairs, std::size_t pair, std::int64_t index) {
        using Pair = typename std::decay_t<decltype(pairs)>::value_type;
        std::vector<double> toi(pairs.size(), 42.0);
        const Status status = time_of_impact(mesh, std::span<const Pair>{pairs}, {}, toi);
        EXPECT_EQ(status.error, Error::index_out_of_range);
        EXPECT_EQ(status.pair, pair);
        EXPECT_EQ(status.index, index);
        for (const double t : toi) EXPECT_EQ(t, 42.0);
    };
    for (const std::int32_t bad : {-1, vertices, std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min()}) {
        auto pairs = made.vertex_face;
        pairs[777].vertex = bad;
        pairs[900].face = faces;  // a later fault is not the one named
        expect(pairs, 777, bad);
    }
    auto pairs = made.edge_edge;
    pairs.back().edge_b = edges;
    expect(pairs, pairs.size() - 1, edges);
    pairs[0].edge_a = -7;
    expect(pairs, 0, -7);

    // Beyond one task of the check.
    std::vector<VertexFace> many(300000, {0, 0});
    many[299999].face = faces;
    many[200000].vertex = vertices;
    expect(many, 200000, vertices);
}

TEST(Indexed, MeshesThatAreNotMeshes)
{
    const MadeMesh made{69, 2};
    const auto positions = [&](std::size_t n) { return PositionView::rows(made.start.data(), n); };
    EXPECT_EQ(MovingMesh{}.status().error, Error::wrong_size);
    EXPECT_EQ((MovingMesh{positions(5), positions(6), {}, {}}).status().error, Error::wrong_size);
    EXPECT_TRUE((MovingMesh{positions(5), positions(5), {}, {}}).status().ok());
    std::vector<std::int32_t> faces = {0, 1, 2, 0, 5, 1};
    const Status status = MovingMesh{positions(5), positions(5), IndexView::rows(faces.data(), 2, 3), {}}.status();
    EXPECT_EQ(status.error, Error::bad_face_index);
    EXPECT_EQ(status.pair, 1u);
    EXPECT_EQ(status.index, 5);
    const Status of_edges = MovingMesh{positions(5), positions(5), IndexView::rows(faces.data(), 1, 3), IndexView::rows(faces.data(), 3, 2)}.status();
    EXPECT_EQ(of_edges.error, Error::bad_edge_index);
    EXPECT_EQ(of_edges.pair, 2u);
    EXPECT_EQ(of_edges.index, 5);
    // Strides forgotten: all columns would be the first one.
    const IndexView without_strides{faces.data(), 1};
    EXPECT_EQ((MovingMesh{positions(5), positions(5), without_strides, {}}).status().error, Error::wrong_size);
    EXPECT_EQ((MovingMesh{positions(5), positions(5), {}, without_strides}).status().error, Error::wrong_size);
    EXPECT_EQ((MovingMesh{positions(5), positions(5), IndexView{faces.data(), 2, 0, 1}, {}}).status().error, Error::wrong_size);
    EXPECT_TRUE((MovingMesh{positions(5), positions(5), IndexView::rows(faces.data(), 1, 3), {}}).status().ok());
    // More records than there can be.
    const double* const one = made.start.data();
    for (const std::size_t n : {std::size_t{1} << 58, (std::size_t{1} << 58) - 1, std::size_t{1} << 57}) {
        const PositionView endless = PositionView::xyz(one, one, one, 0, n);
        EXPECT_EQ((MovingMesh{endless, endless, {}, {}}).status().error, Error::out_of_memory) << n;
    }
    // Strides by which an address would wrap around.
    for (const std::ptrdiff_t stride : {std::numeric_limits<std::ptrdiff_t>::max(), std::numeric_limits<std::ptrdiff_t>::min(),
                                        std::numeric_limits<std::ptrdiff_t>::max() / 16}) {
        const PositionView wide = PositionView::xyz(one, one, one, stride, 5);
        EXPECT_EQ((MovingMesh{wide, positions(5), {}, {}}).status().error, Error::wrong_size) << stride;
        EXPECT_EQ((MovingMesh{positions(5), wide, {}, {}}).status().error, Error::wrong_size) << stride;
        EXPECT_EQ((MovingMesh{positions(5), positions(5), IndexView{faces.data(), 9, stride, 1}, {}}).status().error, Error::wrong_size) << stride;
    }
    const IndexView wide_rows{faces.data(), 1, 3, std::numeric_limits<std::ptrdiff_t>::max()};
    EXPECT_EQ((MovingMesh{positions(5), positions(5), wide_rows, {}}).status().error, Error::wrong_size);
    EXPECT_EQ((MovingMesh{positions(5), positions(5), {}, wide_rows}).status().error, Error::wrong_size);
    std::vector<double> toi;
    EXPECT_EQ(time_of_impact(MovingMesh{}, std::span<const VertexFace>{}, {}, toi).error, Error::wrong_size);
    // Spans with a size and no data.
    const MovingMesh mesh = made.mesh();
    toi.resize(3);
    EXPECT_EQ(time_of_impact(mesh, std::span<const VertexFace>{static_cast<const VertexFace*>(nullptr), 3}, {}, toi).error, Error::wrong_size);
    EXPECT_EQ(time_of_impact(mesh, std::span<const EdgeEdge>{static_cast<const EdgeEdge*>(nullptr), 3}, {}, toi).error, Error::wrong_size);
    // Negative numbers, as sizes.
    const VertexFace pair{0, 0};
    const std::size_t negative = std::size_t{0} - 1;
    EXPECT_EQ(time_of_impact(mesh, std::span{&pair, negative}, {}, toi).error, Error::wrong_size);
    EXPECT_EQ((MovingMesh{positions(5), positions(5), IndexView::rows(faces.data(), negative, 3), {}}).status().error, Error::wrong_size);
    EXPECT_EQ((MovingMesh{positions(negative), positions(negative), {}, {}}).status().error, Error::wrong_size);
    EXPECT_EQ((MovingMesh{positions(5), positions(5), {}, IndexView::rows(faces.data(), negative, 2)}).status().error, Error::wrong_size);
}

TEST(Indexed, AMeshThatWasMovedIsNoMeshAnyMore)
{
    const MadeMesh made{70, 2};
    MovingMesh first = made.mesh();
    const std::size_t vertices = first.vertex_count();
    MovingMesh second{std::move(first)};
    EXPECT_EQ(second.vertex_count(), vertices);
    std::vector<double> toi(made.vertex_face.size());
    const std::span<const VertexFace> pairs{made.vertex_face};
    EXPECT_TRUE(time_of_impact(second, pairs, {}, toi).ok());
    EXPECT_EQ(time_of_impact(first, pairs, {}, toi).error, Error::wrong_size);  // NOLINT(bugprone-use-after-move)
    first = std::move(second);
    EXPECT_TRUE(time_of_impact(first, pairs, {}, toi).ok());
    EXPECT_EQ(time_of_impact(second, pairs, {}, toi).error, Error::wrong_size);  // NOLINT(bugprone-use-after-move)
}

}  // namespace
}  // namespace fastccd::testing
