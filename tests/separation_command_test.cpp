// `fastccd --min-separation` end to end.
#include "scene_command_test.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace fastccd::testing {
namespace {

using Json = nlohmann::json;

/// Whole numbers, as a rational CSV: a vertex that moves from one height to another over the middle of a resting face.
std::string falling_vertex(int from, int to)
{
    std::string text;
    for (const int height : {from, to}) {
        text += "0,1,0,1," + std::to_string(height) + ",1\n";
        text += "-1,1,-1,1,0,1\n2,1,-1,1,0,1\n-1,1,2,1,0,1\n";
    }
    return text;
}

TEST(SeparationCommand, RunTellsWhenPairsComeAsClose)
{
    const ScratchDirectory directory;
    const std::string pairs = directory.write("pairs.csv", falling_vertex(3, 1) + falling_vertex(9, 3) + falling_vertex(1, 2) + falling_vertex(4, -2));
    const std::string hits = directory / "hits.csv";
    const Json report = run_json({"run", pairs, "--kind", "vf", "--min-separation", "2", "--hits", hits});
    EXPECT_EQ(report["contacts"], 3);
    EXPECT_EQ(report["at_start"], 1);
    EXPECT_EQ(report["proven"], 3);
    EXPECT_EQ(report["minimum_separation"], 2.0);
    EXPECT_EQ(report["distance_tolerance"], 1e-6);
    std::istringstream rows{read_text(hits)};
    std::string line;
    std::getline(rows, line);
    const double expected[][2] = {{0, 0.5}, {2, 0.0}, {3, 1.0 / 3.0}};
    for (const auto& [pair, toi] : expected) {
        ASSERT_TRUE(std::getline(rows, line));
        EXPECT_EQ(std::stoi(line), pair) << line;
        const double found = std::stod(line.substr(line.find(',') + 1));
        EXPECT_LE(found, toi);
        EXPECT_NEAR(found, toi, 1e-5);
    }
    EXPECT_FALSE(std::getline(rows, line));
    EXPECT_EQ(run_json({"run", pairs, "--kind", "vf", "--min-separation", "0.5"})["contacts"], 1);
    EXPECT_EQ(run_json({"run", pairs, "--kind", "vf", "--min-separation", "100"})["at_start"], 4);
}

TEST(SeparationCommand, RandomIsTheSameOnEveryWay)
{
    const Arguments asked{"random", "--kind", "ee", "--pairs", "20000", "--min-separation", "0.01", "--distance-tolerance", "1e-3"};
    const auto with = [&](const Arguments& more) {
        Arguments arguments = asked;
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_json(arguments);
    };
    const Json report = with({}), reference = with({"--reference"}), one_thread = with({"--threads", "1", "--isa", "scalar"});
    EXPECT_GT(report["at_start"], 10);
    for (const char* key : {"contacts", "proven", "at_start", "earliest"}) {
        EXPECT_EQ(report[key], reference[key]) << key;
        EXPECT_EQ(report[key], one_thread[key]) << key;
    }
    EXPECT_EQ(reference["scalar_pairs"], 20000);
}

TEST(SeparationCommand, TextSaysHowManyAreAsCloseAtTheStart)
{
    const std::string text = run({"random", "--kind", "vf", "--pairs", "1000", "--min-separation", "0.5"}).out;
    EXPECT_NE(text.find("minimum separation 0.5"), std::string::npos) << text;
    EXPECT_NE(text.find("  at the start   "), std::string::npos) << text;
    EXPECT_EQ(run({"random", "--kind", "vf", "--pairs", "1000"}).out.find("at the start"), std::string::npos);
}

/// The boxes of the two never overlap: the broad phase has to look as far as the separation.
TEST(SeparationCommand, SceneFindsWhatNeverOverlaps)
{
    const ScratchDirectory directory;
    const std::vector<std::string> frames{directory.write("a.obj", two_faces("3", "5")), directory.write("b.obj", two_faces("1", "3"))};
    EXPECT_EQ(run_json(scene(frames))["candidates"], 0);
    EXPECT_EQ(run_json(scene(frames, {"--min-separation", "0.99"}))["contacts"], 0);
    const Json report = run_json(scene(frames, {"--min-separation", "1.5"}));
    EXPECT_GE(report["vf"]["contacts"], 1);
    EXPECT_EQ(report["at_start"], 0);
    EXPECT_LE(report["earliest"]["toi"], 0.75);
    EXPECT_NEAR(report["earliest"]["toi"], 0.75, 1e-5);
    const Json exactly = run_json(scene(frames, {"--min-separation", "1"}));
    EXPECT_GE(exactly["vf"]["contacts"], 1);
    EXPECT_NEAR(exactly["earliest"]["toi"], 1.0, 1e-5);
    EXPECT_GE(run_json(scene(frames, {"--min-separation", "1e308"}))["at_start"], 3);
}

TEST(SeparationCommand, RefusesWhatMakesNoSense)
{
    for (const Arguments& bad : {Arguments{"--min-separation", "-1"}, {"--min-separation", "nan"}, {"--min-separation", "inf"},
                                 {"--min-separation", "1", "--exact"}, {"--min-separation", "1", "--parity"},
                                 {"--distance-tolerance", "0.1"}, {"--min-separation", "1", "--distance-tolerance", "-1"}}) {
        Arguments arguments{"random", "--kind", "vf", "--pairs", "10"};
        arguments.insert(arguments.end(), bad.begin(), bad.end());
        EXPECT_NE(run(arguments).status, 0) << bad[0] << ' ' << bad[1];
    }
}

}  // namespace
}  // namespace fastccd::testing
