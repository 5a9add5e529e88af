// Every public entry point on many tiles, alone and from several callers at once, for ThreadSanitizer to watch; the answers are
// those of one thread.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <thread>

#include <fastccd/fastccd.h>

#include "generators.hpp"
#include "mesh_of_pairs.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Pieces of no more than a tile, which the library runs on the caller's thread, exact or not.
Answer one_thread_answer(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, const Options& options)
{
    constexpr std::size_t piece = 64;
    Answer whole;
    for (std::size_t first = 0; first < pairs.size(); first += piece) {
        const std::size_t count = std::min(piece, pairs.size() - first);
        const Answer part = answer(kind, PairView::interleaved(pairs[first][0].data(), count), options);
        whole.toi.insert(whole.toi.end(), part.toi.begin(), part.toi.end());
        whole.roots.insert(whole.roots.end(), part.roots.begin(), part.roots.end());
    }
    return whole;
}

/// The smallest time, ties to the smaller index.
Contact earliest_of(const Answer& answers)
{
    Contact earliest = Summary{}.earliest;
    for (std::size_t i = 0; i < answers.toi.size(); ++i)
        if (answers.toi[i] < earliest.toi) {
            earliest.pair = i;
            earliest.toi = answers.toi[i];
        }
    return earliest;
}

/// Pairs, packed and as a mesh in which each has vertices of its own, how to ask about them, and what one thread answers.
struct Input {
    Input(oracle::Kind kind, const std::vector<oracle::Pair>& made, const Options& how)
        : pairs{made}, packed{to_buffer(made)}, indexed{made}, mesh{indexed.mesh()}, options{how}, expected{one_thread_answer(kind, made, how)}
    {
    }

    [[nodiscard]] fastccd_mesh mesh_in_c() const
    {
        return {sizeof(fastccd_mesh), indexed.start.size() / 3, indexed.start.data(), indexed.end.data(), indexed.faces.size() / 3, indexed.faces.data(),
                indexed.edges.size() / 2, indexed.edges.data()};
    }

    std::vector<oracle::Pair> pairs;
    PairBuffer packed;
    MeshOfPairs indexed;
    MovingMesh mesh;
    Options options;
    Answer expected;
};

/// Seven tiles, with contacts in each, with invalid pairs, and with pairs for the certified search: `hard` of some families, in
/// which contact at time 0 is frequent.
std::vector<oracle::Pair> tiles_of_pairs(oracle::Kind kind, std::size_t hard)
{
    std::vector<oracle::Pair> pairs, family_pairs;
    generate("uniform", kind, 71, 6500, pairs);
    for (const char* family : {"t0_contact", "grazing_exact", "boundary", "coplanar_map", "simcloth"}) {
        generate(family, kind, 72, hard, family_pairs);
        pairs.insert(pairs.end(), family_pairs.begin(), family_pairs.end());
    }
    std::shuffle(pairs.begin(), pairs.end(), std::mt19937_64{73});
    for (std::size_t i = 300; i < pairs.size(); i += 700) pairs[i][4][1] = std::numeric_limits<double>::quiet_NaN();
    return pairs;
}

/// Several tiles of contacts after time 0, the later ones first: every tile has a better one than those before.
std::vector<oracle::Pair> approaching_pairs(oracle::Kind kind)
{
    std::vector<oracle::Pair> pairs;
    generate("near_interior", kind, 74, 6500, pairs);
    const std::vector<double> toi = one_thread_answer(kind, pairs, {}).toi;
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (toi[i] > 0.0 && toi[i] < infinity) order.push_back(i);
    std::ranges::sort(order, std::ranges::greater{}, [&](std::size_t i) { return toi[i]; });
    std::vector<oracle::Pair> result;
    for (const std::size_t i : order) result.push_back(pairs[i]);
    return result;
}

const std::vector<Input>& inputs(oracle::Kind kind)
{
    const auto make = [](oracle::Kind of) {
        Options exact;
        exact.exact = true;
        std::vector<Input> result;
        result.emplace_back(of, tiles_of_pairs(of, 200), Options{});
        result.emplace_back(of, tiles_of_pairs(of, 20), exact);
        result.emplace_back(of, approaching_pairs(of), Options{});
        return result;
    };
    static const std::vector<Input> vertex_face = make(oracle::Kind::vertex_face), edge_edge = make(oracle::Kind::edge_edge);
    return kind == oracle::Kind::vertex_face ? vertex_face : edge_edge;
}

/// What every entry point answers about the same pairs.
struct Answers {
    std::vector<double> toi;
    Answer with_roots;
    std::vector<Contact> contacts;
    std::vector<std::size_t> invalid;
    Contact earliest{};
};

