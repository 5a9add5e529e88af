// The stages of the narrow phase over one tile:
//
//     block -> length, volume certificates -> [screened] -> volume, area certificates -> [candidates] -> sign-change intervals,
//                     |                                     on both halves                       first Householder steps,
//                     v                                           |                              coarse inclusion
//                   apart                                         v                               |               |
//                                                               apart                           apart        [survivors]
//                                                                                                                 |
//                          certified search  <- undecided, here and above -  refinement, leaf, inclusion <--------+
//                                                                                  |
//                                                                                  v
//                                                                           contact or apart
//
// Queues pack what a stage leaves, so that the next one runs on full batches. Where few pairs are left, their coordinates are
// copied one by one; where most are, whole registers are compressed, and [screened] is left out.
//
// What lanes conclude is what the certified search (scalar/certified_search.hpp) would conclude:
// - "apart" is concluded only with margins under which the search certifies every leaf: certificates and
//   sign tests cover [0, 1] by intervals that overlap by at least one leaf, or by its halves, which
//   no leaf straddles (see error_bound.hpp);
// - "contact in leaf j" is concluded only from a proof (a strict sign change of the cubic over the leaf and
//   strict inclusion throughout it), so that no certificate of absence can hold there, together with
//   "apart" for everything before it.
// Everything else is left undecided. So the bits do not depend on the instruction set or the batch.
#pragma once

#include <area_inclusion.hpp>
#include <block_source.hpp>
#include <halves_certificate.hpp>
#include <householder.hpp>
#include <projected_inclusion.hpp>
#include <records.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <PairKind kind, class L>
class Pipeline {
public:
    static void run_tile(const TileRequest& request, TileScratch& scratch)
    {
        Pipeline pipeline{request, scratch};
        pipeline.prepare(request.count);
        for (std::size_t i = 0; i < pipeline.source.size(); i += group_pairs) {
            const std::size_t left = pipeline.source.size() - i, count = left < group_pairs ? left : group_pairs;
            if (scratch.dense) {
                pipeline.screen_dense_group(i, count);
            } else {
                pipeline.screen_group(i, count);
                pipeline.compare_screened(false);
            }
        }
        pipeline.compare_screened(true);
        pipeline.find_roots(true);
        pipeline.refine(true);
    }

private:
    static constexpr unsigned width = Lane<L>::width;

    const SearchParameters& parameters;
    const CertificateBounds whole, halves, early;
    const double cutoff;
    TileScratch& scratch;
    BlockSource<kind, L> source;

    FASTCCD_INLINE Pipeline(const TileRequest& request, TileScratch& s)
        : parameters{*request.parameters}, whole{parameters.bounds.certificates()}, halves{parameters.bounds.halves()}, early{parameters.bounds.early()},
          cutoff{request.cutoff}, scratch{s}, source{request, s}
    {
    }

