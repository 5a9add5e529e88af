// The stages of the narrow phase over one tile:
//
//     block -> certificates -> sign-change intervals -> [candidates] -> Householder, coarse inclusion
//                 | drops most      | undecided                             | dismisses most
//                 v                 v                                       v
//               apart         certified search   <- undecided -  [survivors] -> refinement, inclusion -> contact
//
// What lanes conclude is what the certified search (scalar/certified_search.hpp) would conclude:
// - "apart" is concluded only with margins under which the search certifies every leaf: certificates and
//   sign tests cover [0, 1] by intervals that overlap by at least one leaf (see error_bound.hpp);
// - "contact in leaf j" is concluded only from a proof (a strict sign change of the cubic over the leaf and
//   strict inclusion throughout it), so that no certificate of absence can hold there, together with
//   "apart" for everything before it.
// Everything else is left undecided. So the bits do not depend on the instruction set or the batch.
#pragma once

#include <area_inclusion.hpp>
#include <block_source.hpp>
#include <householder.hpp>
#include <projected_inclusion.hpp>
#include <root_record.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <PairKind kind, class L>
class Pipeline {
public:
    static void run_tile(const TileRequest& request, TileScratch& scratch)
    {
        Pipeline pipeline{*request.parameters, scratch};
        pipeline.prepare(request.count);
        for (std::size_t i = 0; i < request.count; i += block_pairs) {
            const std::size_t count = request.count - i < block_pairs ? request.count - i : block_pairs;
            const double* block = native_block(*request.pairs, request.first + i, count, scratch.block);
            for (unsigned lane = 0; lane < count; lane += width) {
                pipeline.filter(block + lane, static_cast<double>(i + lane), static_cast<double>(request.count));
                if (scratch.candidates.size >= RootQueue::drain_at) pipeline.reject_coarsely(false);
            }
        }
        pipeline.reject_coarsely(true);
        pipeline.refine(true);
    }

private:
    static constexpr unsigned width = Lane<L>::width;

    /// Half width of the bracket on which candidates are dismissed before full refinement, and of the one
    /// around a refined root. Coarse: two Householder steps usually come closer, and edge functions of
    /// most candidates differ from zero by more than 8 times this. Fine: small against any curvature
    /// that matters, large against E_tol.
    static constexpr double coarse_bracket = 0x1p-8;
    static constexpr double fine_bracket = 0x1p-16;
    static constexpr int coarse_steps = 2;
    static constexpr int fine_steps = 4;

    const SearchParameters& parameters;
    TileScratch& scratch;

    FASTCCD_INLINE Pipeline(const SearchParameters& p, TileScratch& s) : parameters{p}, scratch{s} {}

    FASTCCD_INLINE void prepare(std::size_t count)
    {
        for (std::size_t i = 0; i < count; ++i) scratch.parameter[i] = __builtin_inf();
        for (std::size_t i = 0; i < count; ++i) scratch.roots[i] = scratch.is_undecided[i] = 0;
        scratch.undecided_count = 0;
        scratch.candidates.size = scratch.survivors.size = 0;
    }

    FASTCCD_INLINE void leave_undecided(unsigned pair)
    {
        if (scratch.is_undecided[pair]) return;
        scratch.is_undecided[pair] = 1;
        scratch.undecided[scratch.undecided_count++] = static_cast<std::uint16_t>(pair);
    }

