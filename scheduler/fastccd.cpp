// The public entry points: dense, compact and earliest answers for packed and for indexed pairs.
#include <fastccd/fastccd.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <checked_source.hpp>
#include <guarded.hpp>
#include <parallel_tiles.hpp>
#include <shared_best.hpp>

namespace fastccd {

namespace {

/// Where nothing is reported, without looking at the scratch, so that those times need not be in a cache.
void copy_times(const TileScratch& scratch, std::span<double> toi)
{
    for (std::size_t i = 0; i < toi.size(); i += 64) {
        const std::size_t count = std::min<std::size_t>(toi.size() - i, 64);
        if (scratch.reported[i / 64] == 0)
            std::fill_n(&toi[i], count, std::numeric_limits<double>::infinity());
        else
            std::copy_n(&scratch.time[i], count, &toi[i]);
    }
}

Status dense(PairKind kind, const CheckedSource& pairs, const Options& options, std::span<double> toi, Summary* summary,
             std::span<std::uint8_t> roots)
{
    const std::size_t size = pairs.source.size;
    if (!pairs.status.ok()) return pairs.status;
    if (toi.size() != size || (size > 0 && toi.data() == nullptr)) return {Error::wrong_size};
    if (!roots.empty() && (roots.size() != size || roots.data() == nullptr)) return {Error::wrong_size};
    Job job = no_job(kind);
    if (const Status status = prepare(kind, pairs, options, !roots.empty(), job); !status.ok()) return status;

    Workers<TileWorker> workers;
    const Summary totals =
        for_each_tile(job, workers, whole_interval, [&](const TileWorker& worker, std::size_t first, std::size_t count) {
            copy_times(worker.scratch, toi.subspan(first, count));
            if (!roots.empty()) std::memcpy(roots.data() + first, worker.scratch.roots, count);
        });
    if (summary != nullptr) *summary = totals;
    return {};
}

/// A worker that also keeps the contacts of its tiles, in chunks that stay where they are. Where oneTBB's memory allocator is installed, it
/// keeps them for the next call; pages that the system clears anew for each call would take as long as all else, and longer.
struct CollectingWorker : TileWorker {
    using Chunk = std::vector<Contact, tbb::cache_aligned_allocator<Contact>>;

    /// A chunk with room for `more` contacts, at most those of a tile.
    Chunk& chunk_for(std::size_t more)
    {
        if (chunks.empty() || chunks.back().capacity() - chunks.back().size() < more) chunks.emplace_back().reserve(tile_pairs);
        return chunks.back();
    }

