// The stages of the narrow phase over one tile:
//
//     block -> linear, cubic certificates -> [screened] -> cubic, quadratic certificates -> [candidates] -> sign-change intervals,
//                     |                                     on both halves                        Householder steps, leaf,
//                     v                                           |                               inclusion
//                   apart                                         v                                |             |
//                                                               apart                      contact or apart      [slow]
//                                                                                                                |
//                          certified search  <- undecided, here and above -  more steps, tighter bounds <--------+
//                                                                                  |
//                                                                                  v
//                                                                           contact or apart
//
// [slow] also takes the roots after a pair's first, if that is no contact or if roots are counted. Before a pair is left undecided by
// the search for its roots, all certificates are tried on quarters of the step.
//
// Queues pack what a stage leaves, so that the next one runs on full batches. Where few pairs are left, the queue says where
// their coordinates are; where most are, whole registers are compressed, and [screened] is left out.
//
// What lanes conclude is what the certified search (scalar/certified_search.hpp) would conclude:
// - "apart" is concluded only with margins under which the search certifies every leaf: certificates and
//   sign tests cover [0, 1] by intervals that overlap by at least one leaf, or by its halves or quarters,
//   which no leaf straddles (see error_bound.hpp);
// - "contact in leaf j" is concluded only from a proof (a strict sign change of the cubic over the leaf and
//   strict inclusion throughout it), so that no certificate of absence can hold there, together with
//   "apart" for everything before it.
// Everything else is left undecided. So the bits do not depend on the instruction set or the batch.
#pragma once

#include <block_source.hpp>
#include <part_certificates.hpp>
#include <root_stages.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <PairKind kind, class L>
class Pipeline {
public:
    static void run_tile(const TileRequest& request, TileScratch& scratch)
    {
        Pipeline pipeline{request, scratch};
        clear_results<L>(scratch, request.count);
        scratch.screened.size = 0;
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
        pipeline.root_stages.finish();
        mark_reported<L>(scratch, request.count);
    }

private:
    static constexpr unsigned width = Lane<L>::width;

    const SearchParameters& parameters;
    const CertificateBounds whole, halves, on_part;
    const double cutoff;
    TileScratch& scratch;
    BlockSource<kind, L> source;
    RootStages<kind, L> root_stages;

    FASTCCD_INLINE Pipeline(const TileRequest& request, TileScratch& s)
        : parameters{*request.parameters}, whole{parameters.bounds.certificates()}, halves{parameters.bounds.halves()},
          on_part{parameters.bounds.on_part()}, cutoff{request.cutoff}, scratch{s}, source{request, s}, root_stages{parameters, s}
    {
    }

    /// What the linear and cubic certificates say of a batch.
    struct Screening {
        unsigned kept;    ///< Lanes to look into.
        unsigned beyond;  ///< Lanes whose coordinates lanes do not decide.
    };

    /// Linear and cubic certificates on the whole interval. Fills in the record but for `pair`.
    FASTCCD_INLINE Screening screen(const double* coordinates, PairRecord<L>& record)
    {
        record.r = relative_motion<L>(coordinates, block_pairs, parameters.t_max);
        Extents<L> extents;
        const LaneMask<L> separated = linear_certificate<kind>(record.r, whole, extents);
        record.scale = scales(extents);
        record.cubic = coplanarity_cubic(record.r, cross_product(record.r, 0, 1));
        const unsigned in_range = Lane<L>::bits(in_lane_range(record.cubic, extents, parameters.bounds));
        const unsigned apart = Lane<L>::bits(separated | cubic_certificate(record.cubic, record.scale.volume, whole));
        return {in_range & ~apart, lanes_in_use<L>(width) & ~in_range};
    }

