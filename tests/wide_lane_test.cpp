// The pipeline on a portable lane type of 8 pairs: the logic of the widest batches, on machines without them.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include <pipeline.hpp>
#include <separation_pipeline.hpp>

#include "generators.hpp"
#include "narrow_phase.hpp"

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Eight doubles, one operation after the other.
struct Array8 {
    double value[8];
};
struct Mask8 {
    bool value[8];
};

template <class R, class Operation>
R each(Operation operation)
{
    R result;
    for (int i = 0; i < 8; ++i) result.value[i] = operation(i);
    return result;
}

inline Array8 operator+(Array8 a, Array8 b) { return each<Array8>([&](int i) { return a.value[i] + b.value[i]; }); }
inline Array8 operator-(Array8 a, Array8 b) { return each<Array8>([&](int i) { return a.value[i] - b.value[i]; }); }
inline Array8 operator*(Array8 a, Array8 b) { return each<Array8>([&](int i) { return a.value[i] * b.value[i]; }); }
inline Array8 operator/(Array8 a, Array8 b) { return each<Array8>([&](int i) { return a.value[i] / b.value[i]; }); }
inline Mask8 operator&(Mask8 a, Mask8 b) { return each<Mask8>([&](int i) { return a.value[i] && b.value[i]; }); }
inline Mask8 operator|(Mask8 a, Mask8 b) { return each<Mask8>([&](int i) { return a.value[i] || b.value[i]; }); }
inline Mask8 operator!(Mask8 a) { return each<Mask8>([&](int i) { return !a.value[i]; }); }

template <>
struct Lane<Array8> {
    using One = Lane<double>;
    using Mask = Mask8;
    static constexpr unsigned width = 8;

    static Array8 broadcast(double x) { return each<Array8>([&](int) { return x; }); }
    static Array8 load(const double* p) { return each<Array8>([&](int i) { return p[i]; }); }
    static void store(double* p, Array8 x)
    {
        for (int i = 0; i < 8; ++i) p[i] = x.value[i];
    }
    struct Collector {
        Collector(const double* /*blocks*/, const double* const* pairs_) : pairs{pairs_} {}
        Array8 operator()(int c) const { return each<Array8>([&](int i) { return pairs[i][std::size_t(c) * block_pairs]; }); }
        const double* const* pairs;
    };
    static Array8 lane_number() { return each<Array8>([](int i) { return double(i); }); }
    static Array8 min(Array8 a, Array8 b) { return each<Array8>([&](int i) { return One::min(a.value[i], b.value[i]); }); }
    static Array8 max(Array8 a, Array8 b) { return each<Array8>([&](int i) { return One::max(a.value[i], b.value[i]); }); }
    static Array8 abs(Array8 a) { return each<Array8>([&](int i) { return std::fabs(a.value[i]); }); }
    static Array8 negated(Array8 a) { return each<Array8>([&](int i) { return -a.value[i]; }); }
    static Array8 times_sign(Array8 a, Array8 b)
    {
        return each<Array8>([&](int i) { return std::signbit(b.value[i]) ? -a.value[i] : a.value[i]; });
    }
    static Array8 difference(Array8 a, Array8 b) { return a - b; }
    static Array8 sqrt(Array8 a) { return each<Array8>([&](int i) { return std::sqrt(a.value[i]); }); }
    static Array8 select(Mask m, Array8 yes, Array8 no) { return each<Array8>([&](int i) { return m.value[i] ? yes.value[i] : no.value[i]; }); }
    static Mask less(Array8 a, Array8 b) { return each<Mask>([&](int i) { return a.value[i] < b.value[i]; }); }
    static Mask less_equal(Array8 a, Array8 b) { return each<Mask>([&](int i) { return a.value[i] <= b.value[i]; }); }
    static unsigned bits(Mask m)
    {
        unsigned result = 0;
        for (unsigned i = 0; i < 8; ++i) result |= unsigned{m.value[i]} << i;
        return result;
    }
    static void compress_store(double* p, unsigned bits, Array8 x)
    {
        for (int i = 0; i < 8; ++i)
            if ((bits >> i & 1u) != 0) *p++ = x.value[i];
    }
    static constexpr unsigned transposed_records = One::transposed_records;
    static void transpose_records(const double* const* records, double* start, double* end, std::size_t stride)
    {
        One::transpose_records(records, start, end, stride);
    }
    using FirstBox = One::FirstBox;
    static FirstBox first_box(const GridBox& box, const std::int16_t* separation) { return One::first_box(box, separation); }
    static bool apart(const FirstBox& first, const GridBox& second) { return One::apart(first, second); }
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE

namespace fastccd::testing {
namespace {

/// Pairs that the lanes decide, as the certified search does; the others are its own.
std::size_t expect_decided_as_searched(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, const std::string& family)
{
    const auto scratch = std::make_unique<TileScratch>();
    const SearchParameters parameters{1e-9, 1.0, true};
    const PairBuffer buffer = to_buffer(pairs);
    Options options;
    options.reference = true;
    const Answer expected = answer(kind, buffer.view(), options);
    std::size_t decided = 0;
    // Blocks read in place, and blocks filled anew for every group.
    for (const PairView& view : {buffer.view(), interleaved(pairs)}) {
        const PairSource source{&view, {}, view.size()};
        // Either way to ask for them, whichever this machine takes.
        const CacheLevel into = view.layout() == PairView::Layout::blocked ? CacheLevel::second : CacheLevel::first;
        FASTCCD_KERNEL_NAMESPACE::run_tile<FASTCCD_KERNEL_NAMESPACE::Array8>(
            {pair_kind(kind), &source, 0, pairs.size(), &parameters, 1.0, into}, *scratch);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if ((scratch->is_undecided[i / 64] >> i % 64 & 1) != 0) continue;
            ++decided;
            EXPECT_EQ(scratch->time[i], expected.toi[i]) << family << ' ' << lossless(pairs[i]);
            if (expected.toi[i] <= 1.0) {
                EXPECT_EQ(scratch->roots[i], expected.roots[i]) << family;
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
            decided += expect_decided_as_searched(kind, pairs, family);
            if (HasFailure()) return;
        }
    EXPECT_GT(decided, 20000u);
}

// As in a scene, where few pairs of a group are left after screening, and wait for those of the next one.
TEST(WideLanes, DecideTheFewThatAreNotClearlyApart)
{
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge}) {
        std::vector<oracle::Pair> pairs;
        generate("uniform", kind, 42, 3001, pairs);
        const std::size_t first_primitive = kind == oracle::Kind::vertex_face ? 1 : 2;  // points
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (i % 5 == 4) continue;
            for (std::size_t point = 0; point < first_primitive; ++point) {
                pairs[i][point][0] += 8.0;
                pairs[i][4 + point][0] += 8.0;
            }
        }
        EXPECT_GT(expect_decided_as_searched(kind, pairs, "mostly apart"), 5900u);
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
            FASTCCD_KERNEL_NAMESPACE::run_separation_tile<FASTCCD_KERNEL_NAMESPACE::Array8>(
                {pair_kind(kind), &source, 0, pairs.size(), &parameters, 1.0}, *scratch);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if ((scratch->is_undecided[i / 64] >> i % 64 & 1) != 0) continue;
                ++decided;
                ASSERT_EQ(scratch->time[i], expected.toi[i]) << family << ' ' << lossless(pairs[i]);
            }
        }
    EXPECT_GT(decided, 50000u);
}

}  // namespace
}  // namespace fastccd::testing