void require(const Status& status)
{
    if (!status.ok()) throw std::runtime_error(message(status.error));
}

/// `pairs`: a kind and a view, or a mesh and a span.
template <class... Pairs>
Answers ask_all(std::size_t size, const Options& options, const Pairs&... pairs)
{
    Answers found;
    found.toi.resize(size);
    found.with_roots.toi.resize(size);
    found.with_roots.roots.resize(size);
    require(time_of_impact(pairs..., options, found.toi));
    require(time_of_impact(pairs..., options, found.with_roots.toi, &found.with_roots.summary, found.with_roots.roots));
    require(find_contacts(pairs..., options, found.contacts, &found.invalid));
    require(earliest_contact(pairs..., options, found.earliest));
    return found;
}

Answers ask_packed(oracle::Kind kind, const Input& input, const Options& options)
{
    return ask_all(input.packed.size(), options, pair_kind(kind), input.packed.view());
}

/// Half of the threads for each call, so that it works in an arena of its own.
fastccd_options options_in_c(const Options& options)
{
    fastccd_options same;
    fastccd_options_init(&same, sizeof same);
    same.isa = static_cast<std::int32_t>(options.isa);
    same.exact = options.exact;
    same.threads = 2;
    return same;
}

void require_in_c(int error)
{
    if (error != FASTCCD_OK) throw std::runtime_error(fastccd_message(error));
}

/// The C interface about packed pairs and about pairs of a mesh, two calls of one caller each.
std::array<Answers, 2> ask_in_c(oracle::Kind kind, const Input& input, const Options& asked)
{
    const std::size_t size = input.packed.size();
    const int which = kind == oracle::Kind::vertex_face ? FASTCCD_VERTEX_FACE : FASTCCD_EDGE_EDGE;
    const fastccd_options options = options_in_c(asked);
    const double* const interleaved = input.pairs[0][0].data();
    const fastccd_mesh mesh = input.mesh_in_c();
    const std::int32_t* const candidates = kind == oracle::Kind::vertex_face ? &input.indexed.vertex_face[0].vertex : &input.indexed.edge_edge[0].edge_a;
    std::array<Answers, 2> found;
    for (const bool packed : {true, false}) {
        Answers& answers = found[packed ? 0 : 1];
        answers.toi.resize(size);
        answers.with_roots.toi.resize(size);
        answers.with_roots.roots.resize(size);
        const auto times = [&](double* toi, std::uint8_t* roots) {
            fastccd_summary summary{};
            summary.size = sizeof summary;
            require_in_c(packed ? fastccd_pairs_time_of_impact(which, interleaved, size, &options, toi, roots, &summary)
                                : fastccd_mesh_time_of_impact(&mesh, which, candidates, size, &options, toi, roots, &summary, nullptr));
            answers.with_roots.summary.contacts = summary.contacts;
        };
        times(answers.toi.data(), nullptr);
        times(answers.with_roots.toi.data(), answers.with_roots.roots.data());
        for (std::size_t i = 0; i < size; ++i)
            if (std::isnan(answers.toi[i])) answers.invalid.push_back(i);

        std::vector<fastccd_contact> contacts(size);
        std::size_t count = 0;
        require_in_c(packed ? fastccd_pairs_find_contacts(which, interleaved, size, &options, contacts.data(), size, &count, nullptr)
                            : fastccd_mesh_find_contacts(&mesh, which, candidates, size, &options, contacts.data(), size, &count, nullptr, nullptr));
        contacts.resize(count);
        for (const fastccd_contact& contact : contacts) answers.contacts.push_back({contact.pair, contact.toi, contact.proven != 0, false});
        fastccd_contact earliest{};
        require_in_c(packed ? fastccd_pairs_earliest_contact(which, interleaved, size, &options, &earliest, nullptr)
                            : fastccd_mesh_earliest_contact(&mesh, which, candidates, size, &options, &earliest, nullptr, nullptr));
        answers.earliest = {earliest.pair, earliest.toi, earliest.proven != 0, false};
    }
    return found;
}

Answers ask_indexed(oracle::Kind kind, const Input& input, const Options& options)
{
    const std::size_t size = input.packed.size();
    return kind == oracle::Kind::vertex_face ? ask_all(size, options, input.mesh, std::span<const VertexFace>{input.indexed.vertex_face})
                                             : ask_all(size, options, input.mesh, std::span<const EdgeEdge>{input.indexed.edge_edge});
}

