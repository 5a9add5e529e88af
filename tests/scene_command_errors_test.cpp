// `fastccd scene` and `fastccd make-scene` end to end: bad input, no half-written files, signals.
#include "scene_command_test.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <sys/stat.h>

namespace fastccd::testing {
namespace {

namespace fs = std::filesystem;

bool is_one_line(const Outcome& outcome)
{
    return outcome.error.starts_with("fastccd: ") && std::count(outcome.error.begin(), outcome.error.end(), '\n') == 1;
}

TEST(SceneCommandErrors, BadFramesAreNamedAndLeaveNothing)
{
    const std::string good = two_faces("1", "5");
    const struct {
        const char* name;
        std::string contents;
        const char* message;
    } table[] = {
        {"vertices.obj", good + "v 1 1 1\n", "has 7 vertices, the first frame, "},
        {"faces.obj", good + "f 1 2 4\n", "has 3 faces, the first frame, "},
        {"lines.obj", good + "l 1 2\n", "has 1 lines, the first frame, "},
        {"other.obj", good.substr(0, good.size() - 6) + "4 6 5\n", "has the vertices 3 5 4 in face 1, the first frame, "},
        {"polygon.obj", good + "f 1 2 4 3\n", "line 9"},
        {"outside.obj", good + "f 1 2 7\n", "line 9"},
        {"empty.obj", "", "empty"},
        {"pointless.obj", "# nothing\n", "empty (0 vertices, 0 faces)"},
        {"cloud.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "empty (3 vertices, 0 faces)"},
        {"words.obj", "v a b c\n", "line 1"},
        {"mesh.txt", good, "not a mesh that is read here"},
        {"short.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "header"},
    };
    for (const auto& [name, contents, message] : table) {
        const ScratchDirectory directory;
        const std::string first = directory.write("good.obj", good);
        const std::string path = directory.write(name, contents);
        // In the last place a step has been answered and saved before.
        for (const std::vector<std::string>& frames : {std::vector{first, first, path}, std::vector{first, path, first}}) {
            const Outcome outcome = run(scene(frames, {"--hits", directory / "hits.csv", "--save-pairs", directory / "p/q"}));
            EXPECT_EQ(outcome.status, 1) << name;
            EXPECT_EQ(outcome.out, "") << name;
            EXPECT_TRUE(is_one_line(outcome)) << outcome.error;
            EXPECT_EQ(outcome.error.rfind("fastccd: " + path + ": ", 0), 0U) << outcome.error;
            EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
            EXPECT_EQ(directory.names().size(), 2U) << name;
        }
    }
}

TEST(SceneCommandErrors, FramesThatAreNotThereAreFoundBeforeAnyWork)
{
    const ScratchDirectory directory;
    const std::string good = directory.write("good.obj", two_faces("1", "5"));
    const std::string bad = directory.write("bad.obj", "v a b c\n");
    const Outcome missing = run(scene({good, bad, directory / "none.ply"}));
    EXPECT_EQ(missing.status, 1);
    EXPECT_EQ(missing.error, "fastccd: " + directory / "none.ply" + ": cannot be opened: No such file or directory\n");
    const Outcome folder = run(scene({good, directory / "."}));
    EXPECT_EQ(folder.status, 1);
    EXPECT_NE(folder.error.find("is a directory; name its frames"), std::string::npos) << folder.error;
}

TEST(SceneCommandErrors, OutputThatCannotBeWrittenIsAnError)
{
    const ScratchDirectory directory;
    const std::string a = directory.write("a.obj", two_faces("1", "5"));
    const std::string b = directory.write("b.obj", two_faces("-1", "3"));
    const ScratchDirectory pipes;
    ASSERT_EQ(::mkfifo((pipes / "step_000_vf.npy").c_str(), 0600), 0);
    const int reader = ::open((pipes / "step_000_vf.npy").c_str(), O_RDWR);  // so that nobody waits
    const struct {
        Arguments more;
        int status;
        std::string message;
    } table[] = {
        {{"--hits", directory / "none/hits.csv"}, 1, "none/hits.csv: cannot be created: No such file"},
        {{"--hits", "/dev/full", "--save-pairs", directory / "p"}, 1, "No space left"},
        {{"--hits", b}, 2, "--hits: " + b + " is an input"},
        {{"--save-pairs", a}, 1, "a.obj: is no folder"},
        {{"--save-pairs", a + "/p", "--hits", directory / "hits.csv"}, 1, "a.obj/p: cannot be created: Not a directory"},
        {{"--save-pairs", directory / "p", "--hits", directory / "p/none/hits.csv"}, 1, "hits.csv: cannot be created: No such file"},
        {{"--save-pairs", "-"}, 2, "--save-pairs: is to be a folder"},
        {{"--save-pairs", "--json"}, 2, "--save-pairs: '--json' begins like an option"},
        {{"--save-pairs", pipes / ""}, 1, "step_000_vf.npy: is no regular file"},
    };
    for (const auto& [more, status, message] : table) {
        const Outcome outcome = run(scene({a, b}, more));
        EXPECT_EQ(outcome.status, status) << message;
        EXPECT_EQ(outcome.out, "") << message;
        EXPECT_TRUE(is_one_line(outcome)) << outcome.error;
        EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
        EXPECT_EQ(directory.names().size(), 2U) << message;
    }
    ::close(reader);
}

TEST(SceneCommandErrors, SavedPairsReplaceNeitherAFrameNorTheHits)
{
    const ScratchDirectory directory;
    const std::string mesh = two_faces("1", "5");
    const std::string named_like_pairs = directory.write("step_000_ee.npy", mesh);  // what a mesh is, is told by its content
    const std::string b = directory.write("b.obj", two_faces("-1", "3"));
    const Outcome onto_frame = run(scene({named_like_pairs, b}, {"--save-pairs", directory / "."}));
    EXPECT_EQ(onto_frame.status, 2);
    EXPECT_NE(onto_frame.error.find("--save-pairs: " + directory / "./step_000_ee.npy is an input"), std::string::npos) << onto_frame.error;

    const ScratchDirectory pairs;
    fs::create_symlink(b, pairs / "step_000_vf.npy");
    const Outcome through_link = run(scene({named_like_pairs, b}, {"--save-pairs", pairs / ""}));
    EXPECT_EQ(through_link.status, 2);
    EXPECT_NE(through_link.error.find("step_000_vf.npy is an input"), std::string::npos) << through_link.error;
    EXPECT_EQ(read_text(named_like_pairs), mesh);
    EXPECT_EQ(directory.names().size(), 2U);

    // The hits are to be created where one of the links leads to.
    fs::remove(pairs / "step_000_vf.npy");
    fs::create_symlink(directory / "hits.csv", pairs / "step_000_vf.npy");
    const Outcome onto_hits = run(scene({named_like_pairs, b}, {"--save-pairs", pairs / "", "--hits", directory / "hits.csv"}));
    EXPECT_EQ(onto_hits.status, 2);
    EXPECT_NE(onto_hits.error.find("hits.csv is written already"), std::string::npos) << onto_hits.error;
    EXPECT_EQ(directory.names().size(), 2U);
}

TEST(SceneCommandErrors, UsageErrorsAreOneLineAndStatusTwo)
{
    const ScratchDirectory directory;
    const std::string frame = directory.write("a.obj", two_faces("1", "5"));
    const std::string out = directory / "out";
    const struct {
        Arguments arguments;
        const char* message;
    } table[] = {
        {{"scene"}, "FRAME is required"},
        {{"scene", frame}, "name two or more"},
        {{"scene", "", frame}, "FRAME: the value is empty"},
        {{"scene", frame, frame, "--kind", "vf"}, "--kind"},
        {{"scene", frame, frame, "--t-max", "2"}, "--t-max: '2' is not"},
        {{"scene", frame, frame, "--tolerance", "-1"}, "--tolerance: '-1' is not"},
        {{"scene", frame, frame, "--isa", "mmx"}, "there is no instruction set 'mmx'"},
        {{"make-scene"}, "SCENE is required"},
        {{"make-scene", "cloth-ball"}, "OUT is required"},
        {{"make-scene", "cloth-ball", ""}, "OUT: the value is empty"},
        {{"make-scene", "waterfall", out}, "there is no scene 'waterfall'; cloth-ball is one"},
        {{"make-scene", "cloth-ball", out, "--size", "1"}, "--size: '1' is not a whole number from 2 to 4096"},
        {{"make-scene", "cloth-ball", out, "--frames", "1"}, "--frames: '1' is not a whole number from 2"},
    };
    for (const auto& [arguments, message] : table) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2) << message;
        EXPECT_EQ(outcome.out, "") << message;
        EXPECT_TRUE(is_one_line(outcome)) << outcome.error;
        EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
    }
    EXPECT_EQ(directory.names().size(), 1U);
}

TEST(MakeSceneCommand, SaysWhatItWroteAndKeepsOtherMeshes)
{
    const ScratchDirectory directory;
    const std::string out = directory / "a cloth";
    const auto make = [&](const std::string& size, const std::string& frames) {
        return run({"make-scene", "cloth-ball", "--size", size, "--frames", frames, out});
    };
    const Outcome first = make("8", "3");
    EXPECT_EQ(first.status, 0) << first.error;
    EXPECT_EQ(first.out, "wrote 3 frames, " + out + "/frame_000.ply to " + out + "/frame_002.ply: 82 vertices, 130 faces each\n" +
                             "now:  fastccd scene '" + out + "'/frame_*.ply\n");
    const std::string bytes = read_text(out + "/frame_001.ply");
    EXPECT_EQ(make("8", "3").status, 0) << "nothing changes";
    for (const Outcome& refused : {make("9", "3"), make("8", "2"), make("8", "4")}) {
        EXPECT_EQ(refused.status, 1);
        EXPECT_TRUE(is_one_line(refused)) << refused.error;
        EXPECT_NE(refused.error.find("name an empty "), std::string::npos) << refused.error;
    }
    EXPECT_EQ(files_in(out).size(), 3U);
    EXPECT_EQ(read_text(out + "/frame_001.ply"), bytes);

    for (const char* name : {"SCAN.OBJ", "scan.obj"}) {
        const ScratchDirectory with_a_mesh;
        with_a_mesh.write(name, two_faces("1", "5"));
        EXPECT_EQ(run({"make-scene", "cloth-ball", with_a_mesh / ""}).status, 1);
        EXPECT_EQ(with_a_mesh.names().size(), 1U);
    }
    const ScratchDirectory other;
    other.write("scan.obj", two_faces("1", "5"));
    const Outcome in_a_file = run({"make-scene", "cloth-ball", other / "scan.obj"});
    EXPECT_EQ(in_a_file.status, 1);
    EXPECT_TRUE(is_one_line(in_a_file)) << in_a_file.error;
}

/// Pairs for `fastccd run` may be named by mistake, and a device never ends.
TEST(SceneCommandErrors, WhatIsNoMeshIsNotReadWhole)
{
    const ScratchDirectory directory;
    const std::string frame = directory.write("a.obj", two_faces("1", "5")), large = directory.write("large.npy", "no mesh");
    fs::resize_file(large, 1'000'000'000);
    const long usual = run(scene({frame, frame})).peak_kilobytes;
    for (const std::string& path : {large, std::string{"/dev/zero"}}) {
        const Outcome outcome = run(scene({path, frame}));
        EXPECT_EQ(outcome.status, 1);
        EXPECT_EQ(outcome.error.rfind("fastccd: " + path + ": not a mesh that is read here", 0), 0U) << outcome.error;
        EXPECT_LT(outcome.peak_kilobytes, usual + 100'000);
    }
}

TEST(SceneCommandErrors, AMeshThatDoesNotFitIntoMemoryIsNamed)
{
    if (sanitized) GTEST_SKIP() << "NOT TESTED: a sanitizer needs more memory than the limit; a mesh too large was not refused under one here";
    const ScratchDirectory directory;
    const std::string large = directory.write("large.obj", "# a comment of zeros");
    fs::resize_file(large, 2'000'000'000);
    const Outcome outcome = run_limited(RLIMIT_AS, 1'000'000'000, scene({large, large}, {"--threads", "2"}));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.error, "fastccd: " + large + ": there is not enough memory for this mesh\n");
}

/// How the command ends when `signal` comes once there are so many `files` in `folder`.
int status_after_signal(const Arguments& arguments, int signal, const std::string& folder, std::size_t files)
{
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("cannot fork");
    if (child == 0) become_command(arguments);
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds{60};
    int status = 0;
    bool ended = false;
    while (!ended && std::chrono::steady_clock::now() < give_up) {
        std::error_code not_yet;
        const auto found = std::distance(fs::directory_iterator{folder, not_yet}, fs::directory_iterator{});
        if (static_cast<std::size_t>(found) >= files) break;
        std::this_thread::sleep_for(std::chrono::milliseconds{2});
        ended = ::waitpid(child, &status, WNOHANG) == child;
    }
    if (!ended) {
        ::kill(child, signal);
        ::waitpid(child, &status, 0);
    }
    return exit_status(status);
}

TEST(SceneCommandErrors, SignalsLeaveNothing)
{
    const ScratchDirectory directory;
    const std::vector<std::string> frames = make_scene(directory, "100", "60");
    for (const int signal : {SIGINT, SIGTERM}) {
        const std::string pairs = directory / "pairs";
        // The files of the first two steps are there, under names of their own, when the signal comes.
        const int status = status_after_signal(
            scene(frames, {"--quiet", "--hits", directory / "hits.csv", "--save-pairs", pairs}), signal, pairs, 4);
        EXPECT_EQ(status, 1000 + signal);
        EXPECT_EQ(directory.names(), std::vector<std::string>{"cloth"});

        const std::string cloth = directory / "more";
        EXPECT_EQ(status_after_signal({"make-scene", "cloth-ball", "--size", "100", "--frames", "100000", "--quiet", cloth},
                                      signal, cloth, 2),
                  1000 + signal);
        EXPECT_FALSE(fs::exists(cloth));
    }
}

/// The same command may be given twice; the second time it has nothing to take away.
TEST(MakeSceneCommand, LeavesFramesOfBeforeWhenASignalEndsIt)
{
    const ScratchDirectory directory;
    const std::string cloth = directory / "cloth";
    const Arguments make{"make-scene", "cloth-ball", "--size", "60", "--frames", "200", "--quiet", cloth};
    ASSERT_EQ(run(make).status, 0);
    const std::vector<std::string> before = files_in(cloth);
    ASSERT_EQ(before.size(), 200U);
    EXPECT_EQ(status_after_signal(make, SIGINT, cloth, before.size() + 1), 1000 + SIGINT);
    EXPECT_EQ(files_in(cloth), before);
}

TEST(MakeSceneCommand, LeavesNoFolderWhereItCannotWrite)
{
    const ScratchDirectory directory;
    const std::string deep = directory / "new/folder";
    const Outcome refused = run_limited(RLIMIT_FSIZE, 1000, {"make-scene", "cloth-ball", "--frames", "2", deep});
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.error.find("File too large"), std::string::npos) << refused.error;
    EXPECT_TRUE(directory.names().empty());
}

/// Whether a process has a handler for the signal, as Linux tells, or has ended.
bool catches(pid_t process, int signal)
{
    const std::string status = read_text("/proc/" + std::to_string(process) + "/status");
    const std::size_t at = status.find("SigCgt:");
    if (at == std::string::npos || status.find("State:\tZ") != std::string::npos) return true;
    return (std::stoull(status.substr(at + 7), nullptr, 16) >> (signal - 1) & 1) != 0;
}

/// A pipe that nobody opens at its other end waits, and ends with the signal, not with an error.
TEST(SceneCommandErrors, SignalsEndItWhileAPipeWaits)
{
    const ScratchDirectory directory;
    const std::string pipe = directory / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const std::string frame = directory.write("a.obj", two_faces("1", "5"));
    const auto status_while_waiting = [&](const Arguments& arguments) {
        const pid_t child = ::fork();
        if (child == 0) become_command(arguments);
        while (!catches(child, SIGTERM)) std::this_thread::sleep_for(std::chrono::milliseconds{2});
        std::this_thread::sleep_for(std::chrono::milliseconds{300});  // it waits for the pipe by then; if not yet, it ends the same way
        ::kill(child, SIGTERM);
        int status = 0;
        ::waitpid(child, &status, 0);
        return exit_status(status);
    };
    EXPECT_EQ(status_while_waiting(scene({pipe, frame})), 1000 + SIGTERM) << "to be opened for reading";
    EXPECT_EQ(status_while_waiting(scene({frame, frame}, {"--hits", pipe})), 1000 + SIGTERM) << "to be opened for writing";
    const int both_ends = ::open(pipe.c_str(), O_RDWR);
    EXPECT_EQ(status_while_waiting(scene({pipe, frame})), 1000 + SIGTERM) << "to be read";
    ::close(both_ends);
}

}  // namespace
}  // namespace fastccd::testing
