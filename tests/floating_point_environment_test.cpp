// The same bits whatever the caller's floating-point environment is, and that environment is the caller's again afterwards.
#include <atomic>
#include <cfenv>
#include <cstring>
#include <functional>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#ifdef __SSE2__
#include <immintrin.h>
#endif

#include <fastccd/fastccd.h>

#include "amount.hpp"
#include "generators.hpp"
#include "mesh_of_pairs.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

struct Environment {
    const char* name;
    void (*set)();
};

void flush_subnormals()
{
#if defined(__SSE2__)
    _mm_setcsr(_mm_getcsr() | 0x8040);  // flush to zero, denormals are zero
#elif defined(__aarch64__)
    std::fenv_t environment;
    std::fegetenv(&environment);
    environment.__fpcr |= 1u << 24;  // FZ
    std::fesetenv(&environment);
#else
#error "how does this processor flush subnormal numbers?"
#endif
}

void trap_exceptions()
{
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW | FE_UNDERFLOW);  // without effect where the processor cannot
}

constexpr Environment environments[] = {
    {"upward", [] { std::fesetround(FE_UPWARD); }},
    {"downward", [] { std::fesetround(FE_DOWNWARD); }},
    {"toward zero", [] { std::fesetround(FE_TOWARDZERO); }},
    {"subnormal numbers flushed", flush_subnormals},
    {"exceptions trapped", trap_exceptions},
};

/// What decides how numbers are computed, without the exceptions there were.
unsigned controls()
{
#if defined(__SSE2__)
    return _mm_getcsr() & ~0x3fu;
#else
    std::fenv_t environment;
    std::fegetenv(&environment);
    return environment.__fpcr;
#endif
}

/// Is in an environment while it lives.
class Inside {
public:
    explicit Inside(const Environment& environment)
    {
        std::fegetenv(&before_);
        environment.set();
    }
    ~Inside() { std::fesetenv(&before_); }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

private:
    std::fenv_t before_;
};

/// All that the library says, as bytes, to compare.
class Record {
public:
    template <class T>
    void add(const T& value)
    {
        static_assert(std::is_arithmetic_v<T>);
        const auto* const first = reinterpret_cast<const unsigned char*>(&value);
        bytes_.insert(bytes_.end(), first, first + sizeof value);
    }
    template <class T>
    void add(const std::vector<T>& values)
    {
        for (const T& value : values) add(value);
    }
    void add(const Contact& contact)
    {
        add(contact.pair);
        add(contact.toi);
        add(contact.proven);
        add(contact.at_start);
    }
    void add(const Status& status) { add(static_cast<int>(status.error)); }

    friend bool operator==(const Record&, const Record&) = default;

private:
    std::vector<unsigned char> bytes_;
};

/// Pairs of every family, and a mesh made of them.
struct Scene {
    oracle::Kind kind;
    std::vector<oracle::Pair> pairs;
    std::vector<float> rounded;

    Scene(oracle::Kind kind_of_pairs, std::size_t per_family) : kind{kind_of_pairs}
    {
        std::vector<oracle::Pair> more;
        for (const std::string& family : families()) {
            generate(family, kind, 71, per_family, more);
            pairs.insert(pairs.end(), more.begin(), more.end());
        }
        // Subnormal numbers throughout: hardly any of the pairs so far has one, and flushing takes nothing else away.
        for (oracle::Pair pair : more) {
            for (auto& point : pair)
                for (double& x : point) x *= 0x1p-1060;
            pairs.push_back(pair);
        }
        for (const oracle::Pair& pair : pairs)
            for (const auto& point : pair)
                for (const double x : point) rounded.push_back(static_cast<float>(x));
    }
};

void add_packed(Record& record, const PairView& pairs, oracle::Kind kind, const Options& options)
{
    const Answer all = answer(kind, pairs, options);
    record.add(all.toi);
    record.add(all.roots);
    record.add(all.summary.proven);
    std::vector<Contact> contacts;
    record.add(find_contacts(pair_kind(kind), pairs, options, contacts));
    for (const Contact& contact : contacts) record.add(contact);
    Contact earliest;
    record.add(earliest_contact(pair_kind(kind), pairs, options, earliest));
    record.add(earliest);
}

template <class Pair>
void add_indexed(Record& record, const MovingMesh& mesh, std::span<const Pair> pairs, const Options& options)
{
    std::vector<double> toi(pairs.size());
    record.add(time_of_impact(mesh, pairs, options, toi));
    record.add(toi);
    Contact earliest;
    record.add(earliest_contact(mesh, pairs, options, earliest));
    record.add(earliest);
}

Record all_answers(const Scene& scene)
{
    Record record;
    const PairView rounded = PairView::interleaved(scene.rounded.data(), scene.pairs.size());
    const std::vector<oracle::Pair> few(scene.pairs.end() - 50, scene.pairs.end());  // on the caller's thread
    for (const Isa isa : isas_to_test())
        for (const double t_max : {1.0, 0.7})
            for (const double separation : {0.0, 0.01}) {
                Options options;
                options.isa = isa;
                options.t_max = t_max;
                options.minimum_separation = separation;
                add_packed(record, interleaved(scene.pairs), scene.kind, options);
                add_packed(record, rounded, scene.kind, options);
                add_packed(record, interleaved(few), scene.kind, options);
            }

    const MeshOfPairs made{scene.pairs};
    const MovingMesh mesh = made.mesh();
    const std::span<const VertexFace> vertex_face{made.vertex_face};
    const std::span<const EdgeEdge> edge_edge{made.edge_edge};
    add_indexed(record, mesh, vertex_face, {});
    add_indexed(record, mesh, edge_edge, {});
    CollisionFreeStep step;
    record.add(collision_free_step(mesh, vertex_face.last(50), edge_edge.last(50), {}, step));
    record.add(step.step);

    for (const oracle::Pair& pair : few) {
        Point x0[4], x1[4];
        for (std::size_t p = 0; p < 4; ++p) x0[p] = pair[p], x1[p] = pair[4 + p];
        const PairToi found = scene.kind == oracle::Kind::vertex_face ? vertex_face_toi(x0, x1) : edge_edge_toi(x0, x1);
        record.add(found.toi);
        record.add(found.proven);
    }
    return record;
}

