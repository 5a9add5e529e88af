// The stages of the pipeline, one by one. Compiled once per instruction set, like the kernels and with the same flags, in a namespace of its own.
//
// Each stage reads its input from queues as the pipeline does and hands its results to `keep`, which costs nothing but
// makes the compiler compute them: the cost of queueing what goes on is the pipeline's, not the stage's.
#include <kernel_lane.hpp>
#include <stage_table.hpp>

#include <area_inclusion.hpp>
#include <halves_certificate.hpp>
#include <householder.hpp>
#include <projected_inclusion.hpp>
#include <records.hpp>
#include <sign_change.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

namespace {

using L = KernelLane;
constexpr unsigned width = Lane<L>::width;

#if defined(__aarch64__)
#define FASTCCD_VECTOR_REGISTER "w"
#else
#define FASTCCD_VECTOR_REGISTER "x"
#endif

/// Makes the compiler believe that x is used.
FASTCCD_INLINE void keep(L x)
{
#if defined(FASTCCD_KERNEL_ARCH)
    asm volatile("" : : FASTCCD_VECTOR_REGISTER(x.data));
#else
    asm volatile("" : : FASTCCD_VECTOR_REGISTER(x));
#endif
}

FASTCCD_INLINE unsigned count(unsigned lanes) { return static_cast<unsigned>(__builtin_popcount(lanes)); }

/// Calls stage(record) with every batch of the queues, and adds up the lanes it keeps.
template <class Queue, class StageOfRecord>
FASTCCD_INLINE unsigned for_each_batch(const Queue* queues, StageOfRecord stage)
{
    unsigned kept = 0;
    for (unsigned q = 0; q < bench::stage_queues; ++q)
        for (unsigned i = 0; i < Queue::drain_at; i += width) {
            PairRecord<L> record;
            read(queues[q], i, record);
            kept += count(stage(record));
        }
    return kept;
}

/// What is computed of the pairs, loading included.
enum class Certificates {
    screening,  ///< Length and volume: what every pair costs.
    whole,      ///< All three on the whole interval.
    halves,     ///< Screening, then volume and area on both halves, as the pipeline goes on.
};

/// In the lanes that pairs are screened in.
template <PairKind kind, Certificates wanted>
unsigned certificates(const bench::StageInput& input)
{
    using S = typename Lane<L>::Screening;
    const ErrorBounds& all = input.parameters->bounds;
    const ScreeningBounds bounds = Lane<S>::is_single ? all.screening_in_single() : all.screening();
    unsigned kept = 0;
    for (std::size_t i = 0; i < input.pairs; i += Lane<S>::width) {
        InRows<L> parts[Lane<S>::width / width];
        for (std::size_t j = i; InRows<L>& part : parts) {
            part = {input.blocks + j / block_pairs * block_coordinates + j % block_pairs, block_pairs};
            j += width;
        }
        const RelativeMotion<S> r = relative_motion_in<S, L>(parts, input.parameters->t_max);
        Extents<S> extents;
        LaneMask<S> apart = linear_certificate<kind>(r, bounds.whole, extents);
        const Scales<S> scale = scales(extents);
        const CoplanarityCubic<S> cubic = coplanarity_cubic(r, cross_product(r, 0, 1));
        apart = apart | cubic_certificate(cubic, scale.volume, bounds.whole);
        if constexpr (wanted != Certificates::screening)
            apart = apart |
                    visit_edge_functions<kind>(r, [&](const auto& p, const auto& q, const auto& t, const auto& s) FASTCCD_INLINE_LAMBDA {
                        if constexpr (wanted == Certificates::whole)
                            return quadratic_certificate<kind>(p, q, t, s, scale, bounds.whole);
                        const auto on = halves_certificate<kind>(cubic, p, q, t, s, scale, bounds.halves);
                        return on.first & on.second;
                    });
        kept += count(Lane<S>::bits(in_lane_range(cubic, extents, bounds)) & ~Lane<S>::bits(apart));
    }
    return kept;
}

template <Certificates wanted>
unsigned certificates(const bench::StageInput& input)
{
    return input.kind == PairKind::vertex_face ? certificates<PairKind::vertex_face, wanted>(input)
                                               : certificates<PairKind::edge_edge, wanted>(input);
}

/// The monotone pieces of the cubic and the first in which it changes sign.
unsigned sign_change(const bench::StageInput& input)
{
    return for_each_batch(input.candidates, [&](PairRecord<L>& record) FASTCCD_INLINE_LAMBDA {
        compute_pair_again(record);
        const Window<L> window = window_of(record.pair);
        const MonotonePieces<L> pieces = monotone_pieces(bernstein(record.cubic), record.scale.volume, input.parameters->bounds,
                                                         input.parameters->leaf_width, window.low, window.high);
        const LaneMask<L> first = opposite_signs(pieces.value[0], pieces.value[1]);
        const LaneMask<L> second = opposite_signs(pieces.value[1], pieces.value[2]);
        const LaneMask<L> third = opposite_signs(pieces.value[2], pieces.value[3]);
        keep(select<L>(first, pieces.time[0], select<L>(second, pieces.time[1], pieces.time[2])));
        keep(select<L>(first, pieces.time[1], select<L>(second, pieces.time[2], pieces.time[3])));
        keep(pieces.f.c0), keep(pieces.f.c1), keep(pieces.f.c2), keep(pieces.f.c3);
        return Lane<L>::bits(pieces.certain & (first | second | third));
    });
}

/// Householder's steps as the pipeline takes them before it dismisses roots, clipped to the piece.
unsigned householder_clipped(const bench::StageInput& input)
{
    return for_each_batch(input.roots, [&](PairRecord<L>& root) FASTCCD_INLINE_LAMBDA {
        compute_again(root, *input.parameters);
        L guess = (root.low + root.high) * broadcast<L>(0.5);
        for (int step = 0; step < quick_steps; ++step) guess = clipped_step<L>(root.f, {root.low, root.high}, guess);
        keep(guess);
        return Lane<L>::bits(less_equal(guess, root.high));
    });
}

/// And as it takes them for the roots that few steps do not decide, on a bracket that closes.
unsigned householder_bracketed(const bench::StageInput& input)
{
    return for_each_batch(input.roots, [&](PairRecord<L>& root) FASTCCD_INLINE_LAMBDA {
        compute_again(root, *input.parameters);
        const L at_low = evaluate(root.f, root.low), at_high = evaluate(root.f, root.high);
        const LaneMask<L> rising = less(at_low, at_high);
        Bracket<L> bracket{root.low, root.high};
        L guess = first_guess(bracket, at_low, at_high);
        for (int step = 0; step < most_steps; ++step) guess = bracketed_step(root.f, rising, bracket, guess);
        keep(guess);
        return Lane<L>::bits(less_equal(guess, root.high));
    });
}

template <PairKind kind>
unsigned projected(const bench::StageInput& input)
{
    return for_each_batch(input.roots, [&](PairRecord<L>& root) FASTCCD_INLINE_LAMBDA {
        compute_again(root, *input.parameters);
        const Inclusion<L> found =
            projected_inclusion<kind>(root.r, root.scale, root.pair, broadcast<L>(quick_bracket), input.parameters->bounds);
        return (1u << width) - 1 - Lane<L>::bits(found.absent);
    });
}

template <PairKind kind>
unsigned area(const bench::StageInput& input)
{
    return for_each_batch(input.roots, [&](PairRecord<L>& root) FASTCCD_INLINE_LAMBDA {
        compute_again(root, *input.parameters);
        const LaneMask<L> absent =
            area_certificate<kind>(root.r, root.scale, root.pair, broadcast<L>(quick_bracket), input.parameters->bounds);
        return (1u << width) - 1 - Lane<L>::bits(absent);
    });
}

constexpr PairKind vf = PairKind::vertex_face, ee = PairKind::edge_edge;

template <unsigned (*vertex_face)(const bench::StageInput&), unsigned (*edge_edge)(const bench::StageInput&)>
unsigned by_kind(const bench::StageInput& input)
{
    return input.kind == vf ? vertex_face(input) : edge_edge(input);
}

}  // namespace

extern const bench::StageTable stage_table;
const bench::StageTable stage_table{Isa::FASTCCD_KERNEL_ISA,
                                    {{"screening", certificates<Certificates::screening>, true},
                                     {"certificates", certificates<Certificates::whole>, true},
                                     {"halves", certificates<Certificates::halves>, true},
                                     {"sign_change", sign_change, false},
                                     {"householder_clipped", householder_clipped, false},
                                     {"householder_bracketed", householder_bracketed, false},
                                     {"projected_inclusion", by_kind<projected<vf>, projected<ee>>, false},
                                     {"area_inclusion", by_kind<area<vf>, area<ee>>, false}}};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