    /// Certificates on the whole interval, then the pieces in which the cubic changes sign.
    FASTCCD_INLINE void filter(const double* coordinates, double first, double count)
    {
        const RelativeMotion<L> r = relative_motion<L>(coordinates, block_pairs, parameters.t_max);
        Extents<L> extents;
        const LaneMask<L> separated = linear_certificate<kind>(r, parameters.bounds, extents);
        const Scales<L> scale = scales(extents);
        const QuadraticVector<L> p = cross_product(r, 0, 1);
        const CoplanarityCubic<L> cubic = coplanarity_cubic(r, p);

        const L pair = broadcast<L>(first) + Lane<L>::lane_number();
        const LaneMask<L> in_range = in_lane_range(cubic, extents);
        const LaneMask<L> exists = less(pair, broadcast<L>(count));
        LaneMask<L> apart = separated | cubic_certificate(cubic, scale.volume, parameters.bounds);
        if (Lane<L>::bits(exists & !(apart & in_range)) == 0) return;

        apart = apart | quadratic_certificate<kind>(edge_functions<kind>(r, p), scale, parameters.bounds);
        const LaneMask<L> alive = exists & !(apart & in_range);
        const unsigned alive_bits = Lane<L>::bits(alive);
        if (alive_bits == 0) return;

        const MonotonePieces<L> pieces =
            monotone_pieces(bernstein(cubic), scale.volume, parameters.bounds, parameters.leaf_width);
        const LaneMask<L> certain = pieces.certain & in_range & less(broadcast<L>(smallest_volume), scale.volume);
        for (unsigned bits = alive_bits & ~Lane<L>::bits(certain); bits != 0; bits &= bits - 1)
            leave_undecided(static_cast<unsigned>(first) + static_cast<unsigned>(__builtin_ctz(bits)));

        RootRecord<L> record;
        record.r = r;
        record.f = pieces.f;
        record.threshold = pieces.threshold;
        record.scale = scale;
        record.pair = pair;
        for (int i = 0; i < 3; ++i) {
            const LaneMask<L> changes = opposite_signs(pieces.value[i], pieces.value[i + 1]);
            const unsigned bits = Lane<L>::bits(alive & certain & changes);
            if (bits == 0) continue;
            record.low = pieces.time[i];
            record.high = pieces.time[i + 1];
            record.guess = (record.low + record.high) * broadcast<L>(0.5);
            push(scratch.candidates, bits, record);
        }
    }

    /// The sides of a bracket of half width delta around the guess, within the piece, when f certainly
    /// changes sign between them: then the piece's only root lies inside.
    struct RootBracket {
        L low, high;
        LaneMask<L> certain;
    };
    FASTCCD_INLINE static RootBracket bracket_root(const RootRecord<L>& root, L delta)
    {
        const L low = max(root.guess - delta, root.low);
        const L high = min(root.guess + delta, root.high);
        const L at_low = evaluate(root.f, low), at_high = evaluate(root.f, high);
        const LaneMask<L> beyond = less(root.threshold, min(abs(at_low), abs(at_high)));
        return {low, high, beyond & opposite_signs(at_low, at_high)};
    }

    FASTCCD_INLINE static void iterate(RootRecord<L>& root, int steps)
    {
        const LaneMask<L> rising = less(evaluate(root.f, root.low), evaluate(root.f, root.high));
        Bracket<L> bracket{root.low, root.high};
        for (int step = 0; step < steps; ++step) root.guess = householder_step(root.f, rising, bracket, root.guess);
    }

    FASTCCD_INLINE static unsigned bits_below(unsigned n) { return n >= width ? (1u << width) - 1 : (1u << n) - 1; }

    /// Candidates -> survivors. Takes full batches, and the rest too if `all`.
    FASTCCD_INLINE void reject_coarsely(bool all)
    {
        RootQueue& queue = scratch.candidates;
        unsigned done = 0;
        while (done < queue.size && (all || queue.size - done >= width)) {
            RootRecord<L> root = read<L>(queue, done);
            iterate(root, coarse_steps);
            const L delta = broadcast<L>(coarse_bracket);
            const RootBracket bracket = bracket_root(root, delta);
            // One leaf more on either side: the margin of the certified search.
            const Inclusion<L> inclusion =
                projected_inclusion<kind>(root.r, root.scale, root.guess, delta + broadcast<L>(parameters.leaf_width),
                                          parameters.bounds);
            const unsigned kept = bits_below(queue.size - done) & ~Lane<L>::bits(bracket.certain & inclusion.absent);
            if (kept != 0) push(scratch.survivors, kept, root);
            if (scratch.survivors.size >= RootQueue::drain_at) refine(false);
            done += width;
        }
        drop_front(queue, done < queue.size ? done : queue.size);
    }

