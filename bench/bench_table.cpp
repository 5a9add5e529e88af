#include "bench_table.hpp"

#include <algorithm>

#include <tbb/info.h>

#include <fastccd/isa.hpp>

#include "datasets.hpp"

namespace fastccd::bench {

namespace {

const char* name(Layout layout) noexcept
{
    switch (layout) {
        case Layout::blocked: return "blocked";
        case Layout::strided: return "strided";
        case Layout::interleaved: return "interleaved";
        case Layout::indexed: return "indexed";
    }
    return "unknown";
}

std::vector<int> thread_counts()
{
    const int all = tbb::info::default_concurrency();
    std::vector<int> counts;
    for (int threads = 1; threads < all; threads *= 2) counts.push_back(threads);
    counts.push_back(all);
    return counts;
}

/// The scene on which layouts are compared: the public one of many contacts where it is there.
const std::string& layout_scene()
{
    static const std::string scene = [] {
        const std::vector<std::string> names = available_datasets();
        return std::ranges::find(names, "cloth-ball") != names.end() ? "cloth-ball" : "generated";
    }();
    return scene;
}

}  // namespace

const char* name(PairKind kind) noexcept { return kind == PairKind::vertex_face ? "vertex_face" : "edge_edge"; }

std::string name(const Case& c)
{
    std::string text = std::string(name(c.kind)) + "/" + fastccd::name(c.isa) + "/" + c.data + "/" + name(c.layout) +
                       (c.scalar == PairView::Scalar::float64 ? "/double" : "/float");
    if (c.question == Question::contacts) text += "/contacts";
    if (c.question == Question::earliest) text += "/earliest";
    if (c.question == Question::separation) text += "/separation";
    if (c.question == Question::separation_earliest) text += "/separation_earliest";
    return text + "/threads:" + std::to_string(c.threads);
}

std::vector<Isa> available_isas()
{
    std::vector<Isa> isas;
    for (const Isa isa : {Isa::scalar, Isa::sse2, Isa::neon, Isa::avx2, Isa::avx512})
        if (isa_available(isa)) isas.push_back(isa);
    return isas;
}

std::vector<Case> all_cases()
{
    std::vector<Case> cases;
    const auto add = [&](PairKind kind, const std::string& data, Layout layout, PairView::Scalar scalar) {
        for (const Question question : {Question::dense, Question::contacts, Question::earliest, Question::separation,
                                        Question::separation_earliest})
            for (const Isa isa : available_isas())
                for (const int threads : thread_counts())
                    cases.push_back({kind, isa, data, layout, scalar, question, threads});
    };
    for (const PairKind kind : {PairKind::vertex_face, PairKind::edge_edge})
        for (const std::string& data : available_datasets()) {
            for (const Layout layout : {Layout::blocked, Layout::strided, Layout::interleaved})
                for (const auto scalar : {PairView::Scalar::float64, PairView::Scalar::float32})
                    add(kind, data, layout, scalar);
            if (is_scene(data)) add(kind, data, Layout::indexed, PairView::Scalar::float64);
        }
    return cases;
}

bool in_default_selection(const Case& c)
{
    if (c.data == "grids") return c.layout == Layout::indexed && c.question == Question::dense && c.threads == 1;
    const bool native = c.scalar == PairView::Scalar::float64 &&
                        (c.layout == Layout::blocked || c.layout == Layout::indexed);
    if (!native) {
        // (N,8,3) is what numpy has, floats what games have.
        const bool is_common = c.layout != Layout::strided;
        return (c.isa == best_isa() || is_common) && c.threads == 1 && c.question == Question::dense &&
               (c.data == "random" || c.data == layout_scene());
    }
    return c.isa == best_isa() ? c.threads == 1 || c.question != Question::contacts
                               : c.threads == 1 && c.question == Question::dense;
}

}  // namespace fastccd::bench
