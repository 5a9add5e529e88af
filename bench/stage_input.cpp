// Compiled for any machine, with the scalar lanes in a namespace of their own (see kernels/lane.hpp).
#include "stage_input.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fastccd/fastccd.hpp>

#include <halves_certificate.hpp>
#include <householder.hpp>
#include <records.hpp>
#include <sign_change.hpp>

namespace fastccd::bench {

namespace {

using namespace FASTCCD_KERNEL_NAMESPACE;

constexpr unsigned queue_entries = PairQueue::drain_at;
static_assert(RootQueue::drain_at == queue_entries);

/// Pair number k of a walk through the whole data set in long strides, because neighbours in a scene are much alike.
/// The stride is a prime: unless it divides the size, the walk visits every pair once.
std::size_t visited(std::size_t k, std::size_t size)
{
    const std::size_t stride = size % 7919 != 0 ? 7919 : 7907;
    return k * stride % size;
}

using Coordinates = std::array<double, pair_coordinates>;

Coordinates coordinates(const PairBuffer& packed, std::size_t i)
{
    Coordinates pair{};
    for (std::size_t c = 0; c < pair_coordinates; ++c) pair[c] = packed.at(i, c);
    return pair;
}

/// Appends to the first queue that is not full; false if all are.
template <class Queue>
bool append(std::vector<Queue>& queues, const PairRecord<double>& record)
{
    for (Queue& queue : queues)
        if (queue.size < queue_entries) {
            push(queue, 1u, record);
            return true;
        }
    return false;
}

/// The record as it leaves the certificates; false if one of them dismisses the pair.
template <PairKind kind>
bool passes_certificates(const Coordinates& pair, const SearchParameters& parameters, PairRecord<double>& record)
{
    const CertificateBounds bounds = parameters.bounds.certificates();
    record.pair = 0.0;
    record.r = relative_motion<double>(pair.data(), 1, parameters.t_max);
    Extents<double> extents{};
    const bool separated = linear_certificate<kind>(record.r, bounds, extents).value;
    record.scale = scales(extents);
    record.cubic = coplanarity_cubic(record.r, cross_product(record.r, 0, 1));
    if (separated || cubic_certificate(record.cubic, record.scale.volume, bounds).value) return false;
    const auto apart = visit_edge_functions<kind>(record.r, [&](const auto& p, const auto& q, const auto& t, const auto& s) {
        return halves_certificate<kind>(record.cubic, p, q, t, s, record.scale, parameters.bounds.halves());
    });
    record.pair = record.pair + window_mark(apart);
    return !(apart.first.value && apart.second.value) && in_lane_range(record.cubic, extents, parameters.bounds.screening()).value;
}

/// Fills in the first piece in which the cubic changes sign; false if there is none for certain.
bool has_root(const SearchParameters& parameters, PairRecord<double>& record)
{
    const Window<double> window = window_of(record.pair);
    const MonotonePieces<double> pieces = monotone_pieces(bernstein(record.cubic), record.scale.volume, parameters.bounds,
                                                          parameters.leaf_width, window.low, window.high);
    if (!pieces.certain.value) return false;
    for (int i = 0; i < 3; ++i) {
        if (!opposite_signs(pieces.value[i], pieces.value[i + 1]).value) continue;
        record.f = pieces.f;
        record.threshold = pieces.threshold;
        record.low = pieces.time[i];
        record.high = pieces.time[i + 1];
        record.pair = (record.low + record.high) * 0.5;
        for (int step = 0; step < quick_steps; ++step)
            record.pair = clipped_step<double>(record.f, {record.low, record.high}, record.pair);
        return true;
    }
    return false;
}

}  // namespace

StageData::StageData(PairKind kind, const PairBuffer& packed, const SearchParameters& parameters)
    : kind_{kind}, parameters_{parameters}, blocks_{stage_pairs}, candidates_(stage_queues), roots_(stage_queues)
{
    if (packed.size() == 0) throw std::runtime_error("a data set without pairs has no stages");
    for (std::size_t k = 0; k < stage_pairs; ++k) blocks_.set(k, coordinates(packed, visited(k, packed.size())));
    if (kind == PairKind::vertex_face)
        fill_queues<PairKind::vertex_face>(packed);
    else
        fill_queues<PairKind::edge_edge>(packed);
}

template <PairKind kind>
void StageData::fill_queues(const PairBuffer& packed)
{
    PairRecord<double> record{};
    bool all_full = false;
    while (!all_full) {
        bool any = false;
        for (std::size_t k = 0; k < packed.size() && !all_full; ++k) {
            if (!passes_certificates<kind>(coordinates(packed, visited(k, packed.size())), parameters_, record)) continue;
            const bool candidates_full = !append(candidates_, record);
            if (!has_root(parameters_, record)) continue;
            any = true;
            all_full = !append(roots_, record) && candidates_full;
        }
        if (!any) throw std::runtime_error("no pair of the data set reaches the last stages");
    }
}

}  // namespace fastccd::bench
