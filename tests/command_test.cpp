// The command `fastccd` end to end: results and reports.
#include "command_test.hpp"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fastccd/isa.hpp>
#include <fastccd/pair_buffer.hpp>

#include "npy.hpp"

namespace fastccd::testing {
namespace {

using Json = nlohmann::json;

/// Coordinates of a vertex at height `from` that moves to height `to` above the middle of a resting
/// face in the plane z = 0.
std::vector<double> falling_vertex(double from, double to)
{
    const std::vector<double> face{-1, -1, 0, 2, -1, 0, -1, 2, 0};
    std::vector<double> pair{0, 0, from};
    pair.insert(pair.end(), face.begin(), face.end());
    pair.insert(pair.end(), {0, 0, to});
    pair.insert(pair.end(), face.begin(), face.end());
    return pair;
}

PairBuffer buffer(const std::vector<std::vector<double>>& pairs)
{
    PairBuffer result{pairs.size()};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        for (std::size_t c = 0; c < pair_coordinates; ++c) result.at(i, c) = pairs[i][c];
    }
    return result;
}

void write_npy(const std::string& path, const PairBuffer& pairs,
               PairView::Layout layout = PairView::Layout::interleaved)
{
    tools::NpyWriter writer{path, layout, pairs.size()};
    writer.append(pairs.view());
    writer.commit();
}

/// Rows of a rational CSV whose coordinates are whole numbers.
std::string csv_rows(const std::vector<double>& pair, const std::string& truth = "")
{
    std::string text;
    for (std::size_t point = 0; point < 8; ++point) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            text += std::to_string(static_cast<int>(pair[3 * point + axis])) + (axis < 2 ? ",1," : ",1");
        }
        text += truth + "\n";
    }
    return text;
}

/// What counts as the answer, without the time it took.
Json answer(Json report)
{
    for (const char* key : {"seconds", "pairs_per_second", "threads", "isa", "scalar_pairs", "reference", "files", "seed"}) {
        report.erase(key);
    }
    return report;
}

