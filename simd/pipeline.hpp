// The stages of the narrow phase over one tile:
//
//     block -> length, volume certificates -> [screened] -> area certificate, sign-change intervals,
//                     |                                       first Householder steps, coarse inclusion
//                     v                                           |             |               |
//                   apart                              [later_pieces] again   apart         [survivors]
//                                                                                                 |
//          certified search  <- undecided, here and above -  refinement, leaf, inclusion <--------+
//                                                                  |
//                                                                  v
//                                                           contact or apart
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
#include <records.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <PairKind kind, class L>
class Pipeline {
public:
    static void run_tile(const TileRequest& request, TileScratch& scratch)
    {
        Pipeline pipeline{*request.parameters, request.cutoff, scratch};
        pipeline.prepare();
        for (std::size_t i = 0; i < request.count; i += block_pairs) {
            const std::size_t count = request.count - i < block_pairs ? request.count - i : block_pairs;
            const double* block = native_block<kind, L>(*request.source, request.first + i, count, scratch.block);
            for (unsigned lane = 0; lane < count; lane += width) {
                pipeline.screen(block + lane, static_cast<double>(i + lane), all_lanes(request.count - i - lane));
                if (scratch.screened.size >= PairQueue::drain_at) pipeline.find_roots(false);
            }
        }
        pipeline.find_roots(true);
        pipeline.reject_later_pieces(true);
        pipeline.refine(true);
    }

private:
    static constexpr unsigned width = Lane<L>::width;

    const SearchParameters& parameters;
    const CertificateBounds whole, early;
    const double cutoff;
    TileScratch& scratch;

    FASTCCD_INLINE Pipeline(const SearchParameters& p, double c, TileScratch& s)
        : parameters{p}, whole{p.bounds.certificates()}, early{p.bounds.early()}, cutoff{c}, scratch{s}
    {
    }

    FASTCCD_INLINE void prepare()
    {
        for (std::size_t i = 0; i < tile_pairs; i += Lane<L>::width)
            Lane<L>::store(&scratch.time[i], broadcast<L>(__builtin_inf()));
        __builtin_memset(scratch.roots, 0, sizeof scratch.roots);
        __builtin_memset(scratch.reported, 0, sizeof scratch.reported);
        __builtin_memset(scratch.is_undecided, 0, sizeof scratch.is_undecided);
        scratch.screened.size = scratch.later_pieces.size = scratch.survivors.size = 0;
    }

    /// Bits of a batch of which `left` lanes are in use.
    FASTCCD_INLINE static unsigned all_lanes(std::size_t left)
    {
        return left >= width ? (1u << width) - 1 : (1u << left) - 1;
    }

    FASTCCD_INLINE static void set_bit(std::uint64_t* words, unsigned i) { words[i / 64] |= std::uint64_t{1} << i % 64; }

    FASTCCD_INLINE void leave_undecided(L pair, unsigned lanes)
    {
        alignas(64) double pairs[width];
        Lane<L>::store(pairs, pair);
        for (; lanes != 0; lanes &= lanes - 1)
            set_bit(scratch.is_undecided, static_cast<unsigned>(pairs[__builtin_ctz(lanes)]));
    }

    /// Length and volume certificates on the whole interval. Most lanes end here; the others are packed, so that
    /// the costlier area certificate runs on full batches.
    FASTCCD_INLINE void screen(const double* coordinates, double first, unsigned lanes)
    {
        PairRecord<L> record;
        record.r = relative_motion<L>(coordinates, block_pairs, parameters.t_max);
        Extents<L> extents;
        const LaneMask<L> separated = linear_certificate<kind>(record.r, whole, extents);
        record.scale = scales(extents);
        record.cubic = coplanarity_cubic(record.r, cross_product(record.r, 0, 1));
        record.pair = broadcast<L>(first) + Lane<L>::lane_number();

        const LaneMask<L> in_range = in_lane_range(record.cubic, extents);
        const LaneMask<L> apart = separated | cubic_certificate(record.cubic, record.scale.volume, whole);
        const unsigned decidable = lanes & Lane<L>::bits(in_range);
        if (const unsigned beyond = lanes & ~decidable; beyond != 0) leave_undecided(record.pair, beyond);
        unsigned kept = decidable & ~Lane<L>::bits(apart);
        if (kept != 0 && cutoff < 1.0) kept &= ~Lane<L>::bits(apart_until_cutoff(record));
        if (kept != 0) push(scratch.screened, kept, record);
    }

