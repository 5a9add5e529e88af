// Nothing outside the caller's arrays is read or written: they lie between pages that may not be touched.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "generators.hpp"
#include "guarded_array.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

std::vector<std::size_t> sizes() { return {1, 2, 3, 5, 7, 8, 9, 15, 16, 17, 31, 56, 63, 64, 65, 71, 72, 127, 130, 200, 325, 4095, 4096, 4097, 4104}; }

/// Times of all pairs, for each minimum separation and end of the step asked about.
struct Expected {
    double separation, t_max;
    std::vector<double> toi;
};

/// The times of the pairs at `view`, written to an array between guards, are those of the first pairs.
void expect_times(PairKind kind, const PairView& view, const std::vector<Expected>& expected, Side side, const std::string& what)
{
    for (const Isa isa : isas_to_test())
        for (const auto& [separation, t_max, times] : expected) {
            Options options;
            options.isa = isa;
            options.minimum_separation = separation;
            options.t_max = t_max;
            const GuardedArray<double> toi{view.size(), side};
            ASSERT_TRUE(time_of_impact(kind, view, options, {toi.data(), toi.size()}).ok());
            ASSERT_TRUE(std::equal(toi.data(), toi.data() + toi.size(), times.begin()))
                << what << ' ' << name(isa) << ' ' << view.size() << ' ' << separation << ' ' << t_max;
        }
}

/// All layouts of the first pairs, of so many at a time.
template <class T>
void check_packed(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, const std::vector<Expected>& expected, Side side,
                  const std::vector<std::size_t>& numbers)
{
    const std::string name = sizeof(T) == sizeof(double) ? "doubles" : "floats";
    constexpr auto pair_stride = static_cast<std::ptrdiff_t>(pair_coordinates);
    for (const std::size_t size : numbers) {
        const std::size_t blocks = (size + block_pairs - 1) / block_pairs;
        std::vector<T> interleaved(size * pair_coordinates), blocked(blocks * block_coordinates), columns(size * pair_coordinates);
        std::vector<T> backwards(size * pair_coordinates);
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t c = 0; c < pair_coordinates; ++c) {
                const T x = static_cast<T>(pairs[i][c / 3][c % 3]);
                interleaved[i * pair_coordinates + c] = columns[c * size + i] = backwards[(size - 1 - i) * pair_coordinates + c] = x;
                blocked[blocked_index(i, c)] = x;
            }
        const GuardedArray<T> one_by_one{interleaved, side}, in_blocks{blocked, side}, in_columns{columns, side}, from_the_end{backwards, side};
        std::array<const T*, pair_coordinates> column{}, strided{}, last{};
        for (std::size_t c = 0; c < pair_coordinates; ++c) {
            column[c] = in_columns.data() + c * size;
            strided[c] = one_by_one.data() + c;
            last[c] = from_the_end.data() + (size - 1) * pair_coordinates + c;
        }
        const PairKind asked = pair_kind(kind);
        expect_times(asked, PairView::interleaved(one_by_one.data(), size), expected, side, "interleaved " + name);
        expect_times(asked, PairView::blocked(in_blocks.data(), size), expected, side, "blocked " + name);
        expect_times(asked, PairView::strided(column, 1, size), expected, side, "columns of " + name);
        expect_times(asked, PairView::strided(strided, pair_stride, size), expected, side, "strided " + name);
        expect_times(asked, PairView::strided(last, -pair_stride, size), expected, side, "backwards " + name);
        if (::testing::Test::HasFatalFailure()) return;
    }
}

TEST(ArrayEnds, PackedPairsAreReadToTheirEndsAndNoFarther)
{
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge}) {
        // Dense groups and sparse ones, of numbers that are the same as floats.
        std::vector<oracle::Pair> pairs, more;
        for (std::uint64_t seed = 50; pairs.size() < sizes().back(); ++seed)
            for (const char* family : {"f32_uniform", "f32_simcloth", "f32_degenerate"}) {
                generate(family, kind, seed, 200, more);
                pairs.insert(pairs.end(), more.begin(), more.end());
            }
        std::vector<Expected> expected;
        for (const auto& [separation, t_max] : {std::pair{0.0, 1.0}, {1e-3, 1.0}, {0.0, 0.37}}) {
            Options options;
            options.minimum_separation = separation;
            options.t_max = t_max;
            expected.push_back({separation, t_max, answer_without_roots(kind, to_buffer(pairs).view(), options).toi});
        }
        for (const Side side : {Side::end, Side::beginning}) {
            check_packed<double>(kind, pairs, expected, side, sizes());
            check_packed<float>(kind, pairs, expected, side, sizes());
            if (HasFatalFailure()) return;
        }
    }
}

