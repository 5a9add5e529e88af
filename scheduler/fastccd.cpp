// The public entry points.
#include <fastccd/fastccd.hpp>

#include <cmath>
#include <cstring>

#include <parallel_tiles.hpp>

namespace fastccd {

namespace {

/// A worker that also keeps the contacts and invalid pairs of its tiles, tile after tile.
struct CollectingWorker : TileWorker {
    std::vector<Contact> contacts;
    std::vector<std::size_t> invalid;
};

/// Where the results of one tile lie in its worker.
struct TileShare {
    const CollectingWorker* worker = nullptr;
    std::size_t contacts_begin = 0, contacts_end = 0;
    std::size_t invalid_begin = 0, invalid_end = 0;
};

}  // namespace

Status time_of_impact(PairKind kind, const PairView& pairs, const Options& options, std::span<double> toi,
                      Summary* summary, std::span<std::uint8_t> roots)
{
    if (toi.size() != pairs.size() || (!roots.empty() && roots.size() != pairs.size())) return {Error::wrong_size};
    Job job{kind, &pairs, {1.0, 1.0, false}, nullptr};
    if (const Status status = prepare(kind, pairs, options, !roots.empty(), job); !status.ok()) return status;

    tbb::combinable<TileWorker> workers;
    const Summary totals = for_each_tile(job, workers, [&](const TileWorker& worker, std::size_t first, std::size_t count) {
        std::memcpy(toi.data() + first, worker.result.toi, count * sizeof(double));
        if (!roots.empty()) std::memcpy(roots.data() + first, worker.result.roots, count);
    });
    if (summary != nullptr) *summary = totals;
    return {};
}

Status find_contacts(PairKind kind, const PairView& pairs, const Options& options, std::vector<Contact>& contacts,
                     std::vector<std::size_t>* invalid, Summary* summary)
{
    Job job{kind, &pairs, {1.0, 1.0, false}, nullptr};
    if (const Status status = prepare(kind, pairs, options, false, job); !status.ok()) return status;

    // Each worker appends to its own lists; shares put them back in pair order.
    std::vector<TileShare> shares((pairs.size() + tile_pairs - 1) / tile_pairs);
    tbb::combinable<CollectingWorker> workers;
    const Summary totals = for_each_tile(job, workers, [&](CollectingWorker& worker, std::size_t first, std::size_t count) {
        TileShare& share = shares[first / tile_pairs];
        share = {&worker, worker.contacts.size(), 0, worker.invalid.size(), 0};
        for (std::size_t i = 0; i < count; ++i) {
            const double t = worker.result.toi[i];
            if (t <= 1.0)
                worker.contacts.push_back({first + i, t});
            else if (std::isnan(t))
                worker.invalid.push_back(first + i);
        }
        share.contacts_end = worker.contacts.size();
        share.invalid_end = worker.invalid.size();
    });

    contacts.reserve(contacts.size() + totals.contacts);
    for (const TileShare& share : shares) {
        const auto at = [](const auto& list, std::size_t i) { return list.begin() + static_cast<std::ptrdiff_t>(i); };
        contacts.insert(contacts.end(), at(share.worker->contacts, share.contacts_begin),
                        at(share.worker->contacts, share.contacts_end));
        if (invalid != nullptr)
            invalid->insert(invalid->end(), at(share.worker->invalid, share.invalid_begin),
                            at(share.worker->invalid, share.invalid_end));
    }
    if (summary != nullptr) *summary = totals;
    return {};
}

const char* message(Error error) noexcept
{
    switch (error) {
        case Error::none: return "no error";
        case Error::bad_tolerance: return "the tolerance must be a positive finite number";
        case Error::bad_t_max: return "t_max must be greater than 0 and at most 1";
        case Error::wrong_size: return "an output does not have one element per pair, or the view has no data";
        case Error::isa_unavailable: return "the instruction set is not in this build or not on this machine";
        case Error::bad_isa_environment:
            return "FASTCCD_ISA names an instruction set that is unknown or not available on this machine";
        case Error::index_out_of_range: return "an index of the pair points outside its array";
    }
    return "unknown error";
}

}  // namespace fastccd