    /// The three certificates on [0, cutoff] and one leaf more, with bounds under which the certified search
    /// finds every leaf there apart: toi is greater than the cutoff. Only the end of the motion moves; errors are
    /// those of an interpolated end, and the scale is that of the whole motion, to which the search's bounds refer.
    FASTCCD_INLINE LaneMask<L> apart_until_cutoff(const PairRecord<L>& record)
    {
        const L end = broadcast<L>(cutoff + 2 * parameters.leaf_width < 1.0 ? cutoff + 2 * parameters.leaf_width : 1.0);
        const RelativeMotion<L> r{{record.r.start[0], record.r.start[1], record.r.start[2]},
                                  {position(record.r, 0, end), position(record.r, 1, end), position(record.r, 2, end)}};
        const CoplanarityCubic<L> cubic = coplanarity_cubic(r, cross_product(r, 0, 1));
        const auto apart_in_projections = visit_edge_functions<kind>(
            r, [&](const auto& p, const auto& q, const auto& t, const auto& s) FASTCCD_INLINE_LAMBDA {
                return quadratic_certificate<kind>(p, q, t, s, record.scale, early);
            });
        return cubic_certificate(cubic, record.scale.volume, early) | apart_in_projections;
    }

    /// Takes full batches from the front of a queue, and the rest too if `all`.
    template <class Queue, class Stage>
    FASTCCD_INLINE static void drain(Queue& queue, bool all, Stage stage)
    {
        PairRecord<L> record;
        unsigned done = 0;
        for (; done < queue.size && (all || queue.size - done >= width); done += width) {
            read(queue, done, record);
            stage(record, all_lanes(queue.size - done));
        }
        drop_front(queue, done);
    }

    /// Area certificate; then the pieces in which the cubic changes sign, of which the first is pursued at once.
    void find_roots(bool all)
    {
        drain(scratch.screened, all, [&](PairRecord<L>& record, unsigned lanes) FASTCCD_INLINE_LAMBDA {
            const auto apart = visit_edge_functions<kind>(
                record.r, [&](const auto& p, const auto& q, const auto& t, const auto& s) FASTCCD_INLINE_LAMBDA {
                    return quadratic_certificate<kind>(p, q, t, s, record.scale, whole);
                });
            lanes &= ~Lane<L>::bits(apart);
            if (lanes != 0) find_roots(record, lanes);
        });
    }

    FASTCCD_INLINE void find_roots(PairRecord<L>& record, unsigned lanes)
    {
        const MonotonePieces<L> pieces =
            monotone_pieces(bernstein(record.cubic), record.scale.volume, parameters.bounds, parameters.leaf_width);
        record.f = pieces.f;
        record.threshold = pieces.threshold;
        const unsigned certain =
            lanes & Lane<L>::bits(pieces.certain & less(broadcast<L>(smallest_volume), record.scale.volume));
        if (certain != lanes) leave_undecided(record.pair, lanes & ~certain);

        const LaneMask<L> in_first = opposite_signs(pieces.value[0], pieces.value[1]);
        const LaneMask<L> in_second = opposite_signs(pieces.value[1], pieces.value[2]);
        const LaneMask<L> in_third = opposite_signs(pieces.value[2], pieces.value[3]);
        const auto set_piece = [&](L low, L high) FASTCCD_INLINE_LAMBDA {
            record.low = low;
            record.high = high;
            record.guess = (low + high) * broadcast<L>(0.5);
        };
        // A second root lies in the second piece (after one in the first) or in the third; a third one is rare.
        const LaneMask<L> first_two = in_first & in_second;
        if (const unsigned again = certain & Lane<L>::bits(first_two | (in_third & (in_first | in_second))); again != 0) {
            set_piece(select<L>(first_two, pieces.time[1], pieces.time[2]),
                      select<L>(first_two, pieces.time[2], pieces.time[3]));
            push(scratch.later_pieces, again, record);
        }
        if (const unsigned again = certain & Lane<L>::bits(first_two & in_third); again != 0) {
            set_piece(pieces.time[2], pieces.time[3]);
            push(scratch.later_pieces, again, record);
        }
        if (const unsigned found = certain & Lane<L>::bits(in_first | in_second | in_third); found != 0) {
            set_piece(select<L>(in_first, pieces.time[0], select<L>(in_second, pieces.time[1], pieces.time[2])),
                      select<L>(in_first, pieces.time[1], select<L>(in_second, pieces.time[2], pieces.time[3])));
            reject_coarsely(record, found);
        }
        if (scratch.later_pieces.size >= RootQueue::drain_at) reject_later_pieces(false);
    }

