#include <touching_blocks.hpp>

#include <algorithm>

#include <load_pair.hpp>

namespace fastccd {

namespace {

/// Decided by one call, one pair a lane.
class Block {
public:
    /// `others`: for pairs that are not answered; if there is none, they are for the search.
    Block(const Job& job, std::size_t first, TileScratch& scratch, TouchingBlock* kernel, Block* others)
        : job_{job}, first_{first}, scratch_{scratch}, kernel_{kernel}, others_{others}
    {
    }

    void take(std::size_t i)
    {
        load_pair(job_.kind, job_.source, first_ + i, coordinates_[0] + size_, block_pairs);
        answers_.left[size_] = scratch_.touch_time[i];
        numbers_[size_++] = i;
        if (size_ == block_pairs) decide();
    }

    void decide()
    {
        if (size_ == 0) return;
        for (std::size_t lane = size_; lane < block_pairs; ++lane) {  // the first one again
            for (double(&row)[block_pairs] : coordinates_) row[lane] = row[0];
            answers_.left[lane] = answers_.left[0];
        }
        kernel_(job_.kind, coordinates_[0], job_.parameters, answers_);
        for (std::size_t lane = 0; lane < size_; ++lane) {
            const auto has = [&](unsigned bits) { return (bits >> lane & 1) != 0; };
            const std::size_t i = numbers_[lane];
            if (has(answers_.reported)) {
                scratch_.time[i] = answers_.time[lane];
                scratch_.earliest = std::min(scratch_.earliest, scratch_.time[i]);
                set_bit(scratch_.reported, i);
                if (!has(answers_.proven)) set_bit(scratch_.is_unproven, i);
            } else if (has(answers_.apart)) {
                continue;
            } else if (others_ != nullptr) {
                others_->take(i);
            } else {
                set_bit(scratch_.is_undecided, i);
            }
        }
        size_ = 0;
    }

private:
    const Job& job_;
    std::size_t first_;
    TileScratch& scratch_;
    TouchingBlock* kernel_;
    Block* others_;
    alignas(64) double coordinates_[pair_coordinates][block_pairs];
    TouchAnswers answers_;
    std::size_t numbers_[block_pairs], size_ = 0;
};

/// In narrower leaves most of what is not answered comes to the search all the same: random pairs at 1e-13 took 9 to 12 % longer.
constexpr double narrowest_looked_beyond = 0x1p-40;

}  // namespace

void decide_touching(const Job& job, std::size_t first, std::size_t count, TileScratch& scratch)
{
    if (job.exact) {
        for (std::size_t w = 0; w < tile_pairs / 64; ++w) scratch.is_undecided[w] |= scratch.may_touch[w];
        return;
    }
    for (std::size_t w = 0; w < tile_pairs / 64; ++w) scratch.may_touch[w] &= ~scratch.is_undecided[w];
    Block anywhere{job, first, scratch, job.kernels->contact_anywhere, nullptr};
    const bool both = job.parameters.leaf_width >= narrowest_looked_beyond;
    Block in_leaves{job, first, scratch, job.kernels->contact_in_leaves, both ? &anywhere : nullptr};
    for_each_bit(scratch.may_touch, count, [&](std::size_t i) {
        // A contact that is proven before it needs no other.
        if (!(scratch.time[i] < scratch.touch_time[i])) (scratch.touch_time[i] > 0.0 ? in_leaves : anywhere).take(i);
    });
    in_leaves.decide();
    anywhere.decide();
}

}  // namespace fastccd