constexpr std::size_t per_family = amount(40);
constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

void expect_same_bits_in_any(std::size_t pairs_per_family)
{
    for (const auto kind : kinds) {
        const Scene scene{kind, pairs_per_family};
        const Record expected = all_answers(scene);
        for (const Environment& environment : environments) {
            bool same = false, stays = false;
            {
                const Inside inside{environment};
                const unsigned before = controls();
                same = all_answers(scene) == expected;
                stays = controls() == before;
            }
            EXPECT_TRUE(same) << kind_name(kind) << ", " << environment.name;
            EXPECT_TRUE(stays) << kind_name(kind) << ", " << environment.name;
        }
    }
}

TEST(FloatingPointEnvironment, SameBitsInAnyAndItStays) { expect_same_bits_in_any(per_family); }

/// Callers may look at what their own arithmetic raised: lanes divide by zero for nothing, and that is nobody's business.
TEST(FloatingPointEnvironment, ExceptionsRaisedAreTheCallersOwn)
{
    for (const auto kind : kinds) {
        const Scene scene{kind, per_family};
        std::vector<double> toi(scene.pairs.size());
        for (const int raised : {0, FE_INEXACT, FE_DIVBYZERO | FE_OVERFLOW}) {
            std::feclearexcept(FE_ALL_EXCEPT);
            std::feraiseexcept(raised);
            const int before = std::fetestexcept(FE_ALL_EXCEPT);  // an overflow is inexact, too
            const Status status = time_of_impact(pair_kind(kind), interleaved(scene.pairs), {}, toi);
            EXPECT_EQ(std::fetestexcept(FE_ALL_EXCEPT), before) << kind_name(kind) << ' ' << raised;
            EXPECT_TRUE(status.ok());
        }
    }
    std::feclearexcept(FE_ALL_EXCEPT);
}

/// For machines that are emulated.
TEST(FloatingPointEnvironment, SameBitsInAnyOfFewPairs) { expect_same_bits_in_any(2); }

/// Threads of oneTBB take over the environment in which their arena was made.
TEST(FloatingPointEnvironment, OfTheArenaDoesNotMatter)
{
    const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, 3};
    for (const auto kind : kinds) {
        const Scene scene{kind, per_family};
        const Record expected = all_answers(scene);
        for (const Environment& environment : environments) {
            tbb::task_arena arena{3};
            {
                const Inside inside{environment};
                arena.initialize();
            }
            bool same = false;
            arena.execute([&] { same = all_answers(scene) == expected; });
            EXPECT_TRUE(same) << kind_name(kind) << ", " << environment.name;
        }
    }
}

/// oneTBB gives a thread's tasks the environment in which the thread first used it. Where that is within a call of the library, tasks that
/// the program starts later must not get the library's.
TEST(FloatingPointEnvironment, TasksOfTheProgramHaveItsOwnThoughTheLibraryWasFirstToUseOneTbb)
{
    const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, 3};
    std::vector<oracle::Pair> pairs;  // more than take no other thread
    generate("uniform", oracle::Kind::vertex_face, 72, 3000, pairs);
    std::vector<double> toi(pairs.size());
    const std::vector<double> positions(3 * 5000);
    const auto ask_for_times = [&] { EXPECT_TRUE(time_of_impact(PairKind::vertex_face, interleaved(pairs), {}, toi).ok()); };
    const auto make_mesh = [&] {
        const PositionView points = PositionView::rows(positions.data(), positions.size() / 3);
        EXPECT_TRUE((MovingMesh{points, points, {}, {}}.status().ok()));
    };
    const auto ask_from_c = [&] {
        fastccd_options options;
        fastccd_options_init(&options, sizeof options);
        options.threads = 1;
        EXPECT_EQ(fastccd_pairs_time_of_impact(FASTCCD_VERTEX_FACE, pairs[0][0].data(), toi.size(), &options, toi.data(), nullptr, nullptr),
                  FASTCCD_OK);
    };
    const std::pair<const char*, std::function<void()>> calls[] = {{"times", ask_for_times}, {"mesh", make_mesh}, {"C, one thread", ask_from_c}};
    for (const Environment& environment : environments)
        for (const auto& [name, call] : calls) {
            std::atomic<int> others = 0;
            std::thread{[&, &call = call] {  // which has not used oneTBB yet
                const Inside inside{environment};
                const unsigned before = controls();
                call();
                tbb::parallel_for(0, 1000, [&](int) { others += controls() != before ? 1 : 0; });
            }}.join();
            EXPECT_EQ(others, 0) << environment.name << ", " << name;
        }
}

}  // namespace
}  // namespace fastccd::testing