    FASTCCD_INLINE void prepare(std::size_t count)
    {
        for (std::size_t i = 0; i < count; i += width)
            Lane<L>::store(&scratch.time[i], broadcast<L>(__builtin_inf()));
        __builtin_memset(scratch.roots, 0, count);
        __builtin_memset(scratch.reported, 0, sizeof scratch.reported);
        __builtin_memset(scratch.is_undecided, 0, sizeof scratch.is_undecided);
        scratch.screened.size = scratch.candidates.size = scratch.survivors.size = 0;
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

    /// What the length and volume certificates say of a batch.
    struct Screening {
        unsigned kept;    ///< Lanes to look into.
        unsigned beyond;  ///< Lanes whose coordinates lanes do not decide.
    };

    /// Length and volume certificates on the whole interval. Fills in the record but for `pair`.
    FASTCCD_INLINE Screening screen(const double* coordinates, PairRecord<L>& record)
    {
        record.r = relative_motion<L>(coordinates, block_pairs, parameters.t_max);
        Extents<L> extents;
        const LaneMask<L> separated = linear_certificate<kind>(record.r, whole, extents);
        record.scale = scales(extents);
        record.cubic = coplanarity_cubic(record.r, cross_product(record.r, 0, 1));
        const unsigned in_range = Lane<L>::bits(in_lane_range(record.cubic, extents, parameters.bounds));
        const unsigned apart = Lane<L>::bits(separated | cubic_certificate(record.cubic, record.scale.volume, whole));
        return {in_range & ~apart, all_lanes(width) & ~in_range};
    }

    /// For scenes, where most pairs end here: screens a group without looking at any result, which no branch predictor could
    /// foresee, then copies the coordinates of what is left, pair by pair, to [screened].
    void screen_group(std::size_t first, std::size_t count)
    {
        const double* blocks[group_pairs / block_pairs];
        std::uint64_t kept = 0, beyond = 0;
        for (std::size_t i = 0; i < count; i += block_pairs) {
            const double* const block = blocks[i / block_pairs] = source.block(first + i);
            for (unsigned lane = 0; lane < block_pairs; lane += width) {
                PairRecord<L> record;
                const Screening found = screen(block + lane, record);
                kept |= std::uint64_t{found.kept} << (i + lane);
                beyond |= std::uint64_t{found.beyond} << (i + lane);
            }
        }
        const std::uint64_t in_use = count < group_pairs ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
        kept &= in_use;
        for (beyond &= in_use; beyond != 0; beyond &= beyond - 1)
            set_bit(scratch.is_undecided, static_cast<unsigned>(source.number(first + static_cast<unsigned>(__builtin_ctzll(beyond)))));
        scratch.dense = 2 * static_cast<std::size_t>(__builtin_popcountll(kept)) >= count;

        ScreenedQueue& queue = scratch.screened;
        for (; kept != 0; kept &= kept - 1) {
            const auto i = static_cast<unsigned>(__builtin_ctzll(kept));
            const double* const from = blocks[i / block_pairs] + i % block_pairs;
            double* const to = &queue.data[0][queue.size++];
#pragma GCC unroll 24
            for (std::size_t c = 0; c < pair_coordinates; ++c) to[c * ScreenedQueue::capacity] = from[c * block_pairs];
            to[pair_coordinates * ScreenedQueue::capacity] = static_cast<double>(source.number(first + i));
        }
    }

    /// Where most pairs go on: straight to the certificates on both halves, without a queue.
    void screen_dense_group(std::size_t first, std::size_t count)
    {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count; i += block_pairs) {
            const double* const block = source.block(first + i);
            for (unsigned lane = 0; lane < block_pairs && i + lane < count; lane += width) {
                PairRecord<L> record;
                const Screening found = screen(block + lane, record);
                record.pair = source.numbers(first + i + lane);
                const unsigned in_use = all_lanes(count - i - lane);
                if ((in_use & found.beyond) != 0) leave_undecided(record.pair, in_use & found.beyond);
                kept += static_cast<unsigned>(__builtin_popcount(in_use & found.kept));
                examine(record, in_use & found.kept);
            }
        }
        // Less than what leads here, so that shares around one half do not go to and fro.
        scratch.dense = 3 * kept >= count;
    }

    /// Certificates that need more than screening has computed. Those on both halves include the area certificate on the whole.
    FASTCCD_INLINE void examine(const PairRecord<L>& record, unsigned lanes)
    {
        if (cutoff < 1.0) lanes &= ~Lane<L>::bits(apart_until_cutoff(record));
        const auto apart = visit_edge_functions<kind>(
            record.r, [&](const auto& p, const auto& q, const auto& t, const auto& s) FASTCCD_INLINE_LAMBDA {
                return halves_certificate<kind>(record.cubic, p, q, t, s, record.scale, halves);
            });
        lanes &= ~Lane<L>::bits(apart);
        if (lanes == 0) return;
        push(scratch.candidates, lanes, record);
        if (scratch.candidates.size >= PairQueue::drain_at) find_roots(false);
    }

