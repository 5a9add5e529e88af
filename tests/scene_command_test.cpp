// `fastccd scene` end to end: results and reports.
#include "scene_command_test.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "test_data.hpp"

namespace fastccd::testing {
namespace {

using Json = nlohmann::json;
using Vertices = std::array<int, 4>;

struct Hit {
    int step;
    std::string kind;
    Vertices vertices;
    std::string toi;  ///< As it is written: 17 digits tell all bits.
};

std::vector<Hit> read_hits(const std::string& path)
{
    std::istringstream in{read_text(path)};
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "step,kind,v0,v1,v2,v3,toi");
    std::vector<Hit> hits;
    while (std::getline(in, line)) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream fields{line};
        auto& [step, kind, v, toi] = hits.emplace_back();
        fields >> step >> kind >> v[0] >> v[1] >> v[2] >> v[3] >> toi;
        EXPECT_TRUE(fields) << line;
    }
    return hits;
}

/// The time of impact of every hit of one step and kind, a line each.
std::string times(const std::vector<Hit>& hits, int step, const std::string& kind)
{
    std::string text;
    for (const Hit& hit : hits) {
        if (hit.step == step && hit.kind == kind) text += hit.toi + "\n";
    }
    return text;
}

/// The same of a run over saved pairs.
std::string times_of_run(const std::string& pairs, const std::string& kind)
{
    const ScratchDirectory directory;
    EXPECT_EQ(run({"run", pairs, "--kind", kind, "--quiet", "--hits", directory / "hits.csv"}).status, 0);
    std::istringstream in{rows(directory / "hits.csv")};
    std::string text;
    for (std::string line; std::getline(in, line);) text += line.substr(line.find(',') + 1) + "\n";
    return text;
}

TEST(SceneCommand, ReportsStepsAndTotals)
{
    const ScratchDirectory directory;
    const std::vector<std::string> frames{directory.write("a.obj", two_faces("1", "5")),
                                          directory.write("b.obj", two_faces("-1", "3")),
                                          directory.write("c.obj", two_faces("-3", "1"))};
    const std::string hits = directory / "hits.csv";
    EXPECT_EQ(run(scene(frames, {"--quiet", "--hits", hits, "--proof"})).status, 0);
    EXPECT_TRUE(read_text(hits).starts_with("step,kind,v0,v1,v2,v3,toi,proven\n0,vf,")) << read_text(hits);
    EXPECT_TRUE(read_text(hits).ends_with(",1\n")) << read_text(hits);
    const Json report = run_json(scene(frames, {"--hits", hits}));
    EXPECT_EQ(report["frames"], Json(frames));
    EXPECT_EQ(report["vertices"], 6);
    EXPECT_EQ(report["faces"], 2);
    EXPECT_EQ(report["edges"], 6);
    EXPECT_EQ(report["contacts"], 1);
    EXPECT_EQ(report["invalid"], 0);
    EXPECT_EQ(report["invalid_vertices"], Json::array());
    EXPECT_EQ(report["tolerance"], 1e-9);
    EXPECT_EQ(report["t_max"], 1.0);
    EXPECT_EQ(report["reference"], false);
    EXPECT_GE(report["threads"], 1);
    EXPECT_TRUE(report["isa"].is_string());
    EXPECT_GE(report["read_seconds"], 0.0);
    EXPECT_EQ(report["ee"]["earliest"], nullptr);
    ASSERT_EQ(report["steps"].size(), 2U);
    EXPECT_EQ(report["steps"][0]["step"], 0);
    EXPECT_EQ(report["steps"][0]["vf"]["contacts"], 1);
    EXPECT_EQ(report["steps"][0]["ee"]["contacts"], 0);
    EXPECT_EQ(report["steps"][1]["earliest"], nullptr);
    std::size_t candidates = 0;
    for (const Json& step : report["steps"]) {
        for (const char* kind : {"vf", "ee"}) {
            candidates += step[kind]["candidates"].get<std::size_t>();
            for (const char* key : {"broad_phase_seconds", "broad_phase_candidates_per_second", "narrow_phase_seconds",
                                    "narrow_phase_pairs_per_second", "scalar_pairs"}) {
                EXPECT_GE(step[kind][key], 0.0) << key;
                EXPECT_GE(step[key], 0.0) << key;
            }
        }
    }
    EXPECT_EQ(report["candidates"], candidates);
    EXPECT_EQ(report["earliest"]["kind"], "vf");
    EXPECT_EQ(report["earliest"]["step"], 0);
    EXPECT_EQ(report["earliest"]["vertices"], (Json{3, 0, 1, 2}));
    EXPECT_NEAR(report["earliest"]["toi"].get<double>(), 0.5, 1e-9);
    EXPECT_EQ(report["earliest"], report["vf"]["earliest"]);

    const std::vector<Hit> found = read_hits(hits);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].step, 0);
    EXPECT_EQ(found[0].kind, "vf");
    EXPECT_EQ(found[0].vertices, (Vertices{3, 0, 1, 2}));
    EXPECT_EQ(std::stod(found[0].toi), report["earliest"]["toi"].get<double>());

    EXPECT_EQ(run_json(scene(frames, {"--t-max", "0.49"}))["contacts"], 0);
    EXPECT_EQ(run_json(scene(frames, {"--t-max", "0.51"}))["contacts"], 1);
    const Outcome text = run(scene(frames));
    EXPECT_NE(text.out.find("all              1 contact in "), std::string::npos) << text.out;
    EXPECT_NE(text.out.find(" in step 0, vertex 3 and face 0 1 2\n"), std::string::npos) << text.out;
    EXPECT_EQ(text.error, "");
    EXPECT_EQ(run(scene(frames, {"--quiet"})).out, "");
    const Outcome rows_out = run(scene(frames, {"--json", "--hits", "-"}));
    EXPECT_EQ(rows_out.out, read_text(hits));
    EXPECT_EQ(Json::parse(rows_out.error)["contacts"], 1);
}

