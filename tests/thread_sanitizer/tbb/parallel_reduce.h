// Stand-in for oneTBB's header, see workers.h.
#pragma once

#include <vector>

#include <tbb/parallel_for.h>

namespace tbb {

/// Every chunk starts from the identity; their results are joined in order, on the caller's thread.
template <class Value, class Result, class Body, class Join>
Result parallel_reduce(const blocked_range<Value>& range, const Result& identity, const Body& body, const Join& join,
                       task_group_context& context)
{
    std::vector<Result> results((range.end() - range.begin() + range.grainsize() - 1) / range.grainsize());
    parallel_for(range, [&](const blocked_range<Value>& chunk) {
        results[(chunk.begin() - range.begin()) / range.grainsize()] = body(chunk, identity);
    }, context);
    Result whole = identity;
    for (const Result& result : results) whole = join(whole, result);
    return whole;
}

}  // namespace tbb