    /// The sides of a bracket of half width delta around the guess, within the piece, when f certainly
    /// changes sign between them: then the piece's only root lies inside.
    struct RootBracket {
        L low, high;
        LaneMask<L> certain;
    };
    FASTCCD_INLINE static RootBracket bracket_root(const PairRecord<L>& root, L delta)
    {
        const L low = max(root.guess - delta, root.low);
        const L high = min(root.guess + delta, root.high);
        const L at_low = evaluate(root.f, low), at_high = evaluate(root.f, high);
        const LaneMask<L> beyond = less(root.threshold, min(abs(at_low), abs(at_high)));
        return {low, high, beyond & opposite_signs(at_low, at_high)};
    }

    void reject_later_pieces(bool all)
    {
        drain(scratch.later_pieces, all, [&](PairRecord<L>& root, unsigned lanes) FASTCCD_INLINE_LAMBDA {
            reject_coarsely(root, lanes);
        });
    }

    /// Two steps towards the root; dismisses lanes without inclusion anywhere near it.
    FASTCCD_INLINE void reject_coarsely(PairRecord<L>& root, unsigned lanes)
    {
        root.guess = clipped_steps<L>(root.f, {root.low, root.high}, root.guess, coarse_steps);
        const L delta = broadcast<L>(coarse_bracket);
        const RootBracket bracket = bracket_root(root, delta);
        // One leaf more on either side: the margin of the certified search.
        const Inclusion<L> inclusion = projected_inclusion<kind>(
            root.r, root.scale, root.guess, delta + broadcast<L>(parameters.leaf_width), parameters.bounds);
        const unsigned kept = lanes & ~Lane<L>::bits(bracket.certain & inclusion.absent);
        if (kept == 0) return;
        push(scratch.survivors, kept, root);
        if (scratch.survivors.size >= RootQueue::drain_at) refine(false);
    }

    void refine(bool all)
    {
        drain(scratch.survivors, all, [&](PairRecord<L>& root, unsigned lanes) FASTCCD_INLINE_LAMBDA {
            const LaneMask<L> rising = less(evaluate(root.f, root.low), evaluate(root.f, root.high));
            root.guess = bracketed_steps<L>(root.f, rising, {root.low, root.high}, root.guess, fine_steps);
            decide(root, lanes);
        });
    }

    /// The leaf that holds the refined root, proofs on both sides of it, and inclusion within it.
    FASTCCD_INLINE void decide(const PairRecord<L>& root, unsigned lanes)
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
        if (contact != 0) record_contacts(root.pair, left, contact);
        if (undecided != 0) leave_undecided(root.pair, undecided);
    }

    FASTCCD_INLINE void record_contacts(L pair, L left, unsigned contact)
    {
        alignas(64) double pairs[width], lefts[width];
        Lane<L>::store(pairs, pair);
        Lane<L>::store(lefts, left);
        for (unsigned bits = contact; bits != 0; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits);
            const unsigned i = static_cast<unsigned>(pairs[lane]);
            if (lefts[lane] < scratch.time[i]) scratch.time[i] = lefts[lane];
            ++scratch.roots[i];
            set_bit(scratch.reported, i);
        }
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