TEST(Command, ReportsContactsOfAFile)
{
    const ScratchDirectory directory;
    const std::string file = directory / "pairs.npy";
    write_npy(file, buffer({falling_vertex(1, 0.5), falling_vertex(1, -1), falling_vertex(1, -3)}));
    const Json report = run_json({"run", file, "--kind", "vf", "--parity", "--hits", directory / "hits.csv"});
    EXPECT_EQ(report["kind"], "vf");
    EXPECT_EQ(report["files"], Json{file});
    EXPECT_EQ(report["pairs"], 3);
    EXPECT_EQ(report["contacts"], 2);
    EXPECT_EQ(report["odd"], 2);
    EXPECT_EQ(report["even"], 0);
    EXPECT_EQ(report["invalid"], 0);
    EXPECT_EQ(report["invalid_pairs"], Json::array());
    EXPECT_EQ(report["earliest"]["pair"], 2);
    EXPECT_NEAR(report["earliest"]["toi"].get<double>(), 0.25, 1e-9);
    EXPECT_GE(report["seconds"].get<double>(), 0);
    EXPECT_GE(report["pairs_per_second"].get<double>(), 0);
    EXPECT_EQ(report["isa"], name(best_isa()));
    EXPECT_GE(report["threads"].get<int>(), 1);
    EXPECT_EQ(report["tolerance"], 1e-9);
    EXPECT_EQ(report["t_max"], 1.0);
    EXPECT_EQ(report["reference"], false);
    EXPECT_TRUE(report["scalar_pairs"].is_number_unsigned());
    EXPECT_FALSE(report.contains("missed"));

    std::istringstream hits{rows(directory / "hits.csv")};
    for (const auto& [pair, toi] : {std::pair{1, 0.5}, std::pair{2, 0.25}}) {
        std::string line;
        ASSERT_TRUE(std::getline(hits, line));
        EXPECT_EQ(line.substr(0, 2), std::to_string(pair) + ",");
        EXPECT_NEAR(std::stod(line.substr(2)), toi, 1e-9);
        EXPECT_LE(std::stod(line.substr(2)), toi);
    }

    EXPECT_EQ(run_json({"run", file, "--kind", "vf"})["odd"], nullptr);
    EXPECT_EQ(run_json({"run", file, "--kind", "vf", "--t-max", "0.375"})["contacts"], 1);
    const Outcome text = run({"run", file, "--kind", "vf", "--parity"});
    EXPECT_NE(text.out.find("contacts         2  (66.7 %)"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("in pair 2\n"), std::string::npos) << text.out;
    EXPECT_EQ(run({"run", file, "--kind", "vf", "--quiet"}).out, "");
}

TEST(Command, ZeroPairsAreFine)
{
    const ScratchDirectory directory;
    for (const Arguments& arguments : {Arguments{"run", directory.write("empty.csv", "")},
                                       Arguments{"random", "--pairs", "0"}}) {
        Arguments all = arguments;
        all.insert(all.end(), {"--kind", "ee", "--parity", "--hits", directory / "hits.csv"});
        const Json report = run_json(all);
        for (const char* key : {"pairs", "contacts", "odd", "even", "uncounted", "invalid", "pairs_per_second", "scalar_pairs"}) {
            EXPECT_EQ(report[key], 0) << key;
        }
        EXPECT_EQ(report["earliest"], nullptr);
        EXPECT_EQ(rows(directory / "hits.csv"), "");
    }
}

TEST(Command, InvalidPairsAreNamedAndTheOthersAnswered)
{
    const ScratchDirectory directory;
    std::vector<std::vector<double>> pairs;
    for (int i = 0; i < 40; ++i) {
        pairs.push_back(falling_vertex(1, -1));
        if (i % 3 == 1) pairs.back()[static_cast<std::size_t>(i % 24)] = std::numeric_limits<double>::quiet_NaN();
        if (i == 30) pairs.back()[5] = -std::numeric_limits<double>::infinity();
    }
    const std::string file = directory / "pairs.npy";
    write_npy(file, buffer(pairs), PairView::Layout::blocked);
    const std::string named = "NaN or infinity in pairs 1, 4, 7, 10, 13, 16, 19, 22, 25, 28 and 4 more, which --hits lists";

    const Outcome text = run({"run", file, "--kind", "vf", "--hits", directory / "hits.csv"});
    EXPECT_EQ(text.status, 0);
    EXPECT_NE(text.out.find("invalid          14  (" + named + ")\n"), std::string::npos) << text.out;
    std::istringstream hits{rows(directory / "hits.csv")};
    std::string line;
    for (int i = 0; i < 40; ++i) {
        ASSERT_TRUE(std::getline(hits, line));
        EXPECT_EQ(line.rfind(std::to_string(i) + ",", 0), 0U) << line;
        EXPECT_EQ(line.find("nan") != std::string::npos, i % 3 == 1 || i == 30) << line;
    }

    const Outcome json = run({"run", file, "--kind", "vf", "--json", "--parity"});
    EXPECT_EQ(Json::parse(json.out)["invalid"], 14);
    EXPECT_EQ(Json::parse(json.out)["contacts"], 26);
    EXPECT_EQ(Json::parse(json.out)["invalid_pairs"].size(), 10U);
    EXPECT_EQ(json.error, "fastccd: warning: " + named + "\n");
    EXPECT_EQ(Json::parse(run({"run", file, "--kind", "vf", "--reference", "--json"}).out)["scalar_pairs"], 26) << "invalid ones are not searched";
    const Outcome beside_rows = run({"run", file, "--kind", "vf", "--json", "--hits", "-"});
    EXPECT_EQ(Json::parse(beside_rows.error)["invalid"], 14) << "one object, and nothing else";
}

TEST(Command, ProofTellsWhatIsCertainAndExactSettlesTheRest)
{
    // Above the middle of the face; invalid; ends before the face; onto its corner.
    std::vector<std::vector<double>> pairs{falling_vertex(1, -1), falling_vertex(1, -1), falling_vertex(1, 0.5), falling_vertex(1, -1)};
    pairs[1][0] = std::numeric_limits<double>::quiet_NaN();
    for (const std::size_t point : {0u, 4u})
        for (const std::size_t axis : {0u, 1u}) pairs[3][3 * point + axis] = -1;
    const ScratchDirectory directory;
    const std::string file = directory / "pairs.npy", hits = directory / "hits.csv";
    write_npy(file, buffer(pairs));
    const auto lines_of = [&](const Arguments& more) {
        Arguments arguments{"run", file, "--kind", "vf", "--quiet", "--hits", hits, "--proof"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(run(arguments).status, 0);
        std::vector<std::string> lines;  // pair and proof, without the time
        std::istringstream text{read_text(hits)};
        for (std::string line; std::getline(text, line);) lines.push_back(line.substr(0, line.find(',') + 1) + line.substr(line.rfind(',') + 1));
        return lines;
    };
    EXPECT_EQ(lines_of({}), (std::vector<std::string>{"pair,proven", "0,1", "1,", "3,0"}));
#ifdef FASTCCD_HAVE_EXACT
    EXPECT_EQ(lines_of({"--exact"}), (std::vector<std::string>{"pair,proven", "0,1", "1,", "3,1"}));
#endif
    EXPECT_NE(run({"run", file, "--kind", "vf", "--proof"}).status, 0) << "without --hits there is no place for it";
}

TEST(Command, PairsOfSeveralFilesAreNamedWithTheirFile)
{
    const ScratchDirectory directory;
    const std::vector<double> apart = falling_vertex(1, 2);
    std::vector<double> invalid = apart;
    invalid[7] = std::numeric_limits<double>::quiet_NaN();
    const std::string first = directory / "first.npy", second = directory / "second.npy";
    write_npy(first, buffer({apart, invalid, apart}), PairView::Layout::interleaved);
    write_npy(second, buffer({invalid, falling_vertex(1, -1)}), PairView::Layout::interleaved);
    const Outcome text = run({"run", first, second, "--kind", "vf", "--range", "1:"});
    EXPECT_NE(text.out.find("NaN or infinity in pairs 1 (1 of " + first + "), 3 (0 of " + second + ")"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find(" in pair 4 (1 of " + second + ")\n"), std::string::npos) << text.out;
}

TEST(Command, ComparesWithTruth)
{
    const ScratchDirectory directory;
    const std::string contact = csv_rows(falling_vertex(1, -1), ",1");
    const std::string apart = csv_rows(falling_vertex(2, 1), ",0");
    const std::string missed = csv_rows(falling_vertex(2, 1), ",1");
    const std::string alarm = csv_rows(falling_vertex(1, -1), ",0");
    const std::string known = directory.write("known.csv", contact + apart + missed + alarm + contact);
    const std::string unknown = directory.write("unknown.csv", csv_rows(falling_vertex(1, -1)));
    const Json report = run_json({"run", unknown, known, "--kind", "vf"});
    EXPECT_EQ(report["pairs"], 6);
    EXPECT_EQ(report["contacts"], 4);
    EXPECT_EQ(report["truth_pairs"], 5);
    EXPECT_EQ(report["missed"], 1);
    EXPECT_EQ(report["false_alarms"], 1);
    EXPECT_EQ(run_json({"run", unknown, known, "--kind", "vf", "--range", "1:3"})["missed"], 0);
    EXPECT_FALSE(run_json({"run", known, "--kind", "vf", "--t-max", "0.5"}).contains("missed"));

    const Outcome text = run({"run", known, "--kind", "vf"});
    EXPECT_NE(text.out.find("missed           1 of 5 pairs with a known answer; is --kind right?\nfalse alarms     1\n"), std::string::npos)
        << text.out;
}

TEST(Command, RangesAddUpToTheWhole)
{
    const ScratchDirectory directory;
    const auto hits = [&](Arguments arguments) {
        arguments.insert(arguments.end(), {"--kind", "ee", "--quiet", "--hits", directory / "hits.csv"});
        EXPECT_EQ(run(arguments).status, 0);
        return rows(directory / "hits.csv");
    };
    // (B,24,8), (N,8,3) and (N,8,3) once more, pairs numbered on.
    const std::string a = directory / "a.npy";
    const std::string b = directory / "b.npy";
    hits({"random", "--pairs", "1000", "--seed", "3", "--save", a});
    hits({"random", "--pairs", "1003", "--seed", "4", "--save", b});
    const Arguments files{"run", a, b, b};
    const std::string whole = hits(files);
    EXPECT_GT(std::count(whole.begin(), whole.end(), '\n'), 100);

    std::string parts;
    std::size_t begin = 0;
    for (const std::size_t end : {5U, 16U, 17U, 17U, 500U, 1001U, 2500U, 3006U}) {
        Arguments part = files;
        part.insert(part.end(), {"--range", std::to_string(begin) + ":" + std::to_string(end)});
        parts += hits(part);
        begin = end;
    }
    EXPECT_EQ(parts, whole);
    EXPECT_EQ(hits({"run", a, b, b, "--range", ":"}), whole);
    EXPECT_EQ(hits({"run", a, b, b, "--range", "1001:"}), hits({"run", a, b, b, "--range", "1001:3006"}));
    EXPECT_EQ(hits({"run", a, b, b, "--range", ":1001"}), hits({"run", a, b, b, "--range", "0:1001"}));

    const Json part = run_json({"run", a, b, "--kind", "ee", "--range", "3:11"});
    EXPECT_EQ(part["pairs"], 8);
    EXPECT_EQ(part["range"], (Json{3, 11}));
}

TEST(Command, AnswersDoNotDependOnThreadsChunksLayoutOrIsa)
{
    const ScratchDirectory directory;
    constexpr std::size_t pairs = (std::size_t{1} << 18) + 8;  // a little beyond one chunk
    const Arguments random{"random", "--kind", "vf", "--pairs", std::to_string(pairs), "--seed", "5"};
    const auto with = [&](Arguments arguments, std::initializer_list<std::string> more) {
        arguments.insert(arguments.end(), more);
        arguments.insert(arguments.end(), {"--hits", directory / "hits.csv"});
        const Json report = run_json(arguments);
        return std::pair{answer(report), rows(directory / "hits.csv")};
    };
    const auto whole = with(random, {"--save", directory / "blocked.npy"});
    EXPECT_EQ(whole.first["pairs"], pairs);
    EXPECT_EQ(with(random, {"--threads", "1"}), whole);
    EXPECT_EQ(with(random, {"--threads", "2"}), whole);
    EXPECT_EQ(with(random, {"--isa", "scalar"}), whole);
    EXPECT_EQ(with({"run", directory / "blocked.npy", "--kind", "vf"}, {}), whole);
    const auto counted = with(random, {"--parity"});
    EXPECT_EQ(counted.second, whole.second);
    EXPECT_LE(counted.first["odd"].get<int>() + counted.first["even"].get<int>(), whole.first["contacts"].get<int>());

    // Records are another layout, and a start off any block moves all chunk boundaries.
    const tools::NpyPairs blocked{directory / "blocked.npy"};
    tools::NpyWriter records{directory / "records.npy", PairView::Layout::interleaved, pairs};
    records.append(blocked.view());
    records.commit();
    EXPECT_EQ(with({"run", directory / "records.npy", "--kind", "vf"}, {}), whole);
    for (const char* file : {"blocked.npy", "records.npy"}) {
        const auto tail = with({"run", directory / file, "--kind", "vf"}, {"--range", "3:"});
        ASSERT_FALSE(tail.second.empty());
        const std::string& all = whole.second;
        EXPECT_EQ(tail.second, all.substr(all.size() - tail.second.size()));
    }
}

TEST(Command, RandomPairsTakeBoundedMemory)
{
    // 768 MB of pairs.
    const Outcome outcome = run({"random", "--kind", "vf", "--pairs", "4000000", "--json"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_LT(outcome.peak_kilobytes, 512 * 1024);
}

}  // namespace
}  // namespace fastccd::testing
