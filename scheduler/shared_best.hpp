// The first contact of all, found by many workers that tell each other what they need not look at.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <mutex>

#include <tile_runner.hpp>

namespace fastccd {

/// The best contact so far: smallest toi, ties to the smaller index. Its toi is read without the lock: an old value
/// only drops less.
class SharedBest {
public:
    /// For the tile of the job that begins with pair `first` (by the index this object knows it under): the cutoff up to
    /// which a pair of it can still be better; negative if none can be.
    double cutoff(const Job& job, std::size_t first)
    {
        if (settled_before(first)) return -1.0;
        // In the parameter s. Relative rounding is covered by time_limit; where times are subnormal, SearchParameters::time is
        // off by up to 2^-1073 + 2^-1074.
        return std::min((toi_.load(std::memory_order_relaxed) + 0x1p-1072) / job.parameters.t_max, 1.0);
    }

    void offer(const Contact& contact)
    {
        if (contact.toi > toi_.load(std::memory_order_relaxed)) return;
        const std::lock_guard lock{mutex_};
        if (contact.toi > best_.toi || (contact.toi == best_.toi && contact.pair > best_.pair)) return;
        best_ = contact;
        toi_.store(contact.toi, std::memory_order_relaxed);
    }

    [[nodiscard]] const Contact& contact() const { return best_; }

private:
    /// True if no pair from `first` on can be better: contact at time 0 in an earlier pair.
    bool settled_before(std::size_t first)
    {
        if (toi_.load(std::memory_order_relaxed) > 0.0) return false;
        const std::lock_guard lock{mutex_};
        return best_.pair < first;
    }

    std::mutex mutex_;
    Contact best_ = Summary{}.earliest;
    std::atomic<double> toi_{Summary{}.earliest.toi};
};

}  // namespace fastccd
