// The last stages of the pipeline: from pairs without certificates to the roots of their cubics, and from roots to contacts.
#pragma once

#include <area_inclusion.hpp>
#include <householder.hpp>
#include <lane_results.hpp>
#include <magnitudes.hpp>
#include <part_certificates.hpp>
#include <projected_inclusion.hpp>
#include <records.hpp>
#include <touching.hpp>
#include <unscaled_pairs.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <PairKind kind, class L>
class RootStages {
public:
    FASTCCD_INLINE RootStages(const SearchParameters& parameters, TileScratch& scratch) : parameters_{parameters}, scratch_{scratch}
    {
        scratch_.candidates.size = scratch_.slow.size = 0;
    }

    /// After candidates were queued, of one batch of screening at most.
    FASTCCD_INLINE void find_roots_if_many()
    {
        if (scratch_.candidates.size >= PairQueue::drain_at) find_roots(false);
    }

    /// Empties all queues.
    void finish()
    {
        find_roots(true);
        refine(true);
    }

private:
    static constexpr unsigned width = Lane<L>::width;

    const SearchParameters& parameters_;
    TileScratch& scratch_;
    const bool may_note_touches_ = parameters_.leaf_width >= narrowest_touched && !parameters_.count_roots;

    /// The pieces in which the cubic changes sign, and a few steps towards the root in the first of them. Every step is done for all
    /// batches before the next one, so that divisions and roots of many batches are under way at once: processors look ahead by a few
    /// hundred instructions, and a step that ends with a division is not waited for while the next batch's begins.
    void find_roots(bool all)
    {
        const unsigned size = scratch_.candidates.size, end = all ? size : size / width * width;
        for (unsigned i = 0; i < end; i += width) find_extrema(i);
        for (unsigned i = 0; i < end; i += width) find_pieces(i, lanes_in_use<L>(size - i));
        for (int step = 0; step < quick_steps; ++step)
            for (unsigned i = 0; i < end; i += width) approach_root(i);
        for (unsigned i = 0; i < end; i += width) decide_quickly(i);
        drop_front(scratch_.candidates, end);
    }

    /// Leaves them where find_pieces() puts the piece.
    FASTCCD_INLINE void find_extrema(unsigned i)
    {
        RootSearch& search = scratch_.search;
        PairRecord<L> record;
        read(scratch_.candidates, i, record);
        compute_pair_again(record);
        const Cubic<L> f = bernstein(record.cubic);
        const Extrema<L> cuts = extrema(f);
        store(search.scale, i, record.scale);
        store(search.f, i, power_basis(f));
        Lane<L>::store(&search.threshold[i], sign_threshold(f, record.scale.volume, parameters_.bounds, parameters_.leaf_width));
        Lane<L>::store(&search.low[i], cuts.first);
        Lane<L>::store(&search.high[i], cuts.second);
    }

    /// In the window alone: no leaf straddles the middle of the step, where it may end, and the other half has a certificate.
    FASTCCD_INLINE void find_pieces(unsigned i, unsigned lanes)
    {
        RootSearch& search = scratch_.search;
        const Window<L> window = window_of(read_pair<L>(scratch_.candidates, i));
        const Extrema<L> cuts{Lane<L>::load(&search.low[i]), Lane<L>::load(&search.high[i])};
        const MonotonePieces<L> pieces = monotone_pieces(load<PowerCubic, L>(search.f, i), cuts, Lane<L>::load(&search.threshold[i]),
                                                         window.low, window.high);
        const Scales<L> scale = load<Scales, L>(search.scale, i);
        const unsigned certain = lanes & Lane<L>::bits(pieces.certain & less(broadcast<L>(smallest_volume), scale.volume));
        if (certain != lanes) {
            PairRecord<L> record;
            read(scratch_.candidates, i, record);
            record.scale = scale;
            note_anywhere(record.pair, left_by_quarters(record, lanes & ~certain));
        }

        const LaneMask<L> in_first = opposite_signs(pieces.value[0], pieces.value[1]);
        const LaneMask<L> in_second = opposite_signs(pieces.value[1], pieces.value[2]);
        const LaneMask<L> in_third = opposite_signs(pieces.value[2], pieces.value[3]);
        // A second root lies in the second piece (after one in the first) or in the third.
        const LaneMask<L> first_two = in_first & in_second;
        search.pieces[0][i / width] = certain & Lane<L>::bits(in_first | in_second | in_third);
        search.pieces[1][i / width] = certain & Lane<L>::bits(first_two | (in_third & (in_first | in_second)));
        search.pieces[2][i / width] = certain & Lane<L>::bits(first_two & in_third);

        Lane<L>::store(&search.end[i], window.high);
        const L low = select<L>(in_first, pieces.time[0], select<L>(in_second, pieces.time[1], pieces.time[2]));
        const L high = select<L>(in_first, pieces.time[1], select<L>(in_second, pieces.time[2], pieces.time[3]));
        Lane<L>::store(&search.low[i], low);
        Lane<L>::store(&search.high[i], high);
        Lane<L>::store(&search.guess[i], (low + high) * broadcast<L>(0.5));
        Lane<L>::store(&search.later_low[i], select<L>(first_two, pieces.time[1], pieces.time[2]));
        Lane<L>::store(&search.later_high[i], select<L>(first_two, pieces.time[2], pieces.time[3]));
    }