TEST(SceneCommand, SavedPairsGiveTheSameBits)
{
    const ScratchDirectory directory;
    const std::vector<std::string> frames = make_scene(directory, "40", "5");
    ASSERT_EQ(frames.size(), 5U);
    const std::string pairs = directory / "new/pairs";
    const std::string hits_path = directory / "new/hits.csv";  // in a folder that is made for the pairs
    const Json report = run_json(scene(frames, {"--hits", hits_path, "--save-pairs", pairs}));
    const std::vector<Hit> hits = read_hits(hits_path);
    EXPECT_EQ(report["contacts"], hits.size());
    EXPECT_GT(report["vf"]["contacts"], 100);
    EXPECT_GT(report["ee"]["contacts"], 100);
    EXPECT_EQ(files_in(pairs).size(), 8U);
    EXPECT_TRUE(std::is_sorted(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
        return std::pair(a.step, a.kind == "ee") < std::pair(b.step, b.kind == "ee");
    }));
    for (int step = 0; step < 4; ++step) {
        for (const std::string kind : {"vf", "ee"}) {
            const std::string file = pairs + "/step_00" + std::to_string(step) + "_" + kind + ".npy";
            const std::string dense = times_of_run(file, kind);
            EXPECT_EQ(times(hits, step, kind), dense) << file;
            const Json run_report = run_json({"run", file, "--kind", kind});
            const Json& sums = report["steps"][static_cast<std::size_t>(step)][kind];
            EXPECT_EQ(run_report["pairs"], sums["candidates"]);
            EXPECT_EQ(run_report["earliest"]["pair"], sums["earliest"]["candidate"]);
            EXPECT_EQ(run_report["earliest"]["toi"], sums["earliest"]["toi"]);
        }
    }
    // A shorter scene's pairs would be mixed up with what is there.
    const Outcome shorter = run(scene({frames[0], frames[1]}, {"--save-pairs", pairs}));
    EXPECT_EQ(shorter.status, 1);
    EXPECT_NE(shorter.error.find("pairs of another scene"), std::string::npos) << shorter.error;
    EXPECT_EQ(run(scene(frames, {"--save-pairs", pairs, "--t-max", "0.5"})).status, 0);
}

