// What the public functions promise about arguments, errors and odd inputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>
#include <utility>

#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"

namespace fastccd::testing {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::vector<oracle::Pair> uniform_pairs(std::size_t n)
{
    std::vector<oracle::Pair> pairs;
    generate("uniform", oracle::Kind::vertex_face, 51, n, pairs);
    return pairs;
}

Error error_of(const Options& options)
{
    const auto pairs = uniform_pairs(3);
    std::vector<double> toi(3);
    return time_of_impact(PairKind::vertex_face, interleaved(pairs), options, toi).error;
}

TEST(Api, RefusesBadOptions)
{
    for (const double bad : {0.0, -1e-9, not_a_number, infinity}) {
        Options options;
        options.tolerance = bad;
        EXPECT_EQ(error_of(options), Error::bad_tolerance) << bad;
    }
    for (const double bad : {0.0, -0.5, 1.0000001, not_a_number, infinity}) {
        Options options;
        options.t_max = bad;
        EXPECT_EQ(error_of(options), Error::bad_t_max) << bad;
    }
    EXPECT_EQ(error_of({}), Error::none);
}

TEST(Api, RefusesKindsThatAreNone)
{
    const auto pairs = uniform_pairs(3);
    constexpr double untouched = -1.0;
    std::vector<double> toi(3, untouched);
    std::vector<Contact> contacts;
    Contact earliest;
    for (const int number : {2, 7, 255}) {
        const auto kind = static_cast<PairKind>(number);
        EXPECT_EQ(time_of_impact(kind, interleaved(pairs), {}, toi).error, Error::bad_kind) << number;
        EXPECT_EQ(find_contacts(kind, interleaved(pairs), {}, contacts).error, Error::bad_kind) << number;
        EXPECT_EQ(earliest_contact(kind, interleaved(pairs), {}, earliest).error, Error::bad_kind) << number;
    }
    EXPECT_EQ(toi, std::vector<double>(3, untouched));
    EXPECT_TRUE(contacts.empty());
    EXPECT_STRNE(message(Error::bad_kind), message(Error::bad_tolerance));
    EXPECT_STRNE(message(Error::bad_kind), "unknown error");
}

TEST(Api, RefusesWrongSizes)
{
    const auto pairs = uniform_pairs(5);
    std::vector<double> toi(4);
    std::vector<std::uint8_t> roots(4);
    EXPECT_EQ(time_of_impact(PairKind::vertex_face, interleaved(pairs), {}, toi).error, Error::wrong_size);
    toi.resize(5);
    EXPECT_EQ(time_of_impact(PairKind::vertex_face, interleaved(pairs), {}, toi, nullptr, roots).error, Error::wrong_size);
    EXPECT_EQ(time_of_impact(PairKind::vertex_face, PairView::interleaved(static_cast<const double*>(nullptr), 5), {}, toi).error,
              Error::wrong_size);
    EXPECT_EQ(time_of_impact(PairKind::vertex_face, interleaved(pairs), {}, {static_cast<double*>(nullptr), 5}).error, Error::wrong_size);
    EXPECT_EQ(time_of_impact(PairKind::vertex_face, interleaved(pairs), {}, toi, nullptr, {static_cast<std::uint8_t*>(nullptr), 5}).error,
              Error::wrong_size);
    for (const std::size_t missing : {0u, 5u, 23u}) {
        std::array<const double*, pair_coordinates> columns{};
        columns.fill(pairs[0][0].data());
        columns[missing] = nullptr;
        EXPECT_EQ(time_of_impact(PairKind::vertex_face, PairView::strided(columns, 0, 5), {}, toi).error, Error::wrong_size);
    }
}

TEST(Api, RefusesMorePairsThanMemoryHolds)
{
    // Negative numbers of pairs, as sizes. Rounded up to whole tiles some of them would be none.
    const double pair[24] = {};
    const float narrow[24] = {};
    double one = 0.0;
    std::array<const double*, pair_coordinates> columns{};
    columns.fill(pair);
    for (const std::ptrdiff_t negative : {std::ptrdiff_t{-1}, std::ptrdiff_t{-5}, std::ptrdiff_t{-4096}, std::numeric_limits<std::ptrdiff_t>::min()}) {
        const auto size = static_cast<std::size_t>(negative);
        for (const PairView& view : {PairView::interleaved(pair, size), PairView::interleaved(narrow, size), PairView::blocked(pair, size),
                                     PairView::strided(columns, 1, size)}) {
            EXPECT_EQ(time_of_impact(PairKind::vertex_face, view, {}, {&one, size}).error, Error::wrong_size);
            std::vector<Contact> contacts;
            EXPECT_EQ(find_contacts(PairKind::vertex_face, view, {}, contacts).error, Error::wrong_size);
            Contact earliest{};
            EXPECT_EQ(earliest_contact(PairKind::edge_edge, view, {}, earliest).error, Error::wrong_size);
            CollisionFreeStep step;
            EXPECT_EQ(collision_free_step(view, {}, {}, step).error, Error::wrong_size);
            EXPECT_EQ(collision_free_step({}, view, {}, step).error, Error::wrong_size);
            EXPECT_EQ(step.step, 0.0);
        }
    }
}

TEST(Api, RefusesStridesBeyondMemory)
{
    // The address of an element would wrap around, to somewhere in front of the array or to the first element again.
    constexpr std::ptrdiff_t most = std::numeric_limits<std::ptrdiff_t>::max(), least = std::numeric_limits<std::ptrdiff_t>::min();
    const double pair[24] = {};
    const float narrow[24] = {};
    std::array<const double*, pair_coordinates> columns{};
    std::array<const float*, pair_coordinates> narrow_columns{};
    columns.fill(pair);
    narrow_columns.fill(narrow);
    Contact earliest{};
    const auto error = [&](const PairView& view) { return earliest_contact(PairKind::vertex_face, view, {}, earliest).error; };
    for (const std::ptrdiff_t stride : {most, least, most / 8 + 1, least / 8}) {
        for (const std::size_t size : {std::size_t{1}, std::size_t{2}, std::size_t{9}, std::size_t{96076792050570581}})
            EXPECT_EQ(error(PairView::strided(columns, stride, size)), Error::wrong_size) << stride << ' ' << size;
        EXPECT_EQ(error(PairView::strided(columns, stride, 0)), Error::none) << stride;
    }
    EXPECT_EQ(error(PairView::strided(columns, most / 16, 1)), Error::none);
    EXPECT_EQ(error(PairView::strided(columns, most / 16, 4)), Error::wrong_size);
    EXPECT_EQ(error(PairView::strided(narrow_columns, most / 4 + 1, 2)), Error::wrong_size);
    EXPECT_EQ(error(PairView::strided(narrow_columns, most / 8, 4)), Error::wrong_size);
}

TEST(Api, RefusesAnIsaThatIsNotThere)
{
    for (const Isa isa : {Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon}) {
        Options options;
        options.isa = isa;
        EXPECT_EQ(error_of(options), isa_available(isa) ? Error::none : Error::isa_unavailable) << name(isa);
    }
}

TEST(Api, HonoursTheEnvironmentUnlessToldOtherwise)
{
    const auto pairs = uniform_pairs(20);
    setenv("FASTCCD_ISA", "scalar", 1);
    EXPECT_EQ(answer(oracle::Kind::vertex_face, interleaved(pairs), {}).summary.isa, Isa::scalar);
    setenv("FASTCCD_ISA", "mmx", 1);
    EXPECT_EQ(error_of({}), Error::bad_isa_environment);
    Options reference;
    reference.reference = true;
    EXPECT_EQ(error_of(reference), Error::bad_isa_environment);
    Options explicitly;
    explicitly.isa = Isa::scalar;
    EXPECT_EQ(error_of(explicitly), Error::none);
    setenv("FASTCCD_ISA", "", 1);
    EXPECT_EQ(answer(oracle::Kind::vertex_face, interleaved(pairs), {}).summary.isa, best_isa());
    unsetenv("FASTCCD_ISA");
}

TEST(Api, IsaNames)
{
    for (const Isa isa : {Isa::automatic, Isa::scalar, Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon})
        EXPECT_EQ(isa_from_name(name(isa)), isa);
    EXPECT_FALSE(isa_from_name("AVX2"));
    EXPECT_FALSE(isa_from_name(""));
    EXPECT_TRUE(isa_available(Isa::scalar));
}

TEST(Api, NoPairs)
{
    std::vector<double> toi;
    Summary summary;
    EXPECT_TRUE(time_of_impact(PairKind::edge_edge, PairBuffer{}.view(), {}, toi, &summary).ok());
    EXPECT_EQ(summary.pairs, 0u);
    std::vector<Contact> contacts;
    EXPECT_TRUE(find_contacts(PairKind::edge_edge, PairBuffer{}.view(), {}, contacts).ok());
    EXPECT_TRUE(contacts.empty());
}

TEST(Api, ListsThatManyCallsAppendToAreSeldomMoved)
{
    const PairBuffer touching{1};  // all points in one place
    PairBuffer bad{1};
    bad.at(0, 2) = std::numeric_limits<double>::infinity();
    std::vector<Contact> contacts;
    std::vector<std::size_t> invalid;
    std::size_t moves = 0;
    for (int call = 0; call < 256; ++call) {
        const Contact* const before = contacts.data();
        const std::size_t* const invalid_before = invalid.data();
        ASSERT_TRUE(find_contacts(PairKind::edge_edge, touching.view(), {}, contacts, &invalid).ok());
        ASSERT_TRUE(find_contacts(PairKind::edge_edge, bad.view(), {}, contacts, &invalid).ok());
        moves += (contacts.data() != before ? 1 : 0) + (invalid.data() != invalid_before ? 1 : 0);
    }
    EXPECT_EQ(contacts.size(), 256u);
    EXPECT_EQ(invalid.size(), 256u);
    EXPECT_LE(moves, 24u);
}

TEST(Api, InvalidPairsAreNamedAndTheOthersAnswered)
{
    const auto clean = uniform_pairs(2000);
    for (const oracle::Kind kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge}) {
        const Answer expected = answer(kind, interleaved(clean), {});
        for (const double poison : {not_a_number, infinity, -infinity}) {
            auto pairs = clean;
            std::vector<std::size_t> poisoned;
            for (std::size_t round = 0; round < 6; ++round)
                for (std::size_t c = 0; c < pair_coordinates; ++c) {  // every coordinate once, in changing lanes
                    const std::size_t i = 320 * round + 13 * c + (c + round) % 8;
                    pairs[i][c / 3][c % 3] = poison;
                    poisoned.push_back(i);
                }
            for (const Isa isa : isas_to_test()) {
                Options options;
                options.isa = isa;
                const Answer found = answer(kind, interleaved(pairs), options);
                std::vector<Contact> contacts;
                std::vector<std::size_t> invalid;
                ASSERT_TRUE(find_contacts(pair_kind(kind), interleaved(pairs), options, contacts, &invalid).ok());
                EXPECT_EQ(invalid, poisoned) << name(isa) << ' ' << poison;
                EXPECT_EQ(found.summary.invalid, poisoned.size());
                EXPECT_EQ(found.summary.scalar_pairs, expected.summary.scalar_pairs) << "that is of valid pairs";
                std::size_t next = 0;
                for (std::size_t i = 0; i < pairs.size(); ++i) {
                    if (next < poisoned.size() && poisoned[next] == i) {
                        EXPECT_TRUE(std::isnan(found.toi[i])) << i;
                        ++next;
                    } else {
                        EXPECT_EQ(found.toi[i], expected.toi[i]) << i;
                    }
                }
            }
        }
    }
}

