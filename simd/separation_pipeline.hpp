// The stages of a minimum separation over one tile:
//
//     block -> coordinate axes -> [separating] -> first look -> [advancing] -> step -> contact or farther
//                     |                               |           ^              |
//                     v                               v           +--------------+
//                  farther                         farther
//
// Lanes take the steps of separation_steps.hpp, in the same operations as the scalar search; they leave to it pairs out
// of range, and those that take too many steps. A pair that needs another step goes back to the end of [advancing], from which
// the next batch is taken, so that batches stay full until the queue runs dry.
#pragma once

#include <block_source.hpp>
#include <lane_results.hpp>
#include <records.hpp>
#include <separation_steps.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class Record, class Visit>
FASTCCD_INLINE void for_each_field(const SeparationQueue&, Record& record, Visit visit)
{
    for_each_common_field(record, visit);
    visit(record.extents.x), visit(record.extents.y), visit(record.extents.z);
}

template <class Record, class Visit>
FASTCCD_INLINE void for_each_field(const AdvancingQueue&, Record& record, Visit visit)
{
    for_each_common_field(record, visit);
    visit(record.extents.x), visit(record.extents.y), visit(record.extents.z);
    visit(record.time), visit(record.window_low), visit(record.window_high);
    visit(record.looks), visit(record.purpose), visit(record.at);
    visit(record.n.x), visit(record.n.y), visit(record.n.z), visit(record.high), visit(record.interval);
    visit(record.last_time), visit(record.last_gap);
}

template <PairKind kind, class L>
class SeparationPipeline {
public:
    static void run_tile(const TileRequest& request, TileScratch& scratch)
    {
        SeparationPipeline pipeline{request, scratch};
        clear_results<L>(scratch, request.count);
        scratch.separating.size = scratch.advancing.size = 0;
        const std::size_t size = pipeline.source_.size();
        for (std::size_t first = 0; first < size; first += group_pairs) {
            const double* const blocks = pipeline.source_.group(first);
            const std::size_t end = size - first < group_pairs ? size : first + group_pairs;
            for (std::size_t i = first; i < end; i += block_pairs) {
                const double* const block = blocks + (i - first) * pair_coordinates;
                pipeline.source_.at_block();
                for (unsigned lane = 0; lane < block_pairs && i + lane < end; lane += width) {
                    pipeline.source_.at_batch(block);
                    pipeline.screen(block + lane, pipeline.source_.numbers(i + lane), lanes_in_use<L>(end - i - lane));
                    if (scratch.separating.size >= SeparationQueue::drain_at) pipeline.look_first(width);
                }
            }
        }
        pipeline.look_first(1);
        pipeline.advance(1);
    }

private:
    static constexpr unsigned width = Lane<L>::width;

    const SearchParameters& parameters_;
    const SeparationBounds bounds_;
    const double limit_;
    TileScratch& scratch_;
    BlockSource<kind, L> source_;

    FASTCCD_INLINE SeparationPipeline(const TileRequest& request, TileScratch& scratch)
        : parameters_{*request.parameters}, bounds_{parameters_.bounds.rho}, limit_{time_limit(request.cutoff)}, scratch_{scratch},
          source_{request, scratch}
    {
    }

    FASTCCD_INLINE void screen(const double* coordinates, L pair, unsigned lanes)
    {
        SeparationRecord<L> record;
        record.r = relative_motion<L>(coordinates, block_pairs, parameters_.t_max);
        const LaneMask<L> farther = farther_along_axis<kind>(record.r, parameters_.separation, bounds_, record.extents);
        record.pair = pair;
        const unsigned decidable = lanes & Lane<L>::bits(in_separation_range(record.r, record.extents));
        if (const unsigned beyond = lanes & ~decidable; beyond != 0) leave_undecided(scratch_, record.pair, beyond);
        const unsigned kept = decidable & ~Lane<L>::bits(farther);
        if (3 * static_cast<unsigned>(__builtin_popcount(kept)) >= 2 * width)
            look_first(record, kept);
        else if (kept != 0)
            push(scratch_.separating, kept, record);
    }

    /// Takes a batch from the end of a queue; returns the bits of the lanes that are in use.
    template <class Queue>
    FASTCCD_INLINE static unsigned take_last(Queue& queue, SeparationRecord<L>& record)
    {
        const unsigned taken = queue.size < width ? queue.size : width;
        queue.size -= taken;
        read(queue, queue.size, record);
        return lanes_in_use<L>(taken);
    }

    /// The look at the middle, until fewer than `least` pairs are left.
    void look_first(unsigned least)
    {
        SeparationRecord<L> record;
        while (scratch_.separating.size >= least) {
            const unsigned lanes = take_last(scratch_.separating, record);
            look_first(record, lanes);
        }
    }

    FASTCCD_INLINE void look_first(SeparationRecord<L>& record, unsigned lanes)
    {
        lanes &= ~Lane<L>::bits(first_look<kind>(record, parameters_));
        if (lanes == 0) return;
        push(scratch_.advancing, lanes, record);
        if (scratch_.advancing.size >= AdvancingQueue::drain_at) advance(width);
    }

    void advance(unsigned least)
    {
        SeparationRecord<L> record;
        while (scratch_.advancing.size >= least) {
            unsigned lanes = take_last(scratch_.advancing, record);
            do {
                const StepOutcome<L> outcome = step<kind>(record, parameters_, limit_);
                const unsigned contact = lanes & Lane<L>::bits(outcome.contact);
                if (contact != 0) record_contacts(record, contact, Lane<L>::bits(outcome.proven));
                const unsigned left = lanes & Lane<L>::bits(outcome.left);
                if (left != 0) leave_undecided(scratch_, record.pair, left);
                lanes &= ~(contact | left | Lane<L>::bits(outcome.farther));
                // Moving pairs to fill a batch costs about a fifth of a step.
            } while (5 * static_cast<unsigned>(__builtin_popcount(lanes)) > 4 * width);
            if (lanes != 0) push(scratch_.advancing, lanes, record);
        }
    }

    FASTCCD_INLINE void record_contacts(const SeparationRecord<L>& record, unsigned contact, unsigned proven)
    {
        alignas(64) double times[width];
        Lane<L>::store(times, record.time);
        for_each_pair(record.pair, contact, [&](unsigned i, int lane) FASTCCD_INLINE_LAMBDA {
            scratch_.time[i] = times[lane];
            if (times[lane] < scratch_.earliest) scratch_.earliest = times[lane];
            set_bit(scratch_.reported, i);
            if ((proven >> lane & 1) == 0) set_bit(scratch_.is_unproven, i);
        });
    }
};

template <class L>
FASTCCD_INLINE void run_separation_tile(const TileRequest& request, TileScratch& scratch)
{
    if (request.kind == PairKind::vertex_face)
        SeparationPipeline<PairKind::vertex_face, L>::run_tile(request, scratch);
    else
        SeparationPipeline<PairKind::edge_edge, L>::run_tile(request, scratch);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