    std::vector<Chunk> chunks;
};

/// What one tile reports, in pair order.
struct TileContacts {
    std::span<const Contact> contacts;  ///< In a chunk.
    std::vector<std::size_t> invalid;
};

/// Room for `more` at the end, growing as push_back does: a list that many calls append to is not moved by each.
template <class T>
void reserve_more(std::vector<T>& list, std::size_t more)
{
    const std::size_t needed = list.size() + more;
    if (needed > list.capacity()) list.reserve(std::max(needed, 2 * list.capacity()));
}

Status compact(PairKind kind, const CheckedSource& pairs, const Options& options, std::vector<Contact>& contacts,
               std::vector<std::size_t>* invalid, Summary* summary)
{
    Job job = no_job(kind);
    if (const Status status = prepare(kind, pairs, options, false, job); !status.ok()) return status;

    const std::size_t most = pairs_per_tile(job);
    std::vector<TileContacts> tiles((pairs.source.size + most - 1) / most);
    Workers<CollectingWorker> workers;
    const Summary totals = for_each_tile(job, workers, whole_interval, [&](CollectingWorker& worker, std::size_t first, std::size_t count) {
        const TileScratch& scratch = worker.scratch;
        const std::size_t reported = count_bits(scratch.reported, count);
        if (reported == 0) return;
        CollectingWorker::Chunk& chunk = worker.chunk_for(reported);
        TileContacts& tile = tiles[first / most];
        const std::size_t begin = chunk.size();
        for_each_bit(scratch.reported, count, [&](std::size_t i) {
            if (std::isnan(scratch.time[i]))
                tile.invalid.push_back(first + i);
            else
                chunk.push_back(contact_of(job, scratch, first, i));
        });
        tile.contacts = std::span{chunk}.subspan(begin);
    });

    // Both before either is written to: on want of memory the caller's lists stay as they were.
    reserve_more(contacts, totals.contacts);
    if (invalid != nullptr) reserve_more(*invalid, totals.invalid);
    for (const TileContacts& tile : tiles) {
        contacts.insert(contacts.end(), tile.contacts.begin(), tile.contacts.end());
        if (invalid != nullptr) invalid->insert(invalid->end(), tile.invalid.begin(), tile.invalid.end());
    }
    if (summary != nullptr) *summary = totals;
    return {};
}

Status earliest(PairKind kind, const CheckedSource& pairs, const Options& options, Contact& contact, Summary* summary)
{
    Job job = no_job(kind);
    if (const Status status = prepare(kind, pairs, options, false, job); !status.ok()) return status;

    SharedBest best;
    Workers<TileWorker> workers;
    const auto cutoff = [&](std::size_t first) { return best.cutoff(job, first); };
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
                      Summary* summary, std::span<std::uint8_t> roots) noexcept
{
    return guarded([&] { return dense(kind, packed(pairs), options, toi, summary, roots); });
}

Status time_of_impact(const MovingMesh& mesh, std::span<const VertexFace> pairs, const Options& options,
                      std::span<double> toi, Summary* summary, std::span<std::uint8_t> roots) noexcept
{
    return guarded([&] { return dense(PairKind::vertex_face, indexed(mesh, pairs), options, toi, summary, roots); });
}

Status time_of_impact(const MovingMesh& mesh, std::span<const EdgeEdge> pairs, const Options& options,
                      std::span<double> toi, Summary* summary, std::span<std::uint8_t> roots) noexcept
{
    return guarded([&] { return dense(PairKind::edge_edge, indexed(mesh, pairs), options, toi, summary, roots); });
}

Status find_contacts(PairKind kind, const PairView& pairs, const Options& options, std::vector<Contact>& contacts,
                     std::vector<std::size_t>* invalid, Summary* summary) noexcept
{
    return guarded([&] { return compact(kind, packed(pairs), options, contacts, invalid, summary); });
}

Status find_contacts(const MovingMesh& mesh, std::span<const VertexFace> pairs, const Options& options,
                     std::vector<Contact>& contacts, std::vector<std::size_t>* invalid, Summary* summary) noexcept
{
    return guarded([&] { return compact(PairKind::vertex_face, indexed(mesh, pairs), options, contacts, invalid, summary); });
}

Status find_contacts(const MovingMesh& mesh, std::span<const EdgeEdge> pairs, const Options& options,
                     std::vector<Contact>& contacts, std::vector<std::size_t>* invalid, Summary* summary) noexcept
{
    return guarded([&] { return compact(PairKind::edge_edge, indexed(mesh, pairs), options, contacts, invalid, summary); });
}

Status earliest_contact(PairKind kind, const PairView& pairs, const Options& options, Contact& contact, Summary* summary) noexcept
{
    return guarded([&] { return earliest(kind, packed(pairs), options, contact, summary); });
}

Status earliest_contact(const MovingMesh& mesh, std::span<const VertexFace> pairs, const Options& options,
                        Contact& contact, Summary* summary) noexcept
{
    return guarded([&] { return earliest(PairKind::vertex_face, indexed(mesh, pairs), options, contact, summary); });
}

Status earliest_contact(const MovingMesh& mesh, std::span<const EdgeEdge> pairs, const Options& options,
                        Contact& contact, Summary* summary) noexcept
{
    return guarded([&] { return earliest(PairKind::edge_edge, indexed(mesh, pairs), options, contact, summary); });
}

const char* message(Error error) noexcept
{
    switch (error) {
        case Error::none: return "no error";
        case Error::bad_tolerance: return "the tolerance must be a positive finite number";
        case Error::bad_t_max: return "t_max must be greater than 0 and at most 1";
        case Error::wrong_size: return "an array does not have one element per pair or vertex, has no data, or is larger than memory can be";
        case Error::exact_unavailable: return "this build has no exact verdict: it was built without GMP";
        case Error::isa_unavailable: return "the instruction set is not in this build or not on this machine";
        case Error::bad_isa_environment:
            return "FASTCCD_ISA names an instruction set that is unknown or not available on this machine";
        case Error::index_out_of_range: return "an index of the pair points outside its array";
        case Error::invalid_pair: return "a coordinate of the pair is not a finite number";
        case Error::out_of_memory: return "out of memory, or the system refused a thread";
        case Error::bad_minimum_separation: return "the minimum separation must be a finite number, at least 0";
        case Error::bad_distance_tolerance: return "the distance tolerance must be a finite number, at least 0";
        case Error::bad_face_index: return "a face of the mesh refers to a vertex that is not there";
        case Error::bad_edge_index: return "an edge of the mesh refers to a vertex that is not there";
        case Error::bad_kind: return "pairs are vertex-face or edge-edge; this kind is neither";
        case Error::exact_separation: return "there is no exact verdict with a minimum separation";
    }
    return "unknown error";
}

}  // namespace fastccd
