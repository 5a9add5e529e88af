#include "narrow_phase.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace fastccd::testing {

PairKind pair_kind(oracle::Kind kind)
{
    return kind == oracle::Kind::vertex_face ? PairKind::vertex_face : PairKind::edge_edge;
}

const char* kind_name(oracle::Kind kind) { return kind == oracle::Kind::vertex_face ? "vertex-face" : "edge-edge"; }

PairBuffer to_buffer(const std::vector<oracle::Pair>& pairs)
{
    PairBuffer buffer{pairs.size()};
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (std::size_t c = 0; c < pair_coordinates; ++c) buffer.at(i, c) = pairs[i][c / 3][c % 3];
    return buffer;
}

PairView interleaved(const std::vector<oracle::Pair>& pairs)
{
    static_assert(sizeof(oracle::Pair) == pair_coordinates * sizeof(double));
    return PairView::interleaved(pairs.empty() ? nullptr : pairs[0][0].data(), pairs.size());
}

Answer answer(oracle::Kind kind, const PairView& pairs, const Options& options)
{
    Answer result;
    result.toi.resize(pairs.size());
    result.roots.resize(pairs.size());
    const Status status =
        time_of_impact(pair_kind(kind), pairs, options, result.toi, &result.summary, result.roots);
    if (!status.ok()) throw std::runtime_error(message(status.error));
    return result;
}

Answer answer_without_roots(oracle::Kind kind, const PairView& pairs, const Options& options)
{
    Answer result;
    result.toi.resize(pairs.size());
    const Status status = time_of_impact(pair_kind(kind), pairs, options, result.toi, &result.summary);
    if (!status.ok()) throw std::runtime_error(message(status.error));
    return result;
}

std::vector<Isa> isas_to_test()
{
    static const std::vector<Isa> found = [] {
        std::vector<Isa> isas;
        for (const Isa isa : {Isa::scalar, Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon}) {
            if (isa_available(isa))
                isas.push_back(isa);
            else if (isa_built(isa))
                std::fprintf(stderr, "NOT TESTED: this machine lacks %s; its kernels were built but not run\n", name(isa));
        }
        return isas;
    }();
    return found;
}

std::size_t first_difference(const Answer& a, const Answer& b)
{
    const std::size_t n = std::min(a.toi.size(), b.toi.size());
    for (std::size_t i = 0; i < n; ++i)
        if (std::memcmp(&a.toi[i], &b.toi[i], sizeof(double)) != 0 || a.roots[i] != b.roots[i]) return i;
    return n;
}

std::string lossless(const oracle::Pair& pair)
{
    std::string text;
    for (const auto& point : pair)
        for (const double x : point) {
            char number[40];
            std::snprintf(number, sizeof number, "%a ", x);
            text += number;
        }
    return text;
}

}  // namespace fastccd::testing