    /// The leaf that holds the refined root, proofs on both sides of it, and inclusion within it.
    FASTCCD_INLINE void refine(bool all)
    {
        RootQueue& queue = scratch.survivors;
        unsigned done = 0;
        while (done < queue.size && (all || queue.size - done >= width)) {
            RootRecord<L> root = read<L>(queue, done);
            iterate(root, fine_steps);
            decide(root, bits_below(queue.size - done));
            done += width;
        }
        drop_front(queue, done < queue.size ? done : queue.size);
    }

    FASTCCD_INLINE void decide(const RootRecord<L>& root, unsigned lanes)
    {
        const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
        const L w = broadcast<L>(parameters.leaf_width);
        const RootBracket bracket = bracket_root(root, broadcast<L>(fine_bracket));

        // floor(guess / w), by adding and subtracting 2^52 (exact for 0 <= guess / w <= 2^50).
        const L scaled = root.guess * broadcast<L>(parameters.leaf_count);
        const L nearest = (scaled + broadcast<L>(0x1p52)) - broadcast<L>(0x1p52);
        const L leaf = select<L>(less(scaled, nearest), nearest - one, nearest);
        const L left = leaf * w;
        const L right = left + w;
        // Leaf 0 is the certified search's: it looks for a positive lower bound there.
        const LaneMask<L> inner = less(zero, left) & less_equal(right, one);

        // f has one strict sign from the bracket's low side (and a leaf before it) to the leaf, the other
        // from the leaf to the bracket's high side (and a leaf after it).
        const L before = max(min(bracket.low, left) - w, zero), after = min(max(bracket.high, right) + w, one);
        const QuadraticVector<L> p = cross_product(root.r, 0, 1);
        const Cubic<L> f = bernstein(coplanarity_cubic(root.r, p));
        const Cubic<L> f_before = on_interval(f, before, left), f_after = on_interval(f, right, after);
        const L bound = broadcast<L>(parameters.bounds.cubic_on_interval_lanes()) * root.scale.volume;
        const LaneMask<L> crosses =
            inner & bracket.certain &
            ((less(bound, smallest(f_before)) & less(largest(f_after), zero - bound)) |
             (less(largest(f_before), zero - bound) & less(bound, smallest(f_after))));

        const L half = broadcast<L>(0.5) * w;
        const L centre = left + half;
        const Inclusion<L> inclusion =
            projected_inclusion<kind>(root.r, root.scale, centre, half, parameters.bounds);
        const unsigned crossing = lanes & Lane<L>::bits(crosses);
        const unsigned contact = crossing & Lane<L>::bits(inclusion.present);
        unsigned undecided = lanes & ~contact & ~(crossing & Lane<L>::bits(inclusion.absent));
        if ((undecided & crossing) != 0)
            undecided &= ~(crossing & Lane<L>::bits(area_certificate<kind>(root.r, root.scale, centre, half, parameters.bounds)));
        if ((contact | undecided) != 0) record_results(root.pair, left, contact, undecided);
    }

    FASTCCD_INLINE void record_results(L pair, L left, unsigned contact, unsigned undecided)
    {
        alignas(64) double pairs[width], lefts[width];
        Lane<L>::store(pairs, pair);
        Lane<L>::store(lefts, left);
        for (unsigned bits = contact; bits != 0; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits);
            const unsigned i = static_cast<unsigned>(pairs[lane]);
            if (lefts[lane] < scratch.parameter[i]) scratch.parameter[i] = lefts[lane];
            ++scratch.roots[i];
        }
        for (unsigned bits = undecided; bits != 0; bits &= bits - 1)
            leave_undecided(static_cast<unsigned>(pairs[__builtin_ctz(bits)]));
    }
};

template <class L>
FASTCCD_INLINE void run_tile(const TileRequest& request, TileScratch& scratch)
{
    if (request.kind == PairKind::vertex_face)
        Pipeline<PairKind::vertex_face, L>::run_tile(request, scratch);
    else
        Pipeline<PairKind::edge_edge, L>::run_tile(request, scratch);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
