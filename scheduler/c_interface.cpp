// The C interface: arguments checked and put into the types of the C++ one.
#include <fastccd/fastccd.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include <tbb/task_arena.h>

#include <c_structs.hpp>
#include <fastccd/fastccd.hpp>
#include <guarded.hpp>
#include <parallel_ranges.hpp>

namespace fastccd {

namespace {

static_assert(FASTCCD_BAD_TOLERANCE == static_cast<int>(Error::bad_tolerance) && FASTCCD_BAD_T_MAX == static_cast<int>(Error::bad_t_max) &&
              FASTCCD_WRONG_SIZE == static_cast<int>(Error::wrong_size) &&
              FASTCCD_EXACT_UNAVAILABLE == static_cast<int>(Error::exact_unavailable) &&
              FASTCCD_ISA_UNAVAILABLE == static_cast<int>(Error::isa_unavailable) &&
              FASTCCD_BAD_ISA_ENVIRONMENT == static_cast<int>(Error::bad_isa_environment) &&
              FASTCCD_INDEX_OUT_OF_RANGE == static_cast<int>(Error::index_out_of_range) &&
              FASTCCD_INVALID_PAIR == static_cast<int>(Error::invalid_pair) && FASTCCD_OUT_OF_MEMORY == static_cast<int>(Error::out_of_memory) &&
              FASTCCD_BAD_MINIMUM_SEPARATION == static_cast<int>(Error::bad_minimum_separation) &&
              FASTCCD_BAD_DISTANCE_TOLERANCE == static_cast<int>(Error::bad_distance_tolerance) &&
              FASTCCD_EXACT_SEPARATION == static_cast<int>(Error::exact_separation) &&
              FASTCCD_BAD_FACE_INDEX == static_cast<int>(Error::bad_face_index) &&
              FASTCCD_BAD_EDGE_INDEX == static_cast<int>(Error::bad_edge_index));
static_assert(FASTCCD_VERTEX_FACE == static_cast<int>(PairKind::vertex_face) && FASTCCD_EDGE_EDGE == static_cast<int>(PairKind::edge_edge));
static_assert(FASTCCD_ISA_AUTOMATIC == static_cast<int>(Isa::automatic) && FASTCCD_ISA_SCALAR == static_cast<int>(Isa::scalar) &&
              FASTCCD_ISA_SSE2 == static_cast<int>(Isa::sse2) && FASTCCD_ISA_AVX2 == static_cast<int>(Isa::avx2) &&
              FASTCCD_ISA_AVX512 == static_cast<int>(Isa::avx512) && FASTCCD_ISA_NEON == static_cast<int>(Isa::neon));

/// Sizes of the structs in the first version: none was ever smaller.
constexpr std::size_t first_options = 40, first_mesh = 64, first_summary = 88, first_step = 32;
static_assert(sizeof(std::size_t) != 8 || (sizeof(fastccd_options) >= first_options && sizeof(fastccd_mesh) >= first_mesh &&
                                           sizeof(fastccd_summary) >= first_summary && sizeof(fastccd_step) >= first_step));

bool is_kind(int kind) { return kind == FASTCCD_VERTEX_FACE || kind == FASTCCD_EDGE_EDGE; }
bool is_isa(int isa) { return isa >= FASTCCD_ISA_AUTOMATIC && isa <= FASTCCD_ISA_NEON; }

fastccd_options to_c(const Options& options)
{
    return {sizeof(fastccd_options),        options.tolerance, options.t_max, static_cast<std::int32_t>(options.isa), options.reference ? 1 : 0,
            options.exact ? 1 : 0, 0, options.minimum_separation, options.distance_tolerance, 0, 0};
}

/// Options of a call, and how many threads may work for it; 0: as many as work in the caller's arena.
struct CallOptions : Options {
    int threads = 0;
};

/// Defaults for a null pointer.
int to_cpp(const fastccd_options* given, CallOptions& options)
{
    if (given == nullptr) return FASTCCD_OK;
    fastccd_options known = to_c({});
    if (!read_struct(*given, first_options, known) || known.threads < 0 || known.reserved != 0 || known.reserved2 != 0)
        return FASTCCD_BAD_ARGUMENT;
    if (!is_isa(known.isa)) return FASTCCD_ISA_UNAVAILABLE;
    options.threads = known.threads;
    options.tolerance = known.tolerance;
    options.t_max = known.t_max;
    options.isa = static_cast<Isa>(known.isa);
    options.reference = known.reference != 0;
    options.exact = known.exact != 0;
    options.minimum_separation = known.minimum_separation;
    options.distance_tolerance = known.distance_tolerance;
    return FASTCCD_OK;
}

int report(const Status& status, fastccd_fault* fault)
{
    if (fault != nullptr && status.pair != Status{}.pair) *fault = {status.pair, status.index};
    return static_cast<int>(status.error);
}

void report(const Summary& from, fastccd_summary* to)
{
    if (to == nullptr) return;
    write_struct({0, from.pairs, from.contacts, from.proven, from.odd, from.even, from.invalid, from.scalar_pairs, from.earliest.pair,
                  from.earliest.toi, static_cast<std::int32_t>(from.isa), 0, from.at_start},
                 *to);
}

void report(const Contact& from, fastccd_contact& to) { to = {from.pair, from.toi, from.proven ? 1 : 0, from.at_start ? 1 : 0}; }

/// What `call` returns, an error, called where no more threads work than that.
template <class Call>
int with_threads(int threads, const Call& call)
{
    if (threads == 0 || threads >= tbb::this_task_arena::max_concurrency()) return call();
    int error = FASTCCD_OK;
    const Status status = guarded([&] {
        enter_arena();
        tbb::task_arena{threads}.execute([&] { error = call(); });
        return Status{};
    });
    return status.ok() ? error : static_cast<int>(status.error);
}

/// The arguments that all calls for many pairs share.
struct Request {
    CallOptions options;
    fastccd_summary* summary;
    fastccd_fault* fault;