TEST(SceneCommand, HitsDoNotDependOnThreadsIsaOrPath)
{
    const ScratchDirectory directory;
    const std::vector<std::string> frames = make_scene(directory, "60", "3");
    const std::string hits = directory / "hits.csv";
    const auto with = [&](const Arguments& more) {
        Arguments arguments = scene(frames, more);
        arguments.insert(arguments.end(), {"--quiet", "--hits", hits});
        EXPECT_EQ(run(arguments).status, 0);
        return read_text(hits);
    };
    const std::string expected = with({});
    EXPECT_GT(std::count(expected.begin(), expected.end(), '\n'), 1000);
    for (const Arguments& more : {Arguments{"--threads", "1"}, Arguments{"--threads", "2"}, Arguments{"--threads", "5"},
                                  Arguments{"--isa", "scalar"}, Arguments{"--reference"}}) {
        EXPECT_TRUE(with(more) == expected) << more[0];
    }
}

/// A rod falls through a face: its ends pass beside the face, and only its line meets the edges.
TEST(SceneCommand, LinesAreEdgesToo)
{
    const ScratchDirectory directory;
    const auto frame = [](const std::string& height, const std::string& rod) {
        return "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv -5 0 " + height + "\nv 5 0 " + height + "\nf 1 2 3\n" + rod;
    };
    const std::vector<std::string> frames{directory.write("a.obj", frame("1", "l 4 5\n")), directory.write("b.obj", frame("-1", "l 4 5\n"))};
    const Json report = Json::parse(run(scene(frames, {"--json"})).out);
    EXPECT_EQ(report["faces"], 1);
    EXPECT_EQ(report["edges"], 4);
    EXPECT_EQ(report["contacts"], 2);
    const std::vector<std::string> without{directory.write("c.obj", frame("1", "")), directory.write("d.obj", frame("-1", ""))};
    EXPECT_EQ(Json::parse(run(scene(without, {"--json"})).out)["contacts"], 0);
    // Two rods, no face.
    const auto rods = [](const std::string& height) { return "v -1 0 0\nv 1 0 0\nv 0 -1 " + height + "\nv 0 1 " + height + "\nl 1 2\nl 3 4\n"; };
    const Json crossed = Json::parse(run(scene({directory.write("e.obj", rods("1")), directory.write("f.obj", rods("-3"))}, {"--json"})).out);
    EXPECT_EQ(crossed["contacts"], 1);
    // Of other vertices in the second frame.
    const Outcome other = run(scene({frames[0], directory.write("g.obj", frame("-1", "l 4 3\n"))}));
    EXPECT_EQ(other.status, 1);
    EXPECT_NE(other.error.find("has the vertices 3 2 in line 0, the first frame, " + frames[0] + ", has 3 4; "), std::string::npos) << other.error;
}

TEST(SceneCommand, VerticesThatAreNotFiniteAreNamedAndTheOthersAnswered)
{
    const ScratchDirectory directory;
    const auto with_third_face = [](const std::string& tip, const std::string& top, const std::string& x) {
        return two_faces(tip, top) + "v " + x + " 0 0\nv 1 0 0\nv " + x + " 1 0\nf 7 8 9\n";
    };
    const std::vector<std::string> frames{directory.write("a.obj", with_third_face("1", "5", "0")),
                                          directory.write("b.obj", with_third_face("-1", "3", "nan")),
                                          directory.write("c.obj", with_third_face("-3", "1", "-inf"))};
    const Outcome outcome = run(scene(frames, {"--json"}));
    EXPECT_EQ(outcome.status, 0);
    const Json report = Json::parse(outcome.out);
    EXPECT_EQ(report["invalid"], 2);
    EXPECT_EQ(report["steps"][1]["invalid"], 2);
    EXPECT_EQ(report["invalid_vertices"][2], (Json{{"step", 1}, {"vertex", 6}}));
    EXPECT_GE(report["contacts"], 1);
    EXPECT_EQ(outcome.error, "fastccd: warning: 2 vertices with NaN or infinity, left out with all that they are part of: "
                             "step 0: 6, 8; step 1: 6, 8\n");
    for (const Arguments& more : {Arguments{}, Arguments{"--quiet"}}) {
        EXPECT_EQ(run(scene(frames, more)).error, outcome.error);
    }
    // A file that is standard error too keeps the rows and what follows them.
    const std::string rows = run(scene(frames, {"--quiet", "--hits", "-"})).out;
    EXPECT_EQ(run(scene(frames, {"--quiet", "--hits", "/dev/stderr"})).error, rows + outcome.error);
    EXPECT_EQ(Json::parse(run(scene(frames, {"--json", "--hits", "-"})).error)["invalid"], 2) << "one object, and nothing else";
    std::vector<std::string> many(9, frames[1]);
    EXPECT_NE(run(scene(many)).error.find(" 2 vertices"), std::string::npos);
    EXPECT_NE(run(scene(many)).error.find("; step 4: 6, 8 and more, which --json lists\n"), std::string::npos) << run(scene(many)).error;
    const Json all = Json::parse(run(scene(many, {"--json"})).out)["invalid_vertices"];
    EXPECT_EQ(all.size(), 16);
    EXPECT_EQ(all[15], (Json{{"step", 7}, {"vertex", 8}}));
}

