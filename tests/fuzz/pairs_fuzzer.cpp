// Any bytes as pairs, both kinds: a byte chooses tolerance and t_max, then come 24 doubles a pair; a double after the last pair
// is a minimum separation, a single byte asks for the exact verdict where that is quick. Every instruction set gives the bits of the certified
// search, for packed pairs, as floats, too, and for all pairs of a mesh made of their points; the lists of contacts are those of the times; a time is in [0, t_max] or infinite, and NaN exactly
// where a coordinate is not finite; the exact verdict takes contacts away and makes no time earlier.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include <fastccd/fastccd.hpp>

#include "fuzz/fuzz_bytes.hpp"

namespace {

using namespace fastccd;

std::vector<double> times(PairKind kind, const std::vector<double>& coordinates, const Options& options)
{
    std::vector<double> toi(coordinates.size() / pair_coordinates);
    testing::require(
        time_of_impact(kind, PairView::interleaved(coordinates.data(), toi.size()), options, toi).ok());
    return toi;
}

bool all_finite(const double* coordinates)
{
    for (std::size_t c = 0; c < pair_coordinates; ++c)
        if (!std::isfinite(coordinates[c])) return false;
    return true;
}

void check(PairKind kind, const std::vector<double>& coordinates, Options options)
{
    options.reference = true;
    const std::vector<double> expected = times(kind, coordinates, options);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const bool valid = all_finite(&coordinates[i * pair_coordinates]);
        testing::require(std::isnan(expected[i]) == !valid);
        if (valid) testing::require(expected[i] == INFINITY || (expected[i] >= 0.0 && expected[i] <= options.t_max));
    }
    options.reference = false;
    for (const Isa isa : {Isa::scalar, Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon}) {
        if (!isa_available(isa)) continue;
        options.isa = isa;
        const std::vector<double> found = times(kind, coordinates, options);
        testing::require(std::memcmp(found.data(), expected.data(), found.size() * sizeof(double)) == 0);
    }
}

/// The other questions about packed pairs, answered by the times: all contacts, and the earliest one.
void check_lists(PairKind kind, const std::vector<double>& coordinates, const Options& options)
{
    const std::vector<double> toi = times(kind, coordinates, options);
    const PairView pairs = PairView::interleaved(coordinates.data(), toi.size());
    std::vector<Contact> contacts;
    std::vector<std::size_t> invalid;
    Contact earliest{};
    testing::require(find_contacts(kind, pairs, options, contacts, &invalid).ok());
    testing::require(earliest_contact(kind, pairs, options, earliest).ok());
    auto contact = contacts.begin();
    auto bad = invalid.begin();
    Contact first{no_pair, no_contact};
    for (std::size_t i = 0; i < toi.size(); ++i) {
        if (std::isnan(toi[i])) {
            testing::require(bad != invalid.end() && *bad++ == i);
        } else if (toi[i] <= 1.0) {
            testing::require(contact != contacts.end() && contact->pair == i && contact->toi == toi[i]);
            if (toi[i] < first.toi) first = *contact;
            ++contact;
        }
    }
    testing::require(contact == contacts.end() && bad == invalid.end());
    testing::require(earliest.pair == first.pair && earliest.toi == first.toi);
}

/// Rounded to floats, read as they are and widened; in records of pairs and, as blocks, with others behind.
void check_floats(PairKind kind, const std::vector<double>& coordinates, const Options& options)
{
    constexpr double largest = std::numeric_limits<float>::max();
    const std::size_t size = coordinates.size() / pair_coordinates;
    std::vector<float> records, blocks((size + block_pairs - 1) / block_pairs * block_coordinates);
    for (const double x : coordinates) records.push_back(static_cast<float>(std::isfinite(x) ? std::clamp(x, -largest, largest) : x));
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t c = 0; c < pair_coordinates; ++c) blocks[blocked_index(i, c)] = records[i * pair_coordinates + c];
    Options reference = options;
    reference.reference = true;
    const std::vector<double> expected = times(kind, {records.begin(), records.end()}, reference);
    std::vector<double> found(size);
    for (const PairView& view : {PairView::interleaved(records.data(), size), PairView::blocked(blocks.data(), size)}) {
        testing::require(time_of_impact(kind, view, options, found).ok());
        testing::require(std::memcmp(found.data(), expected.data(), size * sizeof(double)) == 0);
    }
}