    int check(int kind, const void* pairs, std::size_t count, const fastccd_options* given)
    {
        if (!is_kind(kind) || !has_size(summary, first_summary)) return FASTCCD_BAD_ARGUMENT;
        if (pairs == nullptr && count > 0) return FASTCCD_WRONG_SIZE;
        return to_cpp(given, options);
    }
};

/// `call(options, toi, summary, roots)`, a dense answer.
template <class Call>
int dense(const Request& request, std::size_t count, double* toi, std::uint8_t* roots, const Call& call)
{
    if (toi == nullptr && count > 0) return FASTCCD_WRONG_SIZE;
    Summary summary;
    const Status status = call(request.options, std::span{toi, count}, &summary, std::span{roots, roots != nullptr ? count : 0});
    if (status.ok()) report(summary, request.summary);
    return report(status, request.fault);
}

/// `call(options, contacts, nullptr, summary)`, a compact answer.
template <class Call>
int compact(const Request& request, fastccd_contact* contacts, std::size_t capacity, std::size_t* found, const Call& call)
{
    if (found == nullptr || (contacts == nullptr && capacity > 0)) return FASTCCD_BAD_ARGUMENT;
    std::vector<Contact> list;
    Summary summary;
    const Status status = call(request.options, list, nullptr, &summary);
    if (status.ok()) {
        *found = list.size();
        for (std::size_t i = 0; i < std::min(capacity, list.size()); ++i) report(list[i], contacts[i]);
        report(summary, request.summary);
    }
    return report(status, request.fault);
}

/// `call(options, contact, summary)`, the first contact of all.
template <class Call>
int earliest(const Request& request, fastccd_contact* contact, const Call& call)
{
    if (contact == nullptr) return FASTCCD_BAD_ARGUMENT;
    Contact found;
    Summary summary;
    const Status status = call(request.options, found, &summary);
    if (status.ok()) {
        report(found, *contact);
        report(summary, request.summary);
    }
    return report(status, request.fault);
}

/// `call(options, step)`, the step that candidates of both kinds allow. `*step` is written if its size is set, 0 on every error.
template <class Call>
int collision_free(const void* vertex_face, std::size_t vertex_face_count, const void* edge_edge, std::size_t edge_edge_count,
                   const fastccd_options* options, fastccd_step* step, const Call& call)
{
    if (step == nullptr || !has_size(step, first_step)) return FASTCCD_BAD_ARGUMENT;
    CollisionFreeStep found;
    CallOptions chosen;
    int error = to_cpp(options, chosen);
    if ((vertex_face == nullptr && vertex_face_count > 0) || (edge_edge == nullptr && edge_edge_count > 0)) error = FASTCCD_WRONG_SIZE;
    if (error == FASTCCD_OK) error = with_threads(chosen.threads, [&] { return call(chosen, found); });
    write_struct({0, found.step, found.pair, static_cast<std::int32_t>(found.kind), 0}, *step);
    return error;
}

/// The mesh of a call; false: the struct cannot be read.
bool to_cpp(const fastccd_mesh* given, MovingMesh& mesh)
{
    fastccd_mesh known{};
    if (given == nullptr || !read_struct(*given, first_mesh, known)) return false;
    const auto missing = [&](const auto* data, std::size_t rows) { return data == nullptr && rows > 0; };
    if (missing(known.start, known.vertex_count) || missing(known.end, known.vertex_count)) return true;  // as a mesh without data: wrong_size
    const auto positions = [&](const double* data) { return data != nullptr ? PositionView::rows(data, known.vertex_count) : PositionView{}; };
    mesh = {positions(known.start), positions(known.end), IndexView::rows(known.faces, known.face_count, 3),
            IndexView::rows(known.edges, known.edge_count, 2)};
    return true;
}

// Two int32 a pair, read as such.
std::span<const VertexFace> vertex_face_pairs(const std::int32_t* pairs, std::size_t count)
{
    return {reinterpret_cast<const VertexFace*>(pairs), count};
}
std::span<const EdgeEdge> edge_edge_pairs(const std::int32_t* pairs, std::size_t count)
{
    return {reinterpret_cast<const EdgeEdge*>(pairs), count};
}

/// `answer(request, view)` for packed pairs.
template <class Answer>
int of_packed(int kind, const double* pairs, std::size_t count, const fastccd_options* options, fastccd_summary* summary, const Answer& answer)
{
    Request request{{}, summary, nullptr};
    if (const int error = request.check(kind, pairs, count, options); error != FASTCCD_OK) return error;
    return with_threads(request.options.threads, [&] { return answer(request, PairView::interleaved(pairs, count)); });
}

/// `answer(request, mesh, pairs)` for pairs of a mesh of either kind.
template <class Answer>
int of_mesh(const fastccd_mesh* mesh, int kind, const std::int32_t* pairs, std::size_t count, const fastccd_options* options,
            fastccd_summary* summary, fastccd_fault* fault, const Answer& answer)
{
    Request request{{}, summary, fault};
    if (const int error = request.check(kind, pairs, count, options); error != FASTCCD_OK) return error;
    return with_threads(request.options.threads, [&] {
        MovingMesh moving;
        if (!to_cpp(mesh, moving)) return static_cast<int>(FASTCCD_BAD_ARGUMENT);
        return kind == FASTCCD_VERTEX_FACE ? answer(request, moving, vertex_face_pairs(pairs, count))
                                           : answer(request, moving, edge_edge_pairs(pairs, count));
    });
}

int single(PairKind kind, const double* x0, const double* x1, const fastccd_options* given, double* toi)
{
    if (toi == nullptr) return FASTCCD_BAD_ARGUMENT;
    *toi = std::numeric_limits<double>::quiet_NaN();
    if (x0 == nullptr || x1 == nullptr) return FASTCCD_BAD_ARGUMENT;
    CallOptions options;
    if (const int error = to_cpp(given, options); error != FASTCCD_OK) return error;
    Point start[4], end[4];
    for (std::size_t i = 0; i < 4; ++i) {
        std::copy_n(x0 + 3 * i, 3, start[i].begin());
        std::copy_n(x1 + 3 * i, 3, end[i].begin());
    }
    const PairToi found = kind == PairKind::vertex_face ? vertex_face_toi(start, end, options) : edge_edge_toi(start, end, options);
    *toi = found.toi;
    return static_cast<int>(found.status.error);
}

}  // namespace

}  // namespace fastccd