void expect_right(const Input& input, const Answers& found)
{
    const Answer& expected = input.expected;
    const std::size_t size = expected.toi.size();
    EXPECT_EQ(first_difference(expected, found.with_roots), size);
    EXPECT_EQ(first_difference(expected, {found.toi, expected.roots, {}}), size);

    std::vector<std::size_t> invalid;
    std::size_t next = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const double toi = expected.toi[i];
        if (std::isnan(toi)) invalid.push_back(i);
        if (!(toi < infinity)) continue;
        ASSERT_LT(next, found.contacts.size());
        EXPECT_EQ(found.contacts[next].pair, i);
        EXPECT_EQ(found.contacts[next++].toi, toi);
    }
    EXPECT_EQ(found.contacts.size(), next);
    EXPECT_EQ(found.with_roots.summary.contacts, next);
    EXPECT_EQ(found.invalid, invalid);
    EXPECT_EQ(found.earliest.pair, earliest_of(expected).pair);
    EXPECT_EQ(found.earliest.toi, earliest_of(expected).toi);
}

constexpr std::size_t callers = 3;

/// Calls ask(caller) on a thread for each caller.
template <class Ask>
void ask_at_once(const Ask& ask)
{
    std::vector<std::jthread> threads;  // joined at the end
    for (std::size_t caller = 0; caller < callers; ++caller) threads.emplace_back(ask, caller);
}

/// Before all other tests, which begin with a call alone: what that one stored for later ones, they would read without a race.
TEST(FirstCalls, AtOnce)
{
    const std::vector<oracle::Pair> pairs = tiles_of_pairs(oracle::Kind::vertex_face, 100);
    std::array<Answer, callers> found;
    ask_at_once([&](std::size_t caller) { found[caller] = answer(oracle::Kind::vertex_face, interleaved(pairs), {}); });
    const Answer expected = one_thread_answer(oracle::Kind::vertex_face, pairs, {});
    for (const Answer& of_caller : found) EXPECT_EQ(first_difference(expected, of_caller), pairs.size());
}

class Races : public ::testing::TestWithParam<oracle::Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Races, ::testing::Values(oracle::Kind::vertex_face, oracle::Kind::edge_edge),
                         [](const auto& kind) { return kind.param == oracle::Kind::vertex_face ? "VertexFace" : "EdgeEdge"; });

TEST_P(Races, EveryEntryPoint)
{
    for (const Input& input : inputs(GetParam())) {
        ASSERT_TRUE(input.mesh.status().ok());
        for (const Isa isa : isas_to_test()) {
            SCOPED_TRACE(name(isa));
            Options options = input.options;
            options.isa = isa;
            expect_right(input, ask_packed(GetParam(), input, options));
            expect_right(input, ask_indexed(GetParam(), input, options));
        }
    }
}

TEST_P(Races, SeveralCallersAtOnce)
{
    for (const Input& input : inputs(GetParam())) {
        std::array<Answers, callers> packed, indexed;
        ask_at_once([&](std::size_t caller) {
            packed[caller] = ask_packed(GetParam(), input, input.options);
            indexed[caller] = ask_indexed(GetParam(), input, input.options);
        });
        for (const Answers& answers : packed) expect_right(input, answers);
        for (const Answers& answers : indexed) expect_right(input, answers);
    }
}

TEST_P(Races, SeveralCallersInCAtOnce)
{
    const Input& input = inputs(GetParam())[0];
    std::array<std::array<Answers, 2>, callers> found;
    ask_at_once([&](std::size_t caller) { found[caller] = ask_in_c(GetParam(), input, input.options); });
    for (const auto& of_caller : found)
        for (const Answers& answers : of_caller) expect_right(input, answers);
}

TEST_P(Races, CallersWhoMakeTheBoxesOfAMeshAtOnce)
{
    // One triangle a vertex, all of them far from all others, but for pairs of a triangle with itself: contact at time 0.
    constexpr std::int32_t triangles = 500;
    std::vector<double> positions;
    std::vector<std::int32_t> faces;
    for (std::int32_t i = 0; i < triangles; ++i) {
        for (const double offset : {0.0, 0.25, 0.5}) positions.insert(positions.end(), {2.0 * i + offset, offset * offset, 1.0});
        faces.insert(faces.end(), {3 * i, 3 * i + 1, 3 * i + 2});
    }
    const PositionView view = PositionView::rows(positions.data(), positions.size() / 3);
    const MovingMesh mesh{view, view, IndexView::rows(faces.data(), triangles, 3), IndexView::rows(faces.data(), triangles, 2)};
    std::vector<VertexFace> vertex_face;
    std::vector<EdgeEdge> edge_edge;
    for (std::int32_t i = 0; i < 8 * triangles; ++i) {
        vertex_face.push_back({3 * (i % triangles), (i + i / triangles) % triangles});
        edge_edge.push_back({i % triangles, (i + i / triangles) % triangles});
    }
    std::array<std::vector<Contact>, callers> found;
    ask_at_once([&](std::size_t caller) {
        require(GetParam() == oracle::Kind::vertex_face
                    ? find_contacts(mesh, std::span<const VertexFace>{vertex_face}, {}, found[caller])
                    : find_contacts(mesh, std::span<const EdgeEdge>{edge_edge}, {}, found[caller]));
    });
    for (const auto& contacts : found) {
        ASSERT_EQ(contacts.size(), std::size_t{triangles});
        EXPECT_EQ(contacts.back().pair, std::size_t{triangles - 1});
    }
}