/// Of three of the pairs, enough for boxes: every vertex with every face (x1 x2 x3 of a pair), or every edge (x0 x1, x2 x3) with every edge.
template <class Pair>
void check_mesh(const std::vector<double>& coordinates, const Options& options)
{
    constexpr bool faces = std::is_same_v<Pair, VertexFace>;
    const auto count = static_cast<std::int32_t>(std::min<std::size_t>(coordinates.size() / pair_coordinates, 3));
    std::vector<double> start, end;
    std::vector<std::int32_t> rows;
    for (std::int32_t i = 0; i < count; ++i) {
        const double* const pair = &coordinates[static_cast<std::size_t>(i) * pair_coordinates];
        start.insert(start.end(), pair, pair + 12);
        end.insert(end.end(), pair + 12, pair + 24);
        for (std::int32_t corner = faces ? 1 : 0; corner < 4; ++corner) rows.push_back(4 * i + corner);
    }
    const std::int32_t primitives = faces ? count : 2 * count, firsts = faces ? 4 * count : primitives;
    std::vector<Pair> pairs;
    std::vector<double> packed;
    for (std::int32_t first = 0; first < firsts; ++first)
        for (std::int32_t second = 0; second < primitives; ++second) {
            pairs.push_back({first, second});
            const std::size_t corners = faces ? 3 : 2;
            for (const std::vector<double>* positions : {&start, &end}) {
                const auto put = [&](std::int32_t vertex) {
                    const auto at = positions->begin() + 3 * vertex;
                    packed.insert(packed.end(), at, at + 3);
                };
                if (faces) put(first);
                for (std::size_t k = 0; !faces && k < 2; ++k) put(rows[2 * static_cast<std::size_t>(first) + k]);
                for (std::size_t k = 0; k < corners; ++k) put(rows[corners * static_cast<std::size_t>(second) + k]);
            }
        }
    Options reference = options;
    reference.reference = true;
    const std::vector<double> expected = times(faces ? PairKind::vertex_face : PairKind::edge_edge, packed, reference);
    const IndexView view = IndexView::rows(rows.data(), static_cast<std::size_t>(primitives), faces ? 3 : 2);
    const std::size_t vertices = start.size() / 3;
    const MovingMesh mesh{PositionView::rows(start.data(), vertices), PositionView::rows(end.data(), vertices),
                          faces ? view : IndexView{}, faces ? IndexView{} : view};
    std::vector<double> found(pairs.size());
    testing::require(time_of_impact(mesh, std::span<const Pair>{pairs}, options, found).ok());
    testing::require(std::memcmp(found.data(), expected.data(), found.size() * sizeof(double)) == 0);
}

/// Doubles of any bytes are hundreds of binades apart. Rational arithmetic takes a second for those; exact_test has a family of
/// them. 128 is a choice: ordinary coordinates and their mutated exponents.
bool within_few_binades(const std::vector<double>& coordinates)
{
    constexpr double range = 0x1p128;
    double smallest = INFINITY, largest = 0.0;
    for (const double x : coordinates)
        if (x != 0.0 && std::isfinite(x)) smallest = std::min(smallest, std::abs(x)), largest = std::max(largest, std::abs(x));
    return largest / range <= smallest;
}

void check_exact(PairKind kind, const std::vector<double>& coordinates, Options options)
{
    const std::vector<double> possible = times(kind, coordinates, options);
    options.exact = true;
    const std::vector<double> exact = times(kind, coordinates, options);
    for (std::size_t i = 0; i < exact.size(); ++i)
        testing::require(std::isnan(possible[i]) ? std::isnan(exact[i]) : exact[i] >= possible[i]);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    constexpr std::size_t pair_bytes = pair_coordinates * sizeof(double);
    if (size < 1 + pair_bytes) return 0;
    Options options;
    options.tolerance = std::ldexp(1.0, -static_cast<int>(data[0] % 51));
    options.t_max = data[0] % 3 == 0 ? 1.0 : 1.0 / (1 + data[0]);
    std::vector<double> coordinates((size - 1) / pair_bytes * pair_coordinates);
    std::memcpy(coordinates.data(), data + 1, coordinates.size() * sizeof(double));
    const std::size_t rest = (size - 1) % pair_bytes;
    if (rest == sizeof(double)) {
        std::memcpy(&options.minimum_separation, data + size - rest, rest);
        options.minimum_separation = std::abs(options.minimum_separation);
        if (!std::isfinite(options.minimum_separation)) return 0;
    }
    check(PairKind::vertex_face, coordinates, options);
    check(PairKind::edge_edge, coordinates, options);
    check_mesh<VertexFace>(coordinates, options);
    check_mesh<EdgeEdge>(coordinates, options);
    for (const PairKind kind : {PairKind::vertex_face, PairKind::edge_edge}) {
        check_lists(kind, coordinates, options);
        check_floats(kind, coordinates, options);
    }
    if (rest == 1 && within_few_binades(coordinates)) {
        check_exact(PairKind::vertex_face, coordinates, options);
        check_exact(PairKind::edge_edge, coordinates, options);
    }
    return 0;
}