    /// The last look at pairs whose cubic is too close to zero to tell exactly where it changes sign, as that of edges that stay
    /// parallel: most of them are clearly apart. Returns the others. Rare, so out of the way.
    __attribute__((noinline)) unsigned left_by_quarters(const PairRecord<L>& record, unsigned lanes) const
    {
        if (parameters_.leaf_width > 0.25) return lanes;  // a leaf is more than a quarter
        const Window<L> window = window_of(record.pair);
        return lanes & ~apart_on_quarters<kind>(record.r, record.scale, parameters_.bounds.on_part(), window.low, window.high, lanes);
    }

    /// Leaves it to a look at all certificates, from the pair's coordinates, where contact may be.
    FASTCCD_INLINE void note_anywhere(L pair, unsigned lanes)
    {
        if (may_note_touches_)
            note_touches(scratch_, pair, broadcast<L>(0.0), lanes);
        else
            leave_undecided(scratch_, pair, lanes);
    }

    FASTCCD_INLINE void approach_root(unsigned i)
    {
        RootSearch& search = scratch_.search;
        const Bracket<L> piece{Lane<L>::load(&search.low[i]), Lane<L>::load(&search.high[i])};
        Lane<L>::store(&search.guess[i], clipped_step(load<PowerCubic, L>(search.f, i), piece, Lane<L>::load(&search.guess[i])));
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

    /// A leaf of the search, and the times on either side of its centre.
    struct Leaf {
        L left, right, centre, half;
        LaneMask<L> inner;  ///< Within [0, 1], and not leaf 0, which is the certified search's: it looks for a positive bound there.
    };
    FASTCCD_INLINE Leaf leaf_at(L time) const
    {
        const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
        const L w = broadcast<L>(parameters_.leaf_width), left = interval_start(time, parameters_.leaf_width);
        const L right = left + w, half = broadcast<L>(0.5) * w;
        return {left, right, left + half, half, less(zero, left) & less_equal(right, one)};
    }

    /// What the edge functions say of a bracket around the guess.
    struct Neighbourhood {
        LaneMask<L> present;  ///< Inside throughout it.
        LaneMask<L> absent;   ///< Outside throughout it, and the piece has no root elsewhere.
    };
    FASTCCD_INLINE Neighbourhood look_around(const PairRecord<L>& root) const
    {
        const L delta = broadcast<L>(quick_bracket);
        const RootBracket bracket = bracket_root(root, delta);
        // With one leaf more on either side: the margin of the certified search. The guess's leaf lies within.
        const Inclusion<L> inclusion = projected_inclusion<kind>(
            root.r, root.scale, root.guess, delta + broadcast<L>(parameters_.leaf_width), parameters_.bounds);
        return {inclusion.present, bracket.certain & inclusion.absent};
    }

    /// Decides what few steps allow, by the signs of the cubic. The piece is monotone: if it has opposite signs beyond the
    /// threshold at both ends of the leaf, then it has a root there and none beside it, and likewise in the bracket.
    FASTCCD_INLINE void decide_quickly(unsigned i)
    {
        const unsigned lanes = scratch_.search.pieces[0][i / width];
        PairRecord<L> root;
        read(scratch_.candidates, i, root);
        root.scale = load<Scales, L>(scratch_.search.scale, i);
        root.f = load<PowerCubic, L>(scratch_.search.f, i);
        root.threshold = Lane<L>::load(&scratch_.search.threshold[i]);
        root.low = Lane<L>::load(&scratch_.search.low[i]);
        root.high = Lane<L>::load(&scratch_.search.high[i]);
        root.guess = Lane<L>::load(&scratch_.search.guess[i]);

        // The leaf first: few operations that wait for one another, done by the time the many of the bracket are.
        const Leaf leaf = leaf_at(root.guess);
        const L at_left = evaluate(root.f, leaf.left), at_right = evaluate(root.f, leaf.right);
        const LaneMask<L> in_leaf = leaf.inner & less_equal(root.low, leaf.left) & less_equal(leaf.right, root.high) &
                                    less(root.threshold, min(abs(at_left), abs(at_right))) & opposite_signs(at_left, at_right);
        const Neighbourhood around = look_around(root);
        const LaneMask<L> is_contact = in_leaf & around.present, decided = is_contact | around.absent;
        const unsigned contact = lanes & Lane<L>::bits(is_contact), undecided = lanes & ~Lane<L>::bits(decided);
        record_contacts(root.pair, leaf.left, contact);

        // The first root of some lanes and the second of others at once, whether there are any or not: few pairs have one left, but
        // half of the batches of four have such a pair, and not to foresee which costs more. After a contact no other root matters.
        const unsigned settled = parameters_.count_roots ? 0 : contact;
        const unsigned second = scratch_.search.pieces[1][i / width] & ~settled;
        const L second_low = Lane<L>::load(&scratch_.search.later_low[i]), second_high = Lane<L>::load(&scratch_.search.later_high[i]);
        root.low = select<L>(decided, second_low, root.low);
        root.high = select<L>(decided, second_high, root.high);
        leave_for_later(root, undecided | second);
        if (const unsigned both = undecided & second; both != 0) {
            root.low = second_low;
            root.high = second_high;
            leave_for_later(root, both);
        }
        if (const unsigned third = scratch_.search.pieces[2][i / width] & ~settled; third != 0) {
            root.low = Lane<L>::load(&scratch_.search.later_high[i]);
            root.high = Lane<L>::load(&scratch_.search.end[i]);
            leave_for_later(root, third);
        }
    }

    /// Leaves it to refine().
    FASTCCD_INLINE void leave_for_later(const PairRecord<L>& root, unsigned lanes)
    {
        push(scratch_.slow, lanes, root);
        if (scratch_.slow.size >= RootQueue::drain_at) refine(false);
    }

    /// Roots that need more: as many steps as any takes, one step of all batches after the other; then decides with tighter bounds.
    void refine(bool all)
    {
        const unsigned size = scratch_.slow.size, end = all ? size : size / width * width;
        for (unsigned i = 0; i < end; i += width) prepare_refinement(i);
        for (int step = 0; step < most_steps; ++step)
            for (unsigned i = 0; i < end; i += width) refine_root(i);
        for (unsigned i = 0; i < end; i += width) decide(i, lanes_in_use<L>(size - i));
        drop_front(scratch_.slow, end);
    }

    FASTCCD_INLINE void prepare_refinement(unsigned i)
    {
        Refinement& refinement = scratch_.refinement;
        PairRecord<L> root;
        read(scratch_.slow, i, root);
        root.f = power_basis(bernstein(coplanarity_cubic(root.r, cross_product(root.r, 0, 1))));
        store(refinement.f, i, root.f);
        const L at_low = evaluate(root.f, root.low), at_high = evaluate(root.f, root.high);
        Lane<L>::store(&refinement.slope[i], at_high - at_low);
        Lane<L>::store(&refinement.low[i], root.low);
        Lane<L>::store(&refinement.high[i], root.high);
        // Anew: the guess of a root that few steps have not decided is not worth queueing.
        Lane<L>::store(&refinement.guess[i], first_guess(Bracket<L>{root.low, root.high}, at_low, at_high));
    }

    FASTCCD_INLINE void refine_root(unsigned i)
    {
        Refinement& refinement = scratch_.refinement;
        Bracket<L> bracket{Lane<L>::load(&refinement.low[i]), Lane<L>::load(&refinement.high[i])};
        const LaneMask<L> rising = less(broadcast<L>(0.0), Lane<L>::load(&refinement.slope[i]));
        const L guess = bracketed_step(load<PowerCubic, L>(refinement.f, i), rising, bracket, Lane<L>::load(&refinement.guess[i]));
        Lane<L>::store(&refinement.low[i], bracket.low);
        Lane<L>::store(&refinement.high[i], bracket.high);
        Lane<L>::store(&refinement.guess[i], guess);
    }

    /// The leaf that holds the refined root, proofs on both sides of it, and inclusion within it.
    FASTCCD_INLINE void decide(unsigned i, unsigned lanes)
    {
        PairRecord<L> root;
        read(scratch_.slow, i, root);
        root.guess = Lane<L>::load(&scratch_.refinement.guess[i]);
        const Cubic<L> f = compute_again(root, parameters_);
        const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
        const L w = broadcast<L>(parameters_.leaf_width);
        const RootBracket bracket = bracket_root(root, broadcast<L>(fine_bracket));
        const Leaf leaf = leaf_at(root.guess);

        // f has one strict sign from the bracket's low side (and a leaf before it) to the leaf, the other
        // from the leaf to the bracket's high side (and a leaf after it).
        const L before = max(min(bracket.low, leaf.left) - w, zero), after = min(max(bracket.high, leaf.right) + w, one);
        const Cubic<L> f_before = on_interval(f, before, leaf.left), f_after = on_interval(f, leaf.right, after);
        const L bound = cubic_bound_lanes(root.r, root.scale.volume, parameters_.bounds);
        const LaneMask<L> crosses =
            leaf.inner & bracket.certain &
            ((less(bound, smallest(f_before)) & less(largest(f_after), zero - bound)) |
             (less(largest(f_before), zero - bound) & less(bound, smallest(f_after))));

        const Inclusion<L> inclusion =
            projected_inclusion<kind>(root.r, root.scale, leaf.centre, leaf.half, parameters_.bounds);
        const unsigned crossing = lanes & Lane<L>::bits(crosses);
        const unsigned contact = crossing & Lane<L>::bits(inclusion.present);
        unsigned undecided = lanes & ~contact & ~(crossing & Lane<L>::bits(inclusion.absent));
        // The search asks for eq. 7 of the leaf, by the same text, before it reports it as one in which nothing is proven, by a look or by
        // halving; of the same lengths, unless it scales axes. Where f is not zero all axes have an extent, so those of the step are
        // unscaled if those of the searched part are, as lanes take none that are too large. A leaf for each root at most: after some more
        // that only eq. 7 clears, the search goes along directions (scalar/leaf_search.hpp).
        if ((undecided & crossing) != 0) {
            const LaneMask<L> apart = area_certificate<kind>(root.r, root.scale, leaf.centre, leaf.half, parameters_.bounds);
            undecided &= ~(crossing & Lane<L>::bits(apart & is_surely_unscaled(root.r, root.r)));
        }
        if (contact != 0) record_contacts(root.pair, leaf.left, contact);
        if (undecided != 0) look_again(root, undecided);
    }

    /// Roots after a pair's first have not been seen by decide_quickly(), and a few lie so close to a leaf's end that they certainly
    /// cross in neither leaf. Seldom run, hence not inlined.
    __attribute__((noinline)) void look_again(const PairRecord<L>& root, unsigned lanes)
    {
        lanes &= ~Lane<L>::bits(look_around(root).absent);
        if (lanes != 0) lanes = left_by_quarters(root, lanes);
        if (may_note_touches_ && lanes != 0) {
            // f has one strict sign from the bracket's low side, and a leaf before it, to the leaf.
            const Leaf leaf = leaf_around(root.guess);
            const L w = broadcast<L>(parameters_.leaf_width), zero = broadcast<L>(0.0);
            const RootBracket bracket = bracket_root(root, broadcast<L>(fine_bracket));
            const Cubic<L> f_before = on_interval(bernstein(root.cubic), max(min(bracket.low, leaf.left) - w, zero), leaf.left);
            const L bound = cubic_bound_lanes(root.r, root.scale.volume, parameters_.bounds);
            const LaneMask<L> apart_before = less(bound, smallest(f_before)) | less(largest(f_before), negated(bound));
            const unsigned noted = lanes & Lane<L>::bits(leaf.inner & bracket.certain & apart_before);
            note_touches(scratch_, root.pair, leaf.left, noted);
            lanes &= ~noted;
        }
        note_anywhere(root.pair, lanes);
    }

    /// The leaf that holds `time`, or the one before it if `time` is close to its start.
    FASTCCD_INLINE Leaf leaf_around(L time) const { return leaf_at(time - broadcast<L>(0.25 * parameters_.leaf_width)); }

    /// Without branches on which lanes are in contact: no processor foresees that, and while it finds out, the next batch would
    /// wait. `reported` is left to mark_reported: bits of one word would wait for one another here.
    FASTCCD_INLINE void record_contacts(L pair, L left, unsigned contact)
    {
        alignas(64) double lefts[width], pairs[width];
        Lane<L>::store(lefts, left);
        // Lanes past the end of a queue may hold any number.
        Lane<L>::store(pairs, max(min(pair, broadcast<L>(tile_pairs)), broadcast<L>(0.0)));
#pragma GCC unroll 8
        for (unsigned lane = 0; lane < width; ++lane) {
            const unsigned nowhere = static_cast<unsigned>(tile_pairs) + lane, is_contact = contact >> lane & 1;
            const unsigned i = nowhere + ((static_cast<unsigned>(pairs[lane]) - nowhere) & (0u - is_contact));
            scratch_.time[i] = lefts[lane] < scratch_.time[i] ? lefts[lane] : scratch_.time[i];
            ++scratch_.roots[i];
        }
    }
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
