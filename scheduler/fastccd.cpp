// The public entry points: dense, compact and earliest answers for packed and for indexed pairs.
#include <fastccd/fastccd.hpp>

#include <atomic>
#include <cmath>
#include <cstring>
#include <mutex>

#include <index_check.hpp>
#include <parallel_tiles.hpp>

namespace fastccd {

namespace {

/// A source and whether its indices are in range.
struct CheckedSource {
    PairSource source;
    Status status;
};

CheckedSource packed(const PairView& pairs) { return {{&pairs, {}, pairs.size()}, {}}; }

CheckedSource indexed(const MovingMesh& mesh, const std::int32_t* pairs, std::size_t count, const IndexView& primitives,
                      std::size_t first_size)
{
    if (!mesh.status().ok()) return {{}, mesh.status()};
    return {{nullptr, {mesh.records(), pairs, primitives.data, primitives.row_stride, primitives.column_stride}, count},
            check_pairs(pairs, count, first_size, primitives.size)};
}

// The pair types are two int32 each, read as such.
static_assert(sizeof(VertexFace) == 2 * sizeof(std::int32_t) && sizeof(EdgeEdge) == 2 * sizeof(std::int32_t));

CheckedSource indexed(const MovingMesh& mesh, std::span<const VertexFace> pairs)
{
    return indexed(mesh, pairs.empty() ? nullptr : &pairs[0].vertex, pairs.size(), mesh.faces(), mesh.vertex_count());
}

CheckedSource indexed(const MovingMesh& mesh, std::span<const EdgeEdge> pairs)
{
    return indexed(mesh, pairs.empty() ? nullptr : &pairs[0].edge_a, pairs.size(), mesh.edges(), mesh.edges().size);
}

Status prepare(PairKind kind, const CheckedSource& checked, const Options& options, bool count_roots, Job& job)
{
    if (!checked.status.ok()) return checked.status;
    return prepare(kind, checked.source, options, count_roots, job);
}

Job no_job(PairKind kind) { return {kind, {}, {1.0, 1.0, false}, nullptr, false}; }

Status dense(PairKind kind, const CheckedSource& pairs, const Options& options, std::span<double> toi, Summary* summary,
             std::span<std::uint8_t> roots)
{
    Job job = no_job(kind);
    if (const Status status = prepare(kind, pairs, options, !roots.empty(), job); !status.ok()) return status;
    const std::size_t size = pairs.source.size;
    if (toi.size() != size || (!roots.empty() && roots.size() != size)) return {Error::wrong_size};

    tbb::combinable<TileWorker> workers;
    const Summary totals =
        for_each_tile(job, workers, whole_interval, [&](const TileWorker& worker, std::size_t first, std::size_t count) {
            std::memcpy(toi.data() + first, worker.scratch.time, count * sizeof(double));
            if (!roots.empty()) std::memcpy(roots.data() + first, worker.scratch.roots, count);
        });
    if (summary != nullptr) *summary = totals;
    return {};
}

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

Status compact(PairKind kind, const CheckedSource& pairs, const Options& options, std::vector<Contact>& contacts,
               std::vector<std::size_t>* invalid, Summary* summary)
{
    Job job = no_job(kind);
    if (const Status status = prepare(kind, pairs, options, false, job); !status.ok()) return status;

    // Each worker appends to its own lists; shares put them back in pair order.
    std::vector<TileShare> shares((pairs.source.size + tile_pairs - 1) / tile_pairs);
    tbb::combinable<CollectingWorker> workers;
    const Summary totals = for_each_tile(
        job, workers, whole_interval, [&](CollectingWorker& worker, std::size_t first, std::size_t) {
            TileShare& share = shares[first / tile_pairs];
            share = {&worker, worker.contacts.size(), 0, worker.invalid.size(), 0};
            for_each_bit(worker.scratch.reported, [&](std::size_t i) {
                const double t = worker.scratch.time[i];
                if (std::isnan(t))
                    worker.invalid.push_back(first + i);
                else
                    worker.contacts.push_back(contact_of(job, worker.scratch, first, i));
            });
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

/// The best contact so far, shared by all workers. Its toi is read without the lock: an old value only drops less.
class SharedBest {
public:
    [[nodiscard]] double toi() const { return toi_.load(std::memory_order_relaxed); }

    /// True if no pair from `first` on can be better: contact at time 0 in an earlier pair.
    bool settled_before(std::size_t first)
    {
        if (toi() > 0.0) return false;
        const std::lock_guard lock{mutex_};
        return best_.pair < first;
    }

    void offer(const Contact& contact)
    {
        if (contact.toi > toi()) return;
        const std::lock_guard lock{mutex_};
        if (contact.toi > best_.toi || (contact.toi == best_.toi && contact.pair > best_.pair)) return;
        best_ = contact;
        toi_.store(contact.toi, std::memory_order_relaxed);
    }

    [[nodiscard]] const Contact& contact() const { return best_; }

private:
    std::mutex mutex_;
    Contact best_ = Summary{}.earliest;
    std::atomic<double> toi_{Summary{}.earliest.toi};
};

Status earliest(PairKind kind, const CheckedSource& pairs, const Options& options, Contact& contact, Summary* summary)
{
    Job job = no_job(kind);
    if (const Status status = prepare(kind, pairs, options, false, job); !status.ok()) return status;

    SharedBest best;
    tbb::combinable<TileWorker> workers;
    const auto cutoff = [&](std::size_t first) {
        if (best.settled_before(first)) return -1.0;
        // In the parameter s; rounding is far below the leaf that apart_until_cutoff adds.
        return std::min(best.toi() / job.parameters.t_max, 1.0);
    };
    Summary totals = for_each_tile(job, workers, cutoff, [&](TileWorker& worker, std::size_t, std::size_t) {
        best.offer(worker.totals.earliest);
    });
    contact = best.contact();
    totals.contacts = totals.proven = totals.at_start = 0;
    totals.earliest = contact;
    if (summary != nullptr) *summary = totals;
    return {};
}

}  // namespace

Status time_of_impact(PairKind kind, const PairView& pairs, const Options& options, std::span<double> toi,
                      Summary* summary, std::span<std::uint8_t> roots)
{
    return dense(kind, packed(pairs), options, toi, summary, roots);
}

Status time_of_impact(const MovingMesh& mesh, std::span<const VertexFace> pairs, const Options& options,
                      std::span<double> toi, Summary* summary, std::span<std::uint8_t> roots)
{
    return dense(PairKind::vertex_face, indexed(mesh, pairs), options, toi, summary, roots);
}

Status time_of_impact(const MovingMesh& mesh, std::span<const EdgeEdge> pairs, const Options& options,
                      std::span<double> toi, Summary* summary, std::span<std::uint8_t> roots)
{
    return dense(PairKind::edge_edge, indexed(mesh, pairs), options, toi, summary, roots);
}

Status find_contacts(PairKind kind, const PairView& pairs, const Options& options, std::vector<Contact>& contacts,
                     std::vector<std::size_t>* invalid, Summary* summary)
{
    return compact(kind, packed(pairs), options, contacts, invalid, summary);
}

Status find_contacts(const MovingMesh& mesh, std::span<const VertexFace> pairs, const Options& options,
                     std::vector<Contact>& contacts, std::vector<std::size_t>* invalid, Summary* summary)
{
    return compact(PairKind::vertex_face, indexed(mesh, pairs), options, contacts, invalid, summary);
}

Status find_contacts(const MovingMesh& mesh, std::span<const EdgeEdge> pairs, const Options& options,
                     std::vector<Contact>& contacts, std::vector<std::size_t>* invalid, Summary* summary)
{
    return compact(PairKind::edge_edge, indexed(mesh, pairs), options, contacts, invalid, summary);
}

Status earliest_contact(PairKind kind, const PairView& pairs, const Options& options, Contact& contact, Summary* summary)
{
    return earliest(kind, packed(pairs), options, contact, summary);
}

Status earliest_contact(const MovingMesh& mesh, std::span<const VertexFace> pairs, const Options& options,
                        Contact& contact, Summary* summary)
{
    return earliest(PairKind::vertex_face, indexed(mesh, pairs), options, contact, summary);
}

Status earliest_contact(const MovingMesh& mesh, std::span<const EdgeEdge> pairs, const Options& options,
                        Contact& contact, Summary* summary)
{
    return earliest(PairKind::edge_edge, indexed(mesh, pairs), options, contact, summary);
}

const char* message(Error error) noexcept
{
    switch (error) {
        case Error::none: return "no error";
        case Error::bad_tolerance: return "the tolerance must be a positive finite number";
        case Error::bad_t_max: return "t_max must be greater than 0 and at most 1";
        case Error::wrong_size: return "an array does not have one element per pair or vertex, or has no data";
        case Error::exact_unavailable: return "this build has no exact verdict: it was built without GMP";
        case Error::isa_unavailable: return "the instruction set is not in this build or not on this machine";
        case Error::bad_isa_environment:
            return "FASTCCD_ISA names an instruction set that is unknown or not available on this machine";
        case Error::index_out_of_range: return "an index of the pair points outside its array";
        case Error::bad_minimum_separation: return "the minimum separation must be a finite number, at least 0";
        case Error::bad_distance_tolerance: return "the distance tolerance must be a finite number, at least 0";
        case Error::exact_separation: return "there is no exact verdict with a minimum separation";
    }
    return "unknown error";
}

}  // namespace fastccd