    /// Takes full batches from the end of [screened], so that what stays need not move; and the rest too if `all`.
    void compare_screened(bool all)
    {
        ScreenedQueue& queue = scratch.screened;
        while (queue.size >= width || (all && queue.size > 0)) {
            const unsigned count = queue.size < width ? queue.size : width;
            queue.size -= count;
            PairRecord<L> record;
            record.r = relative_motion<L>(&queue.data[0][queue.size], ScreenedQueue::capacity, parameters.t_max);
            record.scale = scales(extents(record.r));
            record.cubic = coplanarity_cubic(record.r, cross_product(record.r, 0, 1));
            record.pair = Lane<L>::load(&queue.data[pair_coordinates][queue.size]);
            examine(record, all_lanes(count));
        }
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

    /// The pieces in which the cubic changes sign, and two steps towards the root of each. Every step is done for all batches
    /// before the next one, so that divisions and roots of many batches are under way at once.
    void find_roots(bool all)
    {
        const unsigned size = scratch.candidates.size, end = all ? size : size / width * width;
        for (unsigned i = 0; i < end; i += width) find_pieces(i, all_lanes(size - i));
        for (unsigned piece = 0; piece < 3; ++piece) {
            unsigned any = 0;
            for (unsigned i = 0; i < end; i += width) {
                if (scratch.search.pieces[piece][i / width] == 0) continue;
                any = 1;
                if (piece > 0) next_piece(i);
                start_in_middle(i);
            }
            if (any == 0) break;
            for (int step = 0; step < coarse_steps; ++step)
                for (unsigned i = 0; i < end; i += width)
                    if (scratch.search.pieces[piece][i / width] != 0) approach_root(i);
            for (unsigned i = 0; i < end; i += width)
                if (const unsigned lanes = scratch.search.pieces[piece][i / width]; lanes != 0) reject_coarsely(i, lanes);
        }
        drop_front(scratch.candidates, end);
    }

    FASTCCD_INLINE void find_pieces(unsigned i, unsigned lanes)
    {
        RootSearch& search = scratch.search;
        PairRecord<L> record;
        read(scratch.candidates, i, record);
        const MonotonePieces<L> pieces =
            monotone_pieces(bernstein(record.cubic), record.scale.volume, parameters.bounds, parameters.leaf_width);
        const unsigned certain =
            lanes & Lane<L>::bits(pieces.certain & less(broadcast<L>(smallest_volume), record.scale.volume));
        if (certain != lanes) leave_undecided(record.pair, lanes & ~certain);

        const LaneMask<L> in_first = opposite_signs(pieces.value[0], pieces.value[1]);
        const LaneMask<L> in_second = opposite_signs(pieces.value[1], pieces.value[2]);
        const LaneMask<L> in_third = opposite_signs(pieces.value[2], pieces.value[3]);
        // A second root lies in the second piece (after one in the first) or in the third.
        const LaneMask<L> first_two = in_first & in_second;
        search.pieces[0][i / width] = certain & Lane<L>::bits(in_first | in_second | in_third);
        search.pieces[1][i / width] = certain & Lane<L>::bits(first_two | (in_third & (in_first | in_second)));
        search.pieces[2][i / width] = certain & Lane<L>::bits(first_two & in_third);

        store(search.f, i, pieces.f);
        Lane<L>::store(&search.threshold[i], pieces.threshold);
        Lane<L>::store(&search.low[i], select<L>(in_first, pieces.time[0], select<L>(in_second, pieces.time[1], pieces.time[2])));
        Lane<L>::store(&search.high[i], select<L>(in_first, pieces.time[1], select<L>(in_second, pieces.time[2], pieces.time[3])));
        Lane<L>::store(&search.later_low[i], select<L>(first_two, pieces.time[1], pieces.time[2]));
        Lane<L>::store(&search.later_high[i], select<L>(first_two, pieces.time[2], pieces.time[3]));
    }

    FASTCCD_INLINE void next_piece(unsigned i)
    {
        RootSearch& search = scratch.search;
        const L later_high = Lane<L>::load(&search.later_high[i]);
        Lane<L>::store(&search.low[i], Lane<L>::load(&search.later_low[i]));
        Lane<L>::store(&search.high[i], later_high);
        Lane<L>::store(&search.later_low[i], later_high);
        Lane<L>::store(&search.later_high[i], broadcast<L>(1.0));
    }

    FASTCCD_INLINE void start_in_middle(unsigned i)
    {
        RootSearch& search = scratch.search;
        const L sum = Lane<L>::load(&search.low[i]) + Lane<L>::load(&search.high[i]);
        Lane<L>::store(&search.guess[i], sum * broadcast<L>(0.5));
    }

    FASTCCD_INLINE void approach_root(unsigned i)
    {
        RootSearch& search = scratch.search;
        const Bracket<L> piece{Lane<L>::load(&search.low[i]), Lane<L>::load(&search.high[i])};
        Lane<L>::store(&search.guess[i], clipped_step(load_cubic<L>(search.f, i), piece, Lane<L>::load(&search.guess[i])));
    }

    /// Dismisses lanes without inclusion anywhere near the root.
    FASTCCD_INLINE void reject_coarsely(unsigned i, unsigned lanes)
    {
        PairRecord<L> root;
        read(scratch.candidates, i, root);
        root.f = load_cubic<L>(scratch.search.f, i);
        root.threshold = Lane<L>::load(&scratch.search.threshold[i]);
        root.low = Lane<L>::load(&scratch.search.low[i]);
        root.high = Lane<L>::load(&scratch.search.high[i]);
        root.guess = Lane<L>::load(&scratch.search.guess[i]);
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

    /// The rest of the way to the root, again one step of all batches after the other; then decides.
    void refine(bool all)
    {
        const unsigned size = scratch.survivors.size, end = all ? size : size / width * width;
        for (unsigned i = 0; i < end; i += width) prepare_refinement(i);
        for (int step = 0; step < fine_steps; ++step)
            for (unsigned i = 0; i < end; i += width) refine_root(i);
        for (unsigned i = 0; i < end; i += width) decide(i, all_lanes(size - i));
        drop_front(scratch.survivors, end);
    }

    FASTCCD_INLINE void prepare_refinement(unsigned i)
    {
        Refinement& refinement = scratch.refinement;
        PairRecord<L> root;
        read(scratch.survivors, i, root);
        root.f = power_basis(bernstein(coplanarity_cubic(root.r, cross_product(root.r, 0, 1))));
        store(refinement.f, i, root.f);
        Lane<L>::store(&refinement.slope[i], evaluate(root.f, root.high) - evaluate(root.f, root.low));
        Lane<L>::store(&refinement.low[i], root.low);
        Lane<L>::store(&refinement.high[i], root.high);
        Lane<L>::store(&refinement.guess[i], root.guess);
    }

    FASTCCD_INLINE void refine_root(unsigned i)
    {
        Refinement& refinement = scratch.refinement;
        Bracket<L> bracket{Lane<L>::load(&refinement.low[i]), Lane<L>::load(&refinement.high[i])};
        const LaneMask<L> rising = less(broadcast<L>(0.0), Lane<L>::load(&refinement.slope[i]));
        const L guess = bracketed_step(load_cubic<L>(refinement.f, i), rising, bracket, Lane<L>::load(&refinement.guess[i]));
        Lane<L>::store(&refinement.low[i], bracket.low);
        Lane<L>::store(&refinement.high[i], bracket.high);
        Lane<L>::store(&refinement.guess[i], guess);
    }

    /// The leaf that holds the refined root, proofs on both sides of it, and inclusion within it.
    FASTCCD_INLINE void decide(unsigned i, unsigned lanes)
    {
        PairRecord<L> root;
        read(scratch.survivors, i, root);
        root.guess = Lane<L>::load(&scratch.refinement.guess[i]);
        const Cubic<L> f = compute_again(root, parameters);
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
