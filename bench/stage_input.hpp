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

    /// Coordinates of the sampled pairs, 24 each, and of pairs in contact: for the certified search.
    [[nodiscard]] const std::vector<double>& sample() const noexcept { return sample_; }
    [[nodiscard]] const std::vector<double>& contacts() const noexcept { return contacts_; }

private:
    template <PairKind kind>
    void fill_queues(const PairBuffer& packed);
    void find_contact_pairs(const PairBuffer& packed);

    PairKind kind_;
    SearchParameters parameters_;
    PairBuffer blocks_;
    std::vector<double> sample_, contacts_;
    std::vector<PairQueue> candidates_;
    std::vector<RootQueue> roots_;
};

}  // namespace fastccd::bench