    /// For scenes, where most pairs end here: screens a group without looking at any result, which no branch predictor could
    /// foresee, then lists what is left in [screened]. Processors overlap one batch with the next only as far as a few hundred
    /// instructions reach: there is nothing in the loop that could be done before or after it.
    void screen_group(std::size_t first, std::size_t count)
    {
        const double* const blocks = source.group(first);
        std::uint64_t kept = 0, beyond = 0;
        for (std::size_t i = 0; i < count; i += block_pairs) {
            const double* const block = blocks + i * pair_coordinates;
            source.at_block();
            for (unsigned lane = 0; lane < block_pairs; lane += width) {
                source.at_batch(block);
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

        // Eight at a time, the last of them perhaps in vain: processors foresee the number of eights better than that of pairs.
        ScreenedQueue& queue = scratch.screened;
        const auto more = static_cast<unsigned>(__builtin_popcountll(kept));
        const std::uint64_t last = std::uint64_t{1} << (count - 1);
        for (unsigned k = 0; k < more; k += 8) {
#pragma GCC unroll 8
            for (unsigned j = 0; j < 8; ++j) {
                const auto i = static_cast<std::size_t>(__builtin_ctzll(kept | last));
                kept &= kept - 1;
                queue.pairs[queue.size + k + j] = blocks + i / block_pairs * block_coordinates + i % block_pairs;
                queue.numbers[queue.size + k + j] = static_cast<double>(source.number(first + i));
            }
        }
        queue.size += more;
    }

    /// Where most pairs go on: straight to the certificates on both halves, without a queue.
    void screen_dense_group(std::size_t first, std::size_t count)
    {
        const double* const blocks = source.group(first);
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count; i += block_pairs) {
            const double* const block = blocks + i * pair_coordinates;
            source.at_block();
            for (unsigned lane = 0; lane < block_pairs && i + lane < count; lane += width) {
                source.at_batch(block);
                PairRecord<L> record;
                const Screening found = screen(block + lane, record);
                record.pair = source.numbers(first + i + lane);
                const unsigned in_use = lanes_in_use<L>(count - i - lane);
                if ((in_use & found.beyond) != 0) leave_undecided(scratch, record.pair, in_use & found.beyond);
                kept += static_cast<unsigned>(__builtin_popcount(in_use & found.kept));
                examine(record, in_use & found.kept);
            }
        }
        // Less than what leads here, so that shares around one half do not go to and fro.
        scratch.dense = 3 * kept >= count;
    }

    /// Certificates that need more than screening has computed. Those on both halves include the quadratic one on the whole.
    FASTCCD_INLINE void examine(PairRecord<L>& record, unsigned lanes)
    {
        if (cutoff < 1.0) {
            lanes &= ~Lane<L>::bits(apart_until_cutoff(record));
            if (lanes == 0) return;  // as for most batches, once a contact is known
        }
        const auto apart = visit_edge_functions<kind>(
            record.r, [&](const auto& p, const auto& q, const auto& t, const auto& s) FASTCCD_INLINE_LAMBDA {
                return halves_certificate<kind>(record.cubic, p, q, t, s, record.scale, halves);
            });
        // Even if no lane goes on, as in a third of the batches of four random pairs: no processor foresees which.
        mark_window(record, apart);
        root_stages.take(record, lanes & ~Lane<L>::bits(apart.first & apart.second));
    }

    /// Takes full batches from the end of [screened], so that what stays need not move; and the rest too if `all`.
    void compare_screened(bool all)
    {
        ScreenedQueue& queue = scratch.screened;
        while (queue.size >= width || (all && queue.size > 0)) {
            const unsigned count = queue.size < width ? queue.size : width;
            queue.size -= count;
            source.meanwhile();
            const double** const pairs = queue.pairs + queue.size;
            for (unsigned lane = count; lane < width; ++lane) pairs[lane] = pairs[count - 1];
            PairRecord<L> record;
            record.r = relative_motion_of<L>(typename Lane<L>::Collector{source.blocks(), pairs}, parameters.t_max);
            compute_pair_again(record);
            record.pair = Lane<L>::load(&queue.numbers[queue.size]);
            examine(record, lanes_in_use<L>(count));
        }
        if (!source.is_in_place()) keep_waiting();
    }

    /// Copies what is left in [screened], less than a batch, before other blocks take its place: pair k to lane k of `waiting`.
    void keep_waiting()
    {
        for (unsigned k = 0; k < scratch.screened.size; ++k) {
            double* const to = scratch.waiting + k;
            const double* const from = scratch.screened.pairs[k];
            if (from == to) continue;
            for (std::size_t c = 0; c < pair_coordinates; ++c) to[c * block_pairs] = from[c * block_pairs];
            scratch.screened.pairs[k] = to;
        }
    }

    /// Certificates on [0, cutoff] and two leaves more, the rest of the one that the cutoff lies in and room for the rounding of this
    /// sum: the certified search finds every leaf there apart, so toi is greater than the cutoff. Only the end of the motion moves.
    FASTCCD_INLINE LaneMask<L> apart_until_cutoff(const PairRecord<L>& record)
    {
        const L end = broadcast<L>(cutoff + 2 * parameters.leaf_width < 1.0 ? cutoff + 2 * parameters.leaf_width : 1.0);
        const RelativeMotion<L> r{{record.r.start[0], record.r.start[1], record.r.start[2]},
                                  {position(record.r, 0, end), position(record.r, 1, end), position(record.r, 2, end)}};
        return part_certificate<kind>(r, record.scale, on_part);
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
