#include <touching_blocks.hpp>

#include <algorithm>

#include <load_pair.hpp>

namespace fastccd {

namespace {

/// Decided by one call, one pair a lane.
class Block {
public:
    /// `for_doubts`: for pairs whose start is in doubt, if the kernel says so of any; `for_others`: for those that are not answered; if there is
    /// none, they are for the search.
    Block(const Job& j, std::size_t first_pair, TileScratch& s, TouchingBlock* k, Block* for_doubts, Block* for_others)
        : job{j}, first{first_pair}, scratch{s}, kernel{k}, doubts{for_doubts}, others{for_others}
    {
    }

    void take(std::size_t i)
    {
        load_pair(job.kind, job.source, first + i, coordinates[0] + size, block_pairs);
        answers.left[size] = scratch.touch_time[i];
        numbers[size++] = i;
        if (size == block_pairs) decide();
    }

    void decide()
    {
        if (size == 0) return;
        for (std::size_t lane = size; lane < block_pairs; ++lane) {  // the first one again
            for (double(&row)[block_pairs] : coordinates) row[lane] = row[0];
            answers.left[lane] = answers.left[0];
        }
        kernel(job.kind, coordinates[0], job.parameters, answers);
        for (std::size_t lane = 0; lane < size; ++lane) {
            const auto has = [&](unsigned bits) { return (bits >> lane & 1) != 0; };
            const std::size_t i = numbers[lane];
            const std::uint64_t bit = std::uint64_t{1} << i % 64;
            if (has(answers.reported)) {
                scratch.time[i] = answers.time[lane];
                scratch.earliest = std::min(scratch.earliest, scratch.time[i]);
                scratch.reported[i / 64] |= bit;
                if (!has(answers.proven)) scratch.is_unproven[i / 64] |= bit;
            } else if (has(answers.apart)) {
                continue;
            } else if (has(answers.start_in_doubt)) {
                doubts->take(i);
            } else if (others != nullptr) {
                others->take(i);
            } else {
                scratch.is_undecided[i / 64] |= bit;
            }
        }
        size = 0;
    }

private:
    const Job& job;
    std::size_t first;
    TileScratch& scratch;
    TouchingBlock* kernel;
    Block* doubts;
    Block* others;
    alignas(64) double coordinates[pair_coordinates][block_pairs];
    TouchAnswers answers;
    std::size_t numbers[block_pairs], size = 0;
};

/// In narrower leaves most of what is not answered comes to the search all the same: random pairs at 1e-13 took 9 to 12 % longer.
constexpr double narrowest_looked_beyond = 0x1p-40;

}  // namespace

void decide_touching(const Job& job, std::size_t first, std::size_t count, TileScratch& scratch)
{
    if (job.exact || job.parameters.count_roots) {
        for (std::size_t w = 0; w < tile_pairs / 64; ++w) scratch.is_undecided[w] |= scratch.may_touch[w];
        return;
    }
    for (std::size_t w = 0; w < tile_pairs / 64; ++w) scratch.may_touch[w] &= ~scratch.is_undecided[w];
    Block in_doubt{job, first, scratch, job.kernels->start_in_doubt, nullptr, nullptr};
    Block anywhere{job, first, scratch, job.kernels->contact_anywhere, &in_doubt, nullptr};
    const bool both = job.parameters.leaf_width >= narrowest_looked_beyond;
    Block in_leaves{job, first, scratch, job.kernels->contact_in_leaves, nullptr, both ? &anywhere : nullptr};
    for_each_bit(scratch.may_touch, count, [&](std::size_t i) {
        // A contact that is proven before it needs no other.
        if (!(scratch.time[i] < scratch.touch_time[i])) (scratch.touch_time[i] > 0.0 ? in_leaves : anywhere).take(i);
    });
    in_leaves.decide();
    anywhere.decide();
    in_doubt.decide();
}

}  // namespace fastccd