// So many pairs come in tiles of 4,096, where fewer come in tiles of 1,024.
TEST(ArrayEnds, PairsOfLargeTilesAreReadToTheirEndsAndNoFarther)
{
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge}) {
        std::vector<oracle::Pair> pairs;
        generate("f32_uniform", kind, 70, 16 * 4096 + 77, pairs);
        const std::vector<Expected> expected{{0.0, 1.0, answer_without_roots(kind, to_buffer(pairs).view(), {}).toi}};
        for (const Side side : {Side::end, Side::beginning}) {
            check_packed<double>(kind, pairs, expected, side, {pairs.size() - 76, pairs.size()});
            check_packed<float>(kind, pairs, expected, side, {pairs.size() - 76, pairs.size()});
            if (HasFatalFailure()) return;
        }
    }
}

/// Pairs of a mesh of n triangles and 3 n vertices: every triangle's first vertex and first edge with the face and edge that follow it.
template <class Pair>
void check_indexed()
{
    constexpr bool of_faces = std::is_same_v<Pair, VertexFace>;
    for (const std::size_t size : sizes()) {
        std::vector<oracle::Pair> source;
        generate("uniform", oracle::Kind::vertex_face, 60, size, source);
        std::vector<double> start(9 * size), end(9 * size);
        std::vector<int> faces(3 * size), edges(2 * size);
        std::vector<Pair> pairs(size);
        for (std::size_t i = 0; i < size; ++i) {
            for (std::size_t k = 0; k < 9; ++k) {
                start[9 * i + k] = source[i][1 + k / 3][k % 3];
                end[9 * i + k] = source[i][5 + k / 3][k % 3];
            }
            for (std::size_t k = 0; k < 3; ++k) faces[3 * i + k] = static_cast<int>(3 * i + k);
            for (std::size_t k = 0; k < 2; ++k) edges[2 * i + k] = static_cast<int>(3 * i + k);
            pairs[i] = {static_cast<int>(of_faces ? 3 * i : i), static_cast<int>((i + 1) % size)};
        }
        std::vector<Expected> expected{{0.0, 1.0, {}}, {1e-3, 1.0, {}}, {0.0, 0.37, {}}};
        const auto check = [&](const double* x0, const double* x1, const int* f, const int* e, std::span<const Pair> asked, std::span<double> toi) {
            const MovingMesh mesh{PositionView::rows(x0, 3 * size), PositionView::rows(x1, 3 * size), IndexView::rows(f, size, 3),
                                  IndexView::rows(e, size, 2)};
            for (const Isa isa : isas_to_test())
                for (auto& [separation, t_max, times] : expected) {
                    Options options;
                    options.isa = isa;
                    options.minimum_separation = separation;
                    options.t_max = t_max;
                    ASSERT_TRUE(time_of_impact(mesh, asked, options, toi).ok()) << size;
                    if (times.empty()) times.assign(toi.begin(), toi.end());
                    ASSERT_TRUE(std::equal(times.begin(), times.end(), toi.begin()))
                        << size << ' ' << name(isa) << ' ' << separation << ' ' << t_max;
                }
        };
        std::vector<double> anywhere(size);
        check(start.data(), end.data(), faces.data(), edges.data(), pairs, anywhere);
        for (const Side side : {Side::end, Side::beginning}) {
            const GuardedArray<double> x0{start, side}, x1{end, side}, toi{size, side};
            const GuardedArray<int> f{faces, side}, e{edges, side};
            const GuardedArray<Pair> asked{pairs, side};
            check(x0.data(), x1.data(), f.data(), e.data(), {asked.data(), size}, {toi.data(), size});
            if (::testing::Test::HasFatalFailure()) return;
        }
    }
}

TEST(ArrayEnds, IndexedPairsAreReadToTheirEndsAndNoFarther)
{
    check_indexed<VertexFace>();
    check_indexed<EdgeEdge>();
}

}  // namespace
}  // namespace fastccd::testing