/// A vertex at rest at the origin, and a face with vertices (l, 0, 1), (0, l, -1), (l, 2 l, 2), l = t - a: at t = a it is a segment
/// through the vertex, and the cubic has a double root.
TEST(Api, ATangentialRootCountsTwiceButAtAnEndOfTheStep)
{
    for (const auto& [a, t_max, expected] : {std::tuple{0.5, 1.0, 2}, {0.25, 0.5, 2}, {0.0, 1.0, 1}, {1.0, 1.0, 1}, {0.5, 0.5, 1}}) {
        double pair[24] = {};
        for (int end = 0; end < 2; ++end) {
            const double l = end - a;
            const double face[9] = {l, 0, 1, 0, l, -1, l, 2 * l, 2};
            std::copy_n(face, 9, pair + 12 * end + 3);
        }
        Options options;
        options.t_max = t_max;
        double toi = 0.0;
        std::uint8_t roots = 0;
        ASSERT_TRUE(time_of_impact(PairKind::vertex_face, PairView::interleaved(pair, 1), options, {&toi, 1}, nullptr, {&roots, 1}).ok());
        EXPECT_LE(toi, a);
        EXPECT_EQ(roots, expected) << a << " in [0, " << t_max << "]";
    }
}

TEST(Api, LargestFiniteCoordinatesAreValid)
{
    // Differences overflow; the pair is nevertheless answered.
    constexpr double big = std::numeric_limits<double>::max();
    const oracle::Pair pair{{{0, 0, big}, {-big, -big, 0}, {big, -big, 0}, {0, big, 0}, {0, 0, -big}, {-big, -big, 0}, {big, -big, 0}, {0, big, 0}}};
    const Answer found = answer(oracle::Kind::vertex_face, interleaved({pair}), {});
    EXPECT_LE(found.toi[0], 0.5);
    EXPECT_GE(found.toi[0], 0.5 - 1e-9);
}