/// From the dense answers: smallest toi, an invalid pair counting as 0, ties to vertex-face, then to the smaller index.
CollisionFreeStep step_of(const Input& faces, const Input& edges)
{
    CollisionFreeStep step{1.0};
    for (const Input* input : {&faces, &edges})
        for (std::size_t i = 0; i < input->expected.toi.size(); ++i) {
            const double toi = std::isnan(input->expected.toi[i]) ? 0.0 : input->expected.toi[i];
            if (toi < step.step) step = {toi, input == &faces ? PairKind::vertex_face : PairKind::edge_edge, i};
        }
    return step;
}

TEST(CollisionFreeStep, OverBothKinds)
{
    for (std::size_t k = 0; k < inputs(oracle::Kind::vertex_face).size(); ++k) {
        const Input &faces = inputs(oracle::Kind::vertex_face)[k], &edges = inputs(oracle::Kind::edge_edge)[k];
        const CollisionFreeStep expected = step_of(faces, edges);
        const std::vector<double>& toi = (expected.kind == PairKind::vertex_face ? faces : edges).expected.toi;
        std::array<CollisionFreeStep, callers> found;
        std::array<Status, callers> status;
        ask_at_once([&](std::size_t caller) {
            status[caller] = collision_free_step(faces.packed.view(), edges.packed.view(), faces.options, found[caller]);
        });
        for (std::size_t caller = 0; caller < callers; ++caller) {
            EXPECT_EQ(status[caller].error, std::isnan(toi[expected.pair]) ? Error::invalid_pair : Error::none);
            EXPECT_EQ(found[caller].step, expected.step);
            EXPECT_EQ(found[caller].kind, expected.kind);
            EXPECT_EQ(found[caller].pair, expected.pair);
        }
    }
}

TEST(CollisionFreeStep, InC)
{
    // All in contact, hence without an error.
    const Input &faces = inputs(oracle::Kind::vertex_face)[2], &edges = inputs(oracle::Kind::edge_edge)[2];
    const CollisionFreeStep expected = step_of(faces, edges);
    const fastccd_options options = options_in_c({});
    const fastccd_mesh mesh = faces.mesh_in_c();
    std::array<fastccd_step, callers> packed{}, indexed{};
    ask_at_once([&](std::size_t caller) {
        packed[caller].size = indexed[caller].size = sizeof(fastccd_step);
        require_in_c(fastccd_pairs_collision_free_step(faces.pairs[0][0].data(), faces.pairs.size(), edges.pairs[0][0].data(),
                                                       edges.pairs.size(), &options, &packed[caller], nullptr));
        require_in_c(fastccd_mesh_collision_free_step(&mesh, &faces.indexed.vertex_face[0].vertex, faces.indexed.vertex_face.size(), nullptr, 0, &options,
                                                      &indexed[caller], nullptr));
    });
    for (std::size_t caller = 0; caller < callers; ++caller) {
        EXPECT_EQ(packed[caller].step, expected.step);
        EXPECT_EQ(packed[caller].pair, expected.pair);
        EXPECT_EQ(indexed[caller].pair, earliest_of(faces.expected).pair);
        EXPECT_EQ(indexed[caller].step, earliest_of(faces.expected).toi);
    }
}

TEST(IndexCheck, MoreIndicesThanOneTaskChecks)
{
    const Input& input = inputs(oracle::Kind::vertex_face)[0];
    std::vector<VertexFace> pairs;
    while (pairs.size() < 200000) pairs.insert(pairs.end(), input.indexed.vertex_face.begin(), input.indexed.vertex_face.end());
    Contact found{};
    require(earliest_contact(input.mesh, std::span<const VertexFace>{pairs}, {}, found));
    EXPECT_EQ(found.pair, earliest_of(input.expected).pair);
    EXPECT_EQ(found.toi, earliest_of(input.expected).toi);

    for (const std::size_t bad : {190000u, 140000u, 70000u, 100u}) {
        pairs[bad].face = -1;
        const Status status = earliest_contact(input.mesh, std::span<const VertexFace>{pairs}, {}, found);
        EXPECT_EQ(status.error, Error::index_out_of_range);
        EXPECT_EQ(status.pair, bad);
    }
}

}  // namespace
}  // namespace fastccd::testing
