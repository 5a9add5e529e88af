// Input for every stage, taken from a data set by running the stages before it.
#pragma once

#include <vector>

#include <fastccd/pair_buffer.hpp>
#include <search_parameters.hpp>

#include "stage_table.hpp"

namespace fastccd::bench {

/// Owns what a StageInput refers to.
class StageData {
public:
    /// Samples pairs from all over the data set. Queues that the data set cannot fill are filled by repetition;
    /// throws std::runtime_error if it has nothing to fill them with.
    StageData(PairKind kind, const PairBuffer& packed, const SearchParameters& parameters);

    [[nodiscard]] StageInput input() const noexcept
    {
        return {kind_, &parameters_, blocks_.data(), blocks_.size(), candidates_.data(), roots_.data()};
    }

private:
    template <PairKind kind>
    void fill_queues(const PairBuffer& packed);

    PairKind kind_;
    SearchParameters parameters_;
    PairBuffer blocks_;
    std::vector<PairQueue> candidates_;
    std::vector<RootQueue> roots_;
};

}  // namespace fastccd::bench