using namespace fastccd;

extern "C" {

const char* fastccd_version(void) { return FASTCCD_VERSION; }

const char* fastccd_message(int error)
{
    if (error == FASTCCD_BAD_ARGUMENT)
        return "a pointer is null, a kind is unknown, the number of threads is negative, the size of a struct is not set, "
               "or a field that is reserved, or that this version does not know, is not 0";
    if (error < FASTCCD_OK || error > FASTCCD_BAD_EDGE_INDEX) return "unknown error";
    return message(static_cast<Error>(error));
}

const char* fastccd_isa_name(int isa) { return is_isa(isa) ? name(static_cast<Isa>(isa)) : "unknown"; }
int fastccd_isa_lanes(int isa) { return is_isa(isa) ? lanes(static_cast<Isa>(isa)) : 0; }
int fastccd_isa_available(int isa) { return is_isa(isa) && isa_available(static_cast<Isa>(isa)) ? 1 : 0; }
int fastccd_best_isa(void) { return static_cast<int>(best_isa()); }

void fastccd_options_init(fastccd_options* options, size_t size)
{
    if (options == nullptr || size < sizeof options->size) return;
    options->size = size;
    write_struct(to_c({}), *options);
}

int fastccd_vertex_face_toi(const double x0[12], const double x1[12], const fastccd_options* options, double* toi)
{
    return single(PairKind::vertex_face, x0, x1, options, toi);
}

int fastccd_edge_edge_toi(const double x0[12], const double x1[12], const fastccd_options* options, double* toi)
{
    return single(PairKind::edge_edge, x0, x1, options, toi);
}

int fastccd_pairs_time_of_impact(int kind, const double* pairs, size_t count, const fastccd_options* options, double* toi,
                                 uint8_t* roots, fastccd_summary* summary)
{
    return of_packed(kind, pairs, count, options, summary, [&](const Request& request, const PairView& view) {
        return dense(request, count, toi, roots,
                     [&](const auto&... arguments) { return time_of_impact(static_cast<PairKind>(kind), view, arguments...); });
    });
}

int fastccd_pairs_find_contacts(int kind, const double* pairs, size_t count, const fastccd_options* options, fastccd_contact* contacts,
                                size_t capacity, size_t* found, fastccd_summary* summary)
{
    return of_packed(kind, pairs, count, options, summary, [&](const Request& request, const PairView& view) {
        return compact(request, contacts, capacity, found,
                       [&](auto&&... arguments) { return find_contacts(static_cast<PairKind>(kind), view, arguments...); });
    });
}

int fastccd_pairs_earliest_contact(int kind, const double* pairs, size_t count, const fastccd_options* options, fastccd_contact* contact,
                                   fastccd_summary* summary)
{
    return of_packed(kind, pairs, count, options, summary, [&](const Request& request, const PairView& view) {
        return earliest(request, contact,
                        [&](auto&&... arguments) { return earliest_contact(static_cast<PairKind>(kind), view, arguments...); });
    });
}

int fastccd_pairs_collision_free_step(const double* vertex_face, size_t vertex_face_count, const double* edge_edge, size_t edge_edge_count,
                                      const fastccd_options* options, fastccd_step* step, fastccd_fault* fault)
{
    return collision_free(vertex_face, vertex_face_count, edge_edge, edge_edge_count, options, step,
                          [&](const Options& chosen, CollisionFreeStep& found) {
                              return report(collision_free_step(PairView::interleaved(vertex_face, vertex_face_count),
                                                                PairView::interleaved(edge_edge, edge_edge_count), chosen, found), fault);
                          });
}

int fastccd_mesh_time_of_impact(const fastccd_mesh* mesh, int kind, const int32_t* pairs, size_t count, const fastccd_options* options,
                                double* toi, uint8_t* roots, fastccd_summary* summary, fastccd_fault* fault)
{
    return of_mesh(mesh, kind, pairs, count, options, summary, fault, [&](const Request& request, const MovingMesh& moving, auto candidates) {
        return dense(request, count, toi, roots,
                     [&](const auto&... arguments) { return time_of_impact(moving, candidates, arguments...); });
    });
}

int fastccd_mesh_find_contacts(const fastccd_mesh* mesh, int kind, const int32_t* pairs, size_t count, const fastccd_options* options,
                               fastccd_contact* contacts, size_t capacity, size_t* found, fastccd_summary* summary, fastccd_fault* fault)
{
    return of_mesh(mesh, kind, pairs, count, options, summary, fault, [&](const Request& request, const MovingMesh& moving, auto candidates) {
        return compact(request, contacts, capacity, found,
                       [&](auto&&... arguments) { return find_contacts(moving, candidates, arguments...); });
    });
}

int fastccd_mesh_earliest_contact(const fastccd_mesh* mesh, int kind, const int32_t* pairs, size_t count, const fastccd_options* options,
                                  fastccd_contact* contact, fastccd_summary* summary, fastccd_fault* fault)
{
    return of_mesh(mesh, kind, pairs, count, options, summary, fault, [&](const Request& request, const MovingMesh& moving, auto candidates) {
        return earliest(request, contact,
                        [&](auto&&... arguments) { return earliest_contact(moving, candidates, arguments...); });
    });
}

int fastccd_mesh_collision_free_step(const fastccd_mesh* mesh, const int32_t* vertex_face, size_t vertex_face_count,
                                     const int32_t* edge_edge, size_t edge_edge_count, const fastccd_options* options,
                                     fastccd_step* step, fastccd_fault* fault)
{
    return collision_free(vertex_face, vertex_face_count, edge_edge, edge_edge_count, options, step,
                          [&](const Options& chosen, CollisionFreeStep& found) {
                              MovingMesh moving;
                              if (!to_cpp(mesh, moving)) return static_cast<int>(FASTCCD_BAD_ARGUMENT);
                              return report(collision_free_step(moving, vertex_face_pairs(vertex_face, vertex_face_count),
                                                                edge_edge_pairs(edge_edge, edge_edge_count), chosen, found), fault);
                          });
}

}  // extern "C"