TEST(Api, NeverZeroWhenApartAtTheStart)
{
    // Contact after a tiny part of the step, far below E_tol, and a pair that is apart at t = 0.
    for (const double gap : {1e-3, 1e-10, 1e-12, 1e-14}) {
        const oracle::Pair pair{{{0, 0, gap}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, gap - 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}};
        for (const Isa isa : isas_to_test()) {
            Options options;
            options.isa = isa;
            const double toi = answer(oracle::Kind::vertex_face, interleaved({pair}), options).toi[0];
            EXPECT_GT(toi, 0.0) << gap;
            EXPECT_LE(toi, oracle::exact_ccd(oracle::Kind::vertex_face, pair).t_lo) << gap;
        }
    }
    const oracle::Pair touching{{{0, 0, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}};
    EXPECT_EQ(answer(oracle::Kind::vertex_face, interleaved({touching}), {}).toi[0], 0.0);
}

/// More of them than a thread collects in one piece, after what the lists held before.
TEST(Api, ContactsOfManyTilesAreThoseOfTheTimes)
{
    auto pairs = uniform_pairs(60'000);
    for (std::size_t i = 100; i < pairs.size(); i += 7'001) pairs[i][3][1] = not_a_number;
    const PairView view = interleaved(pairs);
    const std::vector<double> toi = answer(oracle::Kind::edge_edge, view, {}).toi;
    std::vector<Contact> contacts(1);
    std::vector<std::size_t> invalid(1);
    ASSERT_TRUE(find_contacts(PairKind::edge_edge, view, {}, contacts, &invalid).ok());
    std::size_t contact = 1, bad = 1;
    for (std::size_t i = 0; i < toi.size(); ++i) {
        if (std::isnan(toi[i])) {
            ASSERT_LT(bad, invalid.size());
            EXPECT_EQ(invalid[bad++], i);
        } else if (toi[i] < infinity) {
            ASSERT_LT(contact, contacts.size());
            EXPECT_EQ(contacts[contact].pair, i);
            EXPECT_EQ(contacts[contact++].toi, toi[i]);
        }
    }
    EXPECT_EQ(contact, contacts.size());
    EXPECT_EQ(bad, invalid.size());
    EXPECT_GT(contact, 10'000u);
    EXPECT_GT(bad, 8u);
}

TEST(Api, ABufferMovedFromIsEmpty)
{
    PairBuffer from{3};
    PairBuffer to{std::move(from)};
    EXPECT_EQ(to.size(), 3u);
    EXPECT_EQ(from.size(), 0u);
    from = std::move(to);
    EXPECT_EQ(from.size(), 3u);
    std::vector<double> toi;
    EXPECT_TRUE(time_of_impact(PairKind::vertex_face, to.view(), {}, toi).ok());
}

TEST(Api, LanesPastTheEndOfABlockedViewAreIgnored)
{
    const auto pairs = uniform_pairs(11);
    PairBuffer buffer{16};
    for (std::size_t i = 0; i < 16; ++i)
        for (std::size_t c = 0; c < pair_coordinates; ++c) buffer.at(i, c) = i < 11 ? pairs[i][c / 3][c % 3] : not_a_number;
    const Answer found = answer(oracle::Kind::vertex_face, PairView::blocked(buffer.data(), 11), {});
    EXPECT_EQ(found.summary.invalid, 0u);
    EXPECT_EQ(found.toi, answer(oracle::Kind::vertex_face, interleaved(pairs), {}).toi);
}

/// Totals come from the bits of whole words: here from the answers one by one.
void expect_totals_of_the_answers(const std::vector<oracle::Pair>& pairs, const Options& options)
{
    const PairView view = interleaved(pairs);
    const Answer found = answer(oracle::Kind::vertex_face, view, options);
    std::vector<Contact> list;
    ASSERT_TRUE(find_contacts(PairKind::vertex_face, view, options, list).ok());
    Contact earliest{std::numeric_limits<std::size_t>::max(), infinity};
    std::size_t contacts = 0, odd = 0, even = 0, invalid = 0, proven = 0, at_start = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        invalid += std::isnan(found.toi[i]) ? 1 : 0;
        if (!(found.toi[i] <= 1.0)) continue;
        ++contacts;
        odd += found.roots[i] % 2 == 1;
        even += found.roots[i] != 0 && found.roots[i] % 2 == 0;
        if (found.toi[i] < earliest.toi) earliest = {i, found.toi[i]};
    }
    for (const Contact& contact : list) {
        proven += contact.proven ? 1 : 0;
        at_start += contact.at_start ? 1 : 0;
    }
    EXPECT_EQ(found.summary.pairs, pairs.size());
    EXPECT_EQ(found.summary.contacts, contacts);
    EXPECT_EQ(found.summary.proven, proven);
    EXPECT_EQ(found.summary.at_start, at_start);
    EXPECT_EQ(found.summary.odd, odd);
    EXPECT_EQ(found.summary.even, even);
    EXPECT_EQ(found.summary.invalid, invalid);
    EXPECT_EQ(found.summary.earliest.pair, earliest.pair);
    EXPECT_EQ(found.summary.earliest.toi, earliest.toi);
    if (!options.reference) {
        EXPECT_LT(found.summary.scalar_pairs, pairs.size() / 100);
    }
}

/// All but scalar_pairs, which is no part of the answer.
auto totals_of(const Summary& s)
{
    return std::tuple{s.pairs, s.contacts, s.proven, s.at_start, s.odd, s.even, s.invalid, s.earliest.pair, s.earliest.toi, s.earliest.proven,
                      s.earliest.at_start, s.isa};
}

TEST(Api, TotalsOfPiecesAddUpInAnyOrder)
{
    auto pairs = uniform_pairs(5000);
    pairs[4321][5][0] = not_a_number;
    const std::size_t earliest = answer(oracle::Kind::vertex_face, interleaved(pairs), {}).summary.earliest.pair;
    pairs[earliest + 3] = pairs[earliest];  // of two at the same time, in the same piece or not, the smaller number
    for (const double separation : {0.0, 0.01}) {
        Options options;
        options.minimum_separation = separation;
        const auto summary_of = [&](std::size_t begin, std::size_t end) {
            std::vector<double> toi(end - begin);
            std::vector<std::uint8_t> roots(end - begin);
            Summary summary;
            const std::vector<oracle::Pair> piece(pairs.begin() + static_cast<std::ptrdiff_t>(begin),
                                                  pairs.begin() + static_cast<std::ptrdiff_t>(end));
            const PairKind kind = PairKind::vertex_face;
            const bool count_roots = separation == 0.0;
            EXPECT_TRUE(time_of_impact(kind, interleaved(piece), options, toi, &summary, count_roots ? std::span{roots} : std::span{roots}.first(0)).ok());
            return summary;
        };
        const Summary whole = summary_of(0, pairs.size());
        EXPECT_LT(0u, whole.invalid);
        EXPECT_LT(0u, separation == 0.0 ? whole.odd : whole.at_start);
        // In order, and from the last one on.
        const std::size_t cuts[] = {0, earliest, earliest + 1, earliest + 3, 4000, pairs.size()};
        const std::size_t pieces = std::size(cuts) - 1;
        Summary forwards, backwards;
        for (std::size_t k = 0; k < pieces; ++k) forwards.add(summary_of(cuts[k], cuts[k + 1]), cuts[k]);
        for (std::size_t k = pieces; k-- > 0;) backwards.add(summary_of(cuts[k], cuts[k + 1]), cuts[k]);
        EXPECT_EQ(totals_of(forwards), totals_of(whole));
        EXPECT_EQ(totals_of(backwards), totals_of(whole));
    }
    Summary none;
    none.add(Summary{}, 7);
    EXPECT_EQ(totals_of(none), totals_of(Summary{}));
}

/// Of a contact at time 0 there is nothing more to say without a separation, and the earliest one is all that a search for it knows.
TEST(Api, SaysNothingThatWasNotAsked)
{
    auto pairs = uniform_pairs(1000);
    for (std::size_t c = 0; c < 3; ++c) pairs[7][1][c] = pairs[7][0][c];  // a corner at the vertex
    std::vector<Contact> contacts;
    Summary summary;
    ASSERT_TRUE(find_contacts(PairKind::vertex_face, interleaved(pairs), {}, contacts, nullptr, &summary).ok());
    const auto first = std::ranges::find(contacts, 7u, &Contact::pair);
    ASSERT_NE(first, contacts.end());
    EXPECT_EQ(first->toi, 0.0);
    EXPECT_FALSE(first->at_start);
    EXPECT_EQ(summary.at_start, 0u);
    EXPECT_EQ(summary.odd + summary.even, 0u);

    Contact earliest{};
    for (const double separation : {0.0, 0.01}) {
        Options options;
        options.minimum_separation = separation;
        ASSERT_TRUE(earliest_contact(PairKind::vertex_face, interleaved(pairs), options, earliest, &summary).ok());
        EXPECT_EQ(earliest.pair, 7u);
        EXPECT_EQ(earliest.at_start, separation > 0.0);
        EXPECT_EQ(summary.earliest.pair, 7u);
        EXPECT_EQ(summary.contacts + summary.proven + summary.at_start, 0u);
    }
}

TEST(Api, SummaryAgreesWithTheDenseAnswer)
{
    auto pairs = uniform_pairs(20000);
    // What lanes leave to the certified search: coordinates that are not finite, and a vertex that meets another one.
    pairs[77][2][1] = not_a_number;
    pairs[16001][6][0] = -infinity;
    const oracle::Pair vertices_meet{{{0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1e6}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    for (const bool first_by_search : {false, true}) {
        // Twice, as the first contact: of the pair of smaller index.
        if (first_by_search) {
            pairs[12345] = pairs[19000] = vertices_meet;
            const Contact first = answer(oracle::Kind::vertex_face, interleaved(pairs), {}).summary.earliest;
            EXPECT_EQ(first.pair, 12345u);
            EXPECT_FALSE(first.proven);  // what lanes report is
        }
        for (const double t_max : {1.0, 0.7})
            for (const double separation : {0.0, 1e-6, 0.01}) {  // with the last, some are in contact at the start
                Options options;
                options.t_max = t_max;
                options.minimum_separation = separation;
                for (const Isa isa : isas_to_test()) {
                    options.isa = isa;
                    expect_totals_of_the_answers(pairs, options);
                }
                options.reference = true;
                expect_totals_of_the_answers(pairs, options);
            }
    }
}

}  // namespace
}  // namespace fastccd::testing