// ---- Public scenes ----------------------------------------------------------------------------------------

/// Rows of an int32 array of shape (n, 4).
std::vector<Vertices> read_contacts(const std::filesystem::path& file)
{
    const std::string bytes = read_text(file.string());
    EXPECT_NE(bytes.find("'<i4'"), std::string::npos) << file;
    const std::size_t begin = 10 + static_cast<unsigned char>(bytes.at(8)) + 256 * static_cast<unsigned char>(bytes.at(9));
    std::vector<Vertices> contacts((bytes.size() - begin) / sizeof(Vertices));
    std::memcpy(contacts.data(), bytes.data() + begin, contacts.size() * sizeof(Vertices));
    return contacts;
}

/// Which of an edge-edge pair's edges comes first is nobody's business.
std::multiset<Vertices> as_set(const std::vector<Vertices>& contacts, bool edges)
{
    std::multiset<Vertices> set;
    for (const Vertices& v : contacts) {
        set.insert(edges && std::tie(v[2], v[3]) < std::tie(v[0], v[1]) ? Vertices{v[2], v[3], v[0], v[1]} : v);
    }
    return set;
}

TEST(SceneCommand, ContactsOfPublicScenesAreThePublishedOnes)
{
    const auto data = data_directory();
    if (!data || !std::filesystem::exists(*data / "scenes")) GTEST_SKIP() << no_data_message;
    struct Scene {
        const char* folder;
        const char* frames[2];
        std::size_t candidates[2];
    };
    for (const auto& [folder, frames, candidates] :
         {Scene{"cloth-ball", {"cloth_ball92.ply", "cloth_ball93.ply"}, {1'655'541, 5'197'332}},
          Scene{"cloth-funnel", {"227.ply", "228.ply"}, {7'319, 33'770}},
          Scene{"n-body-simulation", {"balls16_18.ply", "balls16_19.ply"}, {9'396'388, 22'366'873}}}) {
        if (too_large_for_sanitizers(candidates[1])) continue;
        const std::filesystem::path path = *data / "scenes" / folder;
        const ScratchDirectory directory;
        const std::string hits_path = directory / "hits.csv";
        const Outcome outcome = run({"scene", path / frames[0], path / frames[1], "--json", "--hits", hits_path});
        ASSERT_EQ(outcome.status, 0) << outcome.error;
        const Json report = Json::parse(outcome.out);
        // Of n-body's candidates, 192 bytes each would be 6 GB. An address sanitizer keeps freed memory for a while.
        EXPECT_LT(outcome.peak_kilobytes, (sanitized ? 1024 : 256) * 1024) << folder;

        const std::vector<Hit> hits = read_hits(hits_path);
        for (const bool edges : {false, true}) {
            const std::string kind = edges ? "ee" : "vf";
            EXPECT_EQ(report[kind]["candidates"], candidates[edges ? 1 : 0]) << folder << kind;
            std::vector<Vertices> found;
            double earliest = 1;
            for (const Hit& hit : hits) {
                if (hit.kind != kind) continue;
                found.push_back(hit.vertices);
                earliest = std::min(earliest, std::stod(hit.toi));
            }
            EXPECT_TRUE(as_set(found, edges) == as_set(read_contacts(path / ("contacts_" + kind + ".npy")), edges))
                << folder << kind;
            EXPECT_EQ(report[kind]["earliest"]["toi"], earliest) << folder << kind;
        }
    }
}

}  // namespace
}  // namespace fastccd::testing
